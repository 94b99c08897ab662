//! Every kernel, compiled for AVX2 and FMA.
#![cfg(target_arch = "x86_64")]

use hexroll_kernels::{Compiled, For};
use hexroll_physics::lanes::Avx2;

/// The kernels of a machine that has these instructions.
pub fn compiled(instructions: Avx2) -> Box<dyn Compiled> {
    Box::new(For(instructions))
}
