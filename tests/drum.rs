//! The drum as a road: geometry against its definition, the plane as its limit, and how its curvature changes a footprint.

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::road::{Drum, Plane};
use hexroll::physics::tensor::{axpy, cross, dot, scale, sub};
use hexroll::record::Sample;
use hexroll::scene::*;
use hexroll_lab::rig::given::{MESH, OUTER_RADIUS};
use hexroll_lab::rig::{GROUND, Random, close, down, explicit, largest, press, run, simulate_with, wheel};

/// A drum outside (1) or inside (-1) with its axis along y, through the origin there.
fn drum(side: f64, radius: f64, angular_velocity: f64) -> Drum {
    let curvature = side / radius;
    Drum {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        axis: [0.0, 1.0, 0.0],
        curvature,
        speed: angular_velocity / curvature,
    }
}

/// Gap, normal and velocity of a tilted drum, from its axis: distance less radius, radial direction, omega x r.
#[test]
fn a_drum_is_round_and_turns_as_a_whole() {
    let mut random = Random::new(51);
    for side in [1.0, -1.0] {
        let (radius, omega) = (0.85, 7.0);
        let (axis, normal) = ([0.6, 0.8, 0.0], [0.8, -0.6, 0.0]);
        let point = [0.1, -0.2, 0.3];
        let road =
            Road::Drum(Drum { point, normal, axis, curvature: side / radius, speed: omega * radius * side });
        let centre = axpy(normal, -side * radius, point);
        for _ in 0..500 {
            let x = axpy(random.vector(), 0.3, point);
            let from = sub(x, centre);
            let radial = axpy(axis, -dot(axis, from), from);
            let r = dot(radial, radial).sqrt();
            // Coordinates near one: a few round-offs.
            assert!((road.gap(x) - side * (r - radius)).abs() < 1e-15, "{x:?}");
            let n = scale(radial, side / r);
            assert!(largest([&sub(road.normal(x), n)]) < 1e-15);
            let surface = scale(cross(axis, radial), omega * radius / r);
            assert!(largest([&sub(road.velocity(x), surface)]) < 1e-14 * omega);
            // Its own coordinates lead back to the point below x.
            let below = axpy(n, -road.gap(x), x);
            assert!(largest([&sub(road.point(road.chart(x)), below)]) < 1e-15);
            let [along, across] = road.tangents(x);
            assert!(largest([&sub(cross(along, across), n)]) < 1e-15, "a right-handed set");
        }
    }
}

/// The gap of a point of a large drum has the digits of a plane's: nothing cancels.
#[test]
fn the_gap_keeps_its_digits_however_large_the_drum() {
    let x = [0.02, 0.01, 1e-6];
    for radius in [1.0, 1e3, 1e6, 1e9] {
        // gap = z + x^2 / 2R to first order in 1/R.
        let expected = x[2] + x[0] * x[0] / (2.0 * radius);
        let gap: f64 = Road::Drum(drum(1.0, radius, 0.0)).gap(x);
        // Of second order in gap / R.
        let tolerance = 1e-15 + expected / radius;
        close("f64", gap, expected, tolerance);
        let single: f32 = Road::Drum(drum(1.0, radius, 0.0)).gap(x.map(|c| c as f32));
        close("f32", f64::from(single), expected, 3e-7 + tolerance);
    }
}

/// A viscous wheel pressed by 1 mm within 2 ms and rolled by its rim for 6 ms, its axle held.
fn rolling_on(road: Road, elements: [usize; 3], mu: f64, spin: f64) -> Scene {
    let mut scene = wheel(elements, mu);
    scene.road = Some(road);
    scene.body.viscosity = Some(20.0);
    let mut roll = explicit("roll", 6e-3);
    roll.rim.spin = Drive::Velocity { to: spin, ramp: 1e-3 };
    roll.rim.z = Drive::Displacement { to: -1e-3, ramp: 2e-3 };
    scene.stages = vec![roll];
    scene.output.sample = 5e-4;
    scene
}

/// Mean forces of it over the last 3 ms.
fn rolled(road: Road, precision: Precision) -> [f64; 3] {
    let scene = rolling_on(road, MESH, 1.0, 26.0);
    let model = Model::new(&scene).unwrap();
    let outcome = simulate_with(&scene, model, precision, 1).expect("the scene runs");
    let columns: [fn(&Sample) -> f64; 3] = [|s| s.road_fx_N, |s| s.road_fz_N, |s| s.rim_my_Nm];
    columns.map(|column| outcome.mean("roll", 0.5, column))
}

/// A drum of 1e6 times the wheel's radius is the plane that moves at its surface's speed.
#[test]
fn a_very_large_drum_is_a_plane() {
    let (speed, radius) = (-1.0, 1e6 * OUTER_RADIUS);
    let plane = Road::Plane(Plane { velocity: [speed, 0.0, 0.0], point: [0.0; 3], normal: [0.0, 0.0, 1.0] });
    let flat = rolled(plane, Precision::F64);
    for side in [1.0, -1.0] {
        let round = rolled(Road::Drum(drum(side, radius, side * speed / radius)), Precision::F64);
        for (a, b) in flat.iter().zip(&round) {
            // The surface falls by x^2/2R, at 5 mm from the axle by 3e-7 of the indentation.
            assert!((a - b).abs() < 1e-6 * flat[1], "{flat:?} {round:?}");
        }
    }
}

/// On a drum the wheel carries less at the same indentation than on the plane, inside it more, by the relative curvature.
#[test]
fn curvature_changes_the_load_as_hertz_says() {
    let load = |road: Road| {
        let mut scene = wheel([88, 8, 2], 0.0);
        scene.road = Some(road);
        scene.stages = vec![press(down(1e-3))];
        let outcome = run(&scene);
        assert!(outcome.totals.ledger.worst_gap > -1e-12, "never inside the drum");
        outcome.last().road_fz_N
    };
    let flat = load(GROUND);
    let [outside, inside] = [1.0, -1.0].map(|side| load(Road::Drum(drum(side, 0.15, 0.0))));
    let (less, more) = (outside / flat, inside / flat);
    // Hertz: what counts is the relative curvature 1/R1 +- 1/R2, here 26 % more or less. To first order in it the two
    // change the load by opposite shares; what is left is of second order, some 0.26^2 / 4.
    assert!(less < 0.97 && more > 1.03, "{less} {more} of {flat} N");
    assert!((less + more - 2.0).abs() < 0.02, "{less} {more} of {flat} N");
}

/// A drum puts in its force times the way of its surface; part of that moves the body, the rest is dissipated, and the
/// balance of the body closes.
#[test]
fn energies_on_a_turning_drum_add_up() {
    let scene = rolling_on(Road::Drum(drum(1.0, 0.2, -20.0)), [44, 4, 2], 0.6, 0.0);
    let outcome = run(&scene);
    let rows = &outcome.samples[outcome.samples.len() / 2..];
    let (first, last) = (&rows[0], outcome.last());
    let time = last.time_s - first.time_s;
    // Forces are means of windows of equal length. Their x-component is the one along the surface but for the normal
    // force's share, x/R of it where the middle of the print is at x: within 2 mm of the axle.
    let force = rows[1..].iter().map(|s| s.road_fx_N).sum::<f64>() / (rows.len() - 1) as f64;
    let put_in = last.road_work_J - first.road_work_J;
    close("work of the road", put_in, -force * 4.0 * time, 0.01);
    let dissipated = put_in - (last.friction_work_J - first.friction_work_J);
    assert!(dissipated > 0.0 && dissipated < put_in, "{dissipated} of {put_in} J");
    assert!(outcome.totals.ledger.worst_balance < 1e-9 * outcome.totals.ledger.largest_term);
}
