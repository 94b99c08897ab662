use super::{Derivatives, Hyperelastic, Law, Moduli, NeoHookean};
use crate::parameters::parameters;
use crate::scalar::Scalar;

parameters! {
    /// The paper's energy, eq. 5:
    ///
    /// W = g1/2 (J^-2/3 I1 - 3) + g2/2 (J^-4/3 I2 - 3),  U = g0/2 (J - 1)^2,  G = g1 + g2, kappa = g0 (eq. 6).
    pub struct MooneyRivlin("mooney-rivlin", constants "") {
        /// Bulk modulus.
        g0 "g0": Stress, Any;
        /// What I1 has of the shear modulus, 2 C10.
        g1 "g1": Stress, Any;
        /// What I2 has of the shear modulus, 2 C01.
        g2 "g2": Stress, Any, or 0.0;
    } also {
        /// g1 / 2.
        "c10" for "g1": Stress, |c10| 2.0 * c10;
        /// g2 / 2.
        "c01" for "g2": Stress, |c01| 2.0 * c01;
        /// 2 / kappa.
        "d1" for "g0": Compressibility, |d1| 2.0 / d1;
        /// kappa.
        "bulk_modulus" for "g0": Stress, |kappa| kappa;
    }
}

impl Moduli for MooneyRivlin {
    const KEYS_OF_MODULI: [&'static str; 2] = ["g1", "g0"];

    fn shear_modulus(&self) -> f64 {
        self.g1 + self.g2
    }

    fn bulk_modulus(&self) -> f64 {
        self.g0
    }

    fn from_moduli(shear: f64, bulk: f64) -> Self {
        MooneyRivlin { g0: bulk, g1: shear, g2: 0.0 }
    }

    fn with_shear_scaled(self, factor: f64) -> Self {
        MooneyRivlin { g1: factor * self.g1, g2: factor * self.g2, ..self }
    }

    fn example(shear: f64, bulk: f64) -> Self {
        MooneyRivlin { g0: bulk, g1: 0.7 * shear, g2: 0.3 * shear }
    }

    /// Without g2 its own, cheaper, code.
    fn simplified(self) -> Law {
        let MooneyRivlin { g0, g1, g2 } = self;
        if g2 == 0.0 { NeoHookean { g0, g1 }.into() } else { self.into() }
    }
}

impl Hyperelastic for MooneyRivlin {
    const HAS_I2: bool = true;

    #[inline(always)]
    fn psi<S: Scalar>(&self, i1: S, i2: S, j: S) -> S {
        let (g1, g2) = (S::from_f64(self.g1), S::from_f64(self.g2));
        let (half, three) = (S::from_f64(0.5), S::from_f64(3.0));
        let r = j.recip_cbrt();
        let r2 = r * r;
        g1 * half * (r2 * i1 - three) + g2 * half * (r2 * r2 * i2 - three)
    }

    #[inline(always)]
    fn derivatives<S: Scalar>(&self, i1: S, i2: S, j: S) -> Derivatives<S> {
        let (g1, g2) = (S::from_f64(self.g1), S::from_f64(self.g2));
        let half = S::from_f64(0.5);
        let r = j.recip_cbrt();
        let r2 = r * r;
        let w1 = g1 * half * r2;
        let w2 = g2 * half * r2 * r2;
        // -(g1/3 J^-2/3 I1 + 2 g2/3 J^-4/3 I2) / J
        let wj = -(w1 * i1 + (w2 + w2) * i2) * S::from_f64(2.0 / 3.0) * (r2 * r);
        Derivatives { w1, w2, wj }
    }

    #[inline(always)]
    fn U<S: Scalar>(&self, j: S) -> S {
        let e = j - S::one();
        S::from_f64(self.g0) * S::from_f64(0.5) * e * e
    }

    #[inline(always)]
    fn dU<S: Scalar>(&self, j: S) -> S {
        S::from_f64(self.g0) * (j - S::one())
    }

    #[inline(always)]
    fn ddU<S: Scalar>(&self, _j: S) -> S {
        S::from_f64(self.g0)
    }
}
