//! Lanes of 128, 256 and 512 bits by hand: as arrays the compiler splits the wide ones in two and spills, and takes ten
//! times as long over the others. Those of 128 bits need nothing that an x86-64 processor may lack (SSE2).
//!
//! Safety of every intrinsic here: the types have no name outside this folder, and [`super::Level`] alone calls functions that
//! are compiled with them, where it has found their instructions.

use super::Lanes;
use crate::scalar::{Real, Scalar};
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

macro_rules! lanes {
    ($(#[$doc:meta])* $name:ident, $vector:ty, $real:ty, $width:literal,
     $set:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $fmadd:ident, $fnmadd:ident, $load:ident,
     $store:ident, $guess:ident, $min:ident, $not_positive:ident, $negative:ident, $fmsub:ident, $up:ident, $choose:ident,
     $load_over:ident, $store_where:ident, $add_to:ident, $sqrt:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        #[repr(transparent)]
        pub struct $name($vector);

        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($add(self.0, other.0)) }
            }
        }
        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($sub(self.0, other.0)) }
            }
        }
        impl Mul for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($mul(self.0, other.0)) }
            }
        }
        impl Div for $name {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($div(self.0, other.0)) }
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
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
            const UNROLLED: bool = true;
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($set(value as $real)) }
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($fmadd(self.0, a.0, b.0)) }
            }
            #[inline(always)]
            fn mul_sub(self, a: Self, b: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($fmsub(self.0, a.0, b.0)) }
            }
            #[inline(always)]
            fn neg_mul_add(self, a: Self, b: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($fnmadd(self.0, a.0, b.0)) }
            }
            #[inline(always)]
            fn recip_cbrt(self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                super::recip_cbrt_from(unsafe { $name($guess(self.0)) }, self, <$real as Real>::SINGLE)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($sqrt(self.0)) }
            }
            #[inline(always)]
            fn ln(self) -> Self {
                let mut values = [0.0 as $real; $width];
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $store(values.as_mut_ptr(), self.0) };
                for value in &mut values {
                    *value = value.ln();
                }
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($load(values.as_ptr())) }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($min(self.0, other.0)) }
            }
        }

        impl Lanes for $name {
            type Real = $real;
            const WIDTH: usize = $width;
            #[inline(always)]
            fn splat(value: $real) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($set(value)) }
            }
            #[inline(always)]
            unsafe fn load(slice: *const $real, at: usize) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($load(slice.add(at))) }
            }
            #[inline(always)]
            unsafe fn store(self, slice: *mut $real, at: usize) {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $store(slice.add(at), self.0) }
            }
            #[inline(always)]
            unsafe fn gather(slice: *const $real, at: &[u32]) -> Self {
                let mut values = [0.0 as $real; $width];
                for (value, &i) in values.iter_mut().zip(at) {
                    // SAFETY: lanes exist only where their instructions do (head of this file).
                    *value = unsafe { *slice.add(i as usize) };
                }
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($load(values.as_ptr())) }
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> $real {
                let mut values = [0.0 as $real; $width];
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $store(values.as_mut_ptr(), self.0) };
                values[lane]
            }
            #[inline(always)]
            fn moved_up(self, before: Self) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($up(self.0, before.0)) }
            }
            #[inline(always)]
            fn choose(self, other: Self, mask: u32) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($choose(self.0, other.0, mask)) }
            }
            #[inline(always)]
            fn any_not_positive(self) -> bool {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $not_positive(self.0) }
            }
            #[inline(always)]
            fn negative(self) -> u32 {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $negative(self.0) }
            }
            #[inline(always)]
            unsafe fn load_over(self, from: *const $real, mask: u32) -> Self {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $name($load_over(self.0, from, mask)) }
            }
            #[inline(always)]
            unsafe fn store_where(self, to: *mut $real, mask: u32) {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $store_where(self.0, to, mask) }
            }
            #[inline(always)]
            unsafe fn add_to(self, sums: *mut f64) {
                // SAFETY: lanes exist only where their instructions do (head of this file).
                unsafe { $add_to(self.0, sums) }
            }
        }
    };
}

/// First guess of x^(-1/3) within 4 %: the exponent by integer arithmetic on the upper half of the bits.
#[inline(always)]
unsafe fn guess_f64(x: __m512d) -> __m512d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
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
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let third = _mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_castps_si512(x)), _mm512_set1_ps(-1.0 / 3.0));
        let guess = _mm512_cvttps_epi32(_mm512_add_ps(third, _mm512_set1_ps(super::array::GUESS_F32)));
        _mm512_castsi512_ps(guess)
    }
}

/// The same in 256 bits: the upper halves of the numbers gathered into 128.
#[inline(always)]
unsafe fn guess_f64_256(x: __m256d) -> __m256d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let halves = _mm256_setr_epi32(1, 3, 5, 7, 1, 3, 5, 7);
        let upper = _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(x), halves));
        let third = _mm256_mul_pd(_mm256_cvtepi32_pd(upper), _mm256_set1_pd(-1.0 / 3.0));
        let guess = _mm256_cvttpd_epi32(_mm256_add_pd(third, _mm256_set1_pd(super::array::GUESS_F64)));
        _mm256_castsi256_pd(_mm256_slli_epi64::<32>(_mm256_cvtepi32_epi64(guess)))
    }
}

#[inline(always)]
unsafe fn guess_f32_256(x: __m256) -> __m256 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let third = _mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_castps_si256(x)), _mm256_set1_ps(-1.0 / 3.0));
        let guess = _mm256_cvttps_epi32(_mm256_add_ps(third, _mm256_set1_ps(super::array::GUESS_F32)));
        _mm256_castsi256_ps(guess)
    }
}

/// Lanes moved up by one, the last of `before` moved in.
#[inline(always)]
unsafe fn up_f64(a: __m512d, before: __m512d) -> __m512d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        _mm512_castsi512_pd(_mm512_alignr_epi64::<7>(_mm512_castpd_si512(a), _mm512_castpd_si512(before)))
    }
}

#[inline(always)]
unsafe fn up_f32(a: __m512, before: __m512) -> __m512 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        _mm512_castsi512_ps(_mm512_alignr_epi32::<15>(_mm512_castps_si512(a), _mm512_castps_si512(before)))
    }
}

#[inline(always)]
unsafe fn up_f64_256(a: __m256d, before: __m256d) -> __m256d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_shuffle_pd::<0b0101>(_mm256_permute2f128_pd::<0x21>(before, a), a) }
}

#[inline(always)]
unsafe fn up_f32_256(a: __m256, before: __m256) -> __m256 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let middle = _mm256_castps_si256(_mm256_permute2f128_ps::<0x21>(before, a));
        _mm256_castsi256_ps(_mm256_alignr_epi8::<12>(_mm256_castps_si256(a), middle))
    }
}

/// Lanes of `a` where the mask has a bit.
#[inline(always)]
unsafe fn choose_f64(a: __m512d, other: __m512d, mask: u32) -> __m512d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_mask_blend_pd(mask as u8, other, a) }
}

#[inline(always)]
unsafe fn choose_f32(a: __m512, other: __m512, mask: u32) -> __m512 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_mask_blend_ps(mask as u16, other, a) }
}

/// Lanes of 64 and of 32 bits that are all ones where the mask has a bit.
#[inline(always)]
unsafe fn on_64(mask: u32) -> __m256i {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let bits = _mm256_setr_epi64x(1, 2, 4, 8);
        _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(i64::from(mask)), bits), bits)
    }
}

#[inline(always)]
unsafe fn on_32(mask: u32) -> __m256i {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask as i32), bits), bits)
    }
}

#[inline(always)]
unsafe fn choose_f64_256(a: __m256d, other: __m256d, mask: u32) -> __m256d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_blendv_pd(other, a, _mm256_castsi256_pd(on_64(mask))) }
}

#[inline(always)]
unsafe fn choose_f32_256(a: __m256, other: __m256, mask: u32) -> __m256 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_blendv_ps(other, a, _mm256_castsi256_ps(on_32(mask))) }
}

#[inline(always)]
unsafe fn load_over_f64(a: __m512d, from: *const f64, mask: u32) -> __m512d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_mask_loadu_pd(a, mask as u8, from) }
}

#[inline(always)]
unsafe fn load_over_f32(a: __m512, from: *const f32, mask: u32) -> __m512 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_mask_loadu_ps(a, mask as u16, from) }
}

#[inline(always)]
unsafe fn load_over_f64_256(a: __m256d, from: *const f64, mask: u32) -> __m256d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_blendv_pd(a, _mm256_maskload_pd(from, on_64(mask)), _mm256_castsi256_pd(on_64(mask))) }
}

#[inline(always)]
unsafe fn load_over_f32_256(a: __m256, from: *const f32, mask: u32) -> __m256 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_blendv_ps(a, _mm256_maskload_ps(from, on_32(mask)), _mm256_castsi256_ps(on_32(mask))) }
}

#[inline(always)]
unsafe fn store_where_f64(a: __m512d, to: *mut f64, mask: u32) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_mask_storeu_pd(to, mask as u8, a) }
}

#[inline(always)]
unsafe fn store_where_f32(a: __m512, to: *mut f32, mask: u32) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_mask_storeu_ps(to, mask as u16, a) }
}

#[inline(always)]
unsafe fn store_where_f64_256(a: __m256d, to: *mut f64, mask: u32) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_maskstore_pd(to, on_64(mask), a) }
}

#[inline(always)]
unsafe fn store_where_f32_256(a: __m256, to: *mut f32, mask: u32) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_maskstore_ps(to, on_32(mask), a) }
}

/// Adds lanes to sums in double precision.
#[inline(always)]
unsafe fn add_f64(a: __m512d, sums: *mut f64) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm512_storeu_pd(sums, _mm512_add_pd(_mm512_loadu_pd(sums), a)) }
}

#[inline(always)]
unsafe fn add_f32(a: __m512, sums: *mut f64) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let upper = _mm256_castpd_ps(_mm512_extractf64x4_pd::<1>(_mm512_castps_pd(a)));
        add_f64(_mm512_cvtps_pd(_mm512_castps512_ps256(a)), sums);
        add_f64(_mm512_cvtps_pd(upper), sums.add(8));
    }
}

#[inline(always)]
unsafe fn add_f64_256(a: __m256d, sums: *mut f64) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm256_storeu_pd(sums, _mm256_add_pd(_mm256_loadu_pd(sums), a)) }
}

#[inline(always)]
unsafe fn add_f32_256(a: __m256, sums: *mut f64) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        add_f64_256(_mm256_cvtps_pd(_mm256_castps256_ps128(a)), sums);
        add_f64_256(_mm256_cvtps_pd(_mm256_extractf128_ps::<1>(a)), sums.add(4));
    }
}

/// Minimum and tests of a vector type. The minimum instruction returns its second operand if either is NaN: a NaN of
/// the first is kept.
macro_rules! wide {
    ($vector:ty, $cmp:ident, $blend:ident, $least:ident, $zero:ident, $min:ident, $not_positive:ident, $negative:ident) => {
        #[inline(always)]
        unsafe fn $min(a: $vector, b: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $blend($cmp::<_CMP_UNORD_Q>(a, a), $least(a, b), a) }
        }
        #[inline(always)]
        unsafe fn $not_positive(a: $vector) -> bool {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $cmp::<_CMP_NGT_UQ>(a, $zero()) != 0 }
        }
        #[inline(always)]
        unsafe fn $negative(a: $vector) -> u32 {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { u32::from($cmp::<_CMP_LT_OQ>(a, $zero())) }
        }
    };
}
wide!(
    __m512d,
    _mm512_cmp_pd_mask,
    _mm512_mask_blend_pd,
    _mm512_min_pd,
    _mm512_setzero_pd,
    min_f64,
    not_positive_f64,
    negative_f64
);
wide!(
    __m512,
    _mm512_cmp_ps_mask,
    _mm512_mask_blend_ps,
    _mm512_min_ps,
    _mm512_setzero_ps,
    min_f32,
    not_positive_f32,
    negative_f32
);

/// The same where a comparison is a vector, not a mask.
macro_rules! narrow {
    ($vector:ty, $cmp:ident, $blend:ident, $least:ident, $zero:ident, $mask:ident, $min:ident, $not_positive:ident, $negative:ident) => {
        #[inline(always)]
        unsafe fn $min(a: $vector, b: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $blend($least(a, b), a, $cmp::<_CMP_UNORD_Q>(a, a)) }
        }
        #[inline(always)]
        unsafe fn $not_positive(a: $vector) -> bool {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $mask($cmp::<_CMP_NGT_UQ>(a, $zero())) != 0 }
        }
        #[inline(always)]
        unsafe fn $negative(a: $vector) -> u32 {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $mask($cmp::<_CMP_LT_OQ>(a, $zero())) as u32 }
        }
    };
}
narrow!(
    __m256d,
    _mm256_cmp_pd,
    _mm256_blendv_pd,
    _mm256_min_pd,
    _mm256_setzero_pd,
    _mm256_movemask_pd,
    min_f64_256,
    not_positive_f64_256,
    negative_f64_256
);
narrow!(
    __m256,
    _mm256_cmp_ps,
    _mm256_blendv_ps,
    _mm256_min_ps,
    _mm256_setzero_ps,
    _mm256_movemask_ps,
    min_f32_256,
    not_positive_f32_256,
    negative_f32_256
);

/// Products and sums of 128 bits, not fused: SSE2 has nothing for it.
macro_rules! unfused {
    ($vector:ty, $add:ident, $sub:ident, $mul:ident, $fmadd:ident, $fnmadd:ident, $fmsub:ident) => {
        #[inline(always)]
        unsafe fn $fmadd(a: $vector, b: $vector, c: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $add($mul(a, b), c) }
        }
        #[inline(always)]
        unsafe fn $fnmadd(a: $vector, b: $vector, c: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $sub(c, $mul(a, b)) }
        }
        #[inline(always)]
        unsafe fn $fmsub(a: $vector, b: $vector, c: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $sub($mul(a, b), c) }
        }
    };
}
unfused!(__m128d, _mm_add_pd, _mm_sub_pd, _mm_mul_pd, fmadd_f64_128, fnmadd_f64_128, fmsub_f64_128);
unfused!(__m128, _mm_add_ps, _mm_sub_ps, _mm_mul_ps, fmadd_f32_128, fnmadd_f32_128, fmsub_f32_128);

/// The first guess in 128 bits.
#[inline(always)]
unsafe fn guess_f64_128(x: __m128d) -> __m128d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let upper = _mm_shuffle_epi32::<0b11_01_11_01>(_mm_castpd_si128(x));
        let third = _mm_mul_pd(_mm_cvtepi32_pd(upper), _mm_set1_pd(-1.0 / 3.0));
        let guess = _mm_cvttpd_epi32(_mm_add_pd(third, _mm_set1_pd(super::array::GUESS_F64)));
        _mm_castsi128_pd(_mm_unpacklo_epi32(_mm_setzero_si128(), guess))
    }
}

#[inline(always)]
unsafe fn guess_f32_128(x: __m128) -> __m128 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let third = _mm_mul_ps(_mm_cvtepi32_ps(_mm_castps_si128(x)), _mm_set1_ps(-1.0 / 3.0));
        _mm_castsi128_ps(_mm_cvttps_epi32(_mm_add_ps(third, _mm_set1_ps(super::array::GUESS_F32))))
    }
}

#[inline(always)]
unsafe fn up_f64_128(a: __m128d, before: __m128d) -> __m128d {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm_shuffle_pd::<0b01>(before, a) }
}

#[inline(always)]
unsafe fn up_f32_128(a: __m128, before: __m128) -> __m128 {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let (own, last) = (_mm_castps_si128(a), _mm_castps_si128(before));
        _mm_castsi128_ps(_mm_or_si128(_mm_slli_si128::<4>(own), _mm_srli_si128::<12>(last)))
    }
}

/// All ones where the mask has a bit.
#[inline(always)]
unsafe fn on_64_128(mask: u32) -> __m128i {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let bits = _mm_setr_epi32(1, 1, 2, 2);
        _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(mask as i32), bits), bits)
    }
}

#[inline(always)]
unsafe fn on_32_128(mask: u32) -> __m128i {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        let bits = _mm_setr_epi32(1, 2, 4, 8);
        _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(mask as i32), bits), bits)
    }
}

/// What SSE2 has no instruction for: lanes of one of two vectors, the minimum and tests, and loads and stores of single
/// lanes.
macro_rules! smallest {
    ($vector:ty, $real:ty, $width:literal, $and:ident, $andnot:ident, $or:ident, $load:ident, $store:ident, $unordered:ident,
     $not_greater:ident, $less:ident, $least:ident, $zero:ident, $mask:ident, $cast:ident, $on:ident, $blend:ident,
     $choose:ident, $min:ident, $not_positive:ident, $negative:ident, $load_over:ident, $store_where:ident) => {
        #[inline(always)]
        unsafe fn $blend(on: $vector, a: $vector, other: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $or($and(on, a), $andnot(on, other)) }
        }
        #[inline(always)]
        unsafe fn $choose(a: $vector, other: $vector, mask: u32) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $blend($cast($on(mask)), a, other) }
        }
        #[inline(always)]
        unsafe fn $min(a: $vector, b: $vector) -> $vector {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $blend($unordered(a, a), a, $least(a, b)) }
        }
        #[inline(always)]
        unsafe fn $not_positive(a: $vector) -> bool {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $mask($not_greater(a, $zero())) != 0 }
        }
        #[inline(always)]
        unsafe fn $negative(a: $vector) -> u32 {
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $mask($less(a, $zero())) as u32 }
        }
        #[inline(always)]
        unsafe fn $load_over(a: $vector, from: *const $real, mask: u32) -> $vector {
            let mut values: [$real; $width] = [0.0; $width];
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $store(values.as_mut_ptr(), a) };
            for (i, value) in values.iter_mut().enumerate() {
                if mask >> i & 1 == 1 {
                    // SAFETY: lanes exist only where their instructions do (head of this file).
                    *value = unsafe { *from.wrapping_add(i) };
                }
            }
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $load(values.as_ptr()) }
        }
        #[inline(always)]
        unsafe fn $store_where(a: $vector, to: *mut $real, mask: u32) {
            let mut values: [$real; $width] = [0.0; $width];
            // SAFETY: lanes exist only where their instructions do (head of this file).
            unsafe { $store(values.as_mut_ptr(), a) };
            for (i, value) in values.iter().enumerate() {
                if mask >> i & 1 == 1 {
                    // SAFETY: lanes exist only where their instructions do (head of this file).
                    unsafe { *to.wrapping_add(i) = *value };
                }
            }
        }
    };
}
smallest!(
    __m128d,
    f64,
    2,
    _mm_and_pd,
    _mm_andnot_pd,
    _mm_or_pd,
    _mm_loadu_pd,
    _mm_storeu_pd,
    _mm_cmpunord_pd,
    _mm_cmpngt_pd,
    _mm_cmplt_pd,
    _mm_min_pd,
    _mm_setzero_pd,
    _mm_movemask_pd,
    _mm_castsi128_pd,
    on_64_128,
    blend_f64_128,
    choose_f64_128,
    min_f64_128,
    not_positive_f64_128,
    negative_f64_128,
    load_over_f64_128,
    store_where_f64_128
);
smallest!(
    __m128,
    f32,
    4,
    _mm_and_ps,
    _mm_andnot_ps,
    _mm_or_ps,
    _mm_loadu_ps,
    _mm_storeu_ps,
    _mm_cmpunord_ps,
    _mm_cmpngt_ps,
    _mm_cmplt_ps,
    _mm_min_ps,
    _mm_setzero_ps,
    _mm_movemask_ps,
    _mm_castsi128_ps,
    on_32_128,
    blend_f32_128,
    choose_f32_128,
    min_f32_128,
    not_positive_f32_128,
    negative_f32_128,
    load_over_f32_128,
    store_where_f32_128
);

#[inline(always)]
unsafe fn add_f64_128(a: __m128d, sums: *mut f64) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe { _mm_storeu_pd(sums, _mm_add_pd(_mm_loadu_pd(sums), a)) }
}

#[inline(always)]
unsafe fn add_f32_128(a: __m128, sums: *mut f64) {
    // SAFETY: lanes exist only where their instructions do (head of this file).
    unsafe {
        add_f64_128(_mm_cvtps_pd(a), sums);
        add_f64_128(_mm_cvtps_pd(_mm_movehl_ps(a, a)), sums.add(2));
    }
}

lanes!(
    /// Two f64, SSE2.
    F64x2, __m128d, f64, 2,
    _mm_set1_pd, _mm_add_pd, _mm_sub_pd, _mm_mul_pd, _mm_div_pd, fmadd_f64_128, fnmadd_f64_128,
    _mm_loadu_pd, _mm_storeu_pd, guess_f64_128, min_f64_128, not_positive_f64_128, negative_f64_128,
    fmsub_f64_128, up_f64_128, choose_f64_128,
    load_over_f64_128, store_where_f64_128, add_f64_128, _mm_sqrt_pd
);
lanes!(
    /// Four f32, SSE2.
    F32x4, __m128, f32, 4,
    _mm_set1_ps, _mm_add_ps, _mm_sub_ps, _mm_mul_ps, _mm_div_ps, fmadd_f32_128, fnmadd_f32_128,
    _mm_loadu_ps, _mm_storeu_ps, guess_f32_128, min_f32_128, not_positive_f32_128, negative_f32_128,
    fmsub_f32_128, up_f32_128, choose_f32_128,
    load_over_f32_128, store_where_f32_128, add_f32_128, _mm_sqrt_ps
);
lanes!(
    /// Eight f64, AVX-512.
    F64x8, __m512d, f64, 8,
    _mm512_set1_pd, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_fnmadd_pd,
    _mm512_loadu_pd, _mm512_storeu_pd, guess_f64, min_f64, not_positive_f64, negative_f64,
    _mm512_fmsub_pd, up_f64, choose_f64,
    load_over_f64, store_where_f64, add_f64, _mm512_sqrt_pd
);
lanes!(
    /// Sixteen f32, AVX-512.
    F32x16, __m512, f32, 16,
    _mm512_set1_ps, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps,
    _mm512_loadu_ps, _mm512_storeu_ps, guess_f32, min_f32, not_positive_f32, negative_f32,
    _mm512_fmsub_ps, up_f32, choose_f32,
    load_over_f32, store_where_f32, add_f32, _mm512_sqrt_ps
);
lanes!(
    /// Four f64, AVX2 with FMA.
    F64x4, __m256d, f64, 4,
    _mm256_set1_pd, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_fmadd_pd, _mm256_fnmadd_pd,
    _mm256_loadu_pd, _mm256_storeu_pd, guess_f64_256, min_f64_256, not_positive_f64_256, negative_f64_256,
    _mm256_fmsub_pd, up_f64_256, choose_f64_256,
    load_over_f64_256, store_where_f64_256, add_f64_256, _mm256_sqrt_pd
);
lanes!(
    /// Eight f32, AVX2 with FMA.
    F32x8, __m256, f32, 8,
    _mm256_set1_ps, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps, _mm256_fmadd_ps, _mm256_fnmadd_ps,
    _mm256_loadu_ps, _mm256_storeu_ps, guess_f32_256, min_f32_256, not_positive_f32_256, negative_f32_256,
    _mm256_fmsub_ps, up_f32_256, choose_f32_256,
    load_over_f32_256, store_where_f32_256, add_f32_256, _mm256_sqrt_ps
);
