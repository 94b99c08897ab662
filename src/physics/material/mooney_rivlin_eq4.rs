use super::{Choice, Derivatives, Law, Scalar};

/// The law whose Cauchy stress is the paper's eq. 4 (with the sign of its last term that makes G = g1 + g2):
///
/// W = g1/2 (I1 - 3 - 2 ln J) + g2/2 (I2/J^2 - 3 + 2 ln J),  U = g0 (J - 1 - ln J),
/// G = g1 + g2, kappa = g0 + 2/3 (g1 + g2); I2/J^2 = tr B^-1.
#[derive(Debug, Clone, Copy)]
pub struct MooneyRivlinEq4<S> {
    g0: S,
    g1: S,
    g2: S,
}

impl<S: Scalar> Law<S> for MooneyRivlinEq4<S> {
    const HAS_I2: bool = true;

    fn new(choice: &Choice) -> Self {
        let Choice::MooneyRivlinEq4 { g0, g1, g2 } = *choice else { unreachable!("composed for {choice:?}") };
        MooneyRivlinEq4 { g0: S::from_f64(g0), g1: S::from_f64(g1), g2: S::from_f64(g2) }
    }

    #[inline(always)]
    fn psi(&self, i1: S, i2: S, j: S) -> S {
        let (half, three) = (S::from_f64(0.5), S::from_f64(3.0));
        let log = j.ln();
        self.g1 * (half * (i1 - three) - log) + self.g2 * (half * (i2 / (j * j) - three) + log)
    }

    #[inline(always)]
    fn first_piola(&self, _i1: S, i2: S, j: S) -> Derivatives<S> {
        let half = S::from_f64(0.5);
        let r = S::one() / j;
        let w2 = self.g2 * half * r * r;
        // (g2 - g1)/J - g2 I2/J^3
        let wj = r * (self.g2 - self.g1 - (w2 + w2) * i2);
        Derivatives { w1: self.g1 * half, w2, wj }
    }

    #[inline(always)]
    fn U(&self, j: S) -> S {
        self.g0 * (j - S::one() - j.ln())
    }

    #[inline(always)]
    fn dU(&self, j: S) -> S {
        self.g0 * (S::one() - S::one() / j)
    }

    #[inline(always)]
    fn ddU(&self, j: S) -> S {
        self.g0 / (j * j)
    }
}
