//! States of some nodes, which a kernel writes after every step of a submission, and which come back with its reports: no
//! submission waits for them that would not wait anyway.

use super::body::Body;
use super::bound::Bound;
use super::compose::Kernel;
use super::layout::{Wgsl, decode};
use super::program::Program;
use super::programs::Programs;
use crate::engine::{NodeState, Watched};
use crate::error::Result;

/// Bytes that the states of a submission may take.
const ROOM: usize = 16 << 20;

/// Vectors a node and step.
const VECTORS: usize = 3;

/// A kernel with the nodes that it watches, and what has been kept of them.
pub struct Watch {
    program: Bound,
    nodes: usize,
    /// Most steps of a submission.
    pub steps: usize,
    kept: Vec<NodeState>,
}

impl Watch {
    /// Of some nodes of a body, by the model's numbers.
    ///
    /// # Errors
    /// The kernel cannot be composed, or its buffers not be made.
    pub fn new(body: &mut Body, programs: &Programs, nodes: &[Watched]) -> Result<Watch> {
        let numbers = body.by_model((0..body.counts.nodes as u32).collect());
        let none = u32::MAX;
        // Without a road the sums are a placeholder.
        let surface = |w: &Watched| w.surface.filter(|_| body.counts.surface > 0).unwrap_or(none);
        let table: Vec<[u32; 2]> = nodes.iter().map(|w| [numbers[w.node as usize], surface(w)]).collect();
        let each = VECTORS * nodes.len() * <[f64; 4]>::size(body.real());
        let steps = (ROOM / each).clamp(1, body.counts.contact_slots());
        let Body { gpu, buffers, .. } = body;
        buffers.filled(gpu, "watched_nodes", &table);
        buffers.zeroed(gpu, "watched_states", each, steps);
        let program = Program::new(gpu, &programs.choice, Kernel::Watch, &[])?;
        let program = Bound::new(gpu, program, |name| buffers.get(name));
        gpu.check()?;
        Ok(Watch { program, nodes: nodes.len(), steps, kept: Vec::new() })
    }

    /// Records it for the step whose plan entry is at `offset`.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, body: &Body, offset: u32) {
        self.program.dispatch(pass, body.counts.groups(self.nodes), offset);
    }

    /// Bytes of the states of some steps.
    pub fn bytes(&self, body: &Body, steps: usize) -> u64 {
        (steps * VECTORS * self.nodes * <[f64; 4]>::size(body.real())) as u64
    }

    /// Keeps the states that a submission brought back.
    pub fn keep(&mut self, body: &Body, bytes: &[u8]) {
        let vectors: Vec<[f64; 4]> = decode(body.real(), bytes);
        self.kept.extend(vectors.chunks_exact(VECTORS).map(|state| NodeState {
            x: [0, 1, 2].map(|d| state[0][d] + body.frame[d]),
            v: [0, 1, 2].map(|d| state[1][d]),
            impulse: [0, 1, 2].map(|d| state[2][d]),
        }));
    }

    /// What has been kept since the last call.
    pub fn kept(&mut self) -> Vec<NodeState> {
        std::mem::take(&mut self.kept)
    }
}
