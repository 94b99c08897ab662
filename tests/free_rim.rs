//! A free rim is a part of the body: it starts with the body's velocity, its mass has weight and kinetic energy.
#![allow(non_snake_case)] // X: reference positions

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::tensor::Vec3;
use hexroll::record::Sample;
use hexroll::scene::Scene;
use hexroll_lab::rig::{Outcome, close, simulate_with};

const G: f64 = 9.81;
/// Mass of the rim itself [kg].
const RIM: f64 = 0.5;

/// A block, 40 x 40 x 20 mm, whose top is a rim of 500 g, 50 mm above the road: thrown down at 1 m/s.
const THROWN: &str = r#"
title = "a block and its rim fall"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]
[body]
density = "1100 kg/m3"
velocity = ["0 m/s", "0 m/s", "-1 m/s"]
offset = ["0 mm", "0 mm", "50 mm"]
[body.mesh]
generator = "block"
size = ["40 mm", "40 mm", "20 mm"]
elements = [4, 4, 2]
[body.material]
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
[rim]
nodes = "z-max"
[road]
[[stage]]
name = "fall"
method = "explicit"
duration = "4 ms"
[stage.rim]
z = { force = "0 N", mass = "500 g" }
[output]
sample = "0.5 ms"
"#;

const IN_TIME: &str = "stage.0.implicit={ scheme = \"dynamic\", step = \"0.25 ms\" }";

fn thrown(sets: &[&str]) -> Scene {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    Scene::parse(THROWN, "thrown.toml", &sets).unwrap_or_else(|e| panic!("{e}"))
}

fn run(scene: &Scene, precision: Precision) -> Outcome {
    simulate_with(scene, Model::new(scene).unwrap(), precision, 1).unwrap_or_else(|e| panic!("{e}"))
}

fn mass(outcome: &Outcome) -> f64 {
    outcome.model.mass.iter().sum()
}

/// Whether every row of a fall is that of a point of the mass of block and rim; `late`: how much older than the row its
/// velocities are, in steps; tolerances of ways and energies.
fn falls(outcome: &Outcome, late: f64, [of_way, tolerance]: [f64; 2]) {
    let total = mass(outcome) + RIM;
    let start = outcome.model.mesh.axle[2];
    let before = 0.5 * total;
    assert!(outcome.samples.len() >= 8);
    for s in &outcome.samples {
        let fallen = s.time_s + 0.5 * G * s.time_s * s.time_s;
        close("fallen", start - s.axle_z_m, fallen, of_way);
        let kinetic = 0.5 * total * (1.0 + G * (s.time_s - late * s.dt_s)).powi(2);
        close("kinetic energy", s.kinetic_J, kinetic, tolerance);
        // What gravity has done is what was gained: relative to the whole, since it begins with nothing.
        assert!((s.external_work_J - (kinetic - before)).abs() < tolerance * kinetic, "{s:?}");
        assert!(s.balance_error_J.abs() < tolerance * kinetic, "{s:?}");
        assert!(s.road_fz_N == 0.0);
    }
}

/// Central differences and average acceleration are exact for a constant acceleration. f64: round-off of some hundred
/// steps; f32: that of a coordinate of 70 mm, 4e-9 m, each window, over 0.5 mm and more. Implicit steps give the rim's nodes, a
/// sixtieth of the mass, the mean velocity of the step: g dt / 2 = 1.2e-3 m/s less, 4e-5 of the energy.
#[test]
fn block_and_rim_fall_together() {
    falls(&run(&thrown(&[]), Precision::F64), 0.5, [1e-11; 2]);
    falls(&run(&thrown(&[]), Precision::F32), 0.5, [2e-5; 2]);
    let implicit = thrown(&["stage.0.method=implicit", IN_TIME]);
    falls(&run(&implicit, Precision::F64), 0.0, [1e-9, 1e-4]);
}

/// Along every axis, whatever the masses.
#[test]
fn gravity_pulls_on_each_free_translation() {
    let gravity = [
        "gravity=[\"3 m/s2\", \"-2 m/s2\", \"-5 m/s2\"]",
        "body.velocity=[\"1 m/s\", \"2 m/s\", \"0.5 m/s\"]",
    ];
    let free = [
        "stage.0.rim.x={ force = \"0 N\", mass = \"2 kg\" }",
        "stage.0.rim.y={ force = \"0 N\", mass = \"10 g\" }",
    ];
    let implicit = ["stage.0.method=implicit", IN_TIME];
    for (sets, tolerance) in [(vec![], 1e-11), (implicit.to_vec(), 1e-9)] {
        let outcome = run(&thrown(&[&gravity[..], &free, &sets].concat()), Precision::F64);
        let (start, last) = (outcome.model.mesh.axle, outcome.last());
        let t = last.time_s;
        let at = [last.axle_x_m, last.axle_y_m, last.axle_z_m];
        for (d, (v, g)) in [(1.0, 3.0), (2.0, -2.0), (0.5, -5.0)].into_iter().enumerate() {
            close("way", at[d] - start[d], v * t + 0.5 * g * t * t, tolerance);
        }
    }
}

/// A ring that turns about its axle takes the rim along. Within 1 %: its rubber swings outwards meanwhile.
#[test]
fn a_spinning_body_spins_its_rim() {
    let ring = r#"body.mesh={ generator = "ring", outer_radius = "39 mm", inner_radius = "17 mm", width = "17.5 mm", elements = [16, 2, 2] }"#;
    let sets = [
        ring,
        "rim.nodes=inner",
        "body.angular_velocity=[\"0 rad/s\", \"70 rad/s\", \"0 rad/s\"]",
        "stage.0.rim.spin={ moment = \"0 N m\", inertia = \"1e-3 kg m2\" }",
    ];
    for implicit in [&[][..], &["stage.0.method=implicit", IN_TIME]] {
        let outcome = run(&thrown(&[&sets[..], implicit].concat()), Precision::F64);
        for s in &outcome.samples {
            close("turn", s.rim_angle_rad, 70.0 * s.time_s, 0.01);
            assert!(s.kinetic_J > 0.99 * 0.5 * 1e-3 * 70.0 * 70.0, "{s:?}");
        }
    }
}

/// At rest the road carries the weight of block and rim, and the force. Damped relaxation: to the residual that settles it,
/// 1e-4; statics: to Newton's tolerance.
#[test]
fn a_standing_rim_presses_with_its_weight() {
    let standing = [
        "body.offset=[\"0 mm\", \"0 mm\", \"0 mm\"]",
        "body.velocity=[\"0 m/s\", \"0 m/s\", \"0 m/s\"]",
        "stage.0.rim.z={ force = \"-2 N\", mass = \"500 g\" }",
        "stage.0.duration=1 s",
        "output.sample=10 ms",
    ];
    let relaxed = ["stage.0.method=quasi-static", "stage.0.mass_damping=600 1/s"];
    let solved = ["stage.0.method=implicit", "stage.0.implicit={ scheme = \"static\", increments = 1 }"];
    for (method, tolerance) in [(relaxed, 1e-3), (solved, 1e-6)] {
        let outcome = run(&thrown(&[&standing[..], &method].concat()), Precision::F64);
        let expected = (mass(&outcome) + RIM) * G + 2.0;
        close("road_fz", outcome.last().road_fz_N, expected, tolerance);
    }
}

/// What is left of the energies of a row: those that there are, less what was put in, done and lost.
fn left(s: &Sample, start: f64) -> f64 {
    let stored = s.kinetic_J + s.strain_J + s.hourglass_J - start;
    let done = s.external_work_J + s.contact_work_J + s.friction_work_J + s.damping_work_J + s.viscous_work_J;
    stored - done
}

/// A block is thrown at the road by its heavy rim, under a load. The row's energies balance, and the external work is that
/// of weights and load, found from where everything has got to: forces that are constant work along the way up to the
/// velocities' time, half a step before that of the positions (explicit).
#[test]
fn the_energies_of_a_row_are_those_of_block_and_rim() {
    let landing = [
        "body.offset=[\"0 mm\", \"0 mm\", \"1 mm\"]",
        "stage.0.rim.z={ force = \"-20 N\", mass = \"500 g\" }",
        "stage.0.duration=2.5 ms",
        "output.sample=0.1 ms",
    ];
    let implicit =
        ["stage.0.method=implicit", "stage.0.implicit={ scheme = \"dynamic\", step = \"0.05 ms\" }"];
    // Windows of three steps or four: where the step changes, a force acts for the mean of both, to 1e-8 m of 2 mm and twenty
    // newtons. Implicit: the rim's nodes have the mean velocity of the step, 0.01 m/s off at 500 m/s2; 1e-3 of the work.
    for (sets, late, tolerance) in [(&[][..], 0.5, 1e-4), (&implicit, 0.0, 1e-2)] {
        let outcome = run(&thrown(&[&landing[..], sets].concat()), Precision::F64);
        let (last, model) = (outcome.last(), &outcome.model);
        let start = 0.5 * (mass(&outcome) + RIM);
        assert!(last.contact_work_J < 0.0 && last.strain_J > 0.1 * start, "it has landed: {last:?}");
        for s in &outcome.samples {
            if late > 0.0 {
                assert!(s.balance_error_J.abs() < 1e-11 * start, "{s:?}");
                // The margin of an impact at full steps, as elsewhere: the scheme is of second order.
                assert!(s.stored_balance_error_J.abs() < 2e-2 * start, "{s:?}");
            } else {
                // All terms of a row are of one moment.
                assert!((left(s, start) - s.stored_balance_error_J).abs() < 1e-10 * start, "{s:?}");
            }
        }
        let snapshot = outcome.snapshots.last().unwrap();
        let way = |x: Vec3<f64>, X: Vec3<f64>, v: Vec3<f64>| x[2] - X[2] - late * last.dt_s * v[2];
        let of_nodes: f64 = (0..model.node_count())
            .map(|n| -G * model.mass[n] * way(snapshot.x[n], model.mesh.nodes[n], snapshot.v[n]))
            .sum();
        let rim = model.mesh.rim[0] as usize;
        let of_rim = -(G * RIM + 20.0) * way(snapshot.x[rim], model.mesh.nodes[rim], snapshot.v[rim]);
        close("external work", last.external_work_J, of_nodes + of_rim, tolerance);
    }
}

/// A ramp begins with the speed that a free rim has come to: after 0.1 ms of a ramp of 2 ms it has that still, within 1 %.
#[test]
fn a_ramp_takes_over_the_speed_of_a_free_rim() {
    let text = THROWN.replace(
        "[output]",
        "[[stage]]\nname = \"brake\"\nmethod = \"explicit\"\nduration = \"4 ms\"\n[stage.rim]\n\
         z = { velocity = \"0 m/s\", ramp = \"2 ms\" }\n[output]",
    );
    let scene = Scene::parse(&text, "braked.toml", &["output.sample=0.1 ms".into()]).unwrap();
    let outcome = run(&scene, Precision::F64);
    let (fall, brake) = (outcome.stage("fall"), outcome.stage("brake"));
    let (end, next) = (fall.last().unwrap(), brake[0]);
    let speed = (next.axle_z_m - end.axle_z_m) / (next.time_s - end.time_s);
    close("speed", speed, -1.0 - G * end.time_s, 0.01);
}

fn refused(sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    Scene::parse(THROWN, "thrown.toml", &sets).unwrap_err().to_string()
}

#[test]
fn states_that_could_not_hold_are_refused() {
    let fixed = "stage.0.rim.z={ velocity = \"-1 m/s\", mass = \"500 g\" }";
    let fast = "stage.0.rim.spin={ angle = \"0 deg\", ramp = \"1 ms\", inertia = \"1e-5 kg m2\" }";
    let held = "stage.0.rim={ x = { velocity = \"0 m/s\" } }";
    let solved = ["stage.0.method=implicit", "stage.0.implicit={ scheme = \"static\" }"];
    for (sets, key, said) in [
        (&[fixed][..], "stage.0.rim.z.mass", "a motion that is prescribed needs no mass"),
        (&[fixed], "stage.0.rim.z.mass", "remove the key, or write force = .."),
        (&[fast], "stage.0.rim.spin.inertia", "needs no inertia"),
        (&solved, "body.velocity", "nothing moves in the first stage"),
        (&["stage.0.initial_velocity=zero"], "body.velocity", "sets every velocity to zero"),
        (&[held, "stage.0.initial_velocity=rim"], "body.velocity", "to that of the rim"),
    ] {
        let error = refused(sets);
        assert!(error.contains(key) && error.contains(said), "{error}");
    }
    // A free component has nothing but the body's velocity to start with.
    thrown(&["stage.0.initial_velocity=rim"]);
}
