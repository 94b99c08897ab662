//! Multigrid: iterations that hardly depend on the mesh, against the other linear solvers, on the pressed wheel.

use super::fixtures::*;
use hexroll::implicit::Scheme;
use hexroll::implicit::direct::Direct;
use hexroll::implicit::krylov::{BlockJacobi, Krylov, LinearSolver};
use hexroll::implicit::matrix::{axpy, inverse, norm, times};
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

/// Memory that the process holds [MB]; 0 where the system does not say.
fn resident() -> f64 {
    let pages = |text: String| text.split(' ').nth(1).and_then(|p| p.parse::<f64>().ok());
    std::fs::read_to_string("/proc/self/statm").ok().and_then(pages).unwrap_or(0.0) * 4096.0 / 1e6
}

/// A solution, what it took, and what the table says of it.
struct Solved {
    y: Vec<[f64; 3]>,
    iterations: usize,
    /// Seconds to prepare and to solve.
    seconds: [f64; 2],
    /// Memory that came with it [MB], the matrix left out.
    megabytes: f64,
}

fn solved(solver: &mut dyn LinearSolver, system: &System) -> Option<Solved> {
    let before = resident();
    let start = Instant::now();
    solver.prepare(system)?;
    let prepared = start.elapsed().as_secs_f64();
    let (y, iterations) = solver.solve(system, &system.rhs)?;
    let seconds = [prepared, start.elapsed().as_secs_f64() - prepared];
    Some(Solved { y, iterations, seconds, megabytes: resident() - before })
}

fn multigrid(model: &Model) -> Krylov<Multigrid> {
    Krylov { preconditioner: Multigrid::new(&model.mesh).unwrap(), tolerance: TOLERANCE, most: 200 }
}

/// Residual of the linear equations over their right-hand side.
const TOLERANCE: f64 = 1e-8;

/// A line of the table.
fn report(name: &str, model: &Model, result: &Option<Solved>) {
    let mesh = format!("| {} | {} | {name}", model.element_count(), 3 * model.node_count());
    match result {
        Some(Solved { iterations, seconds: [prepare, solve], megabytes, .. }) => {
            println!("{mesh} | {iterations} | {prepare:.2} + {solve:.2} | {megabytes:.0} |");
        }
        None => println!("{mesh} | no convergence | | |"),
    }
}

#[test]
fn multigrid_solves_the_wheel_in_few_iterations_and_agrees_with_the_direct_solution() {
    for (fineness, mu) in [(1, 1.0), (1, 0.0), (2, 1.0)] {
        let scene = scene(fineness, 65.1);
        let model = Model::new(&scene).unwrap();
        let system = pressed(&model, mu);
        let by_cycles = solved(&mut multigrid(&model), &system);
        let direct = solved(&mut Direct::default(), &system);
        report("multigrid CG", &model, &by_cycles);
        report("direct", &model, &direct);
        let (by_cycles, direct) = (by_cycles.unwrap(), direct.unwrap());
        assert!(by_cycles.iterations <= 25, "{} iterations", by_cycles.iterations);
        let largest = direct.y.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        for (x, y) in by_cycles.y.iter().flatten().zip(direct.y.iter().flatten()) {
            // Residual 1e-8 times a condition number of the order of 1e4 at worst.
            assert!((x - y).abs() < 1e-4 * largest, "{x} {y}");
        }
    }
}

/// The paper's relaxation on the same equations: sweeps of 3x3 blocks, forward and backward in turn, for as long as
/// `seconds` allow; sweeps, residual reached, seconds.
fn relaxed(system: &System, seconds: f64) -> (usize, f64, f64) {
    let a = &system.matrix;
    let inverses: Vec<_> = (0..a.rows()).map(|i| inverse(a.diagonal(i))).collect();
    let mut y = vec![[0.0; 3]; a.rows()];
    let (start, mut sweeps, mut left) = (Instant::now(), 0, 1.0);
    while left > TOLERANCE && start.elapsed().as_secs_f64() < seconds {
        for _ in 0..20 {
            for k in 0..a.rows() {
                let i = if sweeps % 2 == 1 { a.rows() - 1 - k } else { k };
                let ay = a.row_times(i, &y);
                let d = times(&inverses[i], [0, 1, 2].map(|c| system.rhs[i][c] - ay[c]));
                (0..3).for_each(|c| y[i][c] += d[c]);
            }
            sweeps += 1;
        }
        let mut r = system.rhs.clone();
        let mut ay = vec![[0.0; 3]; a.rows()];
        a.multiply(&y, &mut ay);
        axpy(&mut r, -1.0, &ay);
        left = norm(&r) / norm(&system.rhs);
    }
    (sweeps, left, start.elapsed().as_secs_f64())
}

/// The table of mesh against solver in docs/implicit.md, on the same contact state: minutes and gigabytes, so by hand
/// and in `make verify`: `FINENESS=8 DIRECT=4 cargo test --release --test implicit -- --ignored --nocapture
/// table_of_solvers`. FROM and FINENESS are the coarsest and finest mesh (1, 2, 4, 8 times 44x4x5), JACOBI and DIRECT
/// the finest for block-Jacobi CG and the direct solver, and SECONDS what the plain relaxation may take a mesh.
#[test]
#[ignore = "minutes and gigabytes; prints a table"]
fn table_of_solvers() {
    let from_env = |key: &str, default: f64| std::env::var(key).map_or(default, |v| v.parse().unwrap());
    let (mut fineness, most) = (from_env("FROM", 1.0) as usize, from_env("FINENESS", 8.0) as usize);
    println!("| elements | unknowns | solver | iterations | prepare + solve, s | MB |");
    let mut counts = Vec::new();
    while fineness <= most {
        let scene = scene(fineness, from_env("KAPPA", 65.1));
        let model = Model::new(&scene).unwrap();
        let system = pressed(&model, 1.0);
        let by_cycles = solved(&mut multigrid(&model), &system);
        report("multigrid CG", &model, &by_cycles);
        counts.push((model.node_count() as f64, by_cycles.map_or(usize::MAX, |s| s.iterations)));
        if fineness <= from_env("JACOBI", 4.0) as usize {
            let preconditioner = BlockJacobi::default();
            let mut jacobi = Krylov { preconditioner, tolerance: TOLERANCE, most: 20_000 };
            report("block-Jacobi CG", &model, &solved(&mut jacobi, &system));
        }
        if fineness <= from_env("DIRECT", 4.0) as usize {
            report("sparse direct (faer)", &model, &solved(&mut Direct::default(), &system));
        }
        let (sweeps, left, took) = relaxed(&system, from_env("SECONDS", 10.0));
        let name = "plain relaxation";
        println!(
            "| {} | {} | {name} | {sweeps} (to {left:.0e}) | {took:.2} | |",
            model.element_count(),
            3 * model.node_count()
        );
        fineness *= 2;
    }
    assert!(counts.iter().all(|(_, n)| *n <= 25), "{counts:?}");
    if let [(small, few), .., (large, many)] = counts[..] {
        let slope = (many as f64 / few as f64).ln() / (large / small).ln();
        println!("iterations grow as unknowns to the power of {slope:.3}");
        assert!(slope < 0.1, "{counts:?}");
    }
}
