//! Friction laws: how large the tangential force of a sliding node is, as a share of its normal force.

mod coulomb;

pub use coulomb::Coulomb;

use super::scalar::Real;

/// What a law may look at.
#[derive(Debug, Clone, Copy)]
pub struct Sliding<S> {
    /// Normal force of the node in this step [N].
    pub normal_force: S,
    /// Tangential speed relative to the road before friction acts [m/s].
    pub slip_speed: S,
}

/// A friction law.
pub trait Friction<S: Real>: Copy + Send + Sync {
    /// mu >= 0.
    fn coefficient(&self, sliding: Sliding<S>) -> S;
}
