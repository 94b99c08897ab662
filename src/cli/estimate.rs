//! How many steps a scene takes, and how fast an engine takes them.

use std::time::{Duration, Instant};

use super::format::{count, duration, si, updates};
use hexroll::Result;
use hexroll::engine::Engine;
use hexroll::model::Model;
use hexroll::run::{Motion, stability};
use hexroll::scene::{ImplicitScheme, Method, Scene, Stage};

/// Steps of a scene at the step that single elements allow.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Steps {
    /// Largest step that is stable for every element by itself, at rest [s].
    pub element_bound_s: f64,
    /// Those of every shape.
    #[serde(skip)]
    pub bounds: Vec<stability::Bound>,
    /// The smallest of them times the scene's safety factor [s].
    pub dt_s: f64,
    /// Steps of every stage; a quasi-static one may settle sooner.
    pub by_stage: Vec<u64>,
    pub total: u64,
    /// Those of explicit and quasi-static stages: increments of implicit ones take a time of their own.
    #[serde(skip)]
    pub explicit: u64,
}

impl Steps {
    pub fn of(scene: &Scene, model: &Model) -> Result<Steps> {
        let bounds = stability::element_bounds(model)?;
        let element_bound_s = bounds.iter().map(|b| b.dt).fold(f64::INFINITY, f64::min);
        let dt_s = scene.safety * element_bound_s;
        let steps = |s: &Stage| match s.method {
            Method::Implicit(implicit) => match implicit.scheme {
                ImplicitScheme::Static { increments } => increments as u64,
                ImplicitScheme::Dynamic { step, .. } => (s.duration / step).ceil() as u64,
            },
            Method::Explicit | Method::QuasiStatic { .. } => (s.duration / dt_s).ceil() as u64,
        };
        let by_stage: Vec<u64> = scene.stages.iter().map(steps).collect();
        let total = by_stage.iter().sum();
        let is_explicit = |s: &Stage| !matches!(s.method, Method::Implicit(_));
        let of_stage = scene.stages.iter().zip(&by_stage);
        let explicit = of_stage.filter(|(s, _)| is_explicit(s)).map(|(_, n)| n).sum();
        Ok(Steps { element_bound_s, bounds, dt_s, by_stage, total, explicit })
    }

    /// Wall time at a rate of element updates per second [s].
    pub fn seconds(&self, model: &Model, rate: f64) -> f64 {
        self.total as f64 * model.element_count() as f64 / rate
    }
}

/// Runs shorter than this [s] are not announced.
const LONG: f64 = 180.0;

/// What a long run is about to take, in a line; none of a shorter one.
///
/// # Errors
/// Those of [`Steps::of`].
pub fn announcement(scene: &Scene, model: &Model, rate: f64) -> Result<Option<String>> {
    let steps = Steps::of(scene, model)?;
    let seconds = steps.explicit as f64 * model.element_count() as f64 / rate;
    let text = || {
        format!(
            "about {} at {}: {} steps of {} at most; Ctrl-C ends the run early and keeps everything",
            duration(seconds),
            updates(rate),
            count(steps.explicit),
            si(steps.dt_s, "s"),
        )
    };
    Ok((seconds >= LONG).then(text))
}

/// Element updates per second of an engine that takes the first steps of the scene. The engine is used up: its state
/// is no longer that of a start.
pub fn rate(engine: &mut dyn Engine, model: &Model, scene: &Scene, element_bound: f64) -> Result<f64> {
    /// A batch as long as this is measured well enough.
    const LONG_ENOUGH: Duration = Duration::from_millis(100);
    /// More steps are never taken: a small scene's rate is known by then, a GPU's too, which takes hundreds of steps a
    /// submission, and the body has hardly moved.
    const MOST: usize = 2_048;
    // Stable whatever safety the scene asks for.
    let dt = 0.5 * element_bound;
    let [x, y, z] = model.mesh.axle;
    let rim = [x, y, z, 0.0, 0.0, 0.0];
    let motion = Motion::at_rest(rim, scene.gravity).next(&scene.stages[0], 0.0, rim, [0.0; 6]);
    engine.begin_stage(&motion.setup(scene.stages[0].mass_damping))?;
    // The first step also builds what an engine builds on first use.
    let mut batch = |first: usize, count: usize| -> Result<Duration> {
        let at = |n: usize| n as f64 * dt;
        let steps = motion.plan(at(first), dt, if first == 0 { 0.0 } else { dt }, count);
        let next = motion.plan(at(first + count), dt, dt, 1)[0];
        let start = Instant::now();
        engine.advance(&steps)?;
        engine.sample(&next)?;
        Ok(start.elapsed())
    };
    batch(0, 1)?;
    let (mut taken, mut count) = (1, 2);
    loop {
        let time = batch(taken, count)?;
        taken += count;
        if time >= LONG_ENOUGH || taken + 4 * count > MOST {
            return Ok((model.element_count() * count) as f64 / time.as_secs_f64());
        }
        count *= 4;
    }
}
