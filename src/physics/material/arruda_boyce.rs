use super::{Derivatives, Hyperelastic, Moduli};
use crate::parameters::{Fault, parameters};
use crate::scalar::Scalar;

parameters! {
    /// The chain model of Arruda & Boyce (J. Mech. Phys. Solids 41, 1993), its inverse Langevin function as five terms of a
    /// series; with I = J^-2/3 I1,
    ///
    /// W = mu sum c_i lambda_m^(2-2i) (I^i - 3^i),  c = 1/2, 1/20, 11/1050, 19/7000, 519/673750,
    /// U = kappa/2 ((J^2 - 1)/2 - ln J),  G = 2 dW/dI at I = 3: mu (1 + 3/5 lambda_m^-2 + ...).
    pub struct ArrudaBoyce("arruda-boyce", constants "") {
        /// Shear modulus of chains without a limit.
        mu "mu": Stress, Any;
        /// Stretch at which chains lock, > 1.
        lambda_m "lambda_m": Number, Positive;
        /// kappa.
        bulk_modulus "bulk_modulus": Stress, Positive;
    } also {
        /// 2 / kappa.
        "d1" for "bulk_modulus": Compressibility, |d1| 2.0 / d1;
    }
}

/// c_i of the series.
const SERIES: [f64; 5] = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

/// The limiting stretch that moduli alone stand for: the one that other programs take where none is given.
const USUAL_LIMIT: f64 = 7.0;

impl ArrudaBoyce {
    /// mu c_i lambda_m^(2-2i).
    #[inline(always)]
    fn coefficients(&self) -> [f64; 5] {
        let b = 1.0 / (self.lambda_m * self.lambda_m);
        let (b2, mu) = (b * b, self.mu);
        let [c1, c2, c3, c4, c5] = SERIES;
        [mu * c1, mu * c2 * b, mu * c3 * b2, mu * c4 * b2 * b, mu * c5 * b2 * b2]
    }

    /// dW/dI by Horner's rule.
    #[inline(always)]
    fn slope<S: Scalar>(&self, i: S) -> S {
        let number = S::from_f64;
        let [c1, c2, c3, c4, c5] = self.coefficients();
        let high = i.mul_add(number(5.0 * c5), number(4.0 * c4)).mul_add(i, number(3.0 * c3));
        high.mul_add(i, number(2.0 * c2)).mul_add(i, number(c1))
    }

    /// mu over G for a limiting stretch.
    fn share(lambda_m: f64) -> f64 {
        1.0 / ArrudaBoyce { mu: 1.0, lambda_m, bulk_modulus: 1.0 }.shear_modulus()
    }
}

impl Moduli for ArrudaBoyce {
    const KEYS_OF_MODULI: [&'static str; 2] = ["mu", "bulk_modulus"];

    fn shear_modulus(&self) -> f64 {
        2.0 * self.slope(3.0_f64)
    }

    fn bulk_modulus(&self) -> f64 {
        self.bulk_modulus
    }

    fn from_moduli(shear: f64, bulk: f64) -> Self {
        ArrudaBoyce { mu: shear * Self::share(USUAL_LIMIT), lambda_m: USUAL_LIMIT, bulk_modulus: bulk }
    }

    fn with_shear_scaled(self, factor: f64) -> Self {
        ArrudaBoyce { mu: factor * self.mu, ..self }
    }

    /// Chains so short that strains of a tenth feel their limit.
    fn example(shear: f64, bulk: f64) -> Self {
        ArrudaBoyce { mu: shear * Self::share(1.5), lambda_m: 1.5, bulk_modulus: bulk }
    }

    fn fault(&self) -> Option<Fault> {
        (self.lambda_m <= 1.0).then(|| Fault {
            key: "lambda_m",
            problem: format!("chains that lock at a stretch of {} are locked at rest", self.lambda_m),
            remedy: "write a stretch above 1, e.g. 7".into(),
        })
    }
}

impl Hyperelastic for ArrudaBoyce {
    const HAS_I2: bool = false;

    /// I^i - 3^i = (I - 3) h_i with h_1 = 1, h_(i+1) = I h_i + 3^i: no difference of large powers.
    #[inline(always)]
    fn psi<S: Scalar>(&self, i1: S, _i2: S, j: S) -> S {
        let number = S::from_f64;
        let r = j.recip_cbrt();
        let i = r * r * i1;
        let [c1, c2, c3, c4, c5] = self.coefficients();
        let h2 = i + number(3.0);
        let h3 = i.mul_add(h2, number(9.0));
        let h4 = i.mul_add(h3, number(27.0));
        let h5 = i.mul_add(h4, number(81.0));
        let sum = h5.mul_add(number(c5), h4.mul_add(number(c4), h3 * number(c3)));
        (i - number(3.0)) * (sum + h2.mul_add(number(c2), number(c1)))
    }

    #[inline(always)]
    fn derivatives<S: Scalar>(&self, i1: S, _i2: S, j: S) -> Derivatives<S> {
        let r = j.recip_cbrt();
        let r2 = r * r;
        let w1 = self.slope(r2 * i1) * r2;
        // dI/dJ = -2/3 J^-5/3 I1, with 1/J = r^3
        Derivatives { w1, w2: S::zero(), wj: w1 * i1 * (r2 * r) * S::from_f64(-2.0 / 3.0) }
    }

    #[inline(always)]
    fn U<S: Scalar>(&self, j: S) -> S {
        let half = S::from_f64(0.5);
        S::from_f64(0.5 * self.bulk_modulus) * (half * (j - S::one()) * (j + S::one()) - j.ln())
    }

    #[inline(always)]
    fn dU<S: Scalar>(&self, j: S) -> S {
        S::from_f64(0.5 * self.bulk_modulus) * (j - S::one()) * (j + S::one()) / j
    }

    #[inline(always)]
    fn ddU<S: Scalar>(&self, j: S) -> S {
        S::from_f64(0.5 * self.bulk_modulus) * (S::one() + S::one() / (j * j))
    }
}
