//! Nodes that stand at the same place made one.

use super::super::raw::Raw;
use super::grid::Grid;

/// Makes nodes no farther apart than `within` [m] one, the first of them: parts that were meshed one by one then hang together.
pub fn merge(raw: &mut Raw, within: f64) {
    let all: Vec<u32> = (0..raw.nodes.len() as u32).collect();
    let grid = Grid::new(&raw.nodes, &all);
    let mut first: Vec<u32> = all.clone();
    for n in &all {
        let x = raw.nodes[*n as usize];
        grid.within([x.map(|c| c - within), x.map(|c| c + within)], |m| {
            let y = raw.nodes[m as usize];
            let apart = (0..3).map(|d| (x[d] - y[d]).powi(2)).sum::<f64>().sqrt();
            if m < *n && apart <= within {
                first[*n as usize] = first[*n as usize].min(first[m as usize]);
            }
        });
    }
    let gone = all.iter().filter(|n| first[**n as usize] != **n).count();
    raw.hexes.iter_mut().flatten().for_each(|n| *n = first[*n as usize]);
    for set in &mut raw.sets {
        set.nodes.iter_mut().for_each(|n| *n = first[*n as usize]);
    }
    raw.notes.push(format!("{gone} nodes became one with another (body.mesh.merge)"));
}
