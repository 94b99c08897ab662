use super::{FrictionLaw, Sliding};
use crate::parameters::{Fault, parameters};
use crate::scalar::Real;

parameters! {
    /// mu = a + b exp(-p/p0) + c exp(-v/v0): a fit of tests of tread rubber at several loads and speeds (LAT 100).
    pub struct PressureVelocity("pressure-velocity", constants "friction_") {
        /// What is left at high pressure and speed.
        a "a": Number, Any;
        /// What pressure takes away.
        b "b": Number, Any;
        /// p0.
        pressure "pressure": Stress, Positive;
        /// What speed takes away.
        c "c": Number, Any;
        /// v0.
        speed "speed": Speed, Positive;
    }
}

impl FrictionLaw for PressureVelocity {
    const READS_PRESSURE: bool = true;

    #[inline(always)]
    fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S {
        let number = S::from_f64;
        number(self.a)
            + number(self.b) * (-(sliding.pressure * number(1.0 / self.pressure))).exp()
            + number(self.c) * (-(sliding.slip_speed * number(1.0 / self.speed))).exp()
    }

    /// mu >= 0 at every pressure and speed.
    fn fault(&self) -> Option<Fault> {
        let least = self.a + self.b.min(0.0) + self.c.min(0.0);
        (least < 0.0).then(|| Fault {
            key: "a",
            problem: format!("the coefficient would fall to {least}"),
            remedy: "write a, b, c that stay positive at every pressure and speed".into(),
        })
    }

    fn formula(&self) -> String {
        let PressureVelocity { a, b, pressure, c, speed } = self;
        format!("mu = {a} + {b} exp(-p/{pressure} Pa) + {c} exp(-v/{speed} m/s)")
    }

    fn example() -> Self {
        PressureVelocity { a: 0.4, b: 0.5, pressure: 2e5, c: 0.3, speed: 0.2 }
    }
}
