//! The same bits on any number of threads, and twice.

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::scene::*;
use hexroll_lab::rig::{HELD, Outcome, explicit, press, simulate_with, wheel};

/// A coarse wheel (3 chunks of elements, 7 of nodes, so that threads share them unevenly, and half of the nodes are the
/// rim's, so that they belong to more than one thread), pressed briefly, then rolled by a driven or a free rim.
fn rolling(free: bool) -> Scene {
    let mut scene = wheel([44, 1, 4], 0.8);
    scene.body.viscosity = Some(20.0);
    scene.gravity = [0.0, 0.0, -9.81];
    let down = Stage {
        method: Method::Explicit,
        duration: 0.004,
        ..press(Drive::Displacement { to: -2e-3, ramp: 0.003 })
    };
    let spin = Drive::Velocity { to: 70.0, ramp: 0.0 };
    let (z, spin) = if free {
        (
            Drive::Free { mass: 0.05, load: -250.0, ramp: 1e-3 },
            Drive::Free { mass: 1e-5, load: 0.5, ramp: 0.0 },
        )
    } else {
        (Drive::Hold, spin)
    };
    let rim = RimMotion { x: Drive::Velocity { to: 2.6, ramp: 0.0 }, z, spin, ..HELD };
    scene.stages =
        vec![down, Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", 0.006) }];
    scene
}

/// Everything a run reports, in a form whose equality is equality of bits (zeros apart).
fn assert_same(a: &Outcome, b: &Outcome, what: &str) {
    assert!(a.samples.len() > 5 && a.last().contact_nodes > 4.0, "{what}: something happens");
    for (a, b) in a.samples.iter().zip(&b.samples) {
        assert_eq!(a, b, "{what}");
    }
    assert_eq!(a.samples.len(), b.samples.len());
    assert_eq!(a.snapshots, b.snapshots, "{what}");
    assert_eq!(a.totals.steps, b.totals.steps, "{what}");
}

/// One, two and three threads, and a second run on one, give the same bits in every sample and in the state.
fn assert_deterministic(precision: Precision, free: bool) {
    let scene = rolling(free);
    let model = Model::new(&scene).unwrap();
    let run = |threads| simulate_with(&scene, model.clone(), precision, threads).expect("the scene runs");
    let one = run(1);
    assert_same(&one, &run(1), "a second run");
    assert_same(&one, &run(2), "two threads");
    assert_same(&one, &run(3), "three threads");
}

#[test]
fn threads_do_not_change_a_bit_in_f64() {
    assert_deterministic(Precision::F64, false);
}

#[test]
fn threads_do_not_change_a_bit_in_f32() {
    assert_deterministic(Precision::F32, false);
}

#[test]
fn threads_do_not_change_a_bit_with_a_free_rim_in_f64() {
    assert_deterministic(Precision::F64, true);
}

#[test]
fn threads_do_not_change_a_bit_with_a_free_rim_in_f32() {
    assert_deterministic(Precision::F32, true);
}
