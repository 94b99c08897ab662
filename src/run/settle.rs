//! When a quasi-static stage has come to rest: energies, the net force, and what rounding leaves of both.

use super::control::StepControl;
use crate::engine::{Engine, Window};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::scene::{Method, Stage};

/// How far a quasi-static stage is from rest.
#[derive(Debug, Clone)]
pub struct Settling {
    /// Kinetic over strain energy, and relative net force, at the last window.
    ratios: [f64; 2],
}

impl Default for Settling {
    /// Not at rest at all.
    fn default() -> Self {
        Settling { ratios: [f64::INFINITY; 2] }
    }
}

impl Settling {
    /// Net force over internal force at the last window.
    pub fn residual(&self) -> f64 {
        self.ratios[1]
    }

    /// Looks at a window, and says whether a quasi-static stage has come to rest with it. `rim`: the kinetic energy of the
    /// rim's own mass, which no node has [J]; none while ramps go on.
    pub fn at_rest(
        &mut self,
        stage: &Stage,
        window: &Window,
        rim: Option<f64>,
        control: &StepControl,
        model: &Model,
        engine: &mut dyn Engine,
    ) -> Result<bool> {
        let Method::QuasiStatic { kinetic_ratio, residual } = stage.method else { return Ok(false) };
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { f64::INFINITY };
        let before = self.ratios[1];
        self.ratios = [
            ratio(window.kinetic + rim.unwrap_or(0.0), window.strain),
            ratio(window.probe.net_force, window.probe.internal_force),
        ];
        let half_unit = half_unit(model, &*engine);
        let amplitude = rounding_amplitude(stage, control);
        let still = || window.kinetic <= rounding_kinetic(model, control, half_unit, amplitude);
        if rim.is_none() || !(self.ratios[0] <= kinetic_ratio || still()) {
            return Ok(false);
        }
        // Where rounding leaves more than is asked for, it is over when the net force has stopped falling.
        let stopped = self.ratios[1] > 0.8 * before;
        Ok(self.ratios[1] <= residual
            || stopped && window.probe.net_force <= amplitude * rounding_force(model, half_unit, engine)?)
    }

    /// The error of a stage that has not come to rest in its time.
    pub fn failure(&self, stage: &Stage) -> Error {
        let asked = match stage.method {
            Method::QuasiStatic { kinetic_ratio, residual } => [kinetic_ratio, residual],
            Method::Explicit | Method::Implicit(_) => [f64::INFINITY; 2],
        };
        Error::NotSettled {
            stage: stage.name.clone(),
            detail: format!(
                "kinetic/strain energy {:.2e} (asked: {:.1e}), relative residual force {:.2e} \
                 (asked: {:.1e}) after {} s; a longer duration or another mass_damping may help",
                self.ratios[0], asked[0], self.ratios[1], asked[1], stage.duration
            ),
        }
    }
}

/// Amplitude, over half a unit in the last place, at which mass damping holds the oscillation that rounding drives: each
/// step adds a third of the unit's square and damping takes its share alpha dt away.
fn rounding_amplitude(stage: &Stage, control: &StepControl) -> f64 {
    (1.0 / (3.0 * stage.mass_damping * control.before)).sqrt().max(1.0)
}

/// Net force that rounding the positions of this engine by up to `half_unit` leaves [N]: no residual can be asked to be
/// smaller. Twice what moving every coordinate by half a unit in the last place does, one way or the other.
fn rounding_force(model: &Model, half_unit: f64, engine: &mut dyn Engine) -> Result<f64> {
    let mesh = &model.mesh;
    let x = engine.state()?.x;
    let still = vec![[0.0; 3]; x.len()];
    let mut sign = 1u32;
    let mut nudged = x.clone();
    for c in nudged.iter_mut().flatten() {
        sign = sign.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *c += if sign >> 31 == 0 { half_unit } else { -half_unit };
    }
    let (f, g) = (engine.force(&x, &still)?, engine.force(&nudged, &still)?);
    let free = (0..x.len()).filter(|&n| mesh.rim.binary_search(&(n as u32)).is_err());
    let held = |n: usize, d: usize| mesh.held.get(n).is_some_and(|bits| bits >> d & 1 == 1);
    let square = |n: usize| (0..3).filter(|&d| !held(n, d)).map(|d| (f[n][d] - g[n][d]).powi(2)).sum::<f64>();
    Ok(2.0 * free.map(square).sum::<f64>().sqrt())
}

/// Half a unit in the last place of the engine's positions [m].
fn half_unit(model: &Model, engine: &dyn Engine) -> f64 {
    let mesh = &model.mesh;
    let reach = |x: &[f64; 3]| (0..3).map(|d| (x[d] - mesh.axle[d]).abs()).fold(0.0, f64::max);
    0.5 * engine.info().precision.epsilon() * mesh.nodes.iter().map(reach).fold(0.0, f64::max)
}

/// Kinetic energy that rounding the positions keeps up [J]: no relaxation comes to less. Every node at the highest
/// frequency, 2 / dt, with the amplitude that rounding keeps up.
fn rounding_kinetic(model: &Model, control: &StepControl, half_unit: f64, amplitude: f64) -> f64 {
    let speed = 2.0 / control.critical() * half_unit * amplitude;
    0.5 * model.mass.iter().sum::<f64>() * speed * speed
}
