//! Several numbers at once: one element, or one node, a lane.
//!
//! The physics is written once over [`Scalar`]; a lane type makes the same source compute 2 to 16 elements. All of it
//! must be inlined into one function with the right target feature (a call in between passes vectors through memory),
//! so hot code has no closures and no `array::map`.
//!
//! Which lane types a processor can compute with is known when the program runs. [`Level`] is the proof that this one can: the
//! types themselves have no name outside this folder, and [`InLanes`] work meets them only through a `Level`.

mod array;
mod level;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use array::Array;
pub(super) use array::{GUESS_F32, GUESS_F64};
#[cfg(target_arch = "x86_64")]
pub use level::{Avx2, Avx512};
pub use level::{InLanes, Instructions, Level, Portable, Vectors};

use super::scalar::{Real, Scalar};

/// Most lanes any type has.
pub const WIDEST: usize = 16;

/// A mask of the first `count` lanes.
#[inline(always)]
pub fn first(count: usize) -> u32 {
    (1 << count) - 1
}

/// x^(-1/3) from a first guess y within 4 %: with r = 1 - x y^3, y (1 - r)^(-1/3) by its series to r^3, which leaves a
/// relative error of 35/243 r^4, 3.5e-5; then once more: 1e-17. In single precision (`single`) the series ends with r the
/// second time, and leaves 2/9 r^2: 2.5e-9.
#[inline(always)]
pub fn recip_cbrt_from<S: Scalar>(guess: S, x: S, single: bool) -> S {
    let (a, b, c) = (S::from_f64(1.0 / 3.0), S::from_f64(2.0 / 9.0), S::from_f64(14.0 / 81.0));
    let mut y = guess;
    let mut first = true;
    loop {
        let r = (x * y).neg_mul_add(y * y, S::one());
        if single && !first {
            return (y * r).mul_add(a, y);
        }
        let series = r.mul_add(c, b).mul_add(r, a);
        y = (y * r).mul_add(series, y);
        if !first {
            return y;
        }
        first = false;
    }
}

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
    /// These lanes, those of `mask` taken from where they lie from `from` on; nothing else is read, and `from` may lie before
    /// what it points into.
    ///
    /// # Safety
    /// The lanes of `mask` can be read.
    unsafe fn load_over(self, from: *const Self::Real, mask: u32) -> Self;
    /// Stores the lanes of `mask` where they lie from `to` on, and touches nothing else.
    ///
    /// # Safety
    /// The lanes of `mask` can be written.
    unsafe fn store_where(self, to: *mut Self::Real, mask: u32);
    /// One number for every index of `at`, which has WIDTH entries.
    ///
    /// # Safety
    /// Every index is within the slice.
    unsafe fn gather(slice: *const Self::Real, at: &[u32]) -> Self;
    /// One lane.
    fn lane(self, lane: usize) -> Self::Real;
    /// The lanes moved up by one, the last lane of `before` moved in.
    fn moved_up(self, before: Self) -> Self;
    /// These lanes where `mask` has a bit (lane 0 the lowest), those of `other` elsewhere.
    fn choose(self, other: Self, mask: u32) -> Self;
    /// Adds lane by lane to WIDTH sums in double precision.
    ///
    /// # Safety
    /// `sums` points to WIDTH numbers.
    unsafe fn add_to(self, sums: *mut f64);
    /// Whether any lane is not greater than zero (or is not a number).
    fn any_not_positive(self) -> bool;
    /// Lanes that are less than zero, the lowest bit that of lane 0.
    fn negative(self) -> u32;
}
