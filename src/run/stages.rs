//! The loop over the stages of a scene.

use super::chatter::Chatter;
use super::estimate;
use super::motion::RimState;
use super::observer::Observer;
use super::state::{Run, State};
use super::totals::Totals;
use crate::engine::{Engine, StageSetup};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::rim;
use crate::record::{ContactNoise, Estimate};
use crate::scene::{Drive, Method, Scene, Stage};

/// Index of the steer angle among the rim's coordinates.
const STEER: usize = 3;

/// Runs every stage of a scene.
///
/// # Errors
/// What implicit stages cannot do, before anything is computed; a stage that does not settle, energies that do not add
/// up, and whatever engine and observer fail with.
pub fn run(
    scene: &Scene,
    model: &Model,
    engine: &mut dyn Engine,
    observer: &mut dyn Observer,
) -> Result<Totals> {
    let implicit = scene.stages.iter().any(|s| matches!(s.method, Method::Implicit(_)));
    if let (true, Some(gap)) = (implicit, scene.beyond_implicit()) {
        return Err(gap);
    }
    let mut run = Run::new(scene, model, engine, observer)?;
    let ended = run.stages();
    if !scene.output.histories.is_empty() {
        // What was taken down before a failure is worth keeping; the failure matters more than that of keeping it.
        let kept = run.histories.finish();
        let kept = run.observer.histories(kept);
        ended.and(kept)?;
    } else {
        ended?;
    }
    Ok(run.state.totals)
}

impl Run<'_> {
    fn stages(&mut self) -> Result<()> {
        let scene = self.scene;
        while let Some(stage) = scene.stages.get(self.state.stage) {
            let left = scene.stages[self.state.stage..].iter().map(|s| s.duration).sum::<f64>();
            self.state.recorder.end = self.state.totals.time + left;
            self.stage(stage)?;
            let estimate = self.estimate(stage)?;
            let noise = self.state.recorder.chatter.noise();
            let noise = noise.map(|noise| ContactNoise { rounding: estimate.rounding, ..noise });
            self.state.totals.noise.push(noise);
            self.state.totals.estimate = estimate;
            self.measure_free_radius(stage);
            if self.state.totals.interrupted {
                break;
            }
            self.state.stage += 1;
        }
        Ok(())
    }

    fn stage(&mut self, stage: &Stage) -> Result<()> {
        let stage = &self.spun(stage)?;
        let State { totals, rim, recorder, .. } = &mut self.state;
        let start = totals.time;
        rim.motion = rim.motion.next(stage, start, rim.at, rim.rate);
        let relaxed = stage.is_quasi_static();
        self.engine.begin_stage(&StageSetup { relaxed, ..rim.motion.setup(stage.mass_damping) })?;
        if !self.scene.output.histories.is_empty() {
            self.engine.watch(&self.histories.begin(stage, self.scene, self.model))?;
        }
        // Mass and inertia belong to a component for as long as it is free.
        totals.ledger.rim_set(rim.own_kinetic());
        let chatter = Chatter::new(self.around, start, stage.duration);
        recorder.begin(start, chatter, self.scene.output.snapshots);
        if self.state.stage == 0 {
            self.start_body()?;
        }
        self.start_stage(stage.initial_velocity, start)?;
        if let Method::Implicit(settings) = stage.method {
            return self.implicit_stage(stage, &settings);
        }
        match self.explicit_stage(stage)? {
            true => Ok(()),
            false => Err(self.state.settling.failure(stage)),
        }
    }

    /// The stage with the spin that its longitudinal slip asks for.
    fn spun(&mut self, stage: &Stage) -> Result<Stage> {
        let mut stage = stage.clone();
        let Some(slip) = stage.slip else { return Ok(stage) };
        let steer = match stage.rim.steer {
            Drive::Displacement { to, .. } => to,
            _ => self.state.rim.at[STEER],
        };
        let speed =
            stage.heading_speed(self.scene.road.as_ref(), rim::axle(&self.state.rim.at).into(), steer);
        let totals = &mut self.state.totals;
        let radius = slip.free_radius.or(totals.free_radius).ok_or_else(|| Error::NotSettled {
            stage: stage.name.clone(),
            detail:
                "no stage before it has rolled freely, so its longitudinal slip has no free-rolling radius"
                    .into(),
        })?;
        totals.free_radius = Some(radius);
        stage.rim.spin = Drive::Velocity { to: (1.0 + slip.kappa) * speed / radius, ramp: slip.ramp };
        Ok(stage)
    }

    /// Classes of the run's errors after a stage.
    fn estimate(&mut self, stage: &Stage) -> Result<Estimate> {
        if let Method::Implicit(_) = stage.method {
            return Ok(Estimate::default());
        }
        let precision = self.engine.info().precision;
        let x = self.engine.state()?.x;
        let State { totals, recorder, settling, .. } = &self.state;
        let rounding = estimate::rounding(self.model, precision, &x, totals.steps);
        if stage.is_quasi_static() {
            return Ok(Estimate { rounding, residual: Some(settling.residual()), time_step: None });
        }
        let changing = recorder.chatter.noise().map_or(0.0, |noise| noise.changing_share);
        Ok(Estimate {
            rounding,
            residual: None,
            time_step: Some(estimate::time_step(totals.stored_error_share(), changing)),
        })
    }

    /// Keeps the free-rolling radius of a stage whose rim has spun freely without a moment.
    fn measure_free_radius(&mut self, stage: &Stage) {
        let State { totals, rim: RimState { at, .. }, recorder, .. } = &mut self.state;
        let speed = stage.heading_speed(self.scene.road.as_ref(), rim::axle(at).into(), at[STEER]);
        let rate = recorder.chatter.spin_rate();
        if let Some(rate) = rate.filter(|w| *w * speed > 0.0 && stage.rolls_freely()) {
            totals.free_radius = Some(speed / rate);
        }
    }
}
