//! What [`GpuEngine`] answers as an explicit engine.

use super::engine::GpuEngine;
use super::watch::Watch;
use crate::engine::{Engine, EngineInfo, NodeState, StageSetup, State, Step, Watched, Window};
use crate::error::{Error, Result};
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

    fn watch(&mut self, nodes: &[Watched]) -> Result<()> {
        if let (false, Some(_)) = (nodes.is_empty(), &self.seat) {
            return Err(Error::Unsupported {
                what: "[[output.history]] in an ensemble".into(),
                instead: "leave --ensemble out, or the histories (--set 'output.history=[]')".into(),
            });
        }
        self.watch = None;
        if !nodes.is_empty() {
            self.watch = Some(Watch::new(&mut self.body, &self.programs, nodes)?);
        }
        let one_by_one = self.watch.is_some();
        if std::mem::replace(&mut self.programs.one_by_one, one_by_one) != one_by_one
            && self.programs.stage.is_some()
        {
            self.compose_stage()?;
        }
        Ok(())
    }

    fn watched(&mut self) -> Vec<NodeState> {
        self.watch.as_mut().map(Watch::kept).unwrap_or_default()
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.trial_force(x, v)
    }
}
