use super::Lanes;
use crate::scalar::{Real, Scalar};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// 4/3 of the exponent bias less what centres the error, in units of the upper 32 bits: x^(-1/3) has about the bits
/// GUESS - bits(x)/3.
pub(crate) const GUESS_F64: f64 = 1_430_195_000.0;
pub(crate) const GUESS_F32: f32 = 1_419_909_400.0;

/// Lanes as an array, which the compiler turns into vector registers (SSE2, NEON): no fused multiply-add, which is a
/// library call where the instructions are not known to be there.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub struct Array<T, const N: usize>([T; N]);

macro_rules! each {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<T: Real, const N: usize> $trait for Array<T, N> {
            type Output = Self;
            #[inline(always)]
            #[allow(clippy::assign_op_pattern)] // Scalar has no assigning product or quotient
            fn $method(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] = self.0[i] $op other.0[i];
                }
                self
            }
        }
    };
}
each!(Add, add, +);
each!(Sub, sub, -);
each!(Mul, mul, *);
each!(Div, div, /);

impl<T: Real, const N: usize> Neg for Array<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for i in 0..N {
            self.0[i] = -self.0[i];
        }
        self
    }
}

impl<T: Real, const N: usize> AddAssign for Array<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real, const N: usize> SubAssign for Array<T, N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Real, const N: usize> Scalar for Array<T, N> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Array([T::from_f64(value); N])
    }

    #[inline(always)]
    fn mul_add(mut self, a: Self, b: Self) -> Self {
        for i in 0..N {
            self.0[i] = self.0[i] * a.0[i] + b.0[i];
        }
        self
    }

    #[inline(always)]
    fn recip_cbrt(self) -> Self {
        let mut y = self;
        for i in 0..N {
            y.0[i] = y.0[i].recip_cbrt_guess();
        }
        super::recip_cbrt_from(y, self, T::SINGLE)
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for i in 0..N {
            self.0[i] = self.0[i].sqrt();
        }
        self
    }

    #[inline(always)]
    fn ln(mut self) -> Self {
        for i in 0..N {
            self.0[i] = Scalar::ln(self.0[i]);
        }
        self
    }

    #[inline(always)]
    fn min(mut self, other: Self) -> Self {
        for i in 0..N {
            self.0[i] = Scalar::min(self.0[i], other.0[i]);
        }
        self
    }
}

impl<T: Real, const N: usize> Lanes for Array<T, N> {
    type Real = T;
    const WIDTH: usize = N;

    #[inline(always)]
    fn splat(value: T) -> Self {
        Array([value; N])
    }

    #[inline(always)]
    unsafe fn load(slice: *const T, at: usize) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Array(slice.add(at).cast::<[T; N]>().read_unaligned()) }
    }

    #[inline(always)]
    unsafe fn store(self, slice: *mut T, at: usize) {
        // SAFETY: the caller's promise.
        unsafe { slice.add(at).cast::<[T; N]>().write_unaligned(self.0) }
    }

    #[inline(always)]
    unsafe fn load_over(mut self, from: *const T, mask: u32) -> Self {
        for i in 0..N {
            if mask >> i & 1 == 1 {
                // SAFETY: the caller's promise.
                self.0[i] = unsafe { *from.wrapping_add(i) };
            }
        }
        self
    }

    #[inline(always)]
    unsafe fn store_where(self, to: *mut T, mask: u32) {
        for i in 0..N {
            if mask >> i & 1 == 1 {
                // SAFETY: the caller's promise.
                unsafe { *to.wrapping_add(i) = self.0[i] };
            }
        }
    }

    #[inline(always)]
    unsafe fn add_to(self, sums: *mut f64) {
        for i in 0..N {
            // SAFETY: the caller's promise.
            unsafe { *sums.add(i) += self.0[i].to_f64() };
        }
    }

    #[inline(always)]
    unsafe fn gather(slice: *const T, at: &[u32]) -> Self {
        let mut values = [T::zero(); N];
        for (value, &i) in values.iter_mut().zip(at) {
            // SAFETY: the caller's promise.
            *value = unsafe { *slice.add(i as usize) };
        }
        Array(values)
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> T {
        self.0[lane]
    }

    #[inline(always)]
    fn moved_up(self, before: Self) -> Self {
        let mut moved = self.0;
        moved[0] = before.0[N - 1];
        moved[1..].copy_from_slice(&self.0[..N - 1]);
        Array(moved)
    }

    #[inline(always)]
    fn choose(mut self, other: Self, mask: u32) -> Self {
        for i in 0..N {
            self.0[i] = if mask >> i & 1 == 1 { self.0[i] } else { other.0[i] };
        }
        self
    }

    #[inline(always)]
    fn any_not_positive(self) -> bool {
        let mut any = false;
        for i in 0..N {
            any |= self.0[i].partial_cmp(&T::zero()) != Some(std::cmp::Ordering::Greater);
        }
        any
    }

    #[inline(always)]
    fn negative(self) -> u32 {
        (0..N).map(|i| u32::from(self.0[i] < T::zero()) << i).sum()
    }
}
