//! Who listens to a simulation, and what it is told.

use super::totals::Totals;
use crate::error::Result;
use crate::record::{History, NewtonRow, Reaction, Sample, Snapshot};

/// Where a simulation stands.
#[derive(Debug, Clone, Copy)]
pub struct Progress<'a> {
    pub stage: &'a str,
    pub time: f64,
    /// Latest possible end of the simulation [s]; a quasi-static stage may end sooner.
    pub end: f64,
    pub steps: u64,
    /// What would be returned if the simulation ended here.
    pub totals: &'a Totals,
}

/// Who listens to a simulation.
pub trait Observer {
    /// A window has ended.
    fn sample(&mut self, sample: &Sample, progress: &Progress) -> Result<()>;
    /// Steps within a window have been taken; called about twice a second, or more often. `totals` are those of its parts
    /// that have been booked.
    fn advanced(&mut self, _progress: &Progress) {}
    /// Whole fields, as often as the scene asks.
    fn snapshot(&mut self, snapshot: &Snapshot, stage: &str) -> Result<()>;
    /// A line for the log: iterations of an implicit increment, and the like.
    fn note(&mut self, _line: &str) -> Result<()> {
        Ok(())
    }
    /// The iterations of an implicit increment, converged or not.
    fn increment(&mut self, _iterations: &[NewtonRow]) -> Result<()> {
        Ok(())
    }
    /// What drives sets of nodes has taken in the window of a `row`, set by set; after [`Observer::sample`].
    fn reactions(&mut self, _row: &Sample, _sets: &[Reaction]) -> Result<()> {
        Ok(())
    }
    /// Histories at a high rate, when the run ends, however it does.
    fn histories(&mut self, _histories: Vec<History>) -> Result<()> {
        Ok(())
    }
    /// Asked about twice a second, or more often: end here, keeping everything. The window on its way is cut short.
    fn interrupted(&self) -> bool {
        false
    }
}
