//! Numbers that carry their derivatives: with one as the scalar, the force routine *is* the tangent routine.

use crate::physics::lanes::Lanes;
use crate::physics::scalar::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A value and its derivatives along as many directions as there are lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<N> {
    pub value: f64,
    pub tangent: N,
}

impl<N: Lanes<Real = f64>> Dual<N> {
    /// A number that does not vary.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Dual { value, tangent: N::zero() }
    }

    /// f(self) with the slope f'(self).
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Dual { value, tangent: self.tangent * N::splat(slope) }
    }

    /// f(a, b) with its two partial derivatives.
    #[inline(always)]
    fn chain2(self, other: Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        let tangent = self.tangent.mul_add(N::splat(by_self), other.tangent * N::splat(by_other));
        Dual { value, tangent }
    }
}

impl<N: Lanes<Real = f64>> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, tangent: self.tangent + other.tangent }
    }
}

impl<N: Lanes<Real = f64>> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Dual { value: self.value - other.value, tangent: self.tangent - other.tangent }
    }
}

impl<N: Lanes<Real = f64>> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.chain2(other, self.value * other.value, [other.value, self.value])
    }
}

impl<N: Lanes<Real = f64>> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.chain2(other, quotient, [1.0 / other.value, -quotient / other.value])
    }
}

impl<N: Lanes<Real = f64>> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual { value: -self.value, tangent: -self.tangent }
    }
}

impl<N: Lanes<Real = f64>> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<N: Lanes<Real = f64>> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<N: Lanes<Real = f64>> Scalar for Dual<N> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Dual::constant(value)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        let by_self = self.tangent.mul_add(N::splat(a.value), b.tangent);
        Dual {
            value: self.value * a.value + b.value,
            tangent: a.tangent.mul_add(N::splat(self.value), by_self),
        }
    }
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        self.mul_add(a, -b)
    }
    #[inline(always)]
    fn neg_mul_add(self, a: Self, b: Self) -> Self {
        let by_self = self.tangent.neg_mul_add(N::splat(a.value), b.tangent);
        let tangent = a.tangent.neg_mul_add(N::splat(self.value), by_self);
        Dual { value: b.value - self.value * a.value, tangent }
    }
    #[inline(always)]
    fn recip_cbrt(self) -> Self {
        let r = self.value.recip_cbrt();
        self.chain(r, -r / (3.0 * self.value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), 1.0 / self.value)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self.value < other.value || self.value.is_nan() { self } else { other }
    }
    #[inline(always)]
    fn fixed(self) -> Self {
        Dual::constant(self.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::lanes::Array;

    #[test]
    fn every_operation_carries_its_derivative() {
        type D = Dual<Array<f64, 2>>;
        let at = |x: f64, y: f64| {
            let unit = |i: usize| Array::splat(1.0).choose(Array::splat(0.0), 1 << i);
            let (a, b) = (D { value: x, tangent: unit(0) }, D { value: y, tangent: unit(1) });
            let sum = (a * b - a / b).mul_add(a + b, -(b.ln() * a.recip_cbrt())) - a.min(b);
            sum + a.neg_mul_add(b * b, a) + a.mul_sub(a, b)
        };
        assert_eq!([0, 1].map(|lane| at(1.7, 2.3).fixed().tangent.lane(lane)), [0.0; 2]);

        let (x, y, h) = (1.7, 2.3, 1e-6);
        let d = [0, 1].map(|lane| at(x, y).tangent.lane(lane));
        let by_x = (at(x + h, y).value - at(x - h, y).value) / (2.0 * h);
        let by_y = (at(x, y + h).value - at(x, y - h).value) / (2.0 * h);
        // Central differences: h^2 plus round-off over h, about 1e-9.
        assert!((d[0] - by_x).abs() < 1e-8 && (d[1] - by_y).abs() < 1e-8, "{d:?} {by_x} {by_y}");
    }
}
