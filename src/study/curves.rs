//! What a law says in the tests that rubber is measured by: nominal stress against stretch in uniaxial, equibiaxial and planar
//! tension, and the stretch where the law loses stability.
//!
//! The sample is homogeneous, and its free sides carry no stress: their stretch is solved for, with the law's own bulk modulus.
//! A law is stable (Drucker) where stress rises along every change of the logarithms of the principal stretches: the matrix
//! d tau_i / d ln l_k of the Kirchhoff stresses is positive definite.

use crate::physics::material::{Hyperelastic, Law};

/// How a sample is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Test {
    /// Drawn along one direction, free sides.
    Uniaxial,
    /// Drawn alike along two.
    Equibiaxial,
    /// Drawn along one, its width held (pure shear).
    Planar,
}

impl Test {
    pub const ALL: [Test; 3] = [Test::Uniaxial, Test::Equibiaxial, Test::Planar];

    pub fn name(self) -> &'static str {
        match self {
            Test::Uniaxial => "uniaxial",
            Test::Equibiaxial => "equibiaxial",
            Test::Planar => "planar",
        }
    }

    /// Principal stretches, of which the last is free.
    fn stretches(self, drawn: f64, free: f64) -> [f64; 3] {
        match self {
            Test::Uniaxial => [drawn, free, free],
            Test::Equibiaxial => [drawn, drawn, free],
            Test::Planar => [drawn, 1.0, free],
        }
    }

    /// The free stretch of an incompressible sample.
    fn incompressible(self, drawn: f64) -> f64 {
        match self {
            Test::Uniaxial => drawn.powf(-0.5),
            Test::Equibiaxial => drawn.powi(-2),
            Test::Planar => 1.0 / drawn,
        }
    }

    /// Principal stretches of a sample of this law, its free sides without stress; `None` where no stretch of them is.
    pub fn state(self, law: &Law, drawn: f64) -> Option<[f64; 3]> {
        let stress = |free: f64| kirchhoff(law, self.stretches(drawn, free))[2];
        let near = self.incompressible(drawn);
        // By bisection: from where the sample is thinner than any that is free to where it is thicker.
        let (mut thin, mut thick) = (0.2 * near, 5.0 * near);
        if !(stress(thin) < 0.0 && stress(thick) > 0.0) {
            return None;
        }
        for _ in 0..100 {
            let middle = 0.5 * (thin + thick);
            if stress(middle) < 0.0 { thin = middle } else { thick = middle }
        }
        Some(self.stretches(drawn, 0.5 * (thin + thick)))
    }

    /// Nominal stress [Pa] along the drawn direction at this stretch.
    pub fn nominal_stress(self, law: &Law, drawn: f64) -> Option<f64> {
        Some(kirchhoff(law, self.state(law, drawn)?)[0] / drawn)
    }

    /// The first of `stretches` at which the law is not stable.
    pub fn lost(self, law: &Law, mut stretches: impl Iterator<Item = f64>) -> Option<f64> {
        stretches.find(|&drawn| !self.state(law, drawn).is_some_and(|state| is_stable(law, state)))
    }
}

/// Stretches in tension, and in compression, that stability is asked at: 1.01 to 10 and 0.99 to 0.1, as other programs do.
pub fn tension() -> impl Iterator<Item = f64> {
    (1..=900).map(|i| 1.0 + 0.01 * f64::from(i))
}

/// See [`tension`].
pub fn compression() -> impl Iterator<Item = f64> {
    (1..=90).map(|i| 1.0 - 0.01 * f64::from(i))
}

/// Principal Kirchhoff stresses J sigma_i = dW / d ln l_i [Pa].
pub fn kirchhoff(law: &Law, l: [f64; 3]) -> [f64; 3] {
    let c = l.map(|l| l * l);
    let (i1, i2) = (c[0] + c[1] + c[2], c[0] * c[1] + c[1] * c[2] + c[2] * c[0]);
    let j = l[0] * l[1] * l[2];
    let d = law.derivatives(i1, i2, j);
    c.map(|c| 2.0 * c * (d.w1 + d.w2 * (i1 - c)) + j * (d.wj + law.dU(j)))
}

/// Whether d tau_i / d ln l_k is positive definite, by central differences and the signs of the leading minors.
pub fn is_stable(law: &Law, l: [f64; 3]) -> bool {
    const STEP: f64 = 1e-5;
    let row = |k: usize| {
        let moved = |sign: f64| {
            let mut l = l;
            l[k] *= (sign * STEP).exp();
            kirchhoff(law, l)
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        [0, 1, 2].map(|i| (up[i] - down[i]) / (2.0 * STEP))
    };
    let [a, b, c] = [row(0), row(1), row(2)];
    let second = a[0] * b[1] - a[1] * b[0];
    let third = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    a[0] > 0.0 && second > 0.0 && third > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::material::{MooneyRivlin, NeoHookean, Yeoh};

    /// Treloar's closed forms of the incompressible solid, nominal stress 2 (l - l^-2)(W1 + W2/l) and so on: with kappa = 1e7 G a
    /// volume strain of sigma / kappa is left, 1e-6 at most.
    #[test]
    fn stresses_are_those_of_the_textbook() {
        let (g1, g2) = (0.7e6, 0.3e6);
        let law = Law::MooneyRivlin(MooneyRivlin { g0: 1e13, g1, g2 });
        for l in [0.5f64, 0.9, 1.3, 2.0, 3.0] {
            let (w1, w2) = (0.5 * g1, 0.5 * g2);
            let expected = [
                2.0 * (l - l.powi(-2)) * (w1 + w2 / l),
                2.0 * (l - l.powi(-5)) * (w1 + l * l * w2),
                2.0 * (l - l.powi(-3)) * (w1 + w2),
            ];
            for (test, expected) in Test::ALL.into_iter().zip(expected) {
                let got = test.nominal_stress(&law, l).unwrap();
                assert!((got / expected - 1.0).abs() < 1e-5, "{test:?} at {l}: {got}, expected {expected}");
            }
        }
    }

    /// With a finite bulk modulus the free sides carry nothing, and a sample at rest is not stressed.
    #[test]
    fn free_sides_are_free() {
        let law = Law::NeoHookean(NeoHookean { g0: 5e6, g1: 1e6 });
        for test in Test::ALL {
            let state = test.state(&law, 1.8).unwrap();
            assert!(kirchhoff(&law, state)[2].abs() < 1e-8, "{test:?}");
            assert!(state.iter().product::<f64>() > 1.02, "drawn rubber of this kind grows: {state:?}");
            assert!(test.nominal_stress(&law, 1.0).unwrap().abs() < 1e-8);
        }
    }

    /// Incompressible Mooney-Rivlin in equibiaxial tension: k_i = 4 (C10 l_i^2 + C01 l_i^-2) is d t_i / d ln l_i, and the two
    /// independent changes are stable while k1 + 2 k3 and k1 are positive. Yeoh with a large negative C20 by the same in
    /// one dimension; the neo-Hookean law never is unstable, but for U = kappa/2 (J - 1)^2, whose stress falls where J < 1/2.
    #[test]
    fn stability_is_lost_where_the_closed_form_says() {
        let (c10, c01) = (1e6, -0.05e6);
        let law = Law::MooneyRivlin(MooneyRivlin { g0: 1e11, g1: 2.0 * c10, g2: 2.0 * c01 });
        let k = |l: f64| c10 * l * l + c01 / (l * l);
        let expected = tension().find(|&l| k(l) + 2.0 * k(l.powi(-2)) <= 0.0).unwrap();
        let got = Test::Equibiaxial.lost(&law, tension()).unwrap();
        assert!((got - expected).abs() < 0.011, "{got}, expected {expected}");
        assert!((1.5..9.0).contains(&expected));
        let stiff = Law::NeoHookean(NeoHookean { g0: 1e13, g1: 1e6 });
        let soft = Law::Yeoh(Yeoh { c10: 1e6, c20: -0.2e6, c30: 0.0, bulk_modulus: 1e8 });
        for test in Test::ALL {
            assert_eq!(
                [test.lost(&stiff, tension()), test.lost(&stiff, compression())],
                [None; 2],
                "{test:?}"
            );
            assert!(test.lost(&soft, tension()).is_some_and(|l| l < 3.0), "{test:?}");
        }
    }
}
