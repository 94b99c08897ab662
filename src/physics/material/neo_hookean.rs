use super::{Derivatives, Hyperelastic, Moduli};
use crate::parameters::parameters;
use crate::scalar::Scalar;

parameters! {
    /// `mooney-rivlin` with g2 = 0, Abaqus's neo-Hookean with C10 = G/2, D1 = 2/kappa:
    ///
    /// W = g1/2 (J^-2/3 I1 - 3),  U = g0/2 (J - 1)^2,  G = g1, kappa = g0.
    pub struct NeoHookean("neo-hookean", constants "") {
        /// Bulk modulus.
        g0 "g0": Stress, Any;
        /// Shear modulus.
        g1 "g1": Stress, Any;
    } also {
        /// G / 2.
        "c10" for "g1": Stress, |c10| 2.0 * c10;
        /// 2 / kappa.
        "d1" for "g0": Compressibility, |d1| 2.0 / d1;
        /// kappa.
        "bulk_modulus" for "g0": Stress, |kappa| kappa;
    }
}

impl Moduli for NeoHookean {
    const KEYS_OF_MODULI: [&'static str; 2] = ["g1", "g0"];

    fn shear_modulus(&self) -> f64 {
        self.g1
    }

    fn bulk_modulus(&self) -> f64 {
        self.g0
    }

    fn from_moduli(shear: f64, bulk: f64) -> Self {
        NeoHookean { g0: bulk, g1: shear }
    }

    fn with_shear_scaled(self, factor: f64) -> Self {
        NeoHookean { g1: factor * self.g1, ..self }
    }

    fn example(shear: f64, bulk: f64) -> Self {
        NeoHookean::from_moduli(shear, bulk)
    }
}

impl Hyperelastic for NeoHookean {
    const HAS_I2: bool = false;

    #[inline(always)]
    fn psi<S: Scalar>(&self, i1: S, _i2: S, j: S) -> S {
        let r = j.recip_cbrt();
        S::from_f64(self.g1) * S::from_f64(0.5) * (r * r * i1 - S::from_f64(3.0))
    }

    #[inline(always)]
    fn derivatives<S: Scalar>(&self, i1: S, _i2: S, j: S) -> Derivatives<S> {
        let r = j.recip_cbrt();
        let r2 = r * r;
        let w1 = S::from_f64(self.g1) * S::from_f64(0.5) * r2;
        // -g1/3 J^-5/3 I1, with 1/J = r^3
        Derivatives { w1, w2: S::zero(), wj: w1 * i1 * (r2 * r) * S::from_f64(-2.0 / 3.0) }
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
