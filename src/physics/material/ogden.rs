use super::hencky::{self, Sum};
use super::{Derivatives, Hyperelastic, Law, Moduli, MooneyRivlin, NeoHookean};
use crate::parameters::{Fault, parameters};
use crate::scalar::Scalar;

parameters! {
    /// Ogden's energy (Proc. R. Soc. A 326, 1972) of up to three terms, in the constants of Abaqus; l_i are the principal
    /// stretches over J^1/3,
    ///
    /// W = sum 2 mu_k / alpha_k^2 (l_1^alpha_k + l_2^alpha_k + l_3^alpha_k - 3),  U = kappa/2 (J - 1)^2,  G = sum mu_k.
    pub struct Ogden("ogden", constants "") {
        /// What the first term has of the shear modulus.
        mu1 "mu_1": Stress, Any;
        /// Its power, not 0.
        alpha1 "alpha_1": Number, Any;
        /// The second term's.
        mu2 "mu_2": Stress, Any, or 0.0;
        /// Its power.
        alpha2 "alpha_2": Number, Any, or 0.0;
        /// The third term's.
        mu3 "mu_3": Stress, Any, or 0.0;
        /// Its power.
        alpha3 "alpha_3": Number, Any, or 0.0;
        /// kappa.
        bulk_modulus "bulk_modulus": Stress, Positive;
    } also {
        /// 2 / kappa.
        "d1" for "bulk_modulus": Compressibility, |d1| 2.0 / d1;
    }
}

impl Ogden {
    /// (mu, alpha) of each term.
    #[inline(always)]
    fn terms(&self) -> [(f64, f64); 3] {
        [(self.mu1, self.alpha1), (self.mu2, self.alpha2), (self.mu3, self.alpha3)]
    }

    /// W: 2 mu / alpha is what each term weighs.
    #[inline(always)]
    fn sum(&self) -> Sum {
        let weight = |mu: f64, alpha: f64| if mu == 0.0 { 0.0 } else { 2.0 * mu / alpha };
        Sum::new(self.terms().map(|(mu, alpha)| (alpha, weight(mu, alpha))))
    }

    /// Sum of the shear moduli of terms with this power.
    fn with_power(&self, power: f64) -> f64 {
        self.terms().iter().filter(|t| t.1 == power).map(|t| t.0).sum()
    }
}

impl Moduli for Ogden {
    const KEYS_OF_MODULI: [&'static str; 2] = ["mu_1", "bulk_modulus"];

    fn shear_modulus(&self) -> f64 {
        self.mu1 + self.mu2 + self.mu3
    }

    fn bulk_modulus(&self) -> f64 {
        self.bulk_modulus
    }

    fn from_moduli(shear: f64, bulk: f64) -> Self {
        let none =
            Ogden { mu1: 0.0, alpha1: 0.0, mu2: 0.0, alpha2: 0.0, mu3: 0.0, alpha3: 0.0, bulk_modulus: bulk };
        Ogden { mu1: shear, alpha1: 2.0, ..none }
    }

    fn with_shear_scaled(self, factor: f64) -> Self {
        Ogden { mu1: factor * self.mu1, mu2: factor * self.mu2, mu3: factor * self.mu3, ..self }
    }

    /// The powers of Ogden's own fit to Treloar's rubber.
    fn example(shear: f64, bulk: f64) -> Self {
        let (mu1, mu2, mu3) = (0.7 * shear, 0.1 * shear, 0.2 * shear);
        Ogden { mu1, alpha1: 1.3, mu2, alpha2: 5.0, mu3, alpha3: -2.0, bulk_modulus: bulk }
    }

    /// Powers 2 and -2 are the two terms of the Mooney-Rivlin law, whose code is cheaper by far.
    fn simplified(self) -> Law {
        let [g1, g2] = [self.with_power(2.0), self.with_power(-2.0)];
        let others = self.terms().iter().any(|&(mu, alpha)| mu != 0.0 && alpha.abs() != 2.0);
        match (others, g2 == 0.0) {
            (true, _) => self.into(),
            (false, true) => NeoHookean { g0: self.bulk_modulus, g1 }.into(),
            (false, false) => MooneyRivlin { g0: self.bulk_modulus, g1, g2 }.into(),
        }
    }

    fn fault(&self) -> Option<Fault> {
        let keys = [("alpha_1", "mu_1"), ("alpha_2", "mu_2"), ("alpha_3", "mu_3")];
        let bad = self.terms().into_iter().zip(keys).find(|((mu, alpha), _)| *mu != 0.0 && *alpha == 0.0);
        bad.map(|(_, (alpha, mu))| Fault {
            key: alpha,
            problem: format!("{mu} has no power, or one of 0, whose term stores nothing"),
            remedy: format!("write {alpha} = 2.0 or another power that is not 0"),
        })
    }
}

impl Hyperelastic for Ogden {
    const HAS_I2: bool = true;
    const UNROLLED: bool = false;

    #[inline(always)]
    fn psi<S: Scalar>(&self, i1: S, i2: S, j: S) -> S {
        let (_, e) = hencky::isochoric(i1, i2, j);
        self.sum().at(e).0
    }

    #[inline(always)]
    fn derivatives<S: Scalar>(&self, i1: S, i2: S, j: S) -> Derivatives<S> {
        let (r, e) = hencky::isochoric(i1, i2, j);
        let (_, [w1, w2]) = self.sum().at(e);
        let r2 = r * r;
        let (w1, w2) = (w1 * r2, w2 * (r2 * r2));
        // -(2 W1 I1 + 4 W2 I2) / (3 J), with 1/J = r^3
        let wj = -(w1 * i1 + (w2 + w2) * i2) * S::from_f64(2.0 / 3.0) * (r2 * r);
        Derivatives { w1, w2, wj }
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
