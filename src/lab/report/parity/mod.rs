//! The GPU engine against the CPU's double precision, on whatever adapter there is: what the program itself can show of
//! parity where there is no Rust to run the test suite with (`benches/gpu-check.sh`).
//!
//! `tests/gpu` has these and more, with mutants that must be noticed; the bounds here are those tests' own.

mod forces;
mod repeat;
mod rig;
mod steps;

use super::Case;

/// Every case, in the order of the page.
pub const CASES: &[Case] = &[forces::CASE, steps::BLOCK, steps::WHEEL, repeat::REPEAT, repeat::ENSEMBLE];
