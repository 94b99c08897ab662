//! When a quasi-static stage has come to rest: energies, the net force, and what rounding leaves of both.

use super::Run;
use crate::engine::Window;
use crate::error::Result;
use crate::scene::{Method, Stage};

impl Run<'_> {
    /// Whether a quasi-static stage has come to rest.
    pub(super) fn has_settled(&mut self, stage: &Stage, window: &Window) -> Result<bool> {
        let Method::QuasiStatic { kinetic_ratio, residual } = stage.method else { return Ok(false) };
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { f64::INFINITY };
        let before = self.last_ratios[1];
        self.last_ratios = [
            ratio(window.kinetic, window.strain),
            ratio(window.probe.net_force, window.probe.internal_force),
        ];
        let at_rest = self.last_ratios[0] <= kinetic_ratio || window.kinetic <= self.rounding_kinetic(stage);
        if self.totals.time < self.motion.settled_after() || !at_rest {
            return Ok(false);
        }
        // Where rounding leaves more than is asked for, it is over when the net force has stopped falling.
        let stopped = self.last_ratios[1] > 0.8 * before;
        let left = |run: &mut Self| -> Result<bool> {
            Ok(window.probe.net_force <= run.rounding_amplitude(stage) * run.rounding_force()?)
        };
        Ok(self.last_ratios[1] <= residual || stopped && left(self)?)
    }

    /// Amplitude, over half a unit in the last place, at which mass damping holds the oscillation that rounding drives: each
    /// step adds a third of the unit's square and damping takes its share alpha dt away.
    fn rounding_amplitude(&self, stage: &Stage) -> f64 {
        (1.0 / (3.0 * stage.mass_damping * self.dt_before)).sqrt().max(1.0)
    }

    /// Net force that rounding the positions of this engine leaves [N]: no residual can be asked to be smaller. Twice
    /// what moving every coordinate by half a unit in the last place does, one way or the other; 0 in double precision.
    fn rounding_force(&mut self) -> Result<f64> {
        let half_unit = self.half_unit();
        if half_unit == 0.0 {
            return Ok(0.0);
        }
        let mesh = &self.model.mesh;
        let x = self.engine.state()?.x;
        let still = vec![[0.0; 3]; x.len()];
        let mut sign = 1u32;
        let mut nudged = x.clone();
        for c in nudged.iter_mut().flatten() {
            sign = sign.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *c += if sign >> 31 == 0 { half_unit } else { -half_unit };
        }
        let (f, g) = (self.engine.force(&x, &still)?, self.engine.force(&nudged, &still)?);
        let free = (0..x.len()).filter(|&n| mesh.rim.binary_search(&(n as u32)).is_err());
        let held = |n: usize, d: usize| mesh.held.get(n).is_some_and(|bits| bits >> d & 1 == 1);
        let square =
            |n: usize| (0..3).filter(|&d| !held(n, d)).map(|d| (f[n][d] - g[n][d]).powi(2)).sum::<f64>();
        Ok(2.0 * free.map(square).sum::<f64>().sqrt())
    }

    /// Half a unit in the last place of the engine's positions [m]; 0 in double precision.
    fn half_unit(&self) -> f64 {
        if self.engine.info().precision == "f64" {
            return 0.0;
        }
        let mesh = &self.model.mesh;
        let reach = |x: &[f64; 3]| (0..3).map(|d| (x[d] - mesh.axle[d]).abs()).fold(0.0, f64::max);
        0.5 * f64::from(f32::EPSILON) * mesh.nodes.iter().map(reach).fold(0.0, f64::max)
    }

    /// Kinetic energy that rounding the positions keeps up [J]: no relaxation comes to less. Every node at the highest
    /// frequency, 2 / dt, with the amplitude that rounding keeps up; 0 in double precision.
    fn rounding_kinetic(&self, stage: &Stage) -> f64 {
        let speed = 2.0 / self.critical.dt * self.half_unit() * self.rounding_amplitude(stage);
        0.5 * self.model.mass.iter().sum::<f64>() * speed * speed
    }
}
