//! Lanes of 512 bits by hand: left to itself the compiler splits them in two and spills.

use super::Lanes;
use crate::physics::scalar::Scalar;
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

macro_rules! lanes {
    ($(#[$doc:meta])* $name:ident, $vector:ty, $real:ty, $width:literal, $steps:literal,
     $set:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $fmadd:ident, $fnmadd:ident, $min:ident, $blend:ident,
     $cmp:ident, $load:ident, $store:ident, $guess:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        #[repr(transparent)]
        pub struct $name($vector);

        // SAFETY of every intrinsic here: values of this type exist only in functions compiled for AVX-512, which run
        // after `Level::detect` has found it.
        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                unsafe { $name($add(self.0, other.0)) }
            }
        }
        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                unsafe { $name($sub(self.0, other.0)) }
            }
        }
        impl Mul for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                unsafe { $name($mul(self.0, other.0)) }
            }
        }
        impl Div for $name {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                unsafe { $name($div(self.0, other.0)) }
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                unsafe { $name($sub($set(0.0), self.0)) }
            }
        }
        impl AddAssign for $name {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl SubAssign for $name {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }

        impl Scalar for $name {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                unsafe { $name($set(value as $real)) }
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                unsafe { $name($fmadd(self.0, a.0, b.0)) }
            }
            #[inline(always)]
            fn recip_cbrt(self) -> Self {
                let mut y = unsafe { $name($guess(self.0)) };
                let (third, four_thirds) = (Self::from_f64(1.0 / 3.0), Self::from_f64(4.0 / 3.0));
                let scaled = third * self;
                let mut n = 0;
                while n < $steps {
                    let cube = y * y * y;
                    y = unsafe { $name($fnmadd(y.0, (scaled * cube).0, (y * four_thirds).0)) };
                    n += 1;
                }
                y
            }
            #[inline(always)]
            fn ln(self) -> Self {
                let mut values = [0.0 as $real; $width];
                unsafe { $store(values.as_mut_ptr(), self.0) };
                for value in &mut values {
                    *value = value.ln();
                }
                unsafe { $name($load(values.as_ptr())) }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // The instruction returns its second operand if either is NaN: keep a NaN of the first.
                unsafe {
                    let nan = $cmp::<_CMP_UNORD_Q>(self.0, self.0);
                    $name($blend(nan, $min(self.0, other.0), self.0))
                }
            }
        }

        impl Lanes for $name {
            type Real = $real;
            const WIDTH: usize = $width;
            #[inline(always)]
            fn splat(value: $real) -> Self {
                unsafe { $name($set(value)) }
            }
            #[inline(always)]
            unsafe fn load(slice: *const $real, at: usize) -> Self {
                unsafe { $name($load(slice.add(at))) }
            }
            #[inline(always)]
            unsafe fn store(self, slice: *mut $real, at: usize) {
                unsafe { $store(slice.add(at), self.0) }
            }
            #[inline(always)]
            unsafe fn gather(slice: *const $real, at: &[u32]) -> Self {
                let mut values = [0.0 as $real; $width];
                for (value, &i) in values.iter_mut().zip(at) {
                    *value = unsafe { *slice.add(i as usize) };
                }
                unsafe { $name($load(values.as_ptr())) }
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> $real {
                let mut values = [0.0 as $real; $width];
                unsafe { $store(values.as_mut_ptr(), self.0) };
                values[lane]
            }
            #[inline(always)]
            fn any_not_positive(self) -> bool {
                unsafe { $cmp::<_CMP_NGT_UQ>(self.0, $set(0.0)) != 0 }
            }
            #[inline(always)]
            fn any_negative(self) -> bool {
                unsafe { $cmp::<_CMP_LT_OQ>(self.0, $set(0.0)) != 0 }
            }
        }
    };
}

/// First guess of x^(-1/3) within 4 %: the exponent by integer arithmetic on the upper half of the bits.
#[inline(always)]
unsafe fn guess_f64(x: __m512d) -> __m512d {
    unsafe {
        let upper = _mm512_cvtepi64_epi32(_mm512_srli_epi64::<32>(_mm512_castpd_si512(x)));
        let third = _mm512_mul_pd(_mm512_cvtepi32_pd(upper), _mm512_set1_pd(-1.0 / 3.0));
        let guess = _mm512_cvttpd_epi32(_mm512_add_pd(third, _mm512_set1_pd(super::array::GUESS_F64)));
        _mm512_castsi512_pd(_mm512_slli_epi64::<32>(_mm512_cvtepi32_epi64(guess)))
    }
}

/// The same on 32 bits.
#[inline(always)]
unsafe fn guess_f32(x: __m512) -> __m512 {
    unsafe {
        let third = _mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_castps_si512(x)), _mm512_set1_ps(-1.0 / 3.0));
        let guess = _mm512_cvttps_epi32(_mm512_add_ps(third, _mm512_set1_ps(super::array::GUESS_F32)));
        _mm512_castsi512_ps(guess)
    }
}

lanes!(
    /// Eight f64.
    F64x8, __m512d, f64, 8, 4,
    _mm512_set1_pd, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_fnmadd_pd,
    _mm512_min_pd, _mm512_mask_blend_pd, _mm512_cmp_pd_mask, _mm512_loadu_pd, _mm512_storeu_pd, guess_f64
);
lanes!(
    /// Sixteen f32.
    F32x16, __m512, f32, 16, 3,
    _mm512_set1_ps, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps,
    _mm512_min_ps, _mm512_mask_blend_ps, _mm512_cmp_ps_mask, _mm512_loadu_ps, _mm512_storeu_ps, guess_f32
);
