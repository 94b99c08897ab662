//! What acts on the body from outside, and what of it a step needs.

use crate::engine::Step;
use crate::kernels::Conditions;
use crate::physics::material::Relaxation;
use crate::physics::node::{Loads, Prediction, StepSize};
use crate::physics::rim::{self, Coordinates};
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, vec3};
use crate::scene::{Friction, Road};

/// Road, loads, and the frame that positions are relative to.
pub struct World<T> {
    pub road: Option<Road>,
    pub friction: Option<Friction>,
    /// [m/s2]
    pub gravity: Vec3<T>,
    /// [1/s]
    pub mass_damping: f64,
    /// Origin of the frame [m].
    pub frame: [f64; 3],
    /// Prony series of the material, and shear modulus of its law [Pa].
    pub relaxation: Relaxation,
    pub shear_modulus: f64,
    /// Driven sets, and the first step whose poses are planned.
    pub driven: usize,
    pub planned_from: u64,
}

impl<T: Real> World<T> {
    /// Conditions of step number `number`, which takes the rim from coordinates `before` to `q`.
    pub fn conditions(
        &self,
        number: u64,
        step: &Step,
        before: &Coordinates,
        q: &Coordinates,
    ) -> Conditions<T> {
        let s = T::from_f64;
        let (start, end) = (rim::rotation(before), rim::rotation(q));
        let size = StepSize { dt: s(step.dt), dtm: s(step.dtm()) };
        let loads = Loads { gravity: self.gravity, alpha: s(self.mass_damping) };
        Conditions {
            step: size,
            loads,
            prediction: Prediction::new(&loads, size),
            road: self.road.as_ref().map(|road| road.seen_from(self.frame)),
            road_moves: self.road.as_ref().is_some_and(|road| road.moves()),
            friction: self.friction,
            axle: vec3(self.local(q)),
            axle_velocity: vec3(std::array::from_fn(|d| (q[d] - before[d]) / step.dt)),
            rotation: end.to_cols_array_2d().map(vec3),
            rotation_rate: ((end - start) * (1.0 / step.dt)).to_cols_array_2d().map(vec3),
            axle_before: vec3(self.local(before)),
            weights: [s(0.5 * step.dtm()); 2],
            has_gravity: self.gravity.iter().any(|g| *g != T::zero()),
            has_damping: self.mass_damping != 0.0,
            driven: self.driven * (number - self.planned_from) as usize,
            number,
        }
    }

    /// The same for a probe: works over the half step before.
    pub fn probed(&self, number: u64, step: &Step, before: &Coordinates, q: &Coordinates) -> Conditions<T> {
        let weights = [0.5 * step.dt_before, 0.0].map(T::from_f64);
        Conditions { weights, ..self.conditions(number, step, before, q) }
    }

    /// The axle in the frame.
    pub fn local(&self, q: &Coordinates) -> [f64; 3] {
        std::array::from_fn(|d| q[d] - self.frame[d])
    }
}
