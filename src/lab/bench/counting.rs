//! A scalar that counts what is done to it: with it, the element routine reports its own floating-point operations.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use serde::{Deserialize, Serialize};

use hexroll::physics::lanes::recip_cbrt_from;
use hexroll::physics::scalar::{Real, Scalar};

/// Floating-point operations by kind. A change of sign, a minimum and a constant are not counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Operations {
    /// Sums and differences.
    pub add: u64,
    pub mul: u64,
    /// a * b + c in one operation.
    pub fused: u64,
    pub div: u64,
}

impl Operations {
    /// Floating-point operations, a fused one being two.
    pub fn flops(&self) -> u64 {
        self.add + self.mul + 2 * self.fused + self.div
    }

    /// Operations that each take a place in the pipeline, a fused one being one.
    pub fn places(&self) -> u64 {
        self.add + self.mul + self.fused + self.div
    }

    fn since(&self, before: &Operations) -> Operations {
        Operations {
            add: self.add - before.add,
            mul: self.mul - before.mul,
            fused: self.fused - before.fused,
            div: self.div - before.div,
        }
    }
}

thread_local! {
    static COUNT: Cell<Operations> = const { Cell::new(NONE) };
}

const NONE: Operations = Operations { add: 0, mul: 0, fused: 0, div: 0 };
const ADD: Operations = Operations { add: 1, ..NONE };
const MUL: Operations = Operations { mul: 1, ..NONE };
const FUSED: Operations = Operations { fused: 1, ..NONE };
const DIV: Operations = Operations { div: 1, ..NONE };

// A call: what is counted is not timed, and thousands of copies would take as long to compile as a lane type's kernels.
#[inline(never)]
fn tally(one: Operations) {
    let n = COUNT.get();
    COUNT.set(Operations {
        add: n.add + one.add,
        mul: n.mul + one.mul,
        fused: n.fused + one.fused,
        div: n.div + one.div,
    });
}

/// What `work` returns, and the operations that this thread's [`Counted`] numbers did in it.
pub fn count<R>(work: impl FnOnce() -> R) -> (R, Operations) {
    let before = COUNT.get();
    let result = work();
    (result, COUNT.get().since(&before))
}

/// A number of precision `T` whose operations are counted, by thread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counted<T>(pub T);

impl<T: Real> Add for Counted<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        tally(ADD);
        Counted(self.0 + other.0)
    }
}

impl<T: Real> Sub for Counted<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        tally(ADD);
        Counted(self.0 - other.0)
    }
}

impl<T: Real> Mul for Counted<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        tally(MUL);
        Counted(self.0 * other.0)
    }
}

impl<T: Real> Div for Counted<T> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        tally(DIV);
        Counted(self.0 / other.0)
    }
}

impl<T: Real> Neg for Counted<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Counted(-self.0)
    }
}

impl<T: Real> AddAssign for Counted<T> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Counted<T> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Real> Scalar for Counted<T> {
    fn from_f64(value: f64) -> Self {
        Counted(T::from_f64(value))
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        tally(FUSED);
        Counted(self.0.mul_add(a.0, b.0))
    }

    fn mul_sub(self, a: Self, b: Self) -> Self {
        tally(FUSED);
        Counted(self.0.mul_sub(a.0, b.0))
    }

    fn neg_mul_add(self, a: Self, b: Self) -> Self {
        tally(FUSED);
        Counted(self.0.neg_mul_add(a.0, b.0))
    }

    /// As the lanes do it: a first guess from the bits (a product and a sum), then their steps.
    fn recip_cbrt(self) -> Self {
        tally(MUL);
        tally(ADD);
        recip_cbrt_from(Counted(self.0.recip_cbrt_guess()), self, T::SINGLE)
    }

    fn sqrt(self) -> Self {
        tally(DIV);
        Counted(self.0.sqrt())
    }

    fn ln(self) -> Self {
        Counted(self.0.ln())
    }

    fn min(self, other: Self) -> Self {
        Counted(self.0.min(other.0))
    }
}
