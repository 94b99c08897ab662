//! Elements and nodes in lanes: consecutive ones that can be treated alike.

use crate::model::Model;
use std::ops::Range;

/// Consecutive elements of one shape class, at most as many as there are lanes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementBatch {
    pub first: usize,
    pub count: usize,
    pub class: usize,
    /// Corner c of lane l is node `base[c] + l`, in every lane: loads need no indices.
    pub contiguous: bool,
    pub base: [u32; 8],
    /// Otherwise: nodes by corner and lane; lanes beyond the count repeat the last element.
    pub nodes: [Vec<u32>; 8],
}

/// Cuts the elements into batches of `width` lanes.
pub fn element_batches(model: &Model, width: usize) -> Vec<ElementBatch> {
    let (hexes, class_of) = (&model.mesh.hexes, &model.class_of);
    let mut batches = Vec::new();
    let mut first = 0;
    while first < hexes.len() {
        let class = class_of[first];
        let alike = class_of[first..].iter().take(width).take_while(|c| **c == class).count();
        batches.push(element_batch(hexes, first, alike, width, class as usize));
        first += alike;
    }
    batches
}

fn element_batch(hexes: &[[u32; 8]], first: usize, count: usize, width: usize, class: usize) -> ElementBatch {
    let base = hexes[first];
    let follows = |lane: usize| (0..8).all(|c| hexes[first + lane][c] == base[c] + lane as u32);
    let contiguous = count == width && (0..width).all(follows);
    let row = |c: usize| (0..width).map(|lane| hexes[first + lane.min(count - 1)][c]).collect();
    let nodes = if contiguous { Default::default() } else { std::array::from_fn(row) };
    ElementBatch { first, count, class, contiguous, base, nodes }
}

/// What the nodes of a batch are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodeKind {
    Interior,
    /// At least one node can touch the road.
    Surface,
    /// All of them belong to the rim; index of the first among the rim nodes, the others follow.
    Rim(usize),
}

/// Consecutive nodes, at most as many as there are lanes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeBatch {
    pub first: usize,
    pub count: usize,
    pub kind: NodeKind,
    /// Held components, the same in every lane: bit d for component d.
    pub held: u8,
    /// (corner, element of lane 0), lane l gathering from element + l; `None`: the lanes have nothing in common.
    pub runs: Option<Vec<(usize, usize)>>,
}

/// Cuts the nodes into batches of `width` lanes. A structured row makes one batch after the other; where neighbours
/// gather from unlike corners, lanes are filled node by node.
pub fn node_batches(model: &Model, road: bool, width: usize) -> Vec<NodeBatch> {
    let mesh = &model.mesh;
    let surface = |n: usize| road && mesh.surface.binary_search(&(n as u32)).is_ok();
    let rim = |n: usize| mesh.rim.binary_search(&(n as u32)).ok();
    let held = |n: usize| mesh.held.get(n).copied().unwrap_or(0);
    let row = |n: usize| &model.corners[model.corner_start[n] as usize..model.corner_start[n + 1] as usize];
    let mut batches = Vec::new();
    let mut first = 0;
    while first < model.node_count() {
        let most = width.min(model.node_count() - first);
        let same_role = |n: &usize| match (rim(first), rim(*n)) {
            (None, None) => held(first) == held(*n),
            (Some(a), Some(b)) => b - a == n - first,
            _ => false,
        };
        let alike = (first..first + most).take_while(same_role).count();
        let (a, follows) = (row(first), |n: &usize| shifted(row(first), row(*n), n - first));
        let run = (first..first + alike).take_while(follows).count();
        // A short run in the middle of irregular nodes is not worth a batch of its own.
        let structured = run == alike || 2 * run >= width;
        let count = if structured { run } else { alike };
        let kind = match rim(first) {
            Some(k) => NodeKind::Rim(k),
            None if (first..first + count).any(surface) => NodeKind::Surface,
            None => NodeKind::Interior,
        };
        let runs = structured.then(|| a.iter().map(|s| ((s & 7) as usize, (s >> 3) as usize)).collect());
        batches.push(NodeBatch { first, count, kind, held: held(first), runs });
        first += count;
    }
    batches
}

/// Whether a node's corners are another's, each `by` elements on.
fn shifted(of: &[u32], row: &[u32], by: usize) -> bool {
    of.len() == row.len() && of.iter().zip(row).all(|(a, b)| a + 8 * by as u32 == *b)
}

/// The part of 0..count that a member works on.
pub fn share(count: usize, member: usize, members: usize) -> Range<usize> {
    count * member / members..count * (member + 1) / members
}
