//! Multigrid inside the projected relaxation: the active set's solution, in iterations that hardly depend on the mesh.

use hexroll::implicit::{Limits, Scheme, Simulation};
use hexroll::model::Model;
use hexroll::scene::Element;
use hexroll_lab::rig::given::{self, DEPTH};
use hexroll_lab::rig::implicit::*;

const LIMITS: Limits = Limits { tolerance: 1e-9, iterations: 30 };

/// Presses by 2.2 mm in four increments.
fn press(s: &mut Simulation<'_>, model: &Model) {
    for n in 1..=4 {
        let down = -DEPTH * f64::from(n) / 4.0;
        let target = held(model, f64::from(n), 1.0, [0.0, 0.0, down, 0.0, 0.0, 0.0]);
        s.step(&target).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn it_finds_the_active_sets_solution() {
    let elements = given::MESH;
    let model = wheel(elements, Element::Q1p0);
    for mu in [0.0, 0.1] {
        let mut reference = simulation(&model, Scheme::Static, Some(road(mu)));
        let mut relaxed = simulation_with(&model, Scheme::Static, Some(road(mu)), corrected(&model), LIMITS);
        press(&mut reference, &model);
        press(&mut relaxed, &model);
        assert_eq!(relaxed.status, reference.status, "mu = {mu}");
        let largest = reference.contact.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
        for (a, b) in relaxed.contact.iter().zip(&reference.contact) {
            for i in 0..3 {
                // Both stop at residuals of 1e-9 of the internal forces' norm, some 10 times the largest force.
                assert!((a[i] - b[i]).abs() < 1e-6 * largest, "mu = {mu}: {a:?} {b:?}");
            }
        }
    }
}

/// The worst Newton iteration of a first increment, on three meshes; the table is `cargo bench --bench solvers`. Sweeps
/// alone take four times as many each time the mesh is halved.
#[test]
#[ignore = "minutes: make verify runs it"]
fn cycles_hardly_depend_on_the_mesh() {
    for mu in [0.0, 0.3] {
        let worst = [1, 2, 4].map(|fineness| first_increment(fineness, mu).0.into_iter().max().unwrap());
        assert!(worst[2] <= 2 * worst[0], "mu = {mu}: {worst:?}");
    }
}
