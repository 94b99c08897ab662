use super::{Choice, Derivatives, Law, Scalar};

/// `mooney-rivlin` with g2 = 0, Abaqus's neo-Hookean with C10 = G/2, D1 = 2/kappa:
///
/// W = g1/2 (J^-2/3 I1 - 3),  U = g0/2 (J - 1)^2,  G = g1, kappa = g0.
#[derive(Debug, Clone, Copy)]
pub struct NeoHookean<S> {
    g0: S,
    g1: S,
}

impl<S: Scalar> Law<S> for NeoHookean<S> {
    const HAS_I2: bool = false;

    fn new(choice: &Choice) -> Self {
        let Choice::NeoHookean { g0, g1 } = *choice else { unreachable!("composed for {choice:?}") };
        NeoHookean { g0: S::from_f64(g0), g1: S::from_f64(g1) }
    }

    #[inline(always)]
    fn psi(&self, i1: S, _i2: S, j: S) -> S {
        let r = j.recip_cbrt();
        self.g1 * S::from_f64(0.5) * (r * r * i1 - S::from_f64(3.0))
    }

    #[inline(always)]
    fn first_piola(&self, i1: S, _i2: S, j: S) -> Derivatives<S> {
        let r = j.recip_cbrt();
        let r2 = r * r;
        let w1 = self.g1 * S::from_f64(0.5) * r2;
        // -g1/3 J^-5/3 I1, with 1/J = r^3
        Derivatives { w1, w2: S::zero(), wj: w1 * i1 * (r2 * r) * S::from_f64(-2.0 / 3.0) }
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
