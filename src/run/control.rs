//! How long steps are: the critical step, and when it is looked at again.

use super::stability::{self, Critical};
use super::totals::Totals;
use crate::engine::{Engine, Window};
use crate::error::Result;
use crate::model::Model;

/// Shortest and longest interval between two looks at the critical step [steps].
const SHORTEST: u64 = 200;
const LONGEST: u64 = 6_400;

/// What decides the length of the next step.
#[derive(Debug, Clone, Default)]
pub struct StepControl {
    critical: Critical,
    /// Step count at which the critical step is looked at again, and how long the last answer held.
    refresh_at: u64,
    refresh_interval: u64,
    /// Stored energy [J] and smallest det F at which it was looked at out of turn, or up to which it need not be.
    strained: f64,
    squeezed: f64,
    /// The step before [s]: 0 where the velocities are those of the positions' time.
    pub before: f64,
}

/// Equal steps to be taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    pub dt: f64,
    pub count: usize,
    /// Whether they end where they were to.
    pub whole: bool,
}

impl StepControl {
    /// `negligible`: a stored energy that cannot change the critical step much [J].
    pub fn new(negligible: f64) -> StepControl {
        StepControl { strained: negligible, squeezed: 1.0, ..StepControl::default() }
    }

    /// The critical step as it was last found [s].
    pub fn critical(&self) -> f64 {
        self.critical.dt
    }

    /// Has the critical step looked at after `steps` steps in all, and often from there on.
    pub fn look_again(&mut self, steps: u64) {
        (self.refresh_at, self.refresh_interval) = (steps, 0);
    }

    /// Has the critical step looked at out of turn when the last answer was found on another body: by an impact, or a press
    /// after a rest. `steps`: those taken so far.
    pub fn watch(&mut self, window: &Window, steps: u64) {
        let stored = window.strain + window.hourglass;
        if stored > 1.5 * self.strained || window.min_jacobian < self.squeezed - 0.05 {
            (self.strained, self.squeezed) =
                (self.strained.max(stored), self.squeezed.min(window.min_jacobian));
            self.look_again(steps);
        }
    }

    /// Finds the critical step again if it is due, and decides how long to trust it, unless [`StepControl::watch`] says
    /// otherwise: twice as long while it stays within 0.2 %, four times while within a quarter of that, half as long where
    /// it moves by more than 1 % (the safety factor covers 5 to 10 %).
    pub fn refresh(&mut self, engine: &mut dyn Engine, model: &Model, totals: &mut Totals) -> Result<()> {
        if totals.steps < self.refresh_at {
            return Ok(());
        }
        let first = self.critical.dt == 0.0;
        let guess = if first { totals.element_bound } else { self.critical.dt };
        let x = engine.state()?.x;
        let new = stability::assembled(engine, model, &x, guess, (!first).then_some(&self.critical))?;
        let change = if first { 1.0 } else { (new.dt / self.critical.dt - 1.0).abs() };
        self.refresh_interval = match self.refresh_interval {
            0 => SHORTEST,
            i if change < 5e-4 => (4 * i).min(LONGEST),
            i if change < 2e-3 => (2 * i).min(LONGEST),
            i if change > 1e-2 => (i / 2).max(SHORTEST),
            i => i,
        };
        if first {
            totals.critical_first = new.dt;
        }
        totals.critical_min = totals.critical_min.min(new.dt);
        totals.lanczos_iterations += new.iterations;
        self.critical = new;
        self.refresh_at = totals.steps + self.refresh_interval;
        Ok(())
    }

    /// Equal steps, no longer than `safety` times the critical one, that would take `length` [s] in all: as many of them
    /// as reach `wanted` [s], at most until the critical step is due to be looked at again. `steps`: those taken so far.
    pub fn steps(&self, safety: f64, length: f64, wanted: f64, steps: u64) -> Steps {
        let whole = (length / (safety * self.critical.dt)).ceil().max(1.0) as usize;
        let dt = length / whole as f64;
        let wanted = (wanted / dt - 1e-6).ceil().max(1.0) as usize;
        let count = whole.min(wanted).min((self.refresh_at - steps) as usize);
        Steps { dt, count, whole: count == whole }
    }
}
