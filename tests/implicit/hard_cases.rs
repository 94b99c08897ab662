//! Cases that are hard for an implicit scheme: they converge, or say clearly why not.

use super::fixtures::*;
use hexroll::implicit::increments::Increments;
use hexroll::implicit::{Failure, Inner, Limits, Scheme, Simulation};
use hexroll::model::Model;
use hexroll::physics::material::NeoHookean;
use hexroll::scene::{Element, Law, MeshSpec};

const LIMITS: Limits = Limits { tolerance: 1e-8, iterations: 25 };

/// What following a path cost.
#[derive(Debug, Default)]
struct Cost {
    increments: usize,
    cuts: usize,
    iterations: usize,
}

fn solver(model: &Model, mu: f64) -> Simulation<'_> {
    let inner = Inner::ActiveSet(Box::new(hexroll::implicit::direct::Direct::default()));
    simulation_with(model, Scheme::Static, Some(road(mu)), inner, LIMITS)
}

/// Takes the rim along a path from 0 to 1, cutting increments where they fail.
fn follow(s: &mut Simulation<'_>, path: impl Fn(f64) -> [f64; 6], steps: usize) -> Result<Cost, Failure> {
    let mut lengths = Increments::new(1.0 / steps as f64, 1.0 / steps as f64);
    let (mut at, mut cost) = (0.0, Cost::default());
    while at < 1.0 - 1e-12 {
        let length = lengths.next(1.0 - at);
        match s.step(&held(s.problem.model, at + length, length, path(at + length))) {
            Ok(log) => {
                at += length;
                cost.increments += 1;
                cost.iterations += log.len() - 1;
                lengths.converged(length, log.len() - 1);
            }
            Err(failure) => {
                cost.cuts += 1;
                println!("at {at:.3}: {failure}");
                if !lengths.failed(length) {
                    return Err(failure);
                }
            }
        }
    }
    Ok(cost)
}

fn down(by: f64) -> impl Fn(f64) -> [f64; 6] {
    move |t| [0.0, 0.0, -by * t, 0.0, 0.0, 0.0]
}

#[test]
fn nearly_incompressible_rubber() {
    let mesh =
        MeshSpec::Ring { outer_radius: 0.039, inner_radius: 0.017, width: 0.0175, elements: [44, 4, 5] };
    let law = Law::NeoHookean(NeoHookean { g0: 2640e6, g1: 2.64e6 });
    let model = model(&body(mesh, law, Element::Q1p0), Some("inner"));
    let mut s = solver(&model, 1.0);
    let cost = follow(&mut s, down(2.2e-3), 10).unwrap_or_else(|e| panic!("{e}"));
    println!("kappa/G = 1000: {:.2} N, {cost:?}", road_force(&s).0[2]);
    // Stiffer than kappa/G = 25, but not locked (`full` at kappa/G = 25 has 379 N).
    assert!((300.8..379.0).contains(&road_force(&s).0[2]));
}

#[test]
fn more_friction_than_load() {
    let model = wheel([44, 4, 5], Element::Q1p0);
    let mut s = solver(&model, 2.0);
    let cost = follow(&mut s, down(2.2e-3), 10).unwrap_or_else(|e| panic!("{e}"));
    println!("mu = 2: {:.2} N, {cost:?}", road_force(&s).0[2]);
    // At mu = 1 nearly everything sticks already.
    assert!((road_force(&s).0[2] / 300.3 - 1.0).abs() < 0.01);
}

#[test]
fn a_press_by_a_third_of_the_rubber() {
    let model = wheel([44, 4, 5], Element::Q1p0);
    let mut s = solver(&model, 1.0);
    let cost = follow(&mut s, down(8e-3), 30).unwrap_or_else(|e| panic!("{e}"));
    let stored = s.problem.assembler.stored(&s.x);
    println!("8 mm: {:.1} N, least det F {:.3}, {cost:?}", road_force(&s).0[2], stored.min_jacobian);
    assert!(stored.min_jacobian > 0.0 && road_force(&s).0[2] > 1500.0);
}

#[test]
fn a_load_that_is_reversed_leaves_nothing_behind() {
    let model = wheel([44, 4, 5], Element::Q1p0);
    let mut s = solver(&model, 0.3);
    let (mut cost, mut forces) = (Cost::default(), Vec::new());
    for (from, to) in [(0.0, -2.2e-3), (-2.2e-3, -1.1e-3), (-1.1e-3, -2.2e-3), (-2.2e-3, 0.5e-3)] {
        let path = |t: f64| [0.0, 0.0, from + (to - from) * t, 0.0, 0.0, 0.0];
        let leg = follow(&mut s, path, 10).unwrap_or_else(|e| panic!("{e}"));
        cost.increments += leg.increments;
        cost.cuts += leg.cuts;
        cost.iterations += leg.iterations;
        forces.push(road_force(&s).0[2]);
    }
    println!("{forces:?} N, {cost:?}");
    assert_eq!(forces[3], 0.0);
    // Friction is a memory only while there is contact.
    for (x, start) in s.x.iter().zip(&model.mesh.nodes) {
        assert!(
            (0..2).all(|i| (x[i] - start[i]).abs() < 1e-9) && (x[2] - start[2] - 0.5e-3).abs() < 1e-9,
            "{x:?} {start:?}"
        );
    }
}

#[test]
fn static_rolling_in_steps_of_a_degree() {
    let model = wheel([44, 4, 5], Element::Q1p0);
    let mut s = solver(&model, 1.0);
    follow(&mut s, down(2.2e-3), 10).unwrap_or_else(|e| panic!("{e}"));
    let degree = 1f64.to_radians();
    let path = |t: f64| [0.0389 * 20.0 * degree * t, 0.0, -2.2e-3, 0.0, 0.0, 20.0 * degree * t];
    let cost = follow(&mut s, path, 20).unwrap_or_else(|e| panic!("{e}"));
    let (f, touching) = road_force(&s);
    println!("20 degrees: {f:?} N on {touching} nodes, {cost:?}");
    // Elastic and without slip: the vertical force stays near that of the press.
    assert!((f[2] / 300.8 - 1.0).abs() < 0.08, "{f:?}");
    assert!(cost.iterations <= 10 * cost.increments, "{cost:?}");
}
