//! The material laws against their definitions: stress from energy, moduli, closed-form states, viscosity.

#![allow(non_snake_case)] // F, J, P: the field's own symbols

use hexroll::physics::element::hex8;
use hexroll::physics::material::{
    ArrudaBoyce, Derivatives, Hyperelastic, KelvinVoigt, Moduli, MooneyRivlin, Ogden, Viscosity, WithLaw,
    Yeoh, velocity_gradient,
};
use hexroll::physics::tensor::{Identity, Mat3, axpy, cofactor, det, dot};
use hexroll::scene::Law;
use hexroll_lab::rig::{EQ4, G, KAPPA, RUBBER, Random, TWO_CONSTANTS, close, laws, times};

struct EnergyAt<'a>(&'a Mat3<f64>);

impl WithLaw for EnergyAt<'_> {
    type Output = f64;
    fn with<L: Hyperelastic>(self, law: L) -> f64 {
        // Any law that has I2 says that it is wanted.
        let k = hex8::invariants::<f64, MooneyRivlin, _>(&hex8::gram(self.0), &Identity);
        let j = det(self.0);
        law.psi(k.i1, k.i2, j) + law.U(j)
    }
}

fn energy(law: &Law, F: &Mat3<f64>) -> f64 {
    law.visit(EnergyAt(F))
}

/// Columns of P, by the element's own assembly of it.
struct PiolaAt<'a>(&'a Mat3<f64>);

impl WithLaw for PiolaAt<'_> {
    type Output = Mat3<f64>;
    fn with<L: Hyperelastic>(self, law: L) -> Mat3<f64> {
        let F = self.0;
        let k = hex8::invariants::<f64, L, _>(&hex8::gram(F), &Identity);
        let (j, cof) = (det(F), cofactor(F));
        let d = law.derivatives(k.i1, k.i2, j);
        let s = hex8::second_piola::<f64, L, _>(&k, &d, &Identity, 1.0);
        let p = hex8::times_second_piola::<f64, L>(F, &s);
        std::array::from_fn(|c| axpy(cof[c], d.wj + law.dU(j), p[c]))
    }
}

fn piola(law: &Law, F: &Mat3<f64>) -> Mat3<f64> {
    law.visit(PiolaAt(F))
}

/// sigma = P F^T / J, columns (symmetric).
fn cauchy(choice: &Law, F: &Mat3<f64>) -> Mat3<f64> {
    let P = piola(choice, F);
    std::array::from_fn(|j| std::array::from_fn(|i| (0..3).map(|c| P[c][i] * F[c][j]).sum::<f64>() / det(F)))
}

/// A random deformation with a volume ratio in 0.7..1.4.
fn random_deformation(random: &mut Random) -> Mat3<f64> {
    let F = random.near_identity(0.35);
    let wanted = 1.05 + 0.35 * random.signed();
    let s = (wanted / det(&F)).cbrt();
    F.map(|c| c.map(|v| v * s))
}

fn diagonal(a: f64, b: f64, c: f64) -> Mat3<f64> {
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

#[track_caller]
fn assert_stress(choice: &Law, F: &Mat3<f64>, expected: Mat3<f64>) {
    let sigma = cauchy(choice, F);
    for i in 0..3 {
        for j in 0..3 {
            // Cubic roots and a dozen products: about 20 round-offs of the stiffest modulus.
            let error = (sigma[j][i] - expected[j][i]).abs();
            assert!(
                error < 1e-14 * 10.0 * KAPPA,
                "{choice:?} sigma[{i}][{j}] = {} is off by {error}",
                sigma[j][i]
            );
        }
    }
}

/// The first Piola stress is the gradient of the stored energy.
#[test]
fn stress_is_the_gradient_of_the_energy() {
    let mut random = Random::new(1);
    // Central differences: truncation h^2 times the third derivative (some ten moduli) 1e-10 of kappa, rounding
    // 1e-16 W / h below that.
    let h = 3e-6;
    for choice in &laws().collect::<Vec<_>>() {
        for _ in 0..50 {
            let F = random_deformation(&mut random);
            let P = piola(choice, &F);
            for (c, i) in (0..9).map(|k| (k / 3, k % 3)) {
                let moved = |s: f64| {
                    let mut F = F;
                    F[c][i] += s;
                    energy(choice, &F)
                };
                let difference = (moved(h) - moved(-h)) / (2.0 * h);
                let error = (P[c][i] - difference).abs();
                assert!(error < 2e-9 * KAPPA, "{choice:?} P[{i}][{c}] = {} is off by {error}", P[c][i]);
            }
        }
    }
}

/// At small strain every law has the moduli of eq. 6, or of its own row of the design's table, and no stress at rest.
#[test]
fn small_strain_moduli_are_those_of_the_table() {
    let h = 1e-5;
    for choice in &laws().collect::<Vec<_>>() {
        let shear = |g: f64| cauchy(choice, &[[1.0, 0.0, 0.0], [g, 1.0, 0.0], [0.0, 0.0, 1.0]])[0][1];
        let pressure = |e: f64| cauchy(choice, &diagonal(1.0 + e, 1.0 + e, 1.0 + e))[0][0];
        // Second-order differences: h^2 = 1e-10 of the third derivative; rounding 1e-16 kappa / h = 7e-10 of kappa.
        close("G", (shear(h) - shear(-h)) / (2.0 * h), G, 1e-8);
        close("kappa", (pressure(h) - pressure(-h)) / (6.0 * h), KAPPA, 1e-8);
        close("G as a scene knows it", choice.shear_modulus(), G, 1e-15);
        close("kappa as a scene knows it", choice.bulk_modulus(), KAPPA, 1e-15);
        close("the P-wave modulus", choice.wave_modulus(), KAPPA + 4.0 / 3.0 * G, 1e-15);
        assert_stress(choice, &diagonal(1.0, 1.0, 1.0), [[0.0; 3]; 3]);
    }
}

/// Simple shear: the closed-form Cauchy stresses of both energies.
#[test]
fn simple_shear_has_its_closed_form_stress() {
    let g = 0.4;
    let F = [[1.0, 0.0, 0.0], [g, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let (g1, g2) = (0.7 * G, 0.3 * G);
    // J = 1: dev[g1 B + g2 (I1 B - B^2)], B11 = 1 + g^2, B12 = g.
    let mean = (g1 - g2) * g * g / 3.0;
    let normal = [g1 * g * g - mean, -g2 * g * g - mean, -mean];
    let shear = (g1 + g2) * g;
    let expected = [[normal[0], shear, 0.0], [shear, normal[1], 0.0], [0.0, 0.0, normal[2]]];
    assert_stress(&TWO_CONSTANTS, &F, expected);
    // g1 (B - I) - g2 (B^-1 - I)
    let expected = [[g1 * g * g, shear, 0.0], [shear, -g2 * g * g, 0.0], [0.0; 3]];
    assert_stress(&EQ4, &F, expected);
}

/// Pure volume change: the deviatoric terms of `mooney-rivlin` vanish, those of eq. 4 do not.
#[test]
fn pure_volume_change_has_its_closed_form_stress() {
    for l in [0.9f64, 1.1] {
        let (F, J) = (diagonal(l, l, l), l.powi(3));
        let p = KAPPA * (J - 1.0);
        assert_stress(&RUBBER, &F, diagonal(p, p, p));
        assert_stress(&TWO_CONSTANTS, &F, diagonal(p, p, p));
        let p = (KAPPA * (J - 1.0) + 0.7 * G * (l * l - 1.0) - 0.3 * G * (1.0 / (l * l) - 1.0)) / J;
        assert_stress(&EQ4, &F, diagonal(p, p, p));
    }
}

/// Stretches l along x and t across: the closed-form Cauchy stresses.
#[test]
fn axial_stretch_has_its_closed_form_stress() {
    for (l, t) in [(1.3f64, 0.9f64), (0.8, 1.15)] {
        let (F, J) = (diagonal(l, t, t), l * t * t);
        let (b1, b2) = (l * l, t * t);
        for (choice, g1, g2) in [(&RUBBER, G, 0.0), (&TWO_CONSTANTS, 0.7 * G, 0.3 * G)] {
            let deviator = (g1 * J.powf(-2.0 / 3.0) + g2 * J.powf(-4.0 / 3.0) * b2) * (b1 - b2) / J;
            let p = KAPPA * (J - 1.0);
            let (along, across) = (p + 2.0 / 3.0 * deviator, p - deviator / 3.0);
            assert_stress(choice, &F, diagonal(along, across, across));
        }
        let sigma = |b: f64| (KAPPA * (J - 1.0) + 0.7 * G * (b - 1.0) - 0.3 * G * (1.0 / b - 1.0)) / J;
        assert_stress(&EQ4, &F, diagonal(sigma(b1), sigma(b2), sigma(b2)));
    }
}

/// The neo-Hookean code is the Mooney-Rivlin code with g2 = 0, cheaper.
#[test]
fn neo_hookean_is_mooney_rivlin_without_its_second_term() {
    let general = Law::MooneyRivlin(MooneyRivlin { g0: KAPPA, g1: G, g2: 0.0 });
    let mut random = Random::new(2);
    for _ in 0..50 {
        let F = random_deformation(&mut random);
        let (a, b) = (piola(&RUBBER, &F), piola(&general, &F));
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            // Same formula, another order of a few operations.
            assert!((a - b).abs() < 1e-14 * KAPPA, "{a} {b}");
        }
        close("W", energy(&RUBBER, &F), energy(&general, &F), 1e-13);
    }
}

struct Volumetric;

impl WithLaw for Volumetric {
    type Output = ();
    fn with<L: Hyperelastic>(self, law: L) {
        let h = 1e-5;
        for j in [0.7, 0.9, 1.0, 1.1, 1.4] {
            // Truncation h^2/6 times the fourth derivative of U, 1e-9; rounding 1e-16 / h of kappa.
            let slope = |f: &dyn Fn(f64) -> f64| (f(j + h) - f(j - h)) / (2.0 * h);
            let error =
                (slope(&|j| law.U(j)) - law.dU(j)).abs().max((slope(&|j| law.dU(j)) - law.ddU(j)).abs());
            assert!(error < 5e-9 * KAPPA, "{law:?} at J = {j}: off by {error}");
        }
        let at_rest = (law.U(1.0), law.dU(1.0));
        assert_eq!(at_rest, (0.0, 0.0), "an undeformed volume stores and pushes nothing");
    }
}

/// The derivatives of U are its derivatives.
#[test]
fn volumetric_derivatives_are_derivatives() {
    laws().for_each(|law| law.visit(Volumetric));
}

const ETA: f64 = 20.0;

/// Cauchy stress sigma_v and power density sigma_v : L of the viscosity at element gradient A and velocity gradient L
/// (columns).
fn viscous(A: &Mat3<f64>, L: &Mat3<f64>) -> (Mat3<f64>, f64) {
    let rate = A.map(|column| times(L, column));
    let (sigma, power) = KelvinVoigt::new(ETA).stress(&velocity_gradient(&rate, &cofactor(A)), det(A), 1.0);
    (sigma, power / det(A))
}

/// An applied velocity gradient gives eta (L + L^T - 2/3 tr L I), whatever the element's shape.
#[test]
fn an_applied_shear_rate_gives_the_closed_form_viscous_stress() {
    let mut random = Random::new(3);
    for _ in 0..50 {
        let A = random_deformation(&mut random);
        let rate = 100.0 * random.signed();
        let (sigma, power) = viscous(&A, &[[0.0; 3], [rate, 0.0, 0.0], [0.0; 3]]);
        let scale = ETA * rate.abs();
        for (c, i) in (0..9).map(|k| (k / 3, k % 3)) {
            let expected = if (c, i) == (0, 1) || (c, i) == (1, 0) { ETA * rate } else { 0.0 };
            // cof and det of a matrix with entries around 1: some ten round-offs, the condition of A a few.
            assert!((sigma[c][i] - expected).abs() < 1e-13 * scale, "sigma[{i}][{c}] = {}", sigma[c][i]);
        }
        close("power", power, ETA * rate * rate, 1e-13);
        let L: Mat3<f64> = [random.vector(), random.vector(), random.vector()];
        let (sigma, _) = viscous(&A, &L);
        let trace = L[0][0] + L[1][1] + L[2][2];
        for (c, i) in (0..9).map(|k| (k / 3, k % 3)) {
            let mean = if c == i { 2.0 / 3.0 * trace } else { 0.0 };
            assert!((sigma[c][i] - ETA * (L[c][i] + L[i][c] - mean)).abs() < 1e-12 * ETA);
        }
    }
}

/// A rigid spin makes no viscous stress, a volume change none either, and the power is never negative.
#[test]
fn viscosity_ignores_rigid_spins_and_never_gives_power() {
    let mut random = Random::new(4);
    for _ in 0..200 {
        let A = random_deformation(&mut random);
        let [a, b, c] = random.vector();
        let spin = [[0.0, c, -b], [-c, 0.0, a], [b, -a, 0.0]];
        let (sigma, power) = viscous(&A, &spin);
        // L is found from A's rate: round-off of the spin.
        assert!(sigma.iter().flatten().all(|s| s.abs() < 1e-13 * ETA), "{sigma:?}");
        assert!(power.abs() < 1e-24 * ETA + 1e-14, "{power}");
        let (sigma, _) = viscous(&A, &diagonal(a, a, a));
        assert!(sigma.iter().flatten().all(|s| s.abs() < 1e-13 * ETA), "{sigma:?}");
        let L: Mat3<f64> = [random.vector(), random.vector(), random.vector()];
        let (sigma, power) = viscous(&A, &L);
        let work: f64 = sigma.iter().zip(&L).map(|(&s, &l)| dot(s, l)).sum();
        close("power", power, work, 1e-11);
        assert!(power >= 0.0);
    }
}

/// Yeoh's law in simple shear by g, where I - 3 = g^2: tau = 2 g (C10 + 2 C20 g^2 + 3 C30 g^4), and in pure volume change.
#[test]
fn yeoh_has_its_closed_form_stress() {
    let (c10, c20, c30) = (1.0e6, -0.1e6, 0.03e6);
    let law = Law::Yeoh(Yeoh { c10, c20, c30, bulk_modulus: KAPPA });
    for g in [0.1f64, 0.5, 1.5] {
        let F = [[1.0, 0.0, 0.0], [g, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let two_w1 = 2.0 * (c10 + 2.0 * c20 * g * g + 3.0 * c30 * g.powi(4));
        // dev(two_w1 B): B11 = 1 + g^2, B12 = g, tr B = 3 + g^2.
        let third = two_w1 * g * g / 3.0;
        let expected = [[2.0 * third, two_w1 * g, 0.0], [two_w1 * g, -third, 0.0], [0.0, 0.0, -third]];
        assert_stress(&law, &F, expected);
    }
    let l = 1.05f64;
    let p = KAPPA * (l.powi(3) - 1.0);
    assert_stress(&law, &diagonal(l, l, l), diagonal(p, p, p));
}

/// With C10 alone it stores what the neo-Hookean law does, and a scene takes the cheaper code.
#[test]
fn yeoh_with_one_constant_is_neo_hookean() {
    let yeoh = Yeoh { c10: 0.5 * G, c20: 0.0, c30: 0.0, bulk_modulus: KAPPA };
    assert_eq!(yeoh.simplified(), RUBBER);
    let mut random = Random::new(6);
    for _ in 0..50 {
        let F = random_deformation(&mut random);
        close("W", energy(&Law::Yeoh(yeoh), &F), energy(&RUBBER, &F), 1e-13);
    }
}

/// One term of Ogden's law, or none.
fn ogden(terms: &[(f64, f64)]) -> Ogden {
    let term = |k: usize| terms.get(k).copied().unwrap_or_default();
    let [(mu1, alpha1), (mu2, alpha2), (mu3, alpha3)] = [term(0), term(1), term(2)];
    Ogden { mu1, alpha1, mu2, alpha2, mu3, alpha3, bulk_modulus: KAPPA }
}

/// With the powers 2 and -2 it has the slopes of the Mooney-Rivlin law, in double and in single precision, and a scene takes
/// the cheaper code.
#[test]
fn ogden_with_powers_two_and_minus_two_is_mooney_rivlin() {
    let mooney = |g1: f64, g2: f64| MooneyRivlin { g0: KAPPA, g1, g2 };
    let both = ogden(&[(0.7 * G, 2.0), (0.3 * G, -2.0)]);
    let pairs = [(ogden(&[(G, 2.0)]), mooney(G, 0.0)), (both, mooney(0.7 * G, 0.3 * G))];
    assert_eq!(pairs[0].0.simplified(), RUBBER);
    assert_eq!(pairs[1].0.simplified(), TWO_CONSTANTS);
    assert_eq!(ogden(&[(G, 2.0), (G, 3.0)]).simplified(), Law::Ogden(ogden(&[(G, 2.0), (G, 3.0)])));
    let mut random = Random::new(8);
    for n in 0..200 {
        // From 35 % of strain down to none.
        let F = if n == 0 { diagonal(1.0, 1.0, 1.0) } else { random.near_identity(0.35 / f64::from(n)) };
        let k = hex8::invariants::<f64, MooneyRivlin, _>(&hex8::gram(&F), &Identity);
        let j = det(&F);
        let numbers = |d: Derivatives<f64>| [d.w1, d.w2, d.wj];
        let singles = |d: Derivatives<f32>| [d.w1, d.w2, d.wj].map(f64::from);
        for (ogden, mooney) in pairs {
            let (got, expected) = (ogden.derivatives(k.i1, k.i2, j), mooney.derivatives(k.i1, k.i2, j));
            let (i1, i2, j) = (k.i1 as f32, k.i2 as f32, j as f32);
            let (got32, expected32) = (ogden.derivatives(i1, i2, j), mooney.derivatives(i1, i2, j));
            for i in 0..3 {
                // Two equations for W1 and W2 from exponentials of some 60 operations, WJ eight times as large: 50 round-offs of G.
                let error = numbers(got)[i] - numbers(expected)[i];
                assert!(error.abs() < 1e-14 * G, "{ogden:?} at {F:?}: {i} off by {error}");
                let error = singles(got32)[i] - singles(expected32)[i];
                assert!(error.abs() < 6e-6 * G, "{ogden:?} in f32 at {F:?}: {i} off by {error}");
            }
            let error = energy(&ogden.into(), &F) - energy(&mooney.into(), &F);
            assert!(error.abs() < 2e-14 * G, "W at {F:?}: off by {error}");
        }
    }
}

/// Stretches that coincide, or nearly, two of them or all three, along axes in any direction: the principal stresses by Ogden's own
/// formula, sum 2 mu / alpha l^alpha less its mean.
#[test]
fn ogden_keeps_its_digits_where_stretches_coincide() {
    let terms = [(0.7 * G, 1.3), (0.1 * G, 5.0), (0.2 * G, -2.0)];
    let (law, mut random) = (ogden(&terms), Random::new(9));
    let mut states = Vec::new();
    for apart in [0.0, 1e-12, 1e-9, 1e-8, 1e-7, 1e-5, 1e-3] {
        states.extend([[1.0, 1.0 + apart, 1.0], [1.0, 1.0 + apart, 1.0 - apart]]);
        states.extend([[1.4, 1.4 + apart, 0.5], [0.7, 2.0, 0.7 + apart], [0.5, 0.5 - apart, 3.9]]);
    }
    for l in states {
        let J: f64 = l.iter().product();
        let powers = |l: f64| terms.map(|(mu, a)| 2.0 * mu / a * l.powf(a)).iter().sum::<f64>();
        let t = |l: f64| powers(l * J.powf(-1.0 / 3.0));
        let mean = l.map(t).iter().sum::<f64>() / 3.0;
        let expected = l.map(|l| KAPPA * (J - 1.0) + (t(l) - mean) / J);
        let axes = turned(&mut random);
        // F = sum l_k n_k (x) n_k
        let F: Mat3<f64> =
            [0, 1, 2].map(|c| [0, 1, 2].map(|i| (0..3).map(|k| l[k] * axes[k][i] * axes[k][c]).sum()));
        let sigma = cauchy(&Law::Ogden(law), &F);
        for (n, expected) in axes.iter().zip(expected) {
            let along = dot(*n, times(&sigma, *n));
            // C and J with some ten round-offs each; J's times kappa.
            let error = (along - expected).abs();
            assert!(error < 2e-14 * KAPPA + 1e-13 * expected.abs(), "{l:?}: {along} is off by {error}");
        }
    }
}

/// Three orthogonal directions.
fn turned(random: &mut Random) -> Mat3<f64> {
    let unit = |v: [f64; 3]| v.map(|c| c / dot(v, v).sqrt());
    let a = unit(random.vector());
    let b = random.vector();
    let b = unit(axpy(a, -dot(a, b), b));
    [a, b, hexroll::physics::tensor::cross(a, b)]
}

/// Chains without a limit are neo-Hookean, but for the other volumetric energy; G is the series of the paper.
#[test]
fn arruda_boyce_with_endless_chains_is_neo_hookean() {
    let l: f64 = 2.0;
    let law = ArrudaBoyce { mu: 1.0, lambda_m: l, bulk_modulus: KAPPA };
    let series = 1.0 + 3.0 / (5.0 * l.powi(2)) + 99.0 / (175.0 * l.powi(4)) + 513.0 / (875.0 * l.powi(6));
    close("G / mu", law.shear_modulus(), series + 42_039.0 / (67_375.0 * l.powi(8)), 1e-15);
    let endless = ArrudaBoyce { mu: G, lambda_m: 1e9, bulk_modulus: KAPPA };
    let mut random = Random::new(10);
    for _ in 0..50 {
        let F = random_deformation(&mut random);
        let j = det(&F);
        let other = KAPPA * (0.25 * (j * j - 1.0) - 0.5 * j.ln()) - 0.5 * KAPPA * (j - 1.0).powi(2);
        // What is left of the second term: 3/5 / lambda_m^2.
        let expected = energy(&RUBBER, &F) + other;
        assert!((energy(&endless.into(), &F) - expected).abs() < 1e-14 * KAPPA, "{F:?}");
    }
}
