//! Every fast routine of `q1p0` gives the forces of the textbook's (`physics/element/textbook.rs`): the routines for any shape
//! and for extruded elements, the passes of the CPU engine at every level of instructions, and the implicit scheme with its
//! tangent. The GPU's are in `tests/gpu/forces.rs`.
#![allow(non_snake_case)] // X: the field's own symbol

use hexroll::cpu::engine_at;
use hexroll::implicit::assembly::Assembler;
use hexroll::implicit::matrix::BlockMatrix;
use hexroll::model::Model;
use hexroll::physics::element::{Class, Compose, Composition, Corners, Element, Formulation};
use hexroll::physics::lanes::Level;
use hexroll::physics::material::{Forgetful, Hyperelastic, Law, Viscosity};
use hexroll::{cpu::Precision, scene::Scene};
use hexroll_lab::rig::{Random, block, book, by_the_book, distort, laws, relative};

struct Fast<'a> {
    class: &'a Class<f64>,
    x: &'a Corners<f64>,
}

impl Compose for Fast<'_> {
    type Output = Corners<f64>;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Corners<f64> {
        F::force(&law, &viscosity, self.class, self.x, &[[0.0; 3]; 8], &mut Forgetful).f
    }
}

/// A block of elements of any shape, or (`extruded`) as it is generated, and positions some 10 % away.
fn case(law: Law, extruded: bool) -> (Scene, Model, Vec<[f64; 3]>) {
    let mut scene = block([0.03, 0.02, 0.02], [3, 2, 2]);
    scene.body.law = law;
    let mut model = Model::new(&scene).unwrap();
    if !extruded {
        let mut mesh = model.mesh.clone();
        distort(&mut mesh, 0.01, 0.15);
        model = Model::from_mesh(mesh, &scene.body).unwrap();
    }
    assert_eq!(model.is_extruded(), extruded);
    let mut random = Random::new(17);
    let F = random.near_identity(0.1);
    let moved = |X: &[f64; 3]| {
        let by = random.vector();
        std::array::from_fn(|i| (0..3).map(|c| F[c][i] * X[c]).sum::<f64>() + 5e-4 * by[i])
    };
    let x = model.mesh.nodes.iter().map(moved).collect();
    (scene, model, x)
}

/// Both routines element by element: a hundred operations in another order, the bulk modulus 25 times the shear modulus.
#[test]
fn the_routines_of_an_element_follow_the_book() {
    for law in laws() {
        for extruded in [false, true] {
            let (_, model, x) = case(law, extruded);
            for (hex, &class) in model.mesh.hexes.iter().zip(&model.class_of) {
                let X = hex.map(|n| model.mesh.nodes[n as usize]);
                let x = hex.map(|n| x[n as usize]);
                let expected = book(&law, &X, &x);
                let class = &model.classes[class as usize];
                let composition =
                    Composition { element: Element::Q1p0, law, viscosity: None, relaxes: false };
                let any = composition.visit(Fast { class, x: &x });
                assert!(relative(&any, &expected) < 1e-12, "{}: {any:?} {expected:?}", law.name());
                let fastest = composition.visit_fastest(extruded, Fast { class, x: &x });
                assert!(relative(&fastest, &expected) < 1e-12, "{}: {fastest:?} {expected:?}", law.name());
            }
        }
    }
}

/// The engine's passes on the assembled block. Single precision: rounding of the stress relative to its deviator, 6e-8 times
/// kappa/G and a few digits of sums.
#[test]
fn the_passes_of_every_level_follow_the_book() {
    for law in laws() {
        for extruded in [false, true] {
            let (scene, model, x) = case(law, extruded);
            let (book, still) = (by_the_book(&model, &x), vec![[0.0; 3]; x.len()]);
            for level in Level::available() {
                for (precision, tolerance) in [(Precision::F64, 1e-12), (Precision::F32, 3e-5)] {
                    let mut engine = engine_at(&model, &scene, precision, 1, level).unwrap();
                    let error = relative(&engine.force(&x, &still).unwrap(), &book);
                    assert!(error < tolerance, "{} {level:?} {precision:?}: {error:e}", law.name());
                }
            }
        }
    }
}

/// The implicit scheme's forces, and its tangent against central differences of the book's: truncation h^2 = 1e-12 of a third
/// derivative that is some 1e4 of the tangent at elements of 10 mm, rounding 1e-16 / h of it.
#[test]
fn the_implicit_scheme_follows_the_book() {
    for law in laws() {
        let (_, model, x) = case(law, false);
        let still = vec![[0.0; 3]; x.len()];
        let assembler = Assembler::new(&model);
        let forces = assembler.forces(&x, &still).unwrap().internal;
        assert!(relative(&forces, &by_the_book(&model, &x)) < 1e-12, "{}", law.name());
        let mut matrix = BlockMatrix::of_mesh(x.len(), &model.mesh.hexes);
        assembler.tangent(&x, &still, &vec![0.0; x.len()], &mut matrix);
        let mut random = Random::new(23);
        let way: Vec<[f64; 3]> = x.iter().map(|_| random.vector()).collect();
        let h = 1e-8;
        let moved = |s: f64| -> Vec<[f64; 3]> {
            x.iter().zip(&way).map(|(x, w)| std::array::from_fn(|d| x[d] + s * w[d])).collect()
        };
        let (ahead, behind) = (by_the_book(&model, &moved(h)), by_the_book(&model, &moved(-h)));
        let difference: Vec<[f64; 3]> = ahead
            .iter()
            .zip(&behind)
            .map(|(a, b)| std::array::from_fn(|d| (a[d] - b[d]) / (2.0 * h)))
            .collect();
        let mut product = vec![[0.0; 3]; x.len()];
        matrix.multiply(&way, &mut product);
        let error = relative(&product, &difference);
        assert!(error < 1e-6, "{}: tangent off by {error:e}", law.name());
    }
}
