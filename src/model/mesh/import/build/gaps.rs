//! Surfaces that lie on each other without common nodes, and parts that hang together by nothing: what is not the same node is not
//! connected.

use super::super::raw::Raw;
use super::fault::Fault;
use super::grid::Grid;
use crate::error::Result;
use crate::physics::tensor::{cross, dot, sub};
use crate::scene::Gaps;

/// Nodes nearer than this share of the shortest edge are at the same place: files have six digits or more.
const SAME: f64 = 1e-3;
/// A node nearer to a face than this share of its size lies on it.
const ON: f64 = 1e-3;

/// What there is of gaps, as notes where the scene keeps them.
///
/// # Errors
/// The first kind of gap that there is, where the scene does not keep them.
pub fn check(raw: &Raw, facets: &[[u32; 4]], fault: &Fault) -> Result<Vec<String>> {
    let mut outer: Vec<u32> = facets.iter().flatten().copied().collect();
    outer.sort_unstable();
    outer.dedup();
    let grid = Grid::new(&raw.nodes, &outer);
    let found = [twice(raw, &outer, &grid, fault), hanging(raw, facets, &grid, fault), loose(raw, fault)];
    let found: Vec<(String, &str)> = found.into_iter().flatten().collect();
    match found.first() {
        Some((problem, remedy)) if fault.file().gaps == Gaps::Refuse => {
            let remedy = format!("{remedy}; if they are meant to be apart, write gaps = \"keep\"");
            Err(fault.error(problem.clone(), remedy))
        }
        _ => Ok(found.into_iter().map(|(problem, _)| problem).collect()),
    }
}

/// Outer nodes at the same place.
fn twice(raw: &Raw, outer: &[u32], grid: &Grid, fault: &Fault) -> Option<(String, &'static str)> {
    let edge = |hex: &[u32; 8], [a, b]: [usize; 2]| distance(raw, hex[a], hex[b]);
    const EDGES: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
    let edges = raw.hexes.iter().flat_map(|hex| EDGES.map(|ends| edge(hex, ends)));
    let within = SAME * edges.fold(f64::INFINITY, f64::min);
    let mut pairs = Vec::new();
    for &n in outer {
        let x = raw.nodes[n as usize];
        grid.within([x.map(|c| c - within), x.map(|c| c + within)], |m| {
            if n < m && distance(raw, n, m) <= within {
                pairs.push([n, m]);
            }
        });
    }
    let first = pairs.first()?;
    let problem = format!(
        "{} pairs of nodes at the same place, and nothing connects them: the first is {}",
        pairs.len(),
        fault.nodes(first)
    );
    Some((problem, "write merge = \"1 um\" to make them one"))
}

/// Outer nodes on a face that they do not belong to.
fn hanging(raw: &Raw, facets: &[[u32; 4]], grid: &Grid, fault: &Fault) -> Option<(String, &'static str)> {
    let (mut nodes, mut on) = (Vec::new(), None);
    for facet in facets {
        let corners = facet.map(|n| raw.nodes[n as usize]);
        let size = dot(sub(corners[2], corners[0]), sub(corners[2], corners[0])).sqrt();
        let near = ON * size;
        let bound = |pick: fn(f64, f64) -> f64, by: f64| -> [f64; 3] {
            std::array::from_fn(|d| corners.iter().map(|c| c[d]).reduce(pick).expect("four corners") + by)
        };
        grid.within([bound(f64::min, -near), bound(f64::max, near)], |n| {
            let x = raw.nodes[n as usize];
            // At a corner it is there twice, which is said elsewhere.
            let apart = |c: &[f64; 3]| dot(sub(x, *c), sub(x, *c)).sqrt() > near;
            if !facet.contains(&n) && corners.iter().all(apart) && is_on(corners, x, near) {
                nodes.push(n);
                on.get_or_insert(*facet);
            }
        });
    }
    nodes.sort_unstable();
    nodes.dedup();
    let problem = format!(
        "{} nodes hang on faces that they do not belong to: {}; the first face has the nodes {}",
        nodes.len(),
        fault.nodes(&nodes),
        fault.nodes(&on?)
    );
    Some((problem, "mesh both sides with common nodes: hanging nodes and ties are not modelled"))
}

/// Whether a point lies on one of the two triangles of a quadrilateral.
fn is_on([a, b, c, d]: [[f64; 3]; 4], x: [f64; 3], near: f64) -> bool {
    [[a, b, c], [a, c, d]].iter().any(|&[p, q, r]| {
        let (u, v, w) = (sub(q, p), sub(r, p), sub(x, p));
        let n = cross(u, v);
        let square = dot(n, n);
        if square == 0.0 {
            return false;
        }
        let (s, t) = (dot(cross(w, v), n) / square, dot(cross(u, w), n) / square);
        let off = dot(w, n).abs() / square.sqrt();
        off <= near && s >= -ON && t >= -ON && s + t <= 1.0 + ON
    })
}

/// Parts that have no node in common.
fn loose(raw: &Raw, fault: &Fault) -> Option<(String, &'static str)> {
    let mut parent: Vec<u32> = (0..raw.nodes.len() as u32).collect();
    for hex in &raw.hexes {
        let root = find(&mut parent, hex[0]);
        for &n in &hex[1..] {
            let other = find(&mut parent, n);
            parent[other as usize] = root;
        }
    }
    let mut first: Vec<u32> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for (e, hex) in raw.hexes.iter().enumerate() {
        if seen.insert(find(&mut parent, hex[0])) {
            first.push(e as u32);
        }
    }
    if first.len() < 2 {
        return None;
    }
    let problem = format!(
        "the mesh is in {} parts that nothing connects, with the elements {}",
        first.len(),
        fault.elements(&first)
    );
    Some((problem, "remove what does not belong to the body, or write merge = \"1 um\" if the parts touch"))
}

/// The root of a node, paths halved on the way.
fn find(parent: &mut [u32], mut n: u32) -> u32 {
    while parent[n as usize] != n {
        parent[n as usize] = parent[parent[n as usize] as usize];
        n = parent[n as usize];
    }
    n
}

fn distance(raw: &Raw, a: u32, b: u32) -> f64 {
    let d = sub(raw.nodes[a as usize], raw.nodes[b as usize]);
    dot(d, d).sqrt()
}
