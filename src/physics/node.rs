//! One node, one step of the central-difference scheme (eqs. 26-28) with half-step velocities, lumped mass and a
//! step that may change: v(n+1/2) = v(n-1/2) + dtm a(n), x(n+1) = x(n) + dt v(n+1/2), dtm the mean of the two steps.
//!
//! Mass damping acts on the mean velocity, -alpha m (v(n-1/2) + v(n+1/2))/2: implicit in v, so it never limits dt.

use super::scalar::Real;
use super::tensor::{Vec3, add, axpy, scale, sub};

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

/// Velocity at n+1/2 without contact.
#[inline(always)]
pub fn predict<S: Real>(loads: &Loads<S>, step: StepSize<S>, mass: S, f_int: Vec3<S>, v: Vec3<S>) -> Vec3<S> {
    let a = sub(loads.gravity, scale(f_int, S::one() / mass));
    let h = loads.alpha * step.dtm * S::from_f64(0.5);
    scale(axpy(a, step.dtm, scale(v, S::one() - h)), S::one() / (S::one() + h))
}

/// m (1 + alpha dtm / 2): the inertia a force of this step meets.
#[inline(always)]
pub fn inertia<S: Real>(loads: &Loads<S>, step: StepSize<S>, mass: S) -> S {
    mass * (S::one() + loads.alpha * step.dtm * S::from_f64(0.5))
}

/// Damping force of this step [N].
#[inline(always)]
pub fn damping_force<S: Real>(loads: &Loads<S>, mass: S, before: Vec3<S>, after: Vec3<S>) -> Vec3<S> {
    scale(add(before, after), -(loads.alpha * mass * S::from_f64(0.5)))
}
