use super::{Derivatives, Hyperelastic, Moduli};
use crate::parameters::parameters;
use crate::scalar::Scalar;

parameters! {
    /// The law whose Cauchy stress is the paper's eq. 4 (with the sign of its last term that makes G = g1 + g2):
    ///
    /// W = g1/2 (I1 - 3 - 2 ln J) + g2/2 (I2/J^2 - 3 + 2 ln J),  U = g0 (J - 1 - ln J),
    /// G = g1 + g2, kappa = g0 + 2/3 (g1 + g2); I2/J^2 = tr B^-1.
    pub struct MooneyRivlinEq4("mooney-rivlin-eq4", constants "") {
        /// Bulk modulus less 2/3 of the shear modulus: the other terms resist volume change too.
        g0 "g0": Stress, Any;
        /// What tr B has of the shear modulus.
        g1 "g1": Stress, Any;
        /// What tr B^-1 has of the shear modulus.
        g2 "g2": Stress, Any, or 0.0;
    }
}

impl Moduli for MooneyRivlinEq4 {
    const IS_ISOCHORIC: bool = false;
    const KEYS_OF_MODULI: [&'static str; 2] = ["g1", "g0"];

    fn shear_modulus(&self) -> f64 {
        self.g1 + self.g2
    }

    fn bulk_modulus(&self) -> f64 {
        self.g0 + 2.0 / 3.0 * (self.g1 + self.g2)
    }

    fn from_moduli(shear: f64, bulk: f64) -> Self {
        MooneyRivlinEq4 { g0: bulk - 2.0 / 3.0 * shear, g1: shear, g2: 0.0 }
    }

    fn with_shear_scaled(self, factor: f64) -> Self {
        MooneyRivlinEq4 { g1: factor * self.g1, g2: factor * self.g2, ..self }
    }

    fn example(shear: f64, bulk: f64) -> Self {
        MooneyRivlinEq4 { g0: bulk - 2.0 / 3.0 * shear, g1: 0.7 * shear, g2: 0.3 * shear }
    }
}

impl Hyperelastic for MooneyRivlinEq4 {
    const HAS_I2: bool = true;

    #[inline(always)]
    fn psi<S: Scalar>(&self, i1: S, i2: S, j: S) -> S {
        let (g1, g2) = (S::from_f64(self.g1), S::from_f64(self.g2));
        let (half, three) = (S::from_f64(0.5), S::from_f64(3.0));
        let log = j.ln();
        g1 * (half * (i1 - three) - log) + g2 * (half * (i2 / (j * j) - three) + log)
    }

    #[inline(always)]
    fn derivatives<S: Scalar>(&self, _i1: S, i2: S, j: S) -> Derivatives<S> {
        let (g1, g2) = (S::from_f64(self.g1), S::from_f64(self.g2));
        let half = S::from_f64(0.5);
        let r = S::one() / j;
        let w2 = g2 * half * r * r;
        // (g2 - g1)/J - g2 I2/J^3
        let wj = r * (g2 - g1 - (w2 + w2) * i2);
        Derivatives { w1: g1 * half, w2, wj }
    }

    #[inline(always)]
    fn U<S: Scalar>(&self, j: S) -> S {
        S::from_f64(self.g0) * (j - S::one() - j.ln())
    }

    #[inline(always)]
    fn dU<S: Scalar>(&self, j: S) -> S {
        S::from_f64(self.g0) * (S::one() - S::one() / j)
    }

    #[inline(always)]
    fn ddU<S: Scalar>(&self, j: S) -> S {
        S::from_f64(self.g0) / (j * j)
    }
}
