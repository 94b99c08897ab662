//! Circles of a directed graph.

use std::collections::{BTreeMap, BTreeSet};

/// Groups of two or more nodes that each lead to every other of the group.
pub fn circles<'a>(edges: &BTreeSet<(&'a str, &'a str)>) -> Vec<BTreeSet<&'a str>> {
    let nodes: BTreeSet<&str> = edges.iter().flat_map(|&(a, b)| [a, b]).collect();
    let reached: BTreeMap<&str, BTreeSet<&str>> = nodes.iter().map(|&n| (n, reach(n, edges))).collect();
    let mut found: Vec<BTreeSet<&str>> = Vec::new();
    for &n in &nodes {
        if found.iter().any(|group| group.contains(n)) {
            continue;
        }
        let group: BTreeSet<&str> = reached[n].iter().copied().filter(|m| reached[m].contains(n)).collect();
        if group.len() > 1 {
            found.push(group);
        }
    }
    found
}

/// Nodes that a node leads to.
fn reach<'a>(from: &'a str, edges: &BTreeSet<(&'a str, &'a str)>) -> BTreeSet<&'a str> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(n) = open.pop() {
        for &(_, to) in edges.range((n, "")..).take_while(|e| e.0 == n) {
            if seen.insert(to) {
                open.push(to);
            }
        }
    }
    seen
}
