//! The steps that a team takes, and how the rim goes meanwhile.

use super::rim::{Reaction, RimState};
use super::world::World;
use crate::engine::{StageSetup, Step};
use crate::kernels::Conditions;
use crate::physics::material::{Fading, Pace};
use crate::physics::scalar::Real;

/// Steps to take, from step number `first` on.
pub struct Course<'a, T> {
    pub world: &'a World<T>,
    pub setup: &'a StageSetup,
    pub first: u64,
    pub steps: &'a [Step],
    /// The rim before them.
    pub rim: RimState,
    /// Whether everything has relaxed when the first of them begins.
    pub rested: bool,
    /// Conditions of every step; none where a component of the rim is free, and they depend on the state.
    known: Option<Vec<Conditions<T>>>,
}

impl<'a, T: Real> Course<'a, T> {
    pub fn new(
        world: &'a World<T>,
        setup: &'a StageSetup,
        first: u64,
        steps: &'a [Step],
        rim: RimState,
        rested: bool,
    ) -> Self {
        let known = (!RimState::is_free(setup)).then(|| {
            let starts = std::iter::once(&rim.q).chain(steps.iter().map(|s| &s.rim));
            let numbered = (first..).zip(steps).zip(starts);
            numbered.map(|((n, step), before)| world.conditions(n, step, before, &step.rim)).collect()
        });
        Course { world, setup, first, steps, rim, rested, known }
    }

    /// Its first steps alone.
    pub fn cut(self, count: usize) -> Self {
        Course { steps: &self.steps[..count], ..self }
    }

    /// Terms of the Prony series in step `n`.
    pub fn terms(&self, n: usize) -> Vec<Fading> {
        let pace = if self.setup.relaxed || (n == 0 && self.rested) { Pace::Relaxed } else { Pace::Timed };
        let (World { relaxation, shear_modulus, .. }, step) = (self.world, &self.steps[n]);
        relaxation.fading(*shear_modulus, step.dt_before, step.dt, pace)
    }

    /// Conditions of lines that are not the rim's, in step `n`: the motion of a free rim is nothing to them.
    pub fn early(&self, n: usize) -> Conditions<T> {
        let held = &self.rim.q;
        match &self.known {
            Some(known) => known[n].clone(),
            None => self.world.conditions(self.first + n as u64, &self.steps[n], held, held),
        }
    }

    /// Takes the rim through step `n`, a free one by the `reaction` of the body; conditions of all lines.
    pub fn late(
        &self,
        n: usize,
        rim: &mut RimState,
        reaction: impl FnOnce(&RimState) -> Reaction,
    ) -> Conditions<T> {
        let step = &self.steps[n];
        let before = *rim;
        match &self.known {
            Some(known) => {
                let rate = std::array::from_fn(|c| (step.rim[c] - before.q[c]) / step.dt);
                *rim = RimState { q: step.rim, rate, ..before };
                known[n].clone()
            }
            None => {
                let (q, rate) = before.advanced(self.setup, step, &reaction(&before));
                *rim = RimState { q, rate, ..before };
                self.world.conditions(self.first + n as u64, step, &before.q, &q)
            }
        }
    }
}
