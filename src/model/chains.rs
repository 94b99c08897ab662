//! Chains of elements: neighbours through the faces xi = +1 and xi = -1, one after the other. Lanes run along them,
//! whatever the numbering of the mesh.

pub use crate::physics::element::hex8::{BACK, FRONT};
use std::collections::{HashMap, VecDeque};

/// Elements in a row; `closed`: the last one's neighbour is the first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    pub elements: Vec<u32>,
    pub closed: bool,
}

/// The chains of a mesh, each element in one, in an order in which neighbours stand near each other: the mesh's own,
/// unless that is a poor one.
pub fn chains(hexes: &[[u32; 8]], nodes: usize) -> Vec<Chain> {
    let chains = walk(hexes);
    let touching = chains_by_node(&chains, hexes, nodes);
    let many = chains.len() > 64;
    if many && 4 * spread(&touching) > chains.len() {
        return reordered(chains, &touching, hexes);
    }
    chains
}

/// Follows the faces; chains by their lowest element.
fn walk(hexes: &[[u32; 8]]) -> Vec<Chain> {
    let by_back: HashMap<[u32; 4], u32> =
        hexes.iter().enumerate().map(|(e, hex)| (BACK.map(|c| hex[c]), e as u32)).collect();
    let next: Vec<Option<u32>> =
        hexes.iter().map(|hex| by_back.get(&FRONT.map(|c| hex[c])).copied()).collect();
    let mut has_previous = vec![false; hexes.len()];
    for &n in next.iter().flatten() {
        has_previous[n as usize] = true;
    }
    let mut taken = vec![false; hexes.len()];
    let mut chains = Vec::new();
    // Open chains from their ends, then what is left: rings.
    for ends in [true, false] {
        for first in 0..hexes.len() {
            if taken[first] || (ends && has_previous[first]) {
                continue;
            }
            let mut elements = Vec::new();
            let mut at = Some(first as u32);
            while let Some(e) = at.filter(|e| !taken[*e as usize]) {
                taken[e as usize] = true;
                elements.push(e);
                at = next[e as usize];
            }
            chains.push(Chain { elements, closed: !ends });
        }
    }
    chains.sort_by_key(|c| c.elements.iter().min().copied());
    chains
}

/// Chains at each node, ascending.
fn chains_by_node(chains: &[Chain], hexes: &[[u32; 8]], nodes: usize) -> Vec<Vec<u32>> {
    let mut touching = vec![Vec::new(); nodes];
    for (k, chain) in chains.iter().enumerate() {
        for &n in chain.elements.iter().flat_map(|e| &hexes[*e as usize]) {
            let list: &mut Vec<u32> = &mut touching[n as usize];
            if list.last() != Some(&(k as u32)) {
                list.push(k as u32);
            }
        }
    }
    touching
}

/// The largest distance, in the order of chains, between two that share a node.
fn spread(touching: &[Vec<u32>]) -> usize {
    touching.iter().filter_map(|t| Some(t.last()? - t.first()?)).max().unwrap_or(0) as usize
}

/// Breadth first from a chain with few neighbours (Cuthill & McKee's order, reversed).
fn reordered(chains: Vec<Chain>, touching: &[Vec<u32>], hexes: &[[u32; 8]]) -> Vec<Chain> {
    let neighbours = |k: usize| {
        let nodes = chains[k].elements.iter().flat_map(|e| &hexes[*e as usize]);
        let mut near: Vec<u32> = nodes.flat_map(|n| touching[*n as usize].iter().copied()).collect();
        near.sort_unstable();
        near.dedup();
        near
    };
    let graph: Vec<Vec<u32>> = (0..chains.len()).map(neighbours).collect();
    let mut by_degree: Vec<usize> = (0..chains.len()).collect();
    by_degree.sort_by_key(|k| graph[*k].len());
    let mut seen = vec![false; chains.len()];
    let mut order = Vec::with_capacity(chains.len());
    for start in by_degree {
        let mut waiting = VecDeque::from([start]);
        while let Some(k) = waiting.pop_front() {
            if std::mem::replace(&mut seen[k], true) {
                continue;
            }
            order.push(k);
            let mut near: Vec<usize> = graph[k].iter().map(|n| *n as usize).filter(|n| !seen[*n]).collect();
            near.sort_by_key(|n| graph[*n].len());
            waiting.extend(near);
        }
    }
    let mut chains: Vec<Option<Chain>> = chains.into_iter().map(Some).collect();
    order.iter().rev().filter_map(|k| chains[*k].take()).collect()
}
