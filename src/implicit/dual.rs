//! Numbers that carry their derivatives: with one as the scalar, the force routine *is* the tangent routine.

use crate::physics::scalar::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A value and its derivatives along `N` directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const N: usize> {
    pub value: f64,
    pub tangent: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A number that does not vary.
    pub fn constant(value: f64) -> Self {
        Dual { value, tangent: [0.0; N] }
    }

    /// f(self) with the slope f'(self).
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Dual { value, tangent: self.tangent.map(|t| slope * t) }
    }

    /// f(a, b) with its two partial derivatives.
    #[inline(always)]
    fn chain2(self, other: Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        let mut tangent = [0.0; N];
        for i in 0..N {
            tangent[i] = by_self * self.tangent[i] + by_other * other.tangent[i];
        }
        Dual { value, tangent }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.chain2(other, self.value * other.value, [other.value, self.value])
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.chain2(other, quotient, [1.0 / other.value, -quotient / other.value])
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for i in 0..N {
            self.tangent[i] += other.tangent[i];
        }
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        for i in 0..N {
            self.tangent[i] -= other.tangent[i];
        }
    }
}

impl<const N: usize> Scalar for Dual<N> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Dual::constant(value)
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        let mut sum = b;
        sum.value += self.value * a.value;
        for i in 0..N {
            sum.tangent[i] += self.value * a.tangent[i] + a.value * self.tangent[i];
        }
        sum
    }
    #[inline(always)]
    fn recip_cbrt(self) -> Self {
        let r = self.value.recip_cbrt();
        self.chain(r, -r / (3.0 * self.value))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), 1.0 / self.value)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self.value < other.value || self.value.is_nan() { self } else { other }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_operation_carries_its_derivative() {
        type D = Dual<2>;
        let at = |x: f64, y: f64| {
            let (a, b) = (D { value: x, tangent: [1.0, 0.0] }, D { value: y, tangent: [0.0, 1.0] });
            (a * b - a / b).mul_add(a + b, -(b.ln() * a.recip_cbrt())) - a.min(b)
        };
        let (x, y, h) = (1.7, 2.3, 1e-6);
        let d = at(x, y).tangent;
        let by_x = (at(x + h, y).value - at(x - h, y).value) / (2.0 * h);
        let by_y = (at(x, y + h).value - at(x, y - h).value) / (2.0 * h);
        // Central differences: h^2 plus round-off over h, about 1e-9.
        assert!((d[0] - by_x).abs() < 1e-8 && (d[1] - by_y).abs() < 1e-8, "{d:?} {by_x} {by_y}");
    }
}
