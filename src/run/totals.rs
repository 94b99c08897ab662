//! What a simulation knows of itself as it goes, and when it is over.

use super::ledger::Ledger;
use super::round_off::RoundOff;
use crate::record::{ContactNoise, Estimate};

/// What a finished simulation knows of itself.
#[derive(Debug, Clone, Default)]
pub struct Totals {
    pub steps: u64,
    pub time: f64,
    pub dt_min: f64,
    pub dt_max: f64,
    /// First and smallest critical step found [s], and the bound from single elements at rest.
    pub critical_first: f64,
    pub critical_min: f64,
    pub element_bound: f64,
    /// Eigenvalue iterations spent on it (two force passes each).
    pub lanczos_iterations: usize,
    /// Of implicit stages: increments, cuts, Newton iterations, iterations or sweeps of the inner solver.
    pub implicit: ImplicitCounts,
    pub ledger: Ledger,
    /// What rounding leaves of the stored energy, at most [J].
    pub energy_rounding: f64,
    /// Scatter of the road's force in every stage that has ended; none in implicit stages, and without a road.
    pub noise: Vec<Option<ContactNoise>>,
    /// Free-rolling radius that the last longitudinal slip was related to, or that was measured since [m].
    pub free_radius: Option<f64>,
    /// Classes of its own errors, as the last stage that has ended leaves them.
    pub estimate: Estimate,
    /// Energy that rounding alone makes.
    pub round_off: RoundOff,
    /// Whether an observer ended it.
    pub interrupted: bool,
}

/// What implicit stages cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ImplicitCounts {
    pub increments: usize,
    pub cuts: usize,
    pub newton: usize,
    /// Iterations of the linear solver, or sweeps of the relaxation.
    pub inner: usize,
}

impl Totals {
    /// Of a simulation that has not begun; `element_bound` is the critical step of single elements at rest [s],
    /// `energy_rounding` what rounding leaves of the stored energy [J].
    pub(super) fn start(element_bound: f64, energy_rounding: f64, round_off: RoundOff) -> Totals {
        let mut totals = Totals {
            element_bound,
            energy_rounding,
            round_off,
            dt_min: f64::INFINITY,
            critical_min: f64::INFINITY,
            ..Totals::default()
        };
        // The reference shape stores nothing.
        totals.ledger.start(0.0);
        totals
    }

    /// Energy that rounding alone has made so far [J].
    pub fn energy_round_off(&self) -> f64 {
        self.round_off.energy(self.steps)
    }

    /// Worst error of the stored-energy balance over the largest term; 0 where rounding alone makes as much.
    pub fn stored_error_share(&self) -> f64 {
        let Ledger { worst_stored_balance: error, largest_term, .. } = self.ledger;
        if error > self.energy_round_off() { error / largest_term } else { 0.0 }
    }

    /// Books `count` steps of `dt` that end at `time`.
    pub(super) fn stepped(&mut self, time: f64, dt: f64, count: usize) {
        self.time = time;
        self.steps += count as u64;
        self.dt_min = self.dt_min.min(dt);
        self.dt_max = self.dt_max.max(dt);
    }
}
