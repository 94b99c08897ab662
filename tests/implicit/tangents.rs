//! The tangent is the derivative of the force, for every law, element and viscosity; symmetric where a potential
//! exists.

use hexroll::implicit::assembly::Assembler;
use hexroll::implicit::matrix::BlockMatrix;
use hexroll_lab::rig::implicit::{body, model};
use hexroll_lab::rig::{ELEMENTS, Random, laws, ring};

/// Vectors with components within `size`.
fn noise(n: usize, size: f64) -> Vec<[f64; 3]> {
    let mut random = Random::new(17);
    (0..n).map(|_| random.within(size)).collect()
}

fn sum(a: &[[f64; 3]], b: &[[f64; 3]], s: f64) -> Vec<[f64; 3]> {
    a.iter().zip(b).map(|(a, b)| std::array::from_fn(|i| a[i] + s * b[i])).collect()
}

#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    let mesh = ring([8, 2, 2]);
    for element in ELEMENTS {
        for law in laws() {
            for viscosity in [None, Some(20.0)] {
                let mut body = body(mesh.clone(), law, element);
                body.viscosity = viscosity;
                let model = model(&body, None);
                let n = model.node_count();
                // Strains of about 10 %, rates of about 100 1/s.
                let x = sum(&model.mesh.nodes, &noise(n, 0.75e-3), 1.0);
                let (v, rate) = (noise(n, 0.5), vec![2e4; n]);
                let direction = noise(n, 0.5).into_iter().rev().collect::<Vec<_>>();
                let assembler = Assembler::new(&model);
                let mut matrix = BlockMatrix::of_mesh(n, &model.mesh.hexes);
                assembler.tangent(&x, &v, &rate, &mut matrix);
                let mut by_tangent = vec![[0.0; 3]; n];
                matrix.multiply(&direction, &mut by_tangent);
                let h = 1e-8;
                let force = |s: f64| {
                    let moved = sum(&x, &direction, s * h);
                    assembler.forces(&moved, &sum(&v, &direction, s * h * rate[0])).unwrap().internal
                };
                let (plus, minus) = (force(1.0), force(-1.0));
                let largest = by_tangent.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
                for (k, t) in by_tangent.iter().enumerate() {
                    for i in 0..3 {
                        let difference = (plus[k][i] - minus[k][i]) / (2.0 * h);
                        // Central differences: (h/size)^2 = 1e-12 plus round-off 1e-16 size/h = 1e-11, some hundredfold.
                        assert!(
                            (difference - t[i]).abs() < 1e-7 * largest,
                            "{element:?} {law:?} {viscosity:?}: {difference} {}",
                            t[i]
                        );
                    }
                }
                let asymmetry = asymmetry(&matrix);
                // Elastic forces have a potential; viscous ones do not, and must show it.
                assert!(
                    if viscosity.is_none() { asymmetry < 1e-13 } else { asymmetry > 1e-6 },
                    "{element:?} {law:?} {viscosity:?}: asymmetry {asymmetry:.1e}"
                );
            }
        }
    }
}

/// Largest difference of an entry and its mirror image, over the largest entry.
fn asymmetry(matrix: &BlockMatrix) -> f64 {
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for i in 0..matrix.rows() {
        for (j, b) in matrix.row(i) {
            let mirror = &matrix.blocks[matrix.entry(j, i as u32)];
            for a in 0..3 {
                for c in 0..3 {
                    worst = worst.max((b[a][c] - mirror[c][a]).abs());
                    largest = largest.max(b[a][c].abs());
                }
            }
        }
    }
    worst / largest
}
