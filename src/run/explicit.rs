//! Explicit and quasi-static stages: whole windows, made of steps.

use std::time::Instant;

use super::footprint::{self, Footprint};
use super::histories::Ends;
use super::state::{Run, State};
use crate::engine::{Step, Window};
use crate::error::Result;
use crate::physics::rim;
use crate::scene::Stage;

/// Steps after which the contact of each is summed up and forgotten: 6 MB of them. Below it a window's figures have the
/// bits of one sum over all of its steps.
const REMEMBERED: usize = 1 << 17;

impl Run<'_> {
    /// Runs the windows of a stage that starts now: until it is over, has settled, or is interrupted.
    /// Returns whether it has come to what it was to come to.
    pub fn explicit_stage(&mut self, stage: &Stage) -> Result<bool> {
        let start = self.state.totals.time;
        // Whole windows, the last one cut at the end of the stage.
        let end = start + stage.duration;
        let sample = self.scene.output.sample;
        let count = (stage.duration / sample - 1e-9).ceil().max(1.0) as u64;
        for n in 1..=count {
            let window_end = if n == count { end } else { start + n as f64 * sample };
            let window = self.window(stage, window_end)?;
            let settled = self.has_settled(stage, &window)?;
            let last = n == count || settled;
            let written = self.snapshots(stage, &window, last)?;
            if self.observer.interrupted() {
                if !written {
                    self.snapshots(stage, &window, true)?;
                }
                self.state.totals.interrupted = true;
                return Ok(true);
            }
            if settled {
                return Ok(true);
            }
        }
        Ok(!stage.is_quasi_static())
    }

    /// Whether a quasi-static stage has come to rest.
    fn has_settled(&mut self, stage: &Stage, window: &Window) -> Result<bool> {
        let State { totals, rim, control, settling, .. } = &mut self.state;
        let ended = rim.motion.settled_after().max(self.model.mesh.driven_end());
        let moving = (totals.time >= ended).then(|| rim.own_kinetic());
        settling.at_rest(stage, window, moving, control, self.model, self.engine)
    }

    /// Steps to `end`, or to where an interruption is seen, and books the window.
    fn window(&mut self, stage: &Stage, end: f64) -> Result<Window> {
        let State { totals, rim, recorder, .. } = &mut self.state;
        recorder.begin_window(totals.time, rim.at[rim::SPIN]);
        let road = self.scene.road.as_ref();
        let (mut whole, mut footprint) = (None::<Window>, Footprint::default());
        while self.state.totals.time < end {
            if let Some(whole) = whole.as_mut().filter(|w| w.step_contact.len() >= REMEMBERED) {
                self.hear(whole);
            }
            let before = self.state.recorder.force_time;
            let part = self.part(stage, end)?;
            footprint.add(self.model, road, self.state.recorder.force_time - before, &part);
            match &mut whole {
                None => whole = Some(part),
                Some(whole) => whole.extend(part),
            }
            if self.observer.interrupted() {
                break;
            }
        }
        let mut window = whole.expect("a window has a step");
        if road.is_some() {
            self.hear(&mut window);
        }
        let row = self.book(stage, self.state.control.before, &window, &footprint)?;
        self.balanced(&row)?;
        self.holds_its_shape(&row)?;
        Ok(window)
    }

    /// Takes down the contact of a window's steps so far, and forgets them.
    fn hear(&mut self, window: &mut Window) {
        let State { totals, rim, recorder, .. } = &mut self.state;
        recorder.hear(totals.time, rim.at[rim::SPIN], &std::mem::take(&mut window.step_contact));
    }

    /// Steps on within a window that ends at `end`: to its end, for as long as a footprint is one, until there are many
    /// steps to remember, or until an interruption is seen.
    fn part(&mut self, stage: &Stage, end: f64) -> Result<Window> {
        let State { totals, rim, .. } = &self.state;
        let (start, first) = (totals.time, totals.steps);
        let [at, rate] = [rim.at, rim.rate];
        let unwatched = self.histories.most();
        let spin = rim.rate[rim::SPIN].abs().max(rim.motion.rate_at(end)[rim::SPIN].abs());
        let parts = match self.scene.road {
            Some(_) => ((end - start) / footprint::part(self.around, spin) - 1e-9).ceil().max(1.0),
            None => 1.0,
        };
        let until = if parts > 1.0 { start + (end - start) / parts } else { end };
        let road = self.scene.road.is_some();
        let full = |steps: u64| {
            let taken = (steps - first) as usize;
            (road && taken >= REMEMBERED) || taken >= unwatched
        };
        loop {
            self.advance_towards(stage, end, until)?;
            let totals = &self.state.totals;
            if totals.time >= until || full(totals.steps) || self.observer.interrupted() {
                break;
            }
        }
        let State { totals, rim, control, .. } = &mut self.state;
        let next = rim.motion.plan(totals.time, control.before, control.before, 1)[0];
        let window = self.engine.sample(&next)?;
        (rim.at, rim.rate) = (window.rim, window.rim_rate);
        control.watch(&window, totals.steps);
        if self.histories.any() {
            let free = rim.motion.setup(0.0).free.map(|own| own.is_some());
            let ends = Ends { start, end: totals.time, at: [at, rim.at], rate: [rate, rim.rate], free };
            self.histories.look(&ends, &window.step_contact)?;
        }
        Ok(window)
    }

    /// Takes equal steps that would end at `end`, as many as reach `until`, at most until the critical step is due to be
    /// looked at again, or until an interruption is seen.
    fn advance_towards(&mut self, stage: &Stage, end: f64, until: f64) -> Result<()> {
        let State { totals, rim, control, .. } = &mut self.state;
        control.refresh(self.engine, self.model, totals)?;
        let start = totals.time;
        let planned = control.steps(self.scene.safety, end - start, until - start, totals.steps);
        let steps = rim.motion.plan(start, planned.dt, control.before, planned.count);
        let mut taken = 0;
        let mut time = start;
        while taken < steps.len() {
            let most = self.pace.most().min(self.histories.most());
            let piece = &steps[taken..steps.len().min(taken + most)];
            let begun = Instant::now();
            self.engine.advance(piece)?;
            self.pace.took(piece.len(), begun.elapsed());
            if self.histories.any() {
                self.histories.took(piece, self.engine.watched());
            }
            taken += piece.len();
            let whole = planned.whole && taken == steps.len();
            time = if whole { end } else { start + taken as f64 * planned.dt };
            if !whole {
                self.tell(stage, time, taken);
            }
            if self.observer.interrupted() {
                break;
            }
        }
        let State { totals, control, recorder, .. } = &mut self.state;
        recorder.force_time += steps[..taken].iter().map(Step::dtm).sum::<f64>();
        control.before = planned.dt;
        totals.stepped(time, planned.dt, taken);
        Ok(())
    }
}
