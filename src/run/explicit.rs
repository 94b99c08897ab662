//! Explicit and quasi-static stages: whole windows, made of steps.

use super::footprint::{self, Footprint};
use super::state::{Run, State};
use crate::engine::{Step, Window};
use crate::error::Result;
use crate::physics::rim;
use crate::scene::Stage;

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
        let moving = (totals.time >= rim.motion.settled_after()).then(|| rim.own_kinetic());
        settling.at_rest(stage, window, moving, control, self.model, self.engine)
    }

    /// Steps to `end` and books the window.
    fn window(&mut self, stage: &Stage, end: f64) -> Result<Window> {
        self.state.recorder.force_time = 0.0;
        let (start, spin) = (self.state.totals.time, self.state.rim.at[rim::SPIN]);
        let road = self.scene.road.as_ref();
        let (mut whole, mut footprint) = (None, Footprint::default());
        while self.state.totals.time < end {
            let before = self.state.recorder.force_time;
            let part = self.part(end)?;
            footprint.add(self.model, road, self.state.recorder.force_time - before, &part);
            match &mut whole {
                None => whole = Some(part),
                Some(whole) => whole.extend(part),
            }
        }
        let window = whole.expect("a window has a step");
        if road.is_some() {
            self.state.recorder.chatter.add(start, end, [spin, window.rim[rim::SPIN]], &window);
        }
        let row = self.book(stage, self.state.control.before, &window, &footprint)?;
        self.balanced(&row)?;
        self.holds_its_shape(&row)?;
        Ok(window)
    }

    /// Steps on within a window that ends at `end`: to its end, or for as long as a footprint is one.
    fn part(&mut self, end: f64) -> Result<Window> {
        let start = self.state.totals.time;
        let rim = &self.state.rim;
        let spin = rim.rate[rim::SPIN].abs().max(rim.motion.rate_at(end)[rim::SPIN].abs());
        let parts = match self.scene.road {
            Some(_) => ((end - start) / footprint::part(self.around, spin) - 1e-9).ceil().max(1.0),
            None => 1.0,
        };
        let until = if parts > 1.0 { start + (end - start) / parts } else { end };
        while self.state.totals.time < until {
            self.advance_towards(end, until)?;
        }
        let State { totals, rim, control, .. } = &mut self.state;
        let next = rim.motion.plan(totals.time, control.before, control.before, 1)[0];
        let window = self.engine.sample(&next)?;
        (rim.at, rim.rate) = (window.rim, window.rim_rate);
        control.watch(&window, totals.steps);
        Ok(window)
    }

    /// Takes equal steps that would end at `end`, as many as reach `until`, at most until the critical step is due to be
    /// looked at again.
    fn advance_towards(&mut self, end: f64, until: f64) -> Result<()> {
        let State { totals, rim, control, recorder, .. } = &mut self.state;
        control.refresh(self.engine, self.model, totals)?;
        let start = totals.time;
        let taken = control.steps(self.scene.safety, end - start, until - start, totals.steps);
        let steps = rim.motion.plan(start, taken.dt, control.before, taken.count);
        self.engine.advance(&steps)?;
        recorder.force_time += steps.iter().map(Step::dtm).sum::<f64>();
        control.before = taken.dt;
        let time = if taken.whole { end } else { start + taken.count as f64 * taken.dt };
        totals.stepped(time, taken.dt, taken.count);
        Ok(())
    }
}
