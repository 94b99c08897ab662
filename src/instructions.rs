//! The kernels of a level of instructions, from the crates that compile them.

use crate::kernels::{Compiled, Passes};
use crate::physics::element::Composition;
use crate::physics::lanes::Level;
use crate::physics::scalar::Real;

/// Kernels for instructions that this machine has.
pub fn compiled(level: Level) -> Box<dyn Compiled> {
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(instructions) = level.avx512() {
            return hexroll_kernels_avx512::compiled(instructions);
        }
        if let Some(instructions) = level.avx2() {
            return hexroll_kernels_avx2::compiled(instructions);
        }
    }
    hexroll_kernels_portable::compiled(level.portable())
}

/// A number that kernels are compiled for.
pub trait Compilable: Real {
    fn passes(compiled: &dyn Compiled, composition: &Composition, extruded: bool) -> Passes<Self>;
}

impl Compilable for f64 {
    fn passes(compiled: &dyn Compiled, composition: &Composition, extruded: bool) -> Passes<f64> {
        compiled.passes_f64(composition, extruded)
    }
}

impl Compilable for f32 {
    fn passes(compiled: &dyn Compiled, composition: &Composition, extruded: bool) -> Passes<f32> {
        compiled.passes_f32(composition, extruded)
    }
}
