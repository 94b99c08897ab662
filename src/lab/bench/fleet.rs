//! Several wheels at once on a GPU, timed as one.

use super::clock::Clock;
use super::kind::Kind;
use super::rows::Timed;
use super::wheel::Roll;
use hexroll::Result;
use hexroll::engine::{Engine, EngineInfo, StageSetup, State, Step, Window};
use hexroll::gpu::{Gpu, GpuEngine, Precision, advance_together, ensemble};
use hexroll::model::Model;
use hexroll::physics::lanes::Level;
use hexroll::physics::rim::Coordinates;
use hexroll::scene::Scene;

/// An ensemble, whose bodies all do the same.
pub struct Fleet(Vec<GpuEngine>);

impl Fleet {
    /// Times it: steps are those of every wheel.
    pub(super) fn time(
        gpu: &Gpu,
        model: &Model,
        scene: &Scene,
        roll: &Roll,
        copies: usize,
        seconds: f64,
    ) -> Result<Timed> {
        let mut fleet = Fleet(ensemble(gpu, &vec![(model, scene); copies])?);
        let Clock { us, steps, batch } = Clock::run(&mut fleet, model, roll, seconds)?;
        // The last one: the furthest in the arrays.
        let last = fleet.0.last_mut().expect("there are several");
        let (state, bytes) = (last.state()?, last.bytes_per_element());
        drop(fleet);
        // What a step of one of them moves; the times are not those of all at once.
        let mut alone = GpuEngine::new(gpu, model, scene, Precision::F32)?;
        alone.set_resident(true)?;
        roll.start(&mut alone, model)?;
        let mut by_pass = alone.timed_advance(&roll.steps(0, 2))?;
        by_pass.passes.iter_mut().for_each(|pass| pass.seconds = None);
        Ok(Timed {
            kind: Kind::GpuF32,
            level: Level::detect(),
            threads: 0,
            copies,
            us,
            steps,
            batch,
            memory: Some(bytes),
            state,
            by_pass: Some(by_pass),
        })
    }

    fn each(&mut self, mut act: impl FnMut(&mut GpuEngine) -> Result<()>) -> Result<()> {
        self.0.iter_mut().try_for_each(&mut act)
    }
}

impl Engine for Fleet {
    fn info(&self) -> EngineInfo {
        self.0[0].info()
    }

    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        self.each(|engine| engine.begin_stage(setup))
    }

    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        advance_together(&mut self.0, steps)
    }

    fn sample(&mut self, next: &Step) -> Result<Window> {
        let windows = self.0.iter_mut().map(|engine| engine.sample(next)).collect::<Result<Vec<Window>>>()?;
        Ok(windows.into_iter().next().expect("there are several"))
    }

    fn state(&mut self) -> Result<State> {
        self.0[0].state()
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.each(|engine| engine.set_velocity(v, rim_rate))
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        self.each(|engine| engine.set_state(state, rim, rim_rate))
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.0[0].force(x, v)
    }
}
