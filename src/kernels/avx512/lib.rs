//! Every kernel, compiled for AVX-512F and FMA.
#![cfg(target_arch = "x86_64")]

use hexroll_kernels::{Compiled, For};
use hexroll_physics::lanes::Avx512;

/// The kernels of a machine that has these instructions.
pub fn compiled(instructions: Avx512) -> Box<dyn Compiled> {
    Box::new(For(instructions))
}
