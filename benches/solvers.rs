//! Linear solvers of the implicit scheme on the pressed wheel, and multigrid inside the projected relaxation: the tables of
//! docs/implicit.md. `cargo bench --bench solvers [-- FINEST]`; FINEST times the paper's mesh, 4 by default, 8 takes
//! gigabytes. What of it must hold is tested (`tests/implicit/multigrid.rs`, `projected_multigrid.rs`).

use hexroll::implicit::direct::Direct;
use hexroll::implicit::krylov::{BlockJacobi, Krylov, LinearSolver};
use hexroll::implicit::matrix::{axpy, inverse, norm, times};
use hexroll::implicit::multigrid::Multigrid;
use hexroll::implicit::system::System;
use hexroll::scene::Element;
use hexroll_lab::rig::given;
use hexroll_lab::rig::implicit::{first_increment, pressed_system, wheel};
use std::time::Instant;

/// Residual of the linear equations over their right-hand side.
const TOLERANCE: f64 = 1e-8;
/// What the plain relaxation may take a mesh [s]: it does not get there.
const SECONDS: f64 = 10.0;
/// Finest mesh for solvers that take too long or too much memory on finer ones.
const JACOBI: usize = 4;
const DIRECT: usize = 4;

fn main() {
    // Cargo says `--bench` to benches.
    let finest = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(4);
    let meshes = || [1, 2, 4, 8].into_iter().filter(move |f| *f <= finest);
    println!(
        "| elements | unknowns | solver | iterations | prepare + solve, s | MB |\n|---|---|---|---|---|---|"
    );
    meshes().for_each(solvers);
    println!("\n| elements | mu | touching | cycles by Newton iteration | s |\n|---|---|---|---|---|");
    for mu in [0.0, 0.3] {
        for fineness in meshes().filter(|f| *f <= 4) {
            let start = Instant::now();
            let (cycles, touching) = first_increment(fineness, mu);
            let elements: usize = given::refined(fineness).iter().product();
            println!(
                "| {elements} | {mu} | {touching} | {cycles:?} | {:.1} |",
                start.elapsed().as_secs_f64()
            );
        }
    }
}

fn solvers(fineness: usize) {
    let elements = given::refined(fineness);
    let model = wheel(elements, Element::Q1p0);
    let system = pressed_system(&model, 1.0);
    let name = format!("| {} | {}", model.element_count(), 3 * model.node_count());
    let preconditioner = Multigrid::new(&model.mesh).expect("a ring has coarser meshes");
    let mut multigrid = Krylov { preconditioner, tolerance: TOLERANCE, most: 200 };
    row(&format!("{name} | multigrid CG"), &mut multigrid, &system);
    if fineness <= JACOBI {
        let preconditioner = BlockJacobi::default();
        let mut jacobi = Krylov { preconditioner, tolerance: TOLERANCE, most: 20_000 };
        row(&format!("{name} | block-Jacobi CG"), &mut jacobi, &system);
    }
    if fineness <= DIRECT {
        row(&format!("{name} | sparse direct (faer)"), &mut Direct::default(), &system);
    }
    let (sweeps, left, took) = relaxed(&system);
    println!("{name} | plain relaxation | {sweeps} (to {left:.0e}) | {took:.2} | |");
}

/// Memory that the process holds [MB]; 0 where the system does not say.
fn resident() -> f64 {
    let pages = |text: String| text.split(' ').nth(1).and_then(|p| p.parse::<f64>().ok());
    std::fs::read_to_string("/proc/self/statm").ok().and_then(pages).unwrap_or(0.0) * 4096.0 / 1e6
}

/// Iterations, times and the memory that came with the solver, the matrix left out.
fn row(name: &str, solver: &mut dyn LinearSolver, system: &System) {
    let before = resident();
    let start = Instant::now();
    let prepared = solver.prepare(system).map(|()| start.elapsed().as_secs_f64());
    match prepared.and_then(|prepared| Some((prepared, solver.solve(system, &system.rhs)?))) {
        Some((prepared, (_, iterations))) => {
            let solve = start.elapsed().as_secs_f64() - prepared;
            let megabytes = resident() - before;
            println!("{name} | {iterations} | {prepared:.2} + {solve:.2} | {megabytes:.0} |");
        }
        None => println!("{name} | no convergence | | |"),
    }
}

/// The paper's relaxation on the same equations: sweeps of 3x3 blocks, forward and backward in turn; sweeps, residual
/// reached, seconds.
fn relaxed(system: &System) -> (usize, f64, f64) {
    let a = &system.matrix;
    let inverses: Vec<_> = (0..a.rows()).map(|i| inverse(a.diagonal(i))).collect();
    let mut y = vec![[0.0; 3]; a.rows()];
    let (start, mut sweeps, mut left) = (Instant::now(), 0, 1.0);
    while left > TOLERANCE && start.elapsed().as_secs_f64() < SECONDS {
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
