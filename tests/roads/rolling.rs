//! Bodies on roads with a shape.

use std::f64::consts::TAU;
use std::sync::Arc;

use hexroll::Error;
use hexroll::model::Model;
use hexroll::physics::road::{Base, Border, HeightField, Profile, Road, Samples, Shape, Wave};
use hexroll::scene::*;
use hexroll_lab::rig::{Outcome, at_once, close, explicit, press, run, shipped, simulate, wheel};

use crate::near;

const LEVEL: Base = Base { point: [0.0; 3], normal: [0.0, 0.0, 1.0], along: [1.0, 0.0, 0.0] };
const SPEED: f64 = 2.7;

/// A small viscous wheel that is pressed by 1 mm below the road's level as it rolls, from x = 0.
fn rolling_over(road: impl Into<Road>, duration: f64) -> Scene {
    let mut scene = wheel([44, 4, 2], 0.6);
    scene.road = Some(road.into());
    scene.body.viscosity = Some(20.0);
    scene.body.on_road = true;
    let mut roll = explicit("roll", duration);
    roll.initial_velocity = Some(InitialVelocity::Rim);
    roll.rim.x = at_once(SPEED);
    roll.rim.spin = at_once(SPEED / 0.0387);
    roll.rim.z = Drive::Displacement { to: -1e-3, ramp: 5e-3 };
    scene.stages = vec![roll];
    scene.output.sample = 5e-4;
    scene
}

fn balanced(outcome: &Outcome) {
    let ledger = &outcome.totals.ledger;
    assert!(ledger.worst_balance < 1e-9 * ledger.largest_term, "{ledger:?}");
    assert!(ledger.worst_gap > -1e-12, "inside the road by {}", -ledger.worst_gap);
}

/// Rolling over a cosine is heard: the load's spectrum has its line at speed over wavelength, whatever road gives the cosine.
#[test]
fn a_wheel_on_a_cosine_hums_at_speed_over_wavelength() {
    let wavelength = SPEED * 0.06 / 8.0;
    let cosine = Wave { base: LEVEL, amplitude: 1e-4, wavelength };
    let (columns, spacing) = (80, wavelength / 20.0);
    let height = |i: usize| 1e-4 * (TAU * i as f64 / 20.0).cos();
    let heights = (0..4 * columns).map(|k| height(k % columns)).collect();
    let samples = Samples::new([columns, 4], [spacing, 0.01], heights, Border::Periodic);
    let sampled = HeightField { base: LEVEL, samples: Arc::new(samples) };
    let amplitudes = [Road::from(cosine), sampled.into()].map(|road| {
        let outcome = run(&rolling_over(road, 0.08));
        balanced(&outcome);
        let load: Vec<f64> =
            outcome.samples[outcome.samples.len() - 120..].iter().map(|s| s.road_fz_N).collect();
        // Lines of 60 ms: the eighth is that of the road.
        let line = |k: usize| {
            let parts = load.iter().enumerate().map(|(n, f)| (f, TAU * (k * n) as f64 / 120.0));
            let (re, im) = parts.fold((0.0, 0.0), |s, (f, a)| (s.0 + f * a.cos(), s.1 + f * a.sin()));
            re.hypot(im) / 60.0
        };
        let lines: Vec<f64> = (1..30).map(line).collect();
        let loudest = (1..30).max_by(|a, b| lines[a - 1].total_cmp(&lines[b - 1])).unwrap();
        assert_eq!(loudest, 8, "{lines:?}");
        lines[7]
    });
    // Twenty samples a wave: the cubic is within (2 pi / 20)^3 / 70 of the cosine.
    close("amplitude", amplitudes[1], amplitudes[0], 0.01);
}

/// Over a cleat and a step: no node is ever inside, and energies add up.
#[test]
fn a_wheel_rolls_over_a_cleat_and_up_a_step() {
    let cleat = [[0.018, 0.0], [0.018, 1.5e-3], [0.026, 1.5e-3], [0.026, 0.0]];
    let step = [[0.02, 0.0], [0.02, 1e-3]];
    let loads = [&cleat[..], &step[..]].map(|vertices| {
        let shape = Shape::new(vertices, 3e-4, None).unwrap();
        let outcome = run(&rolling_over(Profile { base: LEVEL, shape: Arc::new(shape) }, 0.03));
        balanced(&outcome);
        let load = |from: f64, to: f64| {
            let rows = outcome.samples.iter().filter(|s| (from..to).contains(&s.axle_x_m));
            let (sum, count) = rows.fold((0.0, 0.0), |(s, n), row| (s + row.road_fz_N, n + 1.0));
            sum / count
        };
        [load(0.017, 0.027), load(0.055, 0.075)]
    });
    // On the cleat the load is far above that behind it; on the step it stays.
    assert!(loads[0][0] > 1.3 * loads[0][1], "{loads:?}");
    assert!(loads[1][1] > 1.5 * loads[0][1], "{loads:?}");
}

/// The same shape as a profile's points and as heights on a grid gives the same forces.
#[test]
fn implicit_and_explicit_equilibria_on_a_cosine_agree() {
    let road = Wave { base: LEVEL, amplitude: 3e-4, wavelength: 0.03 };
    let mut scene = wheel([44, 4, 2], 0.0);
    scene.road = Some(Wave { base: Base { point: [4e-3, 0.0, -3e-4], ..LEVEL }, ..road }.into());
    scene.body.on_road = true;
    let down = Drive::Displacement { to: -1e-3, ramp: 0.02 };
    scene.stages = vec![press(down)];
    let explicit = run(&scene);
    let settings =
        shipped("lat100_straight_implicit", &[""; 0]).stages.into_iter().find_map(|s| match s.method {
            Method::Implicit(settings) => Some(settings),
            _ => None,
        });
    scene.stages[0].method = Method::Implicit(settings.unwrap());
    scene.stages[0].mass_damping = 0.0;
    let implicit = run(&scene);
    let (a, b) = (explicit.last(), implicit.last());
    // The explicit stage is relaxed to 1e-4 of the internal force.
    close("load", a.road_fz_N, b.road_fz_N, 1e-3);
    // Off the crest the road pushes aside.
    assert!(b.road_fx_N.abs() > 0.01 * b.road_fz_N, "{b:?}");
    near("side", a.road_fx_N, b.road_fx_N, 1e-3 * b.road_fz_N);
    assert!(implicit.totals.ledger.worst_gap > -1e-9);
}

/// A map that ends ends the run, with the place; one that is not below the body is refused.
#[test]
fn where_a_map_ends_the_run_ends() {
    let map = |point: f64| {
        let samples = Samples::new([70, 50], [1e-3; 2], vec![0.0; 3500], Border::Nothing);
        HeightField { base: Base { point: [point, -0.025, 0.0], ..LEVEL }, samples: Arc::new(samples) }
    };
    match simulate(&rolling_over(map(-0.03), 0.03)) {
        Err(Error::OffRoad { at, .. }) => assert!(at[0] > 0.039, "{at:?}"),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("the map has no end"),
    }
    let mut scene = rolling_over(map(0.001), 0.03);
    scene.body.on_road = false;
    let refused = Model::new(&scene).expect_err("no road below the foremost node").to_string();
    assert!(refused.contains("there is no road below the body"), "{refused}");
}
