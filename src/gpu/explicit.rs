//! What [`GpuEngine`] answers as an explicit engine.

use super::engine::GpuEngine;
use crate::engine::{Engine, EngineInfo, StageSetup, State, Step, Window};
use crate::error::Result;
use crate::physics::rim::Coordinates;

impl Engine for GpuEngine {
    fn info(&self) -> EngineInfo {
        let report = &self.body.gpu.report;
        EngineInfo {
            engine: "gpu".into(),
            precision: self.body.precision,
            device: report.name.clone(),
            driver: report.driver.clone(),
            threads: 0,
        }
    }

    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        if *setup != self.programs.setup || self.programs.stage.is_none() {
            self.programs.setup = *setup;
            self.compose_stage()?;
        }
        self.write_rim();
        Ok(())
    }

    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        self.in_submissions(steps, Self::submit)
    }

    fn sample(&mut self, next: &Step) -> Result<Window> {
        self.take_sample(next)
    }

    fn state(&mut self) -> Result<State> {
        self.body.restore()?;
        self.body.state()
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.body.restore()?;
        self.body.write_velocities(v, self.pace.window_steps > 0)?;
        self.rim.set_rate(&self.programs.setup, rim_rate);
        self.write_rim();
        self.body.gpu.check()
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        self.body.restore()?;
        self.body.write_positions(&state.x);
        self.rim.q = *rim;
        self.series.iter_mut().for_each(|series| series.rested = true);
        self.follow()?;
        self.set_velocity(&state.v, rim_rate)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.trial_force(x, v)
    }
}
