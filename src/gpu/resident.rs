//! Small meshes: one work group takes many steps in one dispatch, positions and forces in its own memory.

use super::Gpu;
use super::chains::{Chains, LANES, THREADS};
use super::layout::{Real, Step, Wgsl};
use std::collections::HashSet;

/// Storage buffers that its kernel binds; on adapters with fewer the passes take all meshes.
pub const RESIDENT_STORAGE_BUFFERS: u32 = 21;

/// How a mesh is laid out in a work group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    pub threads: usize,
    /// Rounds of `threads` chains.
    pub rounds: usize,
    /// Faces of the longest chain.
    pub faces: usize,
    /// Numbers that positions need, and forces likewise.
    pub words: usize,
}

impl Shape {
    /// The layout, if the mesh fits the adapter's shared memory, and no two chains that are side by side ever meet at
    /// a node with the same corner.
    pub fn new(gpu: &Gpu, chains: &Chains, nodes: usize) -> Option<Shape> {
        let limits = gpu.device.limits();
        if limits.max_storage_buffers_per_shader_stage < RESIDENT_STORAGE_BUFFERS {
            return None;
        }
        let threads = limits.max_compute_invocations_per_workgroup as usize;
        Shape::within(threads, gpu.report.shared_memory as usize, chains, nodes)
    }

    /// The same for work groups of at most so many threads and so many bytes: as many threads as find chains that are apart.
    pub fn within(threads: usize, memory: usize, chains: &Chains, nodes: usize) -> Option<Shape> {
        let most = THREADS.min(threads) / LANES;
        (2..=most).rev().find_map(|groups| Shape::of_groups(groups, memory, chains, nodes))
    }

    /// With so many groups of chains at a time.
    fn of_groups(groups: usize, memory: usize, chains: &Chains, nodes: usize) -> Option<Shape> {
        let threads = groups * LANES;
        let words = (3 * nodes).max(4 * threads);
        let bytes = 2 * size_of::<f32>() * words + Step::size(Real::Single);
        if bytes > memory {
            return None;
        }
        let rounds: Vec<&[[u32; 4]]> = chains.groups.chunks(groups).collect();
        let faces = chains.groups.iter().map(|g| g[2] as usize + 1).max()?;
        let apart = rounds.iter().all(|round| (0..faces).all(|face| is_apart(chains, round, face)));
        apart.then_some(Shape { threads, rounds: rounds.len(), faces, words })
    }

    /// Values of the kernel's constants.
    pub fn constants(&self) -> [(&'static str, f64); 4] {
        let Shape { threads, rounds, faces, words } = *self;
        [
            ("threads", threads as f64),
            ("rounds", rounds as f64),
            ("faces", faces as f64),
            ("words", words as f64),
        ]
    }
}

/// Whether the chains of a round have different nodes at each corner of their faces number `face`.
fn is_apart(chains: &Chains, round: &[[u32; 4]], face: usize) -> bool {
    (0..4).all(|corner| {
        let mut met = HashSet::new();
        let there = round.iter().filter(|g| face <= g[2] as usize);
        there.flat_map(|g| chains.corner_nodes(g, face, corner)).all(|node| met.insert(*node))
    })
}
