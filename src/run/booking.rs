//! Rows of the history and whole fields, handed to the observer.

use super::fields::{self, Moment};
use super::footprint::Footprint;
use super::ledger::WindowEnd;
use super::observer::Progress;
use super::state::{Run, State};
use crate::engine::Window;
use crate::error::{Error, Result};
use crate::model::mesh::Driven;
use crate::record::{Reaction, Sample};
use crate::scene::Stage;

/// Error of the stored-energy balance, over the largest term, at which a run is ended. Hard impacts leave some per cent.
pub const GARBAGE: f64 = 0.25;

/// What a set has done in a window of `length` that ends at `time` [s], from its impulse [N s].
fn reaction(set: &Driven, impulse: &[f64; 3], time: f64, length: f64) -> Reaction {
    let moved = set.motion.displacement(time);
    let component = |d: usize| set.components[d].then(|| [moved[d], impulse[d] / length]);
    Reaction { set: set.motion.nodes.name.clone(), components: [0, 1, 2].map(component) }
}

impl Run<'_> {
    /// Books a window whose last step was `dt` long, and hands out its row.
    pub fn book(&mut self, stage: &Stage, dt: f64, window: &Window, footprint: &Footprint) -> Result<Sample> {
        let (time, length) = (self.state.totals.time, self.state.recorder.force_time);
        let rim_kinetic = self.state.rim.motion.own_kinetic(&window.rim_rate);
        let at = WindowEnd { time, length, dt, stage: stage.name.clone(), rim_kinetic };
        let State { totals, recorder, .. } = &mut self.state;
        let row = totals.ledger.row(self.scene.road.as_ref(), &at, window, footprint, &recorder.scatter);
        let (totals, end) = (&*totals, recorder.end);
        let progress = Progress { stage: &stage.name, time, end, steps: totals.steps, totals };
        self.observer.sample(&row, &progress)?;
        let sets: Vec<Reaction> = self
            .model
            .mesh
            .driven
            .iter()
            .zip(&window.reactions)
            .map(|(set, i)| reaction(set, i, time, length))
            .collect();
        if !sets.is_empty() {
            self.observer.reactions(&row, &sets)?;
        }
        self.is_on_the_road(window)?;
        Ok(row)
    }

    /// Ends a run whose body has come to where a height field has no height.
    fn is_on_the_road(&self, window: &Window) -> Result<()> {
        let Some(road) = &self.scene.road else { return Ok(()) };
        match window.surface.iter().find(|s| road.gap(s.x).is_nan() && !s.x[0].is_nan()) {
            Some(node) => Err(Error::OffRoad { time: self.state.totals.time, at: node.x }),
            None => Ok(()),
        }
    }

    /// Tells the observer that the steps so far, and `taken` more, have come to `time` within a window.
    pub fn tell(&mut self, stage: &Stage, time: f64, taken: usize) {
        let State { totals, recorder, .. } = &self.state;
        let steps = totals.steps + taken as u64;
        self.observer.advanced(&Progress { stage: &stage.name, time, end: recorder.end, steps, totals });
    }

    /// Ends a run whose energies do not add up: a step beyond the critical one need not turn an element inside out.
    pub fn balanced(&self, row: &Sample) -> Result<()> {
        let (recorder, totals) = (&self.state.recorder, &self.state.totals);
        let error = (row.stored_balance_error_J - recorder.unbalanced).abs();
        let share = error / totals.ledger.largest_term;
        match error > recorder.negligible.max(totals.energy_round_off()) && share > GARBAGE {
            true => Err(Error::Unbalanced { step: totals.steps, time: row.time_s, share }),
            false => Ok(()),
        }
    }

    /// Ends a run whose hourglass energy is beyond the limit that the scene sets.
    pub fn holds_its_shape(&self, row: &Sample) -> Result<()> {
        let (Some(limit), totals) = (self.scene.body.hourglass_limit, &self.state.totals) else {
            return Ok(());
        };
        match row.hourglass_share(totals.ledger.largest_stored, totals.energy_rounding) {
            Some(share) if share > limit => {
                Err(Error::Hourglass { step: totals.steps, time: row.time_s, share, limit })
            }
            _ => Ok(()),
        }
    }

    /// Hands out a snapshot if one is due; whether it was.
    pub fn snapshots(&mut self, stage: &Stage, window: &Window, last: bool) -> Result<bool> {
        let output = &self.scene.output;
        let State { totals, recorder, .. } = &mut self.state;
        if !recorder.wants_fields(output.snapshots, totals.time, output.sample, last) {
            return Ok(false);
        }
        let state = self.engine.state()?;
        let moment = Moment { time: totals.time, step: totals.steps, length: recorder.force_time };
        let worn = &totals.ledger.friction_energy;
        let snapshot = fields::snapshot(self.model, self.scene.road.as_ref(), &moment, state, window, worn);
        self.observer.snapshot(&snapshot, &stage.name)?;
        Ok(true)
    }
}
