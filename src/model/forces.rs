//! Forces of single elements in f64, for whoever looks at a body without an engine: stresses, bounds of the critical step.

use super::Model;
use crate::physics::element::{Compose, Corners, Formulation};
use crate::physics::material::{Hyperelastic, Viscosity};

impl Model {
    /// Internal force of one element of a shape class [N], at any corner positions [m] and velocities [m/s].
    pub fn element_forces(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> Corners<f64> {
        self.composition().visit(Single { model: self, class, x, v })
    }
}

struct Single<'a> {
    model: &'a Model,
    class: usize,
    x: &'a Corners<f64>,
    v: &'a Corners<f64>,
}

impl Compose for Single<'_> {
    type Output = Corners<f64>;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Corners<f64> {
        F::force(&law, &viscosity, &self.model.classes[self.class], self.x, self.v).f
    }
}
