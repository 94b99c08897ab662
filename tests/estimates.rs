//! What a run says of its own errors (`summary.json`, `errors`), against runs with other steps and in other precisions.

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::record::Sample;
use hexroll::run::Totals;
use hexroll::scene::{Scene, Snapshots};
use hexroll_lab::rig::given::{DEPTH, SPIN, STRAIGHT};
use hexroll_lab::rig::{down, press, rolling, simulate_with, wheel};

/// A coarse wheel pressed by 2.2 mm, and rolled for `duration` if that is not zero.
fn scene(eta: f64, duration: f64) -> Scene {
    let mut scene = wheel([24, 3, 3], 1.0);
    scene.body.viscosity = (eta > 0.0).then_some(eta);
    scene.output.sample = 1e-3;
    scene.output.snapshots = Snapshots::None;
    scene.stages = vec![press(down(DEPTH))];
    if duration > 0.0 {
        scene.stages.push(rolling(STRAIGHT, SPIN, duration));
    }
    scene
}

/// Forces along x and z, the mean of the last ten windows (one of a pressed wheel), and the totals.
fn forces(scene: &Scene, safety: f64, precision: Precision) -> ([f64; 2], Totals) {
    let scene = Scene { safety, ..scene.clone() };
    let model = Model::new(&scene).unwrap();
    let outcome = simulate_with(&scene, model, precision, 1).unwrap();
    let count = if scene.stages.len() > 1 { 10 } else { 1 };
    let last = &outcome.samples[outcome.samples.len() - count..];
    let mean = |f: fn(&Sample) -> f64| last.iter().map(f).sum::<f64>() / count as f64;
    ([mean(|s| s.road_fx_N), mean(|s| s.road_fz_N)], outcome.totals)
}

/// Largest difference of two pairs of forces over the load.
fn difference(a: [f64; 2], b: [f64; 2]) -> f64 {
    (0..2).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max) / b[1]
}

/// Rolling, viscous and elastic: the error against a third of the step is within the class of the time step, the error of
/// single precision within that of rounding. A class says something: it is not a thousand times too large for the step, and not
/// ten thousand times for rounding, which is an estimate of a single node's, where forces are means over nodes and steps.
#[test]
fn rolling_runs_know_the_class_of_their_errors() {
    for (eta, duration) in [(20.0, 0.02), (20.0, 0.1), (0.0, 0.02)] {
        let scene = scene(eta, duration);
        let (double, totals) = forces(&scene, 0.9, Precision::F64);
        let (short, of_short) = forces(&scene, 0.3, Precision::F64);
        let (single, of_single) = forces(&scene, 0.9, Precision::F32);
        let case = format!("eta {eta}, {duration} s");
        let class = totals.estimate.time_step.unwrap();
        let error = difference(double, short);
        assert!(error <= class && class < 1e3 * error, "{case}: step {error:e}, said {class:e}");
        assert!(of_short.estimate.time_step.unwrap() < class, "{case}: a shorter step is said to be better");
        let class = of_single.estimate.rounding.unwrap();
        let error = difference(single, double);
        assert!(error <= class && class < 1e4 * error, "{case}: rounding {error:e}, said {class:e}");
        assert!(totals.estimate.rounding.unwrap() < 1e-11, "{case}: {:?}", totals.estimate);
        assert_eq!(totals.estimate.residual, None);
    }
}

/// A pressed wheel has a residual instead of a time-step error, within what was asked for in double precision; its force
/// does not depend on the step by more.
#[test]
fn a_pressed_wheel_knows_its_residual() {
    let scene = scene(0.0, 0.0);
    let (double, totals) = forces(&scene, 0.9, Precision::F64);
    let (short, _) = forces(&scene, 0.3, Precision::F64);
    let residual = totals.estimate.residual.unwrap();
    assert!(totals.estimate.time_step.is_none() && residual <= 1e-4, "{:?}", totals.estimate);
    assert!(difference(double, short) <= residual, "{double:?}, {short:?}, {residual:e}");
    let (single, totals) = forces(&scene, 0.9, Precision::F32);
    let said = totals.estimate.residual.unwrap() + totals.estimate.rounding.unwrap();
    assert!(difference(single, double) <= said, "{single:?}, {double:?}, {:?}", totals.estimate);
}
