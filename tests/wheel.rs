//! The paper's wheel, pressed and rolled, against an independent program (44 x 4 x 5 elements, a node row at the
//! bottom).
//!
//! Expected values and tolerances: `src/lab/rig/references.toml`. The independent program gave each corner an eighth of its
//! element's mass, so the rolling runs here do too; row sums change Fx by 0.7 %.

use hexroll::record::ContactState;
use hexroll::scene::*;
use hexroll_lab::rig::given::{
    AT_5_DEGREES, DEPTH, HOURGLASS, LOAD, MESH, OUTER_RADIUS, ROLLING, SPEED, SPIN, STRAIGHT, VISCOSITY,
};
use hexroll_lab::rig::references::{Node, pressed_nodes};
use hexroll_lab::rig::{
    HELD, Outcome, at_once, close, down, explicit, press, reference, rolling, run, wheel,
};

/// The wheel pressed down by `DEPTH` and relaxed.
fn pressed(element: Element, mu: f64) -> Outcome {
    let mut scene = wheel(MESH, mu);
    scene.body.element = element;
    scene.stages = vec![press(down(DEPTH))];
    run(&scene)
}

/// Pressing force, and what holds of any pressed wheel.
fn assert_force(element: Element, mu: f64, run: &str) {
    let outcome = pressed(element, mu);
    let last = outcome.last();
    let expected = reference(&format!("{run}.road_fz"));
    expected.assert(last.road_fz_N);
    // Relaxed: the rim holds what the road carries, to the stop criterion (1e-4 of the internal force).
    close("rim force", -last.rim_fz_N, last.road_fz_N, 1e-3);
    // No side pushes the wheel.
    let side = last.road_fx_N.abs().max(last.road_fy_N.abs());
    assert!(side < 1e-3 * expected.value, "{last:?}");
    let gap = outcome.totals.ledger.worst_gap;
    assert!(gap > -1e-16, "penetration {gap} m: beyond the round-off of positions of 0.04 m");
}

/// `q1p0` with friction carries the paper's force too.
#[test]
fn pressed_with_friction_it_carries_the_papers_force() {
    assert_force(Element::Q1p0, 1.0, "pressed-q1p0");
    assert_force(Element::Q1p0, 1.0, "pressed-paper");
}

#[test]
fn pressed_without_friction_it_carries_less() {
    assert_force(Element::Q1p0, 0.0, "pressed-q1p0-frictionless");
}

#[test]
fn full_integration_locks() {
    assert_force(Element::Full, 1.0, "pressed-full");
}

/// With friction and without.
#[test]
fn uniform_gradient_agrees_with_q1p0() {
    let element = Element::UniformGradient { hourglass: HOURGLASS };
    assert_force(element, 1.0, "pressed-uniform-gradient");
    assert_force(element, 0.0, "pressed-uniform-gradient-frictionless");
}

/// The paper's load on a free rim finds its depth.
#[test]
fn the_papers_load_finds_its_height() {
    let mut scene = wheel(MESH, 1.0);
    // The rim's own mass only sets how the rim settles.
    scene.stages = vec![press(Drive::Free { mass: 0.05, load: -LOAD, ramp: 0.02 })];
    let outcome = run(&scene);
    close("depth", OUTER_RADIUS - outcome.last().axle_z_m, DEPTH, 0.01);
    close("road force", outcome.last().road_fz_N, LOAD, 1e-3);
}

/// Node by node, the contact forces are those of an independent implicit solver, within 0.5 % of the largest force.
///
/// A node sticks where it lands, so shear forces remember how the wheel came down: pressed in 20 ms they differ by
/// 0.6 % of the largest force, pressed slowly by 0.3 %. Normal forces agree within 0.1 % either way.
#[test]
fn contact_forces_agree_node_by_node() {
    let mut scene = wheel(MESH, 1.0);
    let slowly = Drive::Displacement { to: -DEPTH, ramp: 0.15 };
    scene.stages = vec![Stage { duration: 0.4, mass_damping: 1000.0, ..press(slowly) }];
    let outcome = run(&scene);
    let contact = &outcome.snapshots[0].contact;
    let rows = pressed_nodes();
    let top = rows.iter().map(|n| n.force[2]).fold(0.0, f64::max);
    for Node { position: x, force } in &rows {
        // The file's origin is the undeformed axle; ours is 39 mm below it.
        let near = |n: &&hexroll::record::ContactNode| {
            let here = outcome.model.mesh.nodes[n.node as usize];
            (0..3).all(|d| (here[d] - [0.0, 0.0, OUTER_RADIUS][d] - x[d]).abs() < 1e-8)
        };
        let node = contact.iter().find(near).unwrap_or_else(|| panic!("no node at {x:?}"));
        for d in 0..3 {
            let error = (node.force[d] - force[d]).abs();
            assert!(error < 0.005 * top, "at {x:?}: {:?}, expected {force:?}", node.force);
        }
    }
    let touching = contact.iter().filter(|n| n.state != ContactState::Free).count();
    assert_eq!(touching, rows.len(), "the same nodes touch");
}

/// Pressed with the run's own friction, then rolling at once at `velocity` [m/s].
fn rolled(eta: f64, velocity: [f64; 2]) -> Outcome {
    let mut scene = wheel(MESH, 1.0);
    scene.body.lumping = Lumping::Equal;
    scene.body.viscosity = (eta > 0.0).then_some(eta);
    scene.stages = vec![press(down(DEPTH)), rolling(velocity, SPIN, ROLLING)];
    run(&scene)
}

/// Means over the last 30 ms: road force and rim moment.
fn means(outcome: &Outcome) -> ([f64; 3], [f64; 3]) {
    let of = |column: fn(&hexroll::record::Sample) -> f64| outcome.mean("roll", 0.3, column);
    (
        [of(|s| s.road_fx_N), of(|s| s.road_fy_N), of(|s| s.road_fz_N)],
        [of(|s| s.rim_mx_Nm), of(|s| s.rim_my_Nm), of(|s| s.rim_mz_Nm)],
    )
}

/// 20 Pa s. 5 % more spin than free rolling drives: the road pushes forward, the rim turns the rubber about +y.
#[test]
fn straight_viscous_rolling_has_the_reference_forces() {
    let outcome = rolled(VISCOSITY, STRAIGHT);
    let (force, moment) = means(&outcome);
    outcome.assert_means("roll", "straight-viscous");
    // Symmetric about y = 0: no side force, no moments about x and z.
    assert!(force[1].abs() < 1e-3 * force[2] && moment[0].abs() < 1e-3 && moment[2].abs() < 1e-3);
    // In steady rolling the rim carries what the road does; 1e-2 for the fluctuation of 30 windows.
    close("rim Fx", outcome.mean("roll", 0.3, |s| s.rim_fx_N), -force[0], 0.01);
    close("rim Fz", outcome.mean("roll", 0.3, |s| s.rim_fz_N), -force[2], 0.01);
    // Moments balance too: the road's force below the axle is Fx times the axle's height of 36.8 mm; the rest
    // is Fz times a small offset ahead of the axle.
    assert!((moment[1] / force[0] - (OUTER_RADIUS - DEPTH)).abs() < 0.003, "{}", moment[1] / force[0]);
    let dissipated = outcome.last();
    assert!(dissipated.friction_work_J < 0.0 && dissipated.viscous_work_J < 0.0);
}

#[test]
fn straight_elastic_rolling_has_the_reference_forces() {
    rolled(0.0, STRAIGHT).assert_means("roll", "straight-elastic");
}

/// 5 degrees of slip, 20 Pa s: all six components.
#[test]
fn slip_at_five_degrees_has_the_reference_forces() {
    rolled(VISCOSITY, AT_5_DEGREES).assert_means("roll", "slip5-viscous");
}

/// A rim without torque finds free rolling, and almost no longitudinal force (the independent program after 0.25 s; the
/// rim has settled long before).
#[test]
fn a_torque_free_rim_finds_free_rolling() {
    let mut scene = wheel(MESH, 1.0);
    scene.body.lumping = Lumping::Equal;
    scene.body.viscosity = Some(VISCOSITY);
    let forward = at_once(SPEED);
    let free = Drive::Free { mass: 1e-5, load: 0.0, ramp: 0.0 };
    scene.stages = vec![
        press(down(DEPTH)),
        rolling(STRAIGHT, SPIN, 0.02),
        Stage { rim: RimMotion { x: forward, spin: free, ..HELD }, ..explicit("free", 0.1) },
    ];
    let outcome = run(&scene);
    let rows = outcome.stage("free");
    let [first, last] = [rows[rows.len() - 51], rows[rows.len() - 1]];
    let omega = (last.rim_angle_rad - first.rim_angle_rad) / (last.time_s - first.time_s);
    // The mean over 50 ms, half a turn.
    reference("free.spin").assert(omega);
    reference("free.road_fx").assert(outcome.mean("free", 0.5, |s| s.road_fx_N));
}

/// A spinning rim that is let go keeps its spin, wherever it was driven to.
#[test]
fn a_released_rim_keeps_its_spin() {
    let mut scene = wheel([16, 2, 2], 0.0);
    scene.road = None;
    let spinning = RimMotion { spin: at_once(SPIN), ..HELD };
    let free = RimMotion { spin: Drive::Free { mass: 1e-4, load: 0.0, ramp: 0.0 }, ..HELD };
    scene.stages = vec![
        Stage { initial_velocity: Some(InitialVelocity::Rim), rim: spinning, ..explicit("driven", 0.01) },
        Stage { rim: free, ..explicit("free", 0.01) },
        // Starting a stage with the rim's motion takes a free component's own rate.
        Stage { initial_velocity: Some(InitialVelocity::Rim), rim: free, ..explicit("again", 0.01) },
    ];
    let outcome = run(&scene);
    for pair in outcome.samples.windows(2) {
        let omega = (pair[1].rim_angle_rad - pair[0].rim_angle_rad) / (pair[1].time_s - pair[0].time_s);
        // The ring, let go at once, breathes under its centrifugal load and twists against the rim by a few per cent.
        close("spin", omega, SPIN, 0.05);
    }
}
