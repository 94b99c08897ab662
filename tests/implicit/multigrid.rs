//! Multigrid: iterations that hardly depend on the mesh, against the other linear solvers, on the pressed wheel.

use super::fixtures::*;
use hexroll::implicit::Scheme;
use hexroll::implicit::direct::Direct;
use hexroll::implicit::krylov::{BlockJacobi, Krylov, LinearSolver};
use hexroll::implicit::multigrid::Multigrid;
use hexroll::implicit::problem::Iterate;
use hexroll::implicit::system::System;
use hexroll::model::Model;
use hexroll::scene::Scene;
use std::time::Instant;

/// The paper's wheel, `fineness` times the 44x4x5 mesh in every direction, as a scene.
fn scene(fineness: usize, kappa: f64) -> Scene {
    let [c, r, w] = [44 * fineness, 4 * fineness, 5 * fineness];
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lat100_static.toml");
    let sets =
        [format!("body.mesh.elements=[{c}, {r}, {w}]"), format!("body.material.bulk_modulus={kappa} MPa")];
    Scene::load(file.as_ref(), &sets).unwrap_or_else(|e| panic!("{e}"))
}

/// The linear system of the first Newton iteration from a shape that is pressed by `down` metres at its foot: every
/// node below the road is put on it and sticks, or slides without friction.
fn pressed(model: &Model, mu: f64) -> System {
    let mut s = simulation(model, Scheme::Static, Some(road(mu)));
    let target = held(model, 1.0, 1.0, [0.0, 0.0, -2.2e-4, 0.0, 0.0, 0.0]);
    // A smooth press: the rim's motion fades out towards the tread.
    let foot = 2.0e-4;
    s.status = model
        .mesh
        .surface
        .iter()
        .map(|&n| {
            let touched = if mu > 0.0 {
                hexroll::implicit::contact::Status::Stick
            } else {
                hexroll::implicit::contact::Status::Slip
            };
            if s.x[n as usize][2] < foot { touched } else { Default::default() }
        })
        .collect();
    let inc = s.increment(&target);
    let at = Iterate { x: s.x.clone(), q: s.q, status: s.status.clone() };
    let residual = s.problem.residual(&inc, &at).unwrap();
    let mut matrix = hexroll::implicit::matrix::BlockMatrix::of_mesh(model.node_count(), &model.mesh.hexes);
    s.problem.tangent(&inc, &at, &residual.v, &mut matrix);
    let stiffness = vec![1e5; s.status.len()];
    System::new(&s.problem, &inc, &at, &residual, &stiffness, matrix)
}

/// Iterations, seconds to prepare and to solve, MB.
fn solved(solver: &mut dyn LinearSolver, system: &System) -> Option<Solved> {
    let start = Instant::now();
    solver.prepare(system)?;
    let prepared = start.elapsed().as_secs_f64();
    let (y, iterations) = solver.solve(system, &system.rhs)?;
    let all = start.elapsed().as_secs_f64();
    Some((y, iterations, [prepared, all - prepared, solver.bytes() as f64 / 1e6]))
}

fn multigrid(scene: &Scene) -> Krylov<Multigrid> {
    Krylov { preconditioner: Multigrid::new(&scene.body.mesh).unwrap(), tolerance: 1e-8, most: 200 }
}

/// A solution, its iterations, and what the printed line says of time and memory.
type Solved = (Vec<[f64; 3]>, usize, [f64; 3]);

fn report(name: &str, model: &Model, result: &Option<Solved>) {
    match result {
        Some((_, n, [prepare, solve, bytes])) => println!(
            "{:>8} elements {:>9} unknowns {name:<14} {n:>6} iterations, prepared in {prepare:.2} s, solved in \
             {solve:.2} s, {bytes:.0} MB",
            model.element_count(),
            3 * model.node_count()
        ),
        None => println!("{:>8} elements {name}: no convergence", model.element_count()),
    }
}

#[test]
fn multigrid_solves_the_wheel_in_few_iterations_and_agrees_with_the_direct_solution() {
    for (fineness, mu) in [(1, 1.0), (1, 0.0), (2, 1.0)] {
        let scene = scene(fineness, 65.1);
        let model = Model::new(&scene).unwrap();
        let system = pressed(&model, mu);
        let by_cycles = solved(&mut multigrid(&scene), &system);
        let direct = solved(&mut Direct::default(), &system);
        report("multigrid", &model, &by_cycles);
        report("direct", &model, &direct);
        let ((x, n, _), (y, _, _)) = (by_cycles.unwrap(), direct.unwrap());
        assert!(n <= 25, "{n} iterations");
        let largest = y.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        for (x, y) in x.iter().flatten().zip(y.iter().flatten()) {
            // Residual 1e-8 times a condition number of the order of 1e4 at worst.
            assert!((x - y).abs() < 1e-4 * largest, "{x} {y}");
        }
    }
}

/// The table of mesh against solver; minutes and gigabytes, so by hand:
/// `FINENESS=8 KAPPA=65.1 cargo test --test implicit -- --ignored --nocapture table_of_solvers`.
#[test]
#[ignore = "minutes and gigabytes; prints a table"]
fn table_of_solvers() {
    let from_env = |key: &str, default: f64| std::env::var(key).map_or(default, |v| v.parse().unwrap());
    let most = from_env("FINENESS", 4.0) as usize;
    let kappa = from_env("KAPPA", 65.1);
    let mut fineness = 1;
    while fineness <= most {
        let scene = scene(fineness, kappa);
        let model = Model::new(&scene).unwrap();
        let system = pressed(&model, 1.0);
        if fineness > 1 {
            report("multigrid", &model, &solved(&mut multigrid(&scene), &system));
        }
        let jacobi = BlockJacobi::default();
        let mut jacobi = Krylov { preconditioner: jacobi, tolerance: 1e-8, most: 20_000 };
        report("block-jacobi", &model, &solved(&mut jacobi, &system));
        if fineness <= 2 || from_env("DIRECT", 0.0) as usize >= fineness {
            report("direct", &model, &solved(&mut Direct::default(), &system));
        }
        fineness *= 2;
    }
}
