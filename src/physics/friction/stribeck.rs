use super::{FrictionLaw, Sliding};
use crate::parameters::parameters;
use crate::scalar::Real;

parameters! {
    /// Stribeck's curve as Armstrong-Helouvry writes it (Control of Machines with Friction, 1991, with exponent 2):
    /// mu = kinetic + (still - kinetic) exp(-(v/speed)^2) + slope v.
    pub struct Stribeck("stribeck", constants "friction_") {
        /// mu at rest.
        still "static": Number, Positive;
        /// The level it falls to.
        kinetic "kinetic": Number, NotNegative;
        /// Speed of the fall.
        speed "speed": Speed, Positive;
        /// Viscous part: mu over the slip speed.
        slope "slope": Slowness, NotNegative, or 0.0;
    }
}

impl FrictionLaw for Stribeck {
    #[inline(always)]
    fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S {
        let number = S::from_f64;
        let s = sliding.slip_speed * number(1.0 / self.speed);
        let (still, kinetic) = (number(self.still), number(self.kinetic));
        kinetic + (still - kinetic) * (-(s * s)).exp() + number(self.slope) * sliding.slip_speed
    }

    fn formula(&self) -> String {
        let Stribeck { still, kinetic, speed, slope } = self;
        format!("Stribeck, mu = {kinetic} + {:.3} exp(-(v/{speed} m/s)^2) + {slope} s/m v", still - kinetic)
    }

    fn example() -> Self {
        Stribeck { still: 1.2, kinetic: 0.7, speed: 0.1, slope: 0.05 }
    }
}
