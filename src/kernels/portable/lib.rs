//! Every kernel, compiled for what every machine has.

use hexroll_kernels::tangents::{self, ElementForces};
use hexroll_kernels::{Compiled, For};
use hexroll_physics::element::Composition;
use hexroll_physics::lanes::Portable;

/// The kernels of a machine that has these instructions.
pub fn compiled(instructions: Portable) -> Box<dyn Compiled> {
    Box::new(For(instructions))
}

/// Forces and energies of single elements, in plain numbers.
pub fn element_forces(composition: &Composition) -> Box<dyn ElementForces> {
    tangents::forces(composition)
}
