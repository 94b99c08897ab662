//! Elastic waves in a bar: speed, shape and reflections.

use hexroll::model::Model;
use hexroll::run::stability;
use hexroll::scene::{Rim, Scene};
use hexroll_lab::rig::{DENSITY, Driver, G, KAPPA, block, close};

/// A thin bar along x: 150 elements of 1 mm.
const LENGTH: f64 = 0.15;
const EDGE: f64 = 1e-3;
/// Length of the pulse [m].
const PULSE: f64 = 0.04;

fn bar() -> Scene {
    block([LENGTH, EDGE, EDGE], [150, 1, 1])
}

/// Bar speed sqrt(E / rho), E = 9 kappa G / (3 kappa + G).
fn bar_speed() -> f64 {
    (9.0 * KAPPA * G / (3.0 * KAPPA + G) / DENSITY).sqrt()
}

/// cos^2 bump of `PULSE` around the bar's middle.
fn bump(x: f64) -> f64 {
    let s = (x - 0.5 * LENGTH) / PULSE;
    if s.abs() < 0.5 { (std::f64::consts::PI * s).cos().powi(2) } else { 0.0 }
}

/// Lets the bar go with the bump as axial velocity (two pulses of half its height run apart) and samples the axial
/// velocities, node planes along x, at the times asked for [s].
fn travel(scene: &Scene, times: &[f64]) -> Vec<Vec<f64>> {
    let model = Model::new(scene).unwrap();
    let mut driver = Driver::new(&model, scene).unwrap();
    // Strains of 1e-5: linear.
    let height = 1e-5 * bar_speed();
    let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|x| [height * bump(x[0]), 0.0, 0.0]).collect();
    driver.engine.set_velocity(&v, &[0.0; 6]).unwrap();
    let dt_max = 0.9 * stability::element_bound(&model).unwrap();
    let mut fields = Vec::new();
    for &time in times {
        let count = ((time - driver.time) / dt_max).ceil();
        let dt = (time - driver.time) / count;
        driver.advance(std::iter::repeat_n(dt, count as usize)).unwrap();
        let state = driver.engine.state().unwrap();
        let mut planes = vec![0.0; 151];
        for (reference, v) in model.mesh.nodes.iter().zip(&state.v) {
            planes[(reference[0] / EDGE).round() as usize] += 0.25 * v[0] / height;
        }
        fields.push(planes);
    }
    fields
}

/// Where the right-going pulse has its centre of gravity [m].
fn centre(field: &[f64]) -> f64 {
    let right = || field.iter().enumerate().skip(76);
    right().map(|(i, v)| v * i as f64 * EDGE).sum::<f64>() / right().map(|(_, v)| v).sum::<f64>()
}

/// A pulse in a free bar runs at sqrt(E / rho).
///
/// Pulse of wavelength 40 mm, k = 157 /m: lateral inertia slows it by nu^2 k^2 w^2 / 12 = 0.05 %, the mesh (lumped
/// mass) by (k h)^2 / 24 = 0.1 %: 0.3 %.
#[test]
fn a_pulse_runs_at_the_bar_speed() {
    let c = bar_speed();
    // From 30 to 50 mm off the middle: apart from the other pulse, and not yet at the end.
    let [early, late] = [0.03 / c, 0.05 / c];
    let fields = travel(&bar(), &[early, late]);
    let speed = (centre(&fields[1]) - centre(&fields[0])) / (late - early);
    close("bar speed", speed, c, 3e-3);
    // Each pulse has half the height, less what dispersion spreads.
    close("height", fields[1].iter().fold(0.0, |m, v| v.max(m)), 0.5, 0.02);
}

/// Free ends send the velocity back as it came: after L/c both halves meet in the middle and make the bump again.
#[test]
fn free_ends_reflect_velocity_unchanged() {
    let fields = travel(&bar(), &[LENGTH / bar_speed()]);
    for (i, v) in fields[0].iter().enumerate() {
        // 0.15 % late over 150 mm shifts the bump by 0.2 mm, 2 % of its height at its steepest; dispersion as much.
        let expected = bump(i as f64 * EDGE);
        assert!((v - expected).abs() < 0.04, "velocity {v} at {i} mm, expected {expected}");
    }
}

/// A held end sends it back reversed: after 2 L/c each half has met both ends once, and the bump is upside down.
#[test]
fn a_held_end_reverses_velocity() {
    let mut scene = bar();
    scene.rim = Some(Rim { nodes: "x-min".into() });
    let c = bar_speed();
    let fields = travel(&scene, &[LENGTH / c, 2.0 * LENGTH / c]);
    // Halfway one half is upright, the other is not.
    assert!(fields[0].iter().all(|v| v.abs() < 0.04), "the halves cancel in the middle");
    for (i, v) in fields[1].iter().enumerate() {
        // Twice the way of the free bar.
        let expected = -bump(i as f64 * EDGE);
        assert!((v - expected).abs() < 0.08, "velocity {v} at {i} mm, expected {expected}");
    }
}
