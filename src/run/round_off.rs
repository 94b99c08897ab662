//! Energy that rounding alone makes of a body: below it no balance is judged by a share of its terms, which are round-off too.
//!
//! *Evaluation.* An undeformed element has invariants of 3, and its energy is what G/2 times their difference from 3 leaves
//! of some ten roundings of half a unit each: 3 (G/2) 10 (eps/2) = 7.5 eps G a volume.
//!
//! *Positions.* A step rounds each coordinate by up to half a unit u in the last place. After n steps, independent ones,
//! neighbours a distance h apart are strained by sqrt(n) u / h, which stores M/2 n (u/h)^2 a volume, M = kappa + 4/3 G. What
//! of it moves has been stored, so the bound is one of kinetic energy too.

use super::estimate;
use crate::engine::EngineInfo;
use crate::model::Model;
use crate::precision::Precision;
use crate::scene::Scene;

/// Energy that is round-off, as a function of the steps taken.
#[derive(Debug, Clone, Copy, Default)]
pub struct RoundOff {
    /// Of evaluating a stored energy [J].
    evaluation: f64,
    /// What the rounding of positions adds in a step [J].
    per_step: f64,
}

impl RoundOff {
    /// Of a body on an engine. The CPU adds up energies in double precision whatever it computes forces in.
    pub fn of(scene: &Scene, model: &Model, info: &EngineInfo) -> RoundOff {
        let (mesh, law) = (&model.mesh, scene.body.law);
        let volume = model.mass.iter().sum::<f64>() / scene.body.density;
        let (shear, bulk) = (law.shear_modulus(), law.bulk_modulus());
        let summed = if info.engine == "cpu" { Precision::F64 } else { info.precision };
        let reach = |x: &[f64; 3]| (0..3).map(|d| (x[d] - mesh.axle[d]).abs()).fold(0.0, f64::max);
        let [half_unit, _] =
            estimate::units(info.precision, mesh.nodes.iter().map(reach).fold(0.0, f64::max));
        let strain = half_unit / estimate::shortest_edge(model);
        RoundOff {
            evaluation: 7.5 * summed.epsilon() * shear * volume,
            per_step: 0.5 * (bulk + 4.0 / 3.0 * shear) * strain * strain * volume,
        }
    }

    /// After `steps` steps [J].
    pub fn energy(&self, steps: u64) -> f64 {
        self.evaluation + self.per_step * steps as f64
    }
}
