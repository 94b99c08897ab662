//! The disk as a road: geometry against its definition, what sticks to it, what it puts in, and the plane as its limit.

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::contact::{Node, project};
use hexroll::physics::friction::{Coulomb, StaticKinetic};
use hexroll::physics::node::StepSize;
use hexroll::physics::road::{Disk, Plane, Road};
use hexroll::physics::tensor::{axpy, cross, dot, scale, sub};
use hexroll::record::Sample;
use hexroll::scene::*;
use hexroll_lab::rig::given::OUTER_RADIUS;
use hexroll_lab::rig::{Outcome, Random, block, close, explicit, largest, run, simulate_with, wheel};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

/// Velocity of a tilted disk: omega x r; a point that it carries stays at its distance from the axis, and comes where a rotation
/// takes it; the mean velocity of a step is the way over it.
#[test]
fn a_disk_turns_as_a_whole() {
    let mut random = Random::new(71);
    let (normal, spin) = ([0.6, 0.0, 0.8], -7.0);
    let centre = [0.3, -0.2, 0.1];
    let disk = Disk::about(centre, normal, spin, [0.0; 3]);
    assert!(largest([&sub(disk.centre(), centre)]) < 1e-15);
    let road = Road::Disk(disk);
    for _ in 0..200 {
        let anywhere = axpy(random.vector(), 0.2, centre);
        let x = axpy(normal, -road.gap(anywhere), anywhere);
        let r = sub(x, centre);
        assert!(dot(r, normal).abs() < 1e-15);
        assert!(largest([&sub(road.velocity(anywhere), scale(cross(normal, r), spin))]) < 1e-15);
        // Rodrigues' formula, r being square to the axis.
        let dt = 0.3;
        let (sin, cos) = (spin * dt).sin_cos();
        let turned = axpy(cross(normal, r), sin, scale(r, cos));
        assert!(largest([&sub(sub(road.carried(x, dt), centre), turned)]) < 1e-15);
        // Second order in the angle of a step: of 2e-4, a sixth of its square.
        let dt = 3e-5;
        let end = road.carried(x, dt);
        let mean = scale(sub(end, x), 1.0 / dt);
        let off = length(sub(road.velocity_over(end, dt), mean)) / length(mean);
        assert!(off < 1e-8, "{off}");
    }
}

/// A block of one element, 20 mm wide and 5 mm high, whose middle is at `radius` from the axis, with gravity of 10 m/s2.
fn on_turntable(radius: f64, spin: f64, friction: Friction, duration: f64) -> Scene {
    let (side, height) = (0.02, 0.005);
    let mut scene = block([side, side, height], [1, 1, 1]);
    scene.body.offset = [radius - 0.5 * side, -0.5 * side, 0.0];
    scene.body.velocity = [0.0, radius * spin, 0.0];
    scene.body.angular_velocity = [0.0, 0.0, spin];
    // Its weight comes at once: viscosity ends the bouncing within milliseconds.
    scene.body.viscosity = Some(200.0);
    scene.road = Some(Disk::about([0.0; 3], UP, spin, [radius, 0.0, 0.0]).into());
    scene.friction = Some(friction);
    scene.gravity = [0.0, 0.0, -10.0];
    scene.stages = vec![Stage { initial_velocity: None, ..explicit("ride", duration) }];
    scene.output.sample = 0.02;
    scene.output.snapshots = Snapshots::Every(0.05);
    scene
}

/// Distance of a block's middle from the axis in every snapshot.
fn radii(outcome: &Outcome) -> Vec<f64> {
    let middle = |x: &Vec<[f64; 3]>| -> [f64; 2] {
        [0, 1].map(|d| x.iter().map(|x| x[d]).sum::<f64>() / x.len() as f64)
    };
    outcome.snapshots.iter().map(|s| middle(&s.x)).map(|[x, y]| x.hypot(y)).collect()
}

const MU: f64 = 0.5;

/// omega^2 r = mu g is where a block begins to slide outward: 3 % below it stays where it is, 3 % above it leaves, at any radius.
#[test]
fn a_block_on_a_turntable_slides_above_omega_squared_r_of_mu_g() {
    for radius in [0.05, 0.1, 0.4] {
        let found = [0.97, 1.03].map(|share: f64| {
            let spin = (share * MU * 10.0 / radius).sqrt();
            let scene = on_turntable(radius, spin, Coulomb { mu: MU }.into(), 0.2);
            let outcome = run(&scene);
            assert!(outcome.totals.ledger.worst_balance < 1e-9 * outcome.totals.ledger.largest_term);
            let radii = radii(&outcome);
            (radii[radii.len() - 1] - radii[1]) / radius
        });
        // What slides is pulled out by the 3 % of mu g that friction lacks, and by more the farther it is:
        // r (cosh - 1) of some 0.03 omega^2 t^2 / 2 over 0.15 s.
        let excess = 0.5 * 0.03 * MU * 10.0 * 0.15 * 0.15 / radius;
        assert!(found[0].abs() < 1e-7, "radius {radius} m: {found:?}");
        assert!(found[1] > 0.5 * excess && found[1] < 4.0 * excess, "radius {radius} m: {found:?}, {excess}");
    }
}

/// What sticks goes round on its circle: the velocity of the end of a step alone would take it towards the centre by omega^2 r dt/2
/// a second. A law that holds more at rest than in sliding does not take the turning of the road for sliding.
#[test]
fn what_sticks_to_a_turning_disk_does_not_creep() {
    let (radius, spin, gravity, dt) = (0.1, 6.0, 10.0, 2e-5);
    let road = Road::Disk(Disk::about([0.0; 3], UP, spin, [radius, 0.0, 0.0]));
    // omega^2 r = 3.6 m/s2: enough at rest, too little in sliding.
    let jump = StaticKinetic { still: 0.5, kinetic: 0.3 };
    for law in [Friction::from(Coulomb { mu: 0.5 }), jump.into()] {
        let (mut x, mut v) = ([radius, 0.0, 0.0], [0.0, radius * spin, 0.0]);
        for n in 0..200_000 {
            // The length of the steps changes now and then, as in a run.
            let dt = if n % 1000 < 500 { dt } else { 0.9 * dt };
            let node = Node { inertia: 1e-3, x, v, v_star: axpy(UP, -gravity * dt, v) };
            let touch =
                project(&road, Some(&law), || 0.0, StepSize { dt, dtm: dt }, &node).expect("its weight");
            assert!(touch.sticks, "{law:?}: step {n}");
            (x, v) = (touch.x, touch.v);
        }
        // A step is exact to the third order of its angle: it takes a node out by 9/8 of the fourth power, measured so.
        let angle = spin * dt;
        assert!((length(x) / radius - 1.0).abs() < 1.25 * angle.powi(4) * 2e5, "{law:?}: {x:?}");
    }
}

/// A block held in the middle of a turning disk: the work of the road is omega times the moment on the body, all of it dissipated.
#[test]
fn a_disk_puts_in_omega_times_its_moment() {
    let spin = 40.0;
    let mut scene = block([0.02, 0.02, 0.005], [6, 6, 2]);
    scene.body.offset = [-0.01, -0.01, 0.0];
    scene.body.viscosity = Some(100.0);
    scene.rim = Some(Rim { nodes: "z-max".into() });
    scene.road = Some(Disk::about([0.0; 3], UP, spin, [0.0; 3]).into());
    scene.friction = Some(Coulomb { mu: 0.3 }.into());
    let mut press = explicit("press", 0.02);
    press.rim.z = Drive::Displacement { to: -2e-4, ramp: 5e-3 };
    scene.stages = vec![press];
    scene.output.sample = 1e-3;
    let outcome = run(&scene);
    let rows = &outcome.samples[outcome.samples.len() / 2..];
    let (first, last) = (&rows[0], outcome.last());
    let time = last.time_s - first.time_s;
    // The rim holds what the road turns.
    let moment = -rows[1..].iter().map(|s| s.rim_mz_Nm).sum::<f64>() / (rows.len() - 1) as f64;
    let put_in = last.road_work_J - first.road_work_J;
    assert!(moment > 1e-3, "{moment} N m");
    close("work of the road", put_in, moment * spin * time, 0.01);
    let given = last.friction_work_J - first.friction_work_J;
    assert!(given.abs() < 0.02 * put_in, "{given} J of {put_in} J move the body");
    assert!(outcome.totals.ledger.worst_balance < 1e-9 * outcome.totals.ledger.largest_term);
}

/// A viscous wheel pressed by 1 mm within 2 ms and rolled on the spot for 6 ms, its axle held over the origin.
fn rolling_on(road: Road, spin: f64) -> Scene {
    let mut scene = wheel([44, 4, 4], 1.0);
    scene.road = Some(road);
    scene.body.viscosity = Some(20.0);
    let mut roll = explicit("roll", 6e-3);
    roll.rim.spin = Drive::Velocity { to: spin, ramp: 1e-3 };
    roll.rim.z = Drive::Displacement { to: -1e-3, ramp: 2e-3 };
    scene.stages = vec![roll];
    scene.output.sample = 5e-4;
    scene
}

/// Means over the last 3 ms: forces along and across, load, moment about the normal.
fn rolled(road: Road, spin: f64, precision: Precision) -> [f64; 4] {
    let scene = rolling_on(road, spin);
    let model = Model::new(&scene).unwrap();
    let outcome = simulate_with(&scene, model, precision, 1).expect("the scene runs");
    let columns: [fn(&Sample) -> f64; 4] =
        [|s| s.road_fx_N, |s| s.road_fy_N, |s| s.road_fz_N, |s| s.rim_mz_Nm];
    columns.map(|column| outcome.mean("roll", 0.5, column))
}

/// A disk whose surface goes backwards under the wheel with `speed`, its centre to the wheel's left by `radius`.
fn beside(radius: f64, speed: f64) -> Road {
    Disk::about([0.0, radius, 0.0], UP, -speed / radius, [0.0; 3]).into()
}

/// With the centre far away the disk is the plane that moves at its surface's speed, in f64 and in f32.
#[test]
fn a_very_large_disk_is_a_plane() {
    let speed = 5.0;
    let plane = Road::Plane(Plane { velocity: [-speed, 0.0, 0.0], point: [0.0; 3], normal: UP });
    for (precision, bound) in [
        // Turn-slip: speeds across the print differ by its size over the radius, 5e-7 at 1e6 radii of the wheel.
        (Precision::F64, 1e-6),
        // Sums of single precision differ from the first rounding on, as runs in it do.
        (Precision::F32, 2e-3),
    ] {
        let flat = rolled(plane.clone(), 130.0, precision);
        for side in [1.0, -1.0] {
            let round = rolled(beside(side * 1e6 * OUTER_RADIUS, speed), 130.0, precision);
            for (a, b) in flat.iter().zip(&round) {
                assert!((a - b).abs() < bound * flat[2], "{flat:?} {round:?}");
            }
        }
    }
}

/// The moment of turn-slip: it changes its sign with the sense of the disk and falls as one over the radius.
#[test]
fn turn_slip_has_the_sense_of_the_disk_and_vanishes_with_its_curvature() {
    let moment = |radius: f64, speed: f64| rolled(beside(radius, speed), 26.0 * speed, Precision::F64)[3];
    let forwards = moment(0.1, 5.0);
    // The mirror image: all that differs is the order of sums.
    let backwards = moment(0.1, -5.0);
    assert!(forwards.abs() > 1e-4, "{forwards} N m");
    close("the other sense", backwards, -forwards, 1e-6);
    // The centre on the other side, mirrored in the wheel's plane.
    close("the other side", moment(-0.1, 5.0), -forwards, 1e-6);
    // Of first order in the curvature while most of the print sticks.
    close("twice the radius", moment(0.8, 5.0), 0.5 * moment(0.4, 5.0), 0.05);
    assert!(moment(1e4, 5.0).abs() < 2e-5 * forwards.abs());
}

/// In the implicit scheme what sticks goes round by the angle of an increment, not along its chord.
#[test]
fn an_implicit_block_rides_on_its_circle() {
    let (radius, spin) = (0.1, 5.0);
    let mut scene = on_turntable(radius, spin, Coulomb { mu: 0.6 }.into(), 0.2);
    let settings = Implicit { scheme: ImplicitScheme::Dynamic { step: 2e-3, damping: 0.0 }, ..implicit() };
    scene.stages[0].method = Method::Implicit(settings);
    let radii = radii(&run(&scene));
    let drift = (radii[radii.len() - 1] / radii[1] - 1.0).abs();
    // Chords of 10 mrad, a hundred of them, would lead outwards by 0.5 %.
    assert!(drift < 1e-5, "{radii:?}");
}

fn implicit() -> Implicit {
    let shipped = hexroll_lab::rig::shipped("lat100_straight_implicit", &[""; 0]);
    let found = shipped.stages.into_iter().find_map(|s| match s.method {
        Method::Implicit(settings) => Some(settings),
        _ => None,
    });
    found.expect("an implicit stage")
}

/// A held component may be square to a disk's axis nowhere.
#[test]
fn a_disk_acts_along_every_direction_it_turns_in() {
    let turning = Road::Disk(Disk::about([0.0; 3], UP, 3.0, [0.0; 3]));
    let resting = Road::Disk(Disk::about([0.0; 3], UP, 0.0, [0.0; 3]));
    let acts = |road: &Road| [0, 1, 2].map(|d| road.acts_along(d).is_some());
    assert_eq!((acts(&turning), acts(&resting)), ([true; 3], [false, false, true]));
    assert_eq!((turning.invariant(), resting.invariant()), ([false; 3], [true, true, false]));
    assert!(turning.moves() && !resting.moves());
}
