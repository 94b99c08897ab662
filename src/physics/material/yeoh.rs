use super::{Derivatives, Hyperelastic, Law, Moduli, NeoHookean};
use crate::parameters::parameters;
use crate::scalar::Scalar;

parameters! {
    /// Yeoh's polynomial in I1 (Rubber Chem. Technol. 66, 1993): with I = J^-2/3 I1,
    ///
    /// W = C10 (I - 3) + C20 (I - 3)^2 + C30 (I - 3)^3,  U = kappa/2 (J - 1)^2,  G = 2 C10.
    pub struct Yeoh("yeoh", constants "") {
        /// Half of the shear modulus.
        c10 "c10": Stress, Any;
        /// Mostly negative: softening at small strain.
        c20 "c20": Stress, Any, or 0.0;
        /// Stiffening at large strain.
        c30 "c30": Stress, Any, or 0.0;
        /// kappa.
        bulk_modulus "bulk_modulus": Stress, Positive;
    } also {
        /// 2 / kappa.
        "d1" for "bulk_modulus": Compressibility, |d1| 2.0 / d1;
    }
}

impl Yeoh {
    /// dW/dI by Horner's rule.
    #[inline(always)]
    fn slope<S: Scalar>(&self, e: S) -> S {
        let number = S::from_f64;
        e.mul_add(number(3.0 * self.c30), number(2.0 * self.c20)).mul_add(e, number(self.c10))
    }
}

impl Moduli for Yeoh {
    const KEYS_OF_MODULI: [&'static str; 2] = ["c10", "bulk_modulus"];

    fn shear_modulus(&self) -> f64 {
        2.0 * self.c10
    }

    fn bulk_modulus(&self) -> f64 {
        self.bulk_modulus
    }

    fn from_moduli(shear: f64, bulk: f64) -> Self {
        Yeoh { c10: 0.5 * shear, c20: 0.0, c30: 0.0, bulk_modulus: bulk }
    }

    fn with_shear_scaled(self, factor: f64) -> Self {
        Yeoh { c10: factor * self.c10, c20: factor * self.c20, c30: factor * self.c30, ..self }
    }

    /// C20 and C30 so large that strains of a tenth feel them.
    fn example(shear: f64, bulk: f64) -> Self {
        Yeoh { c10: 0.5 * shear, c20: shear, c30: 10.0 * shear, bulk_modulus: bulk }
    }

    /// With C10 alone it is neo-Hookean, whose code is cheaper.
    fn simplified(self) -> Law {
        let Yeoh { c10, c20, c30, bulk_modulus } = self;
        let linear = c20 == 0.0 && c30 == 0.0;
        if linear { NeoHookean { g0: bulk_modulus, g1: 2.0 * c10 }.into() } else { self.into() }
    }
}

impl Hyperelastic for Yeoh {
    const HAS_I2: bool = false;

    #[inline(always)]
    fn psi<S: Scalar>(&self, i1: S, _i2: S, j: S) -> S {
        let number = S::from_f64;
        let r = j.recip_cbrt();
        let e = r * r * i1 - number(3.0);
        e.mul_add(number(self.c30), number(self.c20)).mul_add(e, number(self.c10)) * e
    }

    #[inline(always)]
    fn derivatives<S: Scalar>(&self, i1: S, _i2: S, j: S) -> Derivatives<S> {
        let r = j.recip_cbrt();
        let r2 = r * r;
        let w1 = self.slope(r2 * i1 - S::from_f64(3.0)) * r2;
        // dI/dJ = -2/3 J^-5/3 I1, with 1/J = r^3
        Derivatives { w1, w2: S::zero(), wj: w1 * i1 * (r2 * r) * S::from_f64(-2.0 / 3.0) }
    }

    #[inline(always)]
    fn U<S: Scalar>(&self, j: S) -> S {
        let e = j - S::one();
        S::from_f64(0.5 * self.bulk_modulus) * e * e
    }

    #[inline(always)]
    fn dU<S: Scalar>(&self, j: S) -> S {
        S::from_f64(self.bulk_modulus) * (j - S::one())
    }

    #[inline(always)]
    fn ddU<S: Scalar>(&self, _j: S) -> S {
        S::from_f64(self.bulk_modulus)
    }
}
