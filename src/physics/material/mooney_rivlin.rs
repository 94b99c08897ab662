use super::{Choice, Derivatives, Law, Scalar};

/// The paper's energy, eq. 5:
///
/// W = g1/2 (J^-2/3 I1 - 3) + g2/2 (J^-4/3 I2 - 3),  U = g0/2 (J - 1)^2,  G = g1 + g2, kappa = g0 (eq. 6).
#[derive(Debug, Clone, Copy)]
pub struct MooneyRivlin<S> {
    g0: S,
    g1: S,
    g2: S,
}

impl<S: Scalar> Law<S> for MooneyRivlin<S> {
    const HAS_I2: bool = true;

    fn new(choice: &Choice) -> Self {
        let Choice::MooneyRivlin { g0, g1, g2 } = *choice else { unreachable!("composed for {choice:?}") };
        MooneyRivlin { g0: S::from_f64(g0), g1: S::from_f64(g1), g2: S::from_f64(g2) }
    }

    #[inline(always)]
    fn psi(&self, i1: S, i2: S, j: S) -> S {
        let (half, three) = (S::from_f64(0.5), S::from_f64(3.0));
        let r = j.recip_cbrt();
        let r2 = r * r;
        self.g1 * half * (r2 * i1 - three) + self.g2 * half * (r2 * r2 * i2 - three)
    }

    #[inline(always)]
    fn first_piola(&self, i1: S, i2: S, j: S) -> Derivatives<S> {
        let half = S::from_f64(0.5);
        let r = j.recip_cbrt();
        let r2 = r * r;
        let w1 = self.g1 * half * r2;
        let w2 = self.g2 * half * r2 * r2;
        // -(g1/3 J^-2/3 I1 + 2 g2/3 J^-4/3 I2) / J
        let wj = -(w1 * i1 + (w2 + w2) * i2) * S::from_f64(2.0 / 3.0) * (r2 * r);
        Derivatives { w1, w2, wj }
    }

    #[inline(always)]
    fn U(&self, j: S) -> S {
        let e = j - S::one();
        self.g0 * S::from_f64(0.5) * e * e
    }

    #[inline(always)]
    fn dU(&self, j: S) -> S {
        self.g0 * (j - S::one())
    }

    #[inline(always)]
    fn ddU(&self, _j: S) -> S {
        self.g0
    }
}
