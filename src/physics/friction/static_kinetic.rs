use super::{FrictionLaw, Sliding};
use crate::parameters::{Fault, parameters};
use crate::scalar::Real;

parameters! {
    /// Two coefficients: one that a node at rest has to overcome, one that slows it while it slides. A sliding node sticks
    /// again where its sliding friction can stop it within a step.
    pub struct StaticKinetic("static-kinetic", constants "friction_") {
        /// mu at rest.
        still "static": Number, Positive;
        /// mu of what slides.
        kinetic "kinetic": Number, NotNegative;
    }
}

impl FrictionLaw for StaticKinetic {
    #[inline(always)]
    fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S {
        S::from_f64(if sliding.slip_speed > S::zero() { self.kinetic } else { self.still })
    }

    /// What slides never needs more than what stands.
    fn fault(&self) -> Option<Fault> {
        let StaticKinetic { still, kinetic } = self;
        (kinetic > still).then(|| Fault {
            key: "kinetic",
            problem: format!("the kinetic coefficient {kinetic} is above the static one, {still}"),
            remedy: format!("write a number up to {still}"),
        })
    }

    fn formula(&self) -> String {
        format!("mu = {} at rest, {} in sliding", self.still, self.kinetic)
    }

    fn example() -> Self {
        StaticKinetic { still: 1.0, kinetic: 0.6 }
    }
}
