//! Contact and Coulomb friction on a rigid road: impenetrable, never a source of energy, exact in stick and slip.

use hexroll::cpu::Precision;
use hexroll::model::Model;
use hexroll::physics::contact::{self, Node};
use hexroll::physics::friction::Coulomb;
use hexroll::physics::node::StepSize;
use hexroll::physics::road::Plane;
use hexroll::physics::tensor::{axpy, dot, scale, sub};
use hexroll::record::ContactState;
use hexroll::run::stability;
use hexroll::scene::*;
use hexroll_lab::rig::{self, GROUND, Outcome, Random, block, close, explicit, given, run, simulate_with};

const GRAVITY: f64 = 9.81;

/// One node against a tilted, moving road, thousands of times: it lands on the surface, the normal force pushes and is
/// what landing takes, momentum accounts for every force, and Coulomb's law holds with equality exactly where it slips.
#[test]
fn a_node_lands_sticks_or_slips_by_the_law() {
    let (normal, mass, mu) = ([0.6, 0.0, 0.8], 2e-3, 0.7);
    let surface = [0.8, 0.5, -0.6];
    let road = Road::Plane(Plane { point: [0.1, 0.0, 0.02], normal, velocity: surface });
    let law = Coulomb { mu }.into();
    let step = StepSize { dt: 1.1e-5, dtm: 1e-5 };
    let mut random = Random::new(21);
    let (mut free, mut stuck, mut slipped) = (0, 0, 0);
    for _ in 0..3000 {
        // On or above the surface by up to 10 um, moving by up to that far a step.
        let tangent = axpy([0.8, 0.0, -0.6], 0.01 * random.signed(), [0.0, 0.01 * random.signed(), 0.0]);
        let height = (1e-5 * random.signed()).max(0.0);
        let x = axpy(normal, height, axpy([1.0; 3], 0.0, [0.1 + tangent[0], tangent[1], 0.02 + tangent[2]]));
        let v = axpy(surface, 1.0, scale(random.vector(), 1.5));
        let gap = road.gap(axpy(v, step.dt, x));
        let node = Node { inertia: mass, x, v, v_star: v };
        let no_area = || unreachable!("Coulomb's law asks for no area");
        let Some(t) = contact::project(&road, Some(&law), no_area, step, &node) else {
            assert!(gap >= 0.0, "a node {gap} m above the road is left alone");
            free += 1;
            continue;
        };
        assert!(gap < 0.0);
        // Coordinates of 0.1 m.
        assert!(road.gap(t.x).abs() < 1e-16, "gap {}", road.gap(t.x));
        let push = dot(t.normal_force, normal);
        close("normal force", push, mass * -gap / (step.dt * step.dtm), 1e-13);
        let total = axpy(t.tangential_force, 1.0, t.normal_force);
        let change = scale(sub(t.v, v), mass / step.dtm);
        assert!(
            rig::largest([&sub(total, change)]) < 1e-12 * push.max(1.0),
            "{total:?} changes momentum by {change:?}"
        );
        let tangential = dot(t.tangential_force, t.tangential_force).sqrt();
        assert!(dot(t.tangential_force, normal).abs() < 1e-12 * (tangential + push));
        let slip = sub(t.v, surface);
        let slip = axpy(normal, -dot(slip, normal), slip);
        if t.sticks {
            assert!(tangential <= mu * push * (1.0 + 1e-12) && rig::largest([&slip]) < 1e-15);
            stuck += 1;
        } else {
            close("friction", tangential, mu * push, 1e-10);
            let against = -dot(t.tangential_force, slip) / (tangential * dot(slip, slip).sqrt());
            close("cosine against the slip", against, 1.0, 1e-9);
            slipped += 1;
        }
        let smooth = contact::project(&road, None, no_area, step, &node).expect("the same touch");
        assert_eq!(smooth.tangential_force, [0.0; 3], "no friction law, no tangential force");
        assert_eq!(smooth.normal_force, t.normal_force);
    }
    assert!(free > 100 && stuck > 100 && slipped > 100, "{free} {stuck} {slipped}");
}

/// A tumbling elastic block thrown at the road: it never enters, contact only takes energy, and it leaves more slowly than
/// it came.
#[test]
fn a_bouncing_block_never_gains_energy() {
    let mut scene = block([0.02, 0.02, 0.02], [3, 3, 3]);
    scene.body.offset = [0.0, 0.0, 6e-3];
    scene.body.velocity = [0.5, 0.0, -3.0];
    scene.body.angular_velocity = [40.0, 60.0, 0.0];
    scene.road = Some(GROUND);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: 0.3 }));
    scene.output.sample = 1e-4;
    scene.stages[0].duration = 0.02;
    let outcome = run(&scene);
    // On z = 0 exactly.
    assert_eq!(outcome.totals.ledger.worst_gap.min(0.0), 0.0, "never inside the road, to the last bit");
    let start = outcome.samples[0].kinetic_J;
    let (mut contact, mut friction) = (0.0, 0.0);
    for s in &outcome.samples {
        assert!(s.contact_work_J <= contact && s.friction_work_J <= friction, "losses only: {s:?}");
        (contact, friction) = (s.contact_work_J, s.friction_work_J);
        // Stored and kinetic energy are what is left, to the step's second-order error in an impact.
        assert!(s.stored_balance_error_J.abs() < 2e-2 * start, "{s:?}");
    }
    let last = outcome.last();
    assert!(
        contact < -1e-3 * start && friction < -1e-3 * start,
        "it did hit and rub: {contact} {friction} of {start}"
    );
    assert_eq!((last.road_fz_N, last.contact_nodes), (0.0, 0.0), "it has left the road");
    let rise = momentum(&outcome, &outcome.snapshots[0].v)[2];
    let mass: f64 = outcome.model.mass.iter().sum();
    assert!(rise > 0.3 * mass && rise < 3.0 * mass, "it rises at {} m/s", rise / mass);
}

/// A block that is dropped on its corner on an oblique road, with one point an element, which lets its nodes swing: friction
/// gives back less than a thousandth of what it takes, in nodes that turn round within a step (`friction_gives_energy_..` has
/// the bound of a node). A fifth of the step resolves how they turn.
#[test]
fn friction_on_a_resting_road_gives_back_next_to_nothing() {
    let third = 1.0 / 3.0;
    let mut scene = block([0.04; 3], [6; 3]);
    scene.body.element = Element::UniformGradient { hourglass: given::HOURGLASS };
    scene.body.velocity = [third, 2.0 * third, -2.0 * third];
    let normal = [-third, -2.0 * third, 2.0 * third];
    scene.road = Some(Road::Plane(Plane { point: [0.04, 0.04, 0.0], normal, velocity: [0.0; 3] }));
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: 1.0 }));
    scene.output.sample = 1e-4;
    scene.stages[0].duration = 0.01;
    for (precision, safety, share) in
        [(Precision::F64, 0.9, 1e-3), (Precision::F32, 0.9, 1e-3), (Precision::F64, 0.18, 1e-6)]
    {
        let scene = Scene { safety, ..scene.clone() };
        let outcome = simulate_with(&scene, Model::new(&scene).unwrap(), precision, 1).unwrap();
        let total = outcome.last().friction_work_J;
        assert!(total < -1e-4, "{precision:?}: it rubs, {total} J");
        let rises = outcome.samples.windows(2).map(|s| s[1].friction_work_J - s[0].friction_work_J);
        let most = rises.fold(0.0, f64::max);
        assert!(most < -share * total, "{precision:?} at {safety}: {most} J of {total} J");
    }
}

fn momentum(outcome: &Outcome, v: &[[f64; 3]]) -> [f64; 3] {
    let sum = |d: usize| v.iter().zip(&outcome.model.mass).map(|(v, m)| m * v[d]).sum();
    [sum(0), sum(1), sum(2)]
}

/// Angle of the slope.
const ANGLE: f64 = std::f64::consts::FRAC_PI_6;

/// A viscous rubber block of length `size` on a slope of 30 degrees in gravity `g`, settled by mass damping, then left to
/// itself for `steps` steps of the element bound.
///
/// Sliding at the speed at which damping balances the pull stresses it exactly as sliding freely does, so the settled
/// block goes over into free sliding without a jolt.
fn slope(size: f64, g: f64, mu: f64, settle: Method, steps: f64) -> Scene {
    let mut scene = block([size, 0.5 * size, 0.5 * size], [6, 3, 3]);
    let (sin, cos) = ANGLE.sin_cos();
    scene.friction = Some(Friction::Coulomb(Coulomb { mu }));
    scene.road = Some(GROUND);
    scene.gravity = [g * sin, 0.0, -g * cos];
    let dt = 0.9 * stability::element_bound(&Model::new(&scene).unwrap()).unwrap();
    // Damping ratio 0.03 of the highest frequency 2/dt: xi = (4/3) eta w / (2 (kappa + 4/3 G)).
    scene.body.viscosity = Some(0.03 * 1.5 * scene.body.law.wave_modulus() * dt / 2.0);
    // Near critical for the block's slowest mode, shear over its height: w = (pi/2) sqrt(G/rho) / (size/2).
    let alpha = std::f64::consts::PI * (rig::G / rig::DENSITY).sqrt() / size;
    let settle = Stage { method: settle, mass_damping: alpha, ..explicit("settle", 100.0 / alpha) };
    scene.stages = vec![settle, explicit("free", steps * dt)];
    scene.output.sample = 50.0 * dt;
    scene
}

/// Until the net force is `residual` of the internal force; a sliding block keeps its kinetic energy.
fn settled(residual: f64) -> Method {
    Method::QuasiStatic { kinetic_ratio: f64::INFINITY, residual }
}

/// Acceleration down the slope over the free stage, from the body's momentum [m/s2].
fn acceleration(outcome: &Outcome) -> f64 {
    let [before, after] = [0, 1].map(|k| momentum(outcome, &outcome.snapshots[k].v)[0]);
    let duration = outcome.snapshots[1].time - outcome.snapshots[0].time;
    (after - before) / duration / outcome.model.mass.iter().sum::<f64>()
}

/// A block on a slope slides with g (sin th - mu cos th) at 1 m, 0.1 m and 10 mm, within 0.5 %; every node that slips has
/// friction mu times its normal force, against the slip.
#[test]
fn a_block_slides_down_with_the_closed_form_acceleration() {
    let mu = 0.4;
    let expected = GRAVITY * (ANGLE.sin() - mu * ANGLE.cos());
    for size in [1.0, 0.1, 0.01] {
        let outcome = run(&slope(size, GRAVITY, mu, settled(1e-6), 2000.0));
        close(&format!("acceleration of a block of {size} m"), acceleration(&outcome), expected, 5e-3);
        let mut total = [0.0; 3];
        for n in &outcome.snapshots[1].contact {
            // A mean over steps of forces of mu fN or less.
            assert!(n.force[0].hypot(n.force[1]) <= mu * n.force[2] * (1.0 + 1e-9), "{n:?}");
            assert!(n.state != ContactState::Slip || (n.force[0] < 0.0 && n.slip_speed > 0.0), "{n:?}");
            total = axpy(n.force, 1.0, total);
        }
        // The whole base slips downhill; only nodes that are about to lift off turn aside.
        close("friction over normal force", -total[0] / total[2], mu, 1e-3);
        assert!(outcome.totals.ledger.worst_gap >= 0.0);
    }
}

/// Where tan(th) = 0.9 mu the block stays: its base drifts by less than `tolerance` of its length in 10,000 steps, and a
/// node that sticks does not move by a bit.
fn assert_stays(precision: Precision, size: f64, scene: &Scene, tolerance: f64) {
    let outcome = simulate_with(scene, Model::new(scene).unwrap(), precision, 1).expect("the scene runs");
    let [.., before, after] = &outcome.snapshots[..] else { panic!("a snapshot at the end of every stage") };
    assert!(after.step - before.step >= 10_000);
    let (mut stuck, mut touching) = (0, 0);
    for node in after.contact.iter().filter(|n| n.state != ContactState::Free) {
        let [a, b] = [before, after].map(|s| s.x[node.node as usize]);
        let drift = rig::largest([&sub(b, a)]) / size;
        assert!(
            drift < tolerance,
            "node {} of a block of {size} m drifts by {drift:e} of its length",
            node.node
        );
        touching += 1;
        stuck += usize::from(a == b);
    }
    assert!(stuck > 10, "{stuck} of {touching} nodes have not moved by a bit");
}

#[test]
fn a_block_below_the_friction_angle_stays_in_f64() {
    for size in [1.0, 0.1, 0.01] {
        let scene = slope(size, GRAVITY, ANGLE.tan() / 0.9, settled(1e-8), 14_000.0);
        assert_stays(Precision::F64, size, &scene, 1e-12);
    }
}

/// In single precision gravity grows as the block shrinks: a 10 mm block's own weight strains it by 1e-5, which f32
/// positions hardly resolve. For the same reason damping stops a node short of its place, a few last digits away,
/// and the block gets a stage to take it, undamped.
#[test]
fn a_block_below_the_friction_angle_stays_in_f32() {
    for size in [1.0, 0.1, 0.01] {
        let mut scene = slope(size, GRAVITY / size, ANGLE.tan() / 0.9, Method::Explicit, 14_000.0);
        let rest = Stage { name: "rest".into(), ..scene.stages[1].clone() };
        scene.stages.insert(1, rest);
        assert_stays(Precision::F32, size, &scene, 1e-6);
    }
}

/// A frictionless road makes no tangential force at all.
#[test]
fn a_frictionless_road_makes_no_tangential_force() {
    let mut scene = block([0.02, 0.02, 0.02], [2, 2, 2]);
    scene.body.velocity = [1.0, -0.5, -0.5];
    scene.road = Some(GROUND);
    scene.gravity = [0.0, 0.0, -GRAVITY];
    scene.output.sample = 1e-4;
    let outcome = run(&scene);
    assert!(outcome.samples.iter().any(|s| s.road_fz_N > 0.0));
    for s in &outcome.samples {
        assert_eq!((s.road_fx_N, s.road_fy_N, s.friction_work_J, s.sticking_share), (0.0, 0.0, 0.0, 0.0));
    }
}

/// A moving road drags a resting block along with mu m g, does work on it, and lets it ride in the end.
#[test]
fn a_moving_road_drags() {
    let (mu, speed) = (0.5, 0.2);
    let mut scene = block([0.02, 0.02, 0.01], [2, 2, 1]);
    scene.body.viscosity = Some(100.0);
    scene.road =
        Some(Road::Plane(Plane { point: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [speed, 0.0, 0.0] }));
    scene.friction = Some(Friction::Coulomb(Coulomb { mu }));
    scene.gravity = [0.0, 0.0, -GRAVITY];
    // Up to speed after v / (mu g) = 41 ms.
    scene.stages[0].duration = 0.08;
    let outcome = run(&scene);
    let weight = GRAVITY * outcome.model.mass.iter().sum::<f64>();
    let dragged: Vec<_> = outcome.samples.iter().filter(|s| (0.01..0.03).contains(&s.time_s)).collect();
    // 20 windows of a block that has stopped bouncing: what remains of it, 2 %.
    let drag = dragged.iter().map(|s| s.road_fx_N).sum::<f64>() / dragged.len() as f64;
    close("drag", drag, mu * weight, 0.02);
    assert!(dragged.iter().all(|s| s.sticking_share < 0.5));
    let last = outcome.last();
    assert!(last.friction_work_J > 0.0 && last.sticking_share > 0.9, "{last:?}");
    let ride = momentum(&outcome, &outcome.snapshots[0].v)[0] * GRAVITY / weight;
    close("ride", ride, speed, 1e-2);
}
