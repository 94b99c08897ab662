//! The patch test: an affine motion of a distorted mesh stresses every element alike and leaves its inside in balance.
#![allow(non_snake_case)] // F, J, P: the field's own symbols

use hexroll::cpu::{self, Precision};
use hexroll::model::Model;
use hexroll::physics::element::hex8;
use hexroll::physics::material::{ArrudaBoyce, MooneyRivlin, MooneyRivlinEq4, NeoHookean, Ogden, Yeoh};
use hexroll::physics::tensor::{Mat3, det};
use hexroll::scene::{Element, Law};
use hexroll_lab::rig::{self, ELEMENTS, block, distort, largest, laws, times};

const ETA: f64 = 20.0;
const EDGE: f64 = 0.01;
/// Deformation and velocity gradients, columns: stretch, shear and twist of some 20 %, and rates of 100 /s.
const F: Mat3<f64> = [[1.15, 0.1, -0.05], [-0.2, 0.95, 0.12], [0.07, 0.03, 1.1]];
const L: Mat3<f64> = [[30.0, -70.0, 20.0], [110.0, -10.0, 50.0], [5.0, 40.0, -60.0]];

/// A block of 4 x 3 x 3 elements, every node moved by up to 20 % of an edge.
fn patch(element: Element, law: Law) -> (hexroll::scene::Scene, Model) {
    let mut scene = block([4.0 * EDGE, 3.0 * EDGE, 3.0 * EDGE], [4, 3, 3]);
    (scene.body.element, scene.body.law, scene.body.viscosity) = (element, law, Some(ETA));
    let mut mesh = Model::new(&scene).unwrap().mesh;
    distort(&mut mesh, EDGE, 0.2);
    let model = Model::from_mesh(mesh, &scene.body).expect("still a valid mesh");
    (scene, model)
}

/// Cauchy stress from the closed forms of the design's table plus the viscous stress.
fn expected_stress(law: Law) -> Mat3<f64> {
    let J = det(&F);
    let B: Mat3<f64> =
        std::array::from_fn(|j| std::array::from_fn(|i| (0..3).map(|c| F[c][i] * F[c][j]).sum()));
    let square = |A: &Mat3<f64>| -> Mat3<f64> { std::array::from_fn(|c| times(A, A[c])) };
    let trace = |A: &Mat3<f64>| A[0][0] + A[1][1] + A[2][2];
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let Bb = B.map(|c| c.map(|v| v * J.powf(-2.0 / 3.0)));
    let (i1b, Bb2) = (trace(&Bb), square(&Bb));
    // kappa (J - 1) + dev(g1 B' + g2 (I1' B' - B'^2)) / J with B' = J^-2/3 B.
    let split = |[kappa, g1, g2]: [f64; 3], i: usize, j: usize| {
        let T = |i: usize, j: usize| g1 * Bb[j][i] + g2 * (i1b * Bb[j][i] - Bb2[j][i]);
        let mean = (T(0, 0) + T(1, 1) + T(2, 2)) / 3.0;
        kappa * (J - 1.0) * unit(i, j) + (T(i, j) - mean * unit(i, j)) / J
    };
    let elastic = |i: usize, j: usize| match law {
        Law::MooneyRivlinEq4(MooneyRivlinEq4 { g0, g1, g2 }) => {
            // B^-1 = (B^2 - I1 B + I2 I) / J^2
            let (i1, b2) = (trace(&B), square(&B));
            let i2 = 0.5 * (i1 * i1 - trace(&b2));
            let inverse = (b2[j][i] - i1 * B[j][i] + i2 * unit(i, j)) / (J * J);
            (g0 * (J - 1.0) * unit(i, j) + g1 * (B[j][i] - unit(i, j)) - g2 * (inverse - unit(i, j))) / J
        }
        Law::NeoHookean(NeoHookean { g0, g1 }) => split([g0, g1, 0.0], i, j),
        Law::MooneyRivlin(MooneyRivlin { g0, g1, g2 }) => split([g0, g1, g2], i, j),
        Law::Yeoh(Yeoh { c10, c20, c30, bulk_modulus }) => {
            let e = i1b - 3.0;
            split([bulk_modulus, 2.0 * (c10 + 2.0 * c20 * e + 3.0 * c30 * e * e), 0.0], i, j)
        }
        Law::ArrudaBoyce(ArrudaBoyce { mu, lambda_m, bulk_modulus }) => {
            let c = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];
            let term = |n: usize| (n + 1) as f64 * c[n] * lambda_m.powi(-2 * n as i32) * i1b.powi(n as i32);
            let g1 = 2.0 * mu * (0..5).map(term).sum::<f64>();
            0.5 * bulk_modulus * (J - 1.0 / J) * unit(i, j) + split([0.0, g1, 0.0], i, j)
        }
        Law::Ogden(Ogden { mu1, alpha1, mu2, alpha2, mu3, alpha3, bulk_modulus }) => {
            let (squares, axes) = principal(Bb);
            let terms = [(mu1, alpha1), (mu2, alpha2), (mu3, alpha3)];
            let t = squares.map(|b| terms.map(|(mu, a)| 2.0 * mu / a * b.powf(0.5 * a)).iter().sum::<f64>());
            let mean = t.iter().sum::<f64>() / 3.0;
            let T = (0..3).map(|k| (t[k] - mean) * axes[k][i] * axes[k][j]).sum::<f64>();
            bulk_modulus * (J - 1.0) * unit(i, j) + T / J
        }
    };
    let viscous = |i: usize, j: usize| ETA * (L[j][i] + L[i][j] - 2.0 / 3.0 * trace(&L) * unit(i, j));
    std::array::from_fn(|j| std::array::from_fn(|i| elastic(i, j) + viscous(i, j)))
}

/// Principal values of a symmetric matrix and its axes, by Jacobi's rotations.
fn principal(mut A: Mat3<f64>) -> ([f64; 3], Mat3<f64>) {
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(36) {
        let angle = 0.5 * (2.0 * A[p][q]).atan2(A[p][p] - A[q][q]);
        let (s, c) = angle.sin_cos();
        let turned = |a: &Mat3<f64>| {
            let mut b = *a;
            for k in 0..3 {
                (b[p][k], b[q][k]) = (c * a[p][k] + s * a[q][k], c * a[q][k] - s * a[p][k]);
            }
            b
        };
        let transposed =
            |a: Mat3<f64>| -> Mat3<f64> { std::array::from_fn(|i| std::array::from_fn(|j| a[j][i])) };
        A = transposed(turned(&transposed(turned(&A))));
        axes = turned(&axes);
    }
    ([A[0][0], A[1][1], A[2][2]], axes)
}

/// Volume mean of an element's Cauchy stress, sum_a f_a (x) x_a / v.
fn mean_stress(x: &[[f64; 3]; 8], f: &[[f64; 3]; 8]) -> Mat3<f64> {
    let volume = hex8::volume(x);
    std::array::from_fn(|j| std::array::from_fn(|i| (0..8).map(|a| f[a][i] * x[a][j]).sum::<f64>() / volume))
}

/// Every formulation with every law: one stress, that of the closed form, and no force inside, to round-off.
#[test]
fn an_affine_motion_of_a_distorted_mesh_is_homogeneous() {
    for (element, law) in ELEMENTS.into_iter().flat_map(|e| laws().map(move |l| (e, l))) {
        let (scene, model) = patch(element, law);
        let x: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|&X| times(&F, X)).collect();
        let v: Vec<[f64; 3]> = x.iter().map(|&x| times(&L, x)).collect();
        let forces = cpu::engine(&model, &scene, Precision::F64, 1).unwrap().force(&x, &v).unwrap();
        let scale = largest(&forces);
        let inside = |n: &usize| model.mesh.surface.binary_search(&(*n as u32)).is_err();
        let interior: Vec<usize> = (0..x.len()).filter(inside).collect();
        assert_eq!(interior.len(), 3 * 2 * 2);
        for n in interior {
            // Eight elements' round-off, with positions of four edges.
            assert!(
                largest([&forces[n]]) < 2e-14 * scale,
                "{element:?} {law:?}: {:?} at node {n}",
                forces[n]
            );
        }
        let expected = expected_stress(law);
        for (hex, &class) in model.mesh.hexes.iter().zip(&model.class_of) {
            let (x, v) = (hex.map(|n| x[n as usize]), hex.map(|n| v[n as usize]));
            let sigma = mean_stress(&x, &model.element_forces(class as usize, &x, &v));
            for (c, i) in (0..9).map(|k| (k / 3, k % 3)) {
                // Round-off of the bulk modulus, positions of four edges.
                let error = (sigma[c][i] - expected[c][i]).abs();
                assert!(error < 1e-13 * rig::KAPPA, "{element:?} {law:?} sigma[{i}][{c}] is off by {error}");
            }
        }
    }
}
