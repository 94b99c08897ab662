use super::Road;
use crate::physics::lanes::Lanes;
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, dot, vec3};

/// A half-space n . x < d, moving in its own plane.
#[derive(Debug, Clone, Copy)]
pub struct Plane<S> {
    normal: Vec3<S>,
    offset: S,
    velocity: Vec3<S>,
}

impl<S: Real> Plane<S> {
    /// A plane through `point` with unit `normal`, seen from a frame whose origin is at `frame`.
    pub fn new(point: [f64; 3], normal: [f64; 3], velocity: [f64; 3], frame: [f64; 3]) -> Self {
        let offset: f64 = (0..3).map(|d| normal[d] * (point[d] - frame[d])).sum();
        Plane { normal: vec3(normal), offset: S::from_f64(offset), velocity: vec3(velocity) }
    }
}

impl<S: Real> Plane<S> {
    /// The gap of several points at once.
    #[inline(always)]
    pub fn gap_in_lanes<N: Lanes<Real = S>>(&self, x: Vec3<N>) -> N {
        let n = [N::splat(self.normal[0]), N::splat(self.normal[1]), N::splat(self.normal[2])];
        dot(n, x) - N::splat(self.offset)
    }
}

impl<S: Real> Road<S> for Plane<S> {
    #[inline(always)]
    fn gap(&self, x: Vec3<S>) -> S {
        dot(self.normal, x) - self.offset
    }
    #[inline(always)]
    fn normal(&self, _x: Vec3<S>) -> Vec3<S> {
        self.normal
    }
    #[inline(always)]
    fn velocity(&self, _x: Vec3<S>) -> Vec3<S> {
        self.velocity
    }
}
