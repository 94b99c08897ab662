use super::{FrictionLaw, Sliding};
use crate::parameters::parameters;
use crate::scalar::Real;

parameters! {
    /// Constant coefficient: |fT| <= mu |fN| (eq. 10).
    pub struct Coulomb("coulomb", constants "friction_") {
        /// mu.
        mu "coefficient": Number, NotNegative;
    }
}

impl FrictionLaw for Coulomb {
    const CONSTANT: bool = true;

    #[inline(always)]
    fn coefficient<S: Real>(&self, _sliding: Sliding<S>) -> S {
        S::from_f64(self.mu)
    }

    fn is_none(&self) -> bool {
        self.mu == 0.0
    }

    fn formula(&self) -> String {
        format!("Coulomb, mu = {}, stick and slip", self.mu)
    }

    fn example() -> Self {
        Coulomb { mu: 0.8 }
    }
}
