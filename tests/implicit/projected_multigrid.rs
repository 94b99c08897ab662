//! Multigrid inside the projected relaxation: the active set's solution, in iterations that hardly depend on the mesh.

use super::fixtures::*;
use hexroll::implicit::krylov::Krylov;
use hexroll::implicit::multigrid::Multigrid;
use hexroll::implicit::relax::{Corrections, Relaxation};
use hexroll::implicit::{Inner, Limits, Scheme, Simulation};
use hexroll::model::Model;
use hexroll::scene::Element;

const LIMITS: Limits = Limits { tolerance: 1e-9, iterations: 30 };

fn corrected(model: &Model) -> Inner {
    let cycles = Krylov { preconditioner: Multigrid::new(&model.mesh).unwrap(), tolerance: 1e-2, most: 100 };
    let relaxation = Relaxation { omega: 1.0, tolerance: 1e-11, sweeps: 2_000 };
    Inner::Corrected(relaxation, Corrections::new(Box::new(cycles)))
}

/// Presses by 2.2 mm in four increments; multigrid cycles of every Newton iteration.
fn press(s: &mut Simulation<'_>, model: &Model) -> Vec<usize> {
    let mut cycles = Vec::new();
    for n in 1..=4 {
        let down = -2.2e-3 * f64::from(n) / 4.0;
        let target = held(model, f64::from(n), 1.0, [0.0, 0.0, down, 0.0, 0.0, 0.0]);
        let log = s.step(&target).unwrap_or_else(|e| panic!("{e}"));
        println!("{:.2} mm, {:.3} N: {log:.1?}", 1e3 * down, road_force(s).0[2]);
        cycles.extend(log.iter().filter(|i| i.inner > 0).map(|i| i.inner));
    }
    cycles
}

#[test]
fn it_finds_the_active_sets_solution() {
    let elements = [44, 4, 5];
    let model = wheel(elements, Element::Q1p0);
    for mu in [0.0, 0.1] {
        let mut reference = simulation(&model, Scheme::Static, Some(road(mu)));
        let mut relaxed = simulation_with(&model, Scheme::Static, Some(road(mu)), corrected(&model), LIMITS);
        press(&mut reference, &model);
        let cycles = press(&mut relaxed, &model);
        println!("mu = {mu}: {cycles:?}");
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

/// Cycles of a first increment on three meshes, `make verify`; the table in docs/implicit.md:
/// `cargo test --release --test implicit -- --ignored --nocapture cycles_hardly_depend_on_the_mesh`.
#[test]
#[ignore = "minutes; prints a table"]
fn cycles_hardly_depend_on_the_mesh() {
    let most = std::env::var("FINENESS").map_or(4, |v| v.parse().unwrap());
    println!("| elements | mu | touching | Newton | cycles by Newton iteration | s |");
    for mu in [0.0, 0.3] {
        let (mut fineness, mut worst) = (1, Vec::new());
        while fineness <= most {
            let elements = [44, 4, 5].map(|n| n * fineness);
            let model = wheel(elements, Element::Q1p0);
            let mut s = simulation_with(&model, Scheme::Static, Some(road(mu)), corrected(&model), LIMITS);
            let start = std::time::Instant::now();
            let target = held(&model, 1.0, 1.0, [0.0, 0.0, -5e-4, 0.0, 0.0, 0.0]);
            let log = s.step(&target).unwrap_or_else(|e| panic!("{e}"));
            let cycles: Vec<usize> = log.iter().filter(|i| i.inner > 0).map(|i| i.inner).collect();
            let seconds = start.elapsed().as_secs_f64();
            let touching = road_force(&s).1;
            let elements = model.element_count();
            println!("| {elements} | {mu} | {touching} | {} | {cycles:?} | {seconds:.1} |", log.len() - 1);
            worst.push(*cycles.iter().max().unwrap());
            fineness *= 2;
        }
        // Sweeps alone take four times as many each time the mesh is halved.
        assert!(worst.last() <= worst.first().map(|w| 2 * w).as_ref(), "mu = {mu}: {worst:?}");
    }
}
