//! Forces of single elements in f64, for whoever looks at a body without an engine: stresses, bounds of the critical step.

use super::Model;
use crate::physics::element::Corners;

impl Model {
    /// Internal force of one element of a shape class [N], at any corner positions [m] and velocities [m/s].
    pub fn element_forces(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> Corners<f64> {
        hexroll_kernels_portable::element_forces(&self.composition()).force(&self.classes[class], x, v).f
    }
}
