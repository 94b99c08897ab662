use super::{FrictionLaw, Sliding};
use crate::parameters::parameters;
use crate::scalar::Real;

parameters! {
    /// mu = slope v: a lubricant's film; never sticks.
    pub struct Viscous("viscous", constants "friction_") {
        /// mu over the slip speed.
        slope "slope": Slowness, Positive;
    }
}

impl FrictionLaw for Viscous {
    #[inline(always)]
    fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S {
        S::from_f64(self.slope) * sliding.slip_speed
    }

    fn formula(&self) -> String {
        format!("viscous, mu = {} s/m v", self.slope)
    }

    fn example() -> Self {
        Viscous { slope: 0.8 }
    }
}
