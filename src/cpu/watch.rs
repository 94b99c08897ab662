//! States of some nodes, kept after every step.

use super::program::Program;
use crate::engine::{NodeState, Watched};
use crate::kernels::Shared;
use crate::physics::scalar::Real;

/// Where the watched nodes lie.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    /// Place, and number among the surface nodes.
    nodes: Vec<(usize, Option<usize>)>,
}

impl Watch {
    /// These nodes of a program; `road`: surface nodes have sums.
    pub fn new<T>(program: &Program<T>, nodes: &[Watched], road: bool) -> Watch {
        let at = |w: &Watched| {
            (program.place[w.node as usize] as usize, w.surface.filter(|_| road).map(|k| k as usize))
        };
        Watch { nodes: nodes.iter().map(at).collect() }
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }
}

/// Room for the states of some steps, which the members of a team fill, each a part of every step.
pub struct Kept<'a> {
    watch: &'a Watch,
    states: *mut NodeState,
}

// SAFETY: members write to parts that do not overlap (`keep`).
unsafe impl Sync for Kept<'_> {}

impl<'a> Kept<'a> {
    /// `states`: as many as there are watched nodes, for every step.
    pub fn new(watch: &'a Watch, states: &'a mut [NodeState]) -> Kept<'a> {
        Kept { watch, states: states.as_mut_ptr() }
    }

    pub fn any(&self) -> bool {
        self.watch.len() > 0
    }

    /// Keeps the part of a `member` of so many, after step number `n` of those there is room for. Positions are relative to
    /// the engine's frame.
    ///
    /// # Safety
    /// No node moves meanwhile, no other call has the same member and step, and there is room for step `n`.
    pub unsafe fn keep<T: Real>(&self, shared: &Shared<T>, n: usize, [member, of]: [usize; 2]) {
        let count = self.watch.len();
        let part = count * member / of..count * (member + 1) / of;
        for i in part {
            let (place, surface) = self.watch.nodes[i];
            // SAFETY: a place of the plan; nobody writes there now.
            let [x, v] = unsafe { [shared.x, shared.v].map(|f| f.map(|f| (*f.add(place)).to_f64())) };
            // SAFETY: as above, for the entry of a surface node.
            let impulse = surface.map_or([0.0; 3], |k| unsafe { shared.surface(k).0.impulse });
            // SAFETY: there is room, and this entry is this member's.
            unsafe { *self.states.add(n * count + i) = NodeState { x, v, impulse } };
        }
    }
}
