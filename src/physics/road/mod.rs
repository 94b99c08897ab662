//! Rigid roads: a gap, a normal and a velocity at a point.

mod plane;

pub use plane::Plane;

use super::scalar::Real;
use super::tensor::Vec3;

/// A rigid road.
pub trait Road<S: Real>: Copy + Send + Sync {
    /// Distance of x from the surface along the normal, negative inside [m] (eq. 8).
    fn gap(&self, x: Vec3<S>) -> S;
    /// Outward unit normal at the surface point nearest to x.
    fn normal(&self, x: Vec3<S>) -> Vec3<S>;
    /// Velocity of the surface there [m/s].
    fn velocity(&self, x: Vec3<S>) -> Vec3<S>;
}
