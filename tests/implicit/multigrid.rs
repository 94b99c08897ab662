//! Multigrid: iterations that hardly depend on the mesh, and the direct solver's solution, on the pressed wheel. What it
//! takes beside other solvers: `cargo bench --bench solvers`.

use hexroll::implicit::direct::Direct;
use hexroll::implicit::krylov::{Krylov, LinearSolver};
use hexroll::implicit::multigrid::Multigrid;
use hexroll::implicit::system::System;
use hexroll::model::Model;
use hexroll::scene::Element;
use hexroll_lab::rig::given;
use hexroll_lab::rig::implicit::{pressed_system, wheel};

/// The paper's wheel, `fineness` times its mesh in every direction, pressed.
fn pressed(fineness: usize, mu: f64) -> (Model, System) {
    let model = wheel(given::refined(fineness), Element::Q1p0);
    let system = pressed_system(&model, mu);
    (model, system)
}

/// Conjugate gradients to a residual of 1e-8 of the right-hand side: solution and iterations.
fn by_multigrid(model: &Model, system: &System) -> (Vec<[f64; 3]>, usize) {
    let preconditioner = Multigrid::new(&model.mesh).unwrap();
    let mut solver = Krylov { preconditioner, tolerance: 1e-8, most: 200 };
    solver.prepare(system).expect("a positive definite matrix");
    solver.solve(system, &system.rhs).expect("it converges")
}

#[test]
fn multigrid_solves_the_wheel_in_few_iterations_and_agrees_with_the_direct_solution() {
    for (fineness, mu) in [(1, 1.0), (1, 0.0), (2, 1.0)] {
        let (model, system) = pressed(fineness, mu);
        let (by_cycles, iterations) = by_multigrid(&model, &system);
        assert!(iterations <= 25, "{iterations} iterations");
        let mut direct = Direct::default();
        direct.prepare(&system).unwrap();
        let (exact, _) = direct.solve(&system, &system.rhs).unwrap();
        let largest = exact.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        for (x, y) in by_cycles.iter().flatten().zip(exact.iter().flatten()) {
            // Residual 1e-8 times a condition number of the order of 1e4 at worst.
            assert!((x - y).abs() < 1e-4 * largest, "{x} {y}");
        }
    }
}

/// From 880 to 450,560 elements.
#[test]
#[ignore = "minutes and gigabytes: make verify runs it"]
fn iterations_hardly_grow_with_the_mesh() {
    let counts = [1, 2, 4, 8].map(|fineness| {
        let (model, system) = pressed(fineness, 1.0);
        (model.node_count() as f64, by_multigrid(&model, &system).1)
    });
    assert!(counts.iter().all(|(_, n)| *n <= 25), "{counts:?}");
    let [(small, few), .., (large, many)] = counts;
    let power = (many as f64 / few as f64).ln() / (large / small).ln();
    assert!(power < 0.1, "iterations grow as unknowns to the power of {power}: {counts:?}");
}
