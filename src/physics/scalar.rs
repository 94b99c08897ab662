//! The arithmetic the physics is written in.

use super::lanes::{GUESS_F32, GUESS_F64, Vectors};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number, or several lanes of one. No comparisons here: the element physics has no branches.
pub trait Scalar:
    Copy
    + Send
    + Sync
    + 'static
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// Whether a loop over points is worth its unrolling: for lanes in registers, not for numbers that are called for now and then.
    const UNROLLED: bool = false;

    /// Nearest value (every lane).
    fn from_f64(value: f64) -> Self;
    /// self * a + b; fused only where the hardware does it at no cost.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// self * a - b and b - self * a, likewise: one instruction where there is one.
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        self * a - b
    }
    #[inline(always)]
    fn neg_mul_add(self, a: Self, b: Self) -> Self {
        b - self * a
    }
    /// self^(-1/3), self > 0.
    fn recip_cbrt(self) -> Self;
    fn sqrt(self) -> Self;
    /// Natural logarithm; in energies only, never in forces.
    fn ln(self) -> Self;
    /// The smaller of the two; NaN if either is NaN, so that a failure cannot hide.
    fn min(self, other: Self) -> Self;
    /// The same number without derivatives, of a number that carries some.
    #[inline(always)]
    fn fixed(self) -> Self {
        self
    }

    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

/// A single number with an order and a square root: what the node physics (contact, friction) needs.
pub trait Real: Scalar + PartialOrd + bytemuck::Pod + Vectors {
    /// Unit round-off doubled: the distance from 1 to the next number.
    const EPSILON: f64;
    fn to_f64(self) -> f64;
    /// e^self; in friction laws only.
    fn exp(self) -> Self;
    /// self^(-1/3) within 4 %.
    fn recip_cbrt_guess(self) -> Self;
    /// Whether this is single precision.
    const SINGLE: bool;
}

macro_rules! real {
    ($type:ty, $single:literal, $guess:expr) => {
        impl Scalar for $type {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $type
            }
            // Without a target feature a fused multiply-add is a library call, 20 times slower.
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                self * a + b
            }
            #[inline(always)]
            fn recip_cbrt(self) -> Self {
                1.0 / self.cbrt()
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$type>::sqrt(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                <$type>::ln(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other || self.is_nan() { self } else { other }
            }
        }
        impl Real for $type {
            const EPSILON: f64 = <$type>::EPSILON as f64;
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn exp(self) -> Self {
                <$type>::exp(self)
            }
            #[inline(always)]
            fn recip_cbrt_guess(self) -> Self {
                $guess(self)
            }
            const SINGLE: bool = $single;
        }
    };
}
real!(f64, false, guess_f64);
real!(f32, true, guess_f32);

#[inline(always)]
fn guess_f64(x: f64) -> f64 {
    let upper = (x.to_bits() >> 32) as i32;
    let guess = (GUESS_F64 - f64::from(upper) * (1.0 / 3.0)) as i32;
    f64::from_bits((guess as u64) << 32)
}

#[inline(always)]
fn guess_f32(x: f32) -> f32 {
    let guess = GUESS_F32 - (x.to_bits() as i32) as f32 * (1.0 / 3.0);
    f32::from_bits(guess as i32 as u32)
}
