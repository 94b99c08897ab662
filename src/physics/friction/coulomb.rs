use super::{Friction, Sliding};
use crate::physics::scalar::Real;

/// Constant coefficient: |fT| <= mu |fN| (eq. 10).
#[derive(Debug, Clone, Copy)]
pub struct Coulomb<S> {
    pub mu: S,
}

impl<S: Real> Friction<S> for Coulomb<S> {
    const CONSTANT: bool = true;
    #[inline(always)]
    fn coefficient(&self, _sliding: Sliding<S>) -> S {
        self.mu
    }
}
