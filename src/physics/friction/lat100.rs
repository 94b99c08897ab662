use super::{FrictionLaw, Sliding};
use crate::parameters::{Fault, parameters};
use crate::scalar::Real;

parameters! {
    /// mu = a + b exp(-1/(alpha p)) + c exp(-1/(beta v)): the form that tests of tread compounds on a LAT 100 are fitted with (Tire
    /// Sci. Technol. 2022, tire.22.21022). Both exponentials are 0 at rest and without pressure and grow towards 1.
    pub struct Lat100("lat100", constants "friction_") {
        /// At no pressure and no speed.
        a "a": Number, NotNegative;
        /// What pressure adds, mostly negative.
        b "b": Number, Any;
        /// alpha.
        alpha "alpha": Compressibility, Positive;
        /// What speed adds.
        c "c": Number, Any;
        /// beta.
        beta "beta": Slowness, Positive;
    }
}

/// exp(-1/x) for x >= 0: at 0 its limit, 0, which 1/0 has in this arithmetic.
#[inline(always)]
fn growth<S: Real>(x: S) -> S {
    (-(S::one() / x)).exp()
}

impl FrictionLaw for Lat100 {
    const READS_PRESSURE: bool = true;

    #[inline(always)]
    fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S {
        let number = S::from_f64;
        number(self.a)
            + number(self.b) * growth(sliding.pressure * number(self.alpha))
            + number(self.c) * growth(sliding.slip_speed * number(self.beta))
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
        let Lat100 { a, b, alpha, c, beta } = self;
        format!("mu = {a} + {b} exp(-1/({alpha} 1/Pa p)) + {c} exp(-1/({beta} s/m v))")
    }

    fn example() -> Self {
        Lat100 { a: 1.2, b: -0.5, alpha: 5e-6, c: 0.4, beta: 5.0 }
    }
}
