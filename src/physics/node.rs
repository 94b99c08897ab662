//! One node, one step of the central-difference scheme (eqs. 26-28) with half-step velocities, lumped mass and a
//! step that may change: v(n+1/2) = v(n-1/2) + dtm a(n), x(n+1) = x(n) + dt v(n+1/2), dtm the mean of the two steps.
//!
//! Mass damping acts on the mean velocity, -alpha m (v(n-1/2) + v(n+1/2))/2: implicit in v, so it never limits dt.

use super::lanes::Lanes;
use super::scalar::Scalar;
use super::tensor::{Vec3, add, axpy, scale};

/// Lengths of a step.
#[derive(Debug, Clone, Copy)]
pub struct StepSize<S> {
    /// dt(n+1/2) = t(n+1) - t(n) [s]
    pub dt: S,
    /// (dt(n-1/2) + dt(n+1/2)) / 2 [s]; the first step after a start from v(n) has dt(n-1/2) = 0.
    pub dtm: S,
}

/// What acts on every free node.
#[derive(Debug, Clone, Copy)]
pub struct Loads<S> {
    /// Body force per mass [m/s2].
    pub gravity: Vec3<S>,
    /// Mass damping [1/s].
    pub alpha: S,
}

/// v(n+1/2) without contact as keep v(n-1/2) + push (g - f_int / m), the same for all nodes of a step.
#[derive(Debug, Clone, Copy)]
pub struct Prediction<S> {
    keep: S,
    push: S,
    gravity: Vec3<S>,
}

impl<S: Scalar> Prediction<S> {
    /// With h = alpha dtm / 2: keep = (1 - h)/(1 + h), push = dtm/(1 + h).
    pub fn new(loads: &Loads<S>, step: StepSize<S>) -> Self {
        let h = loads.alpha * step.dtm * S::from_f64(0.5);
        let share = S::one() / (S::one() + h);
        Prediction { keep: (S::one() - h) * share, push: step.dtm * share, gravity: loads.gravity }
    }

    /// The same in every lane.
    #[inline(always)]
    pub fn in_lanes<N: Lanes<Real = S>>(&self) -> Prediction<N> {
        let [x, y, z] = self.gravity;
        let gravity = [N::splat(x), N::splat(y), N::splat(z)];
        Prediction { keep: N::splat(self.keep), push: N::splat(self.push), gravity }
    }

    #[inline(always)]
    pub fn velocity(&self, inverse_mass: S, f_int: Vec3<S>, v: Vec3<S>) -> Vec3<S> {
        let a = axpy(f_int, -inverse_mass, self.gravity);
        axpy(a, self.push, scale(v, self.keep))
    }
}

/// m (1 + alpha dtm / 2): the inertia a force of this step meets.
#[inline(always)]
pub fn inertia<S: Scalar>(loads: &Loads<S>, step: StepSize<S>, mass: S) -> S {
    mass * (S::one() + loads.alpha * step.dtm * S::from_f64(0.5))
}

/// Damping force of this step [N].
#[inline(always)]
pub fn damping_force<S: Scalar>(loads: &Loads<S>, mass: S, before: Vec3<S>, after: Vec3<S>) -> Vec3<S> {
    scale(add(before, after), -(loads.alpha * mass * S::from_f64(0.5)))
}
