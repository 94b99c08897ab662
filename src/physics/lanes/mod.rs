//! Several numbers at once: one element, or one node, a lane.
//!
//! The physics is written once over [`Scalar`]; a lane type makes the same source compute 2 to 16 elements. All of it
//! must be inlined into one function with the right target feature (a call in between passes vectors through memory),
//! so hot code has no closures and no `array::map`.

mod array;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use array::Array;
pub(super) use array::{GUESS_F32, GUESS_F64};
#[cfg(target_arch = "x86_64")]
pub use x86::{F32x8, F32x16, F64x4, F64x8};

use super::scalar::{Real, Scalar};

/// Lanes of a real number.
pub trait Lanes: Scalar {
    type Real: Real;
    const WIDTH: usize;

    /// The same number in every lane.
    fn splat(value: Self::Real) -> Self;
    /// WIDTH consecutive numbers from `at`.
    ///
    /// # Safety
    /// `at + WIDTH <= slice.len()`.
    unsafe fn load(slice: *const Self::Real, at: usize) -> Self;
    /// # Safety
    /// As [`Lanes::load`].
    unsafe fn store(self, slice: *mut Self::Real, at: usize);
    /// One number for every index of `at`, which has WIDTH entries.
    ///
    /// # Safety
    /// Every index is within the slice.
    unsafe fn gather(slice: *const Self::Real, at: &[u32]) -> Self;
    /// One lane.
    fn lane(self, lane: usize) -> Self::Real;
    /// Whether any lane is not greater than zero (or is not a number).
    fn any_not_positive(self) -> bool;
    /// Whether any lane is less than zero.
    fn any_negative(self) -> bool;
}

/// Which instructions the machine has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
pub enum Level {
    Portable,
    Avx2,
    Avx512,
}

impl Level {
    /// The best this machine has.
    pub fn detect() -> Level {
        #[cfg(target_arch = "x86_64")]
        {
            if std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("fma") {
                return Level::Avx512;
            }
            if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
                return Level::Avx2;
            }
        }
        Level::Portable
    }
}
