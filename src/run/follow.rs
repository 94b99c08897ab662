//! When the critical step is looked at again.

use super::{Run, stability};
use crate::engine::Window;
use crate::error::Result;

impl Run<'_> {
    /// Has the critical step looked at out of turn when the last answer was found on another body: by an impact, or a press
    /// after a rest.
    pub(super) fn watch(&mut self, window: &Window) {
        let stored = window.strain + window.hourglass;
        if stored > 1.5 * self.strained || window.min_jacobian < self.squeezed - 0.05 {
            (self.strained, self.squeezed) =
                (self.strained.max(stored), self.squeezed.min(window.min_jacobian));
            (self.refresh_at, self.refresh_interval) = (self.totals.steps, 0);
        }
    }

    /// Finds the critical step again, and decides how long to trust it, unless [`Run::watch`] says otherwise: twice
    /// as long while it stays within 0.2 %, four times while within a quarter of that, half as long where it moves by more than
    /// 1 % (the safety factor covers 5 to 10 %).
    pub(super) fn refresh(&mut self) -> Result<()> {
        const SHORTEST: u64 = 200;
        const LONGEST: u64 = 6_400;
        let first = self.critical.dt == 0.0;
        let guess = if first { self.totals.element_bound } else { self.critical.dt };
        let x = self.engine.state()?.x;
        let new =
            stability::assembled(self.engine, self.model, &x, guess, (!first).then_some(&self.critical))?;
        let change = if first { 1.0 } else { (new.dt / self.critical.dt - 1.0).abs() };
        self.refresh_interval = match self.refresh_interval {
            0 => SHORTEST,
            i if change < 5e-4 => (4 * i).min(LONGEST),
            i if change < 2e-3 => (2 * i).min(LONGEST),
            i if change > 1e-2 => (i / 2).max(SHORTEST),
            i => i,
        };
        if first {
            self.totals.critical_first = new.dt;
        }
        self.totals.critical_min = self.totals.critical_min.min(new.dt);
        self.totals.lanczos_iterations += new.iterations;
        self.critical = new;
        self.refresh_at = self.totals.steps + self.refresh_interval;
        Ok(())
    }
}
