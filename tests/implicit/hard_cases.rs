//! Cases that are hard for an implicit scheme: they converge, or say clearly why not.

use hexroll::implicit::increments::Increments;
use hexroll::implicit::{Failure, Inner, Limits, Scheme, Simulation};
use hexroll::model::Model;
use hexroll::physics::material::NeoHookean;
use hexroll::scene::{Element, Law};
use hexroll_lab::rig::given::{DEPTH, MESH};
use hexroll_lab::rig::implicit::*;
use hexroll_lab::rig::{self, reference};

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
    let law = Law::NeoHookean(NeoHookean { g0: 1000.0 * rig::G, g1: rig::G });
    let model = model(&body(rig::ring(MESH), law, Element::Q1p0), Some("inner"));
    let mut s = solver(&model, 1.0);
    let cost = follow(&mut s, down(DEPTH), 10).unwrap_or_else(|e| panic!("{e}"));
    // An element may invert on the way of a whole increment.
    assert!(cost.cuts <= 2, "{cost:?}");
    // Stiffer than kappa/G = 25, but not locked as `full` is there.
    let [usual, locked] = ["pressed-q1p0", "pressed-full"].map(|run| reference(&format!("{run}.road_fz")));
    let force = road_force(&s).0[2];
    assert!(!usual.holds(force) && force > usual.value && force < 0.99 * locked.value, "{force} N");
}

#[test]
fn more_friction_than_load() {
    let model = wheel(MESH, Element::Q1p0);
    let mut s = solver(&model, 2.0);
    let cost = follow(&mut s, down(DEPTH), 10).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(cost.cuts, 0, "{cost:?}");
    // At mu = 1 nearly everything sticks already.
    reference("pressed-q1p0.road_fz").assert(road_force(&s).0[2]);
}

#[test]
fn a_press_by_a_third_of_the_rubber() {
    let model = wheel(MESH, Element::Q1p0);
    let mut s = solver(&model, 1.0);
    let cost = follow(&mut s, down(8e-3), 30).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(cost.cuts, 0, "{cost:?}");
    let stored = s.problem.assembler.stored(&s.x);
    assert!(stored.min_jacobian > 0.0 && road_force(&s).0[2] > 1500.0);
}

#[test]
fn a_load_that_is_reversed_leaves_nothing_behind() {
    let model = wheel(MESH, Element::Q1p0);
    let mut s = solver(&model, 0.3);
    let mut forces = Vec::new();
    for (from, to) in [(0.0, -DEPTH), (-DEPTH, -0.5 * DEPTH), (-0.5 * DEPTH, -DEPTH), (-DEPTH, 0.5e-3)] {
        let path = |t: f64| [0.0, 0.0, from + (to - from) * t, 0.0, 0.0, 0.0];
        let leg = follow(&mut s, path, 10).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(leg.cuts, 0, "{leg:?}");
        forces.push(road_force(&s).0[2]);
    }
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
    let model = wheel(MESH, Element::Q1p0);
    let mut s = solver(&model, 1.0);
    follow(&mut s, down(DEPTH), 10).unwrap_or_else(|e| panic!("{e}"));
    let degree = 1f64.to_radians();
    let radius = reference("free.free_rolling_radius").value;
    let path = |t: f64| [radius * 20.0 * degree * t, 0.0, -DEPTH, 0.0, 0.0, 20.0 * degree * t];
    let cost = follow(&mut s, path, 20).unwrap_or_else(|e| panic!("{e}"));
    let (f, _) = road_force(&s);
    // Elastic and without slip: the vertical force stays near that of the press.
    let pressed = reference("pressed-q1p0.road_fz").value;
    assert!((f[2] / pressed - 1.0).abs() < 0.08, "{f:?}");
    assert!(cost.iterations <= 10 * cost.increments, "{cost:?}");
}
