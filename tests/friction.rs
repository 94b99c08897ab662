//! Friction laws beyond Coulomb's: their curves, and what one step of contact makes of them.

use hexroll::physics::contact::{self, Node, Touch};
use hexroll::physics::friction::{
    Coulomb, Lat100, PressureVelocity, Sliding, StaticKinetic, Stribeck, Viscous,
};
use hexroll::physics::node::StepSize;
use hexroll::physics::road::Plane;
use hexroll::physics::tensor::{axpy, dot};
use hexroll::scene::{Friction, GROUND, Road};
use hexroll_lab::rig::{Random, block, close, run};

const STRIBECK: Friction = Friction::Stribeck(Stribeck { still: 1.2, kinetic: 0.7, speed: 0.1, slope: 0.05 });
const FIT: Friction =
    Friction::PressureVelocity(PressureVelocity { a: 0.4, b: 0.5, pressure: 2e5, c: 0.3, speed: 0.2 });
const LAT100: Friction = Friction::Lat100(Lat100 { a: 1.2, b: -0.5, alpha: 5e-6, c: 0.4, beta: 5.0 });
const VISCOUS: Friction = Friction::Viscous(Viscous { slope: 0.8 });

/// The curve at pressure p and speed v, as the documentation of scene files writes it.
fn expected(law: &Friction, p: f64, v: f64) -> f64 {
    match *law {
        Friction::Coulomb(Coulomb { mu }) => mu,
        Friction::Viscous(Viscous { slope }) => slope * v,
        Friction::Stribeck(Stribeck { still, kinetic, speed, slope }) => {
            kinetic + (still - kinetic) * (-(v / speed).powi(2)).exp() + slope * v
        }
        Friction::PressureVelocity(PressureVelocity { a, b, pressure, c, speed }) => {
            a + b * (-p / pressure).exp() + c * (-v / speed).exp()
        }
        Friction::Lat100(Lat100 { a, b, alpha, c, beta }) => {
            let growth = |x: f64| if x > 0.0 { (-1.0 / x).exp() } else { 0.0 };
            a + b * growth(alpha * p) + c * growth(beta * v)
        }
        Friction::StaticKinetic(StaticKinetic { still, kinetic }) => {
            if v > 0.0 {
                kinetic
            } else {
                still
            }
        }
    }
}

fn coefficient(law: &Friction, pressure: f64, slip_speed: f64) -> f64 {
    law.coefficient(Sliding { pressure, slip_speed })
}

#[test]
fn every_law_has_its_curve() {
    for law in [VISCOUS, STRIBECK, FIT, LAT100] {
        for v in [0.0, 0.03, 0.1, 0.5, 3.0] {
            for p in [0.0, 1e4, 2e5, 5e6] {
                let (got, wanted) = (coefficient(&law, p, v), expected(&law, p, v));
                // The same formula in another order.
                assert!((got - wanted).abs() < 1e-15 * 4.0, "{law:?} at {p} Pa, {v} m/s: {got}, {wanted}");
            }
        }
    }
    // The numbers themselves, by hand: exp(-1) = 0.36788.
    close("Stribeck at its speed", coefficient(&STRIBECK, 0.0, 0.1), 0.7 + 0.5 * 0.367_879_44 + 0.005, 1e-8);
    close("fit at its pressure and speed", coefficient(&FIT, 2e5, 0.2), 0.4 + 0.8 * 0.367_879_44, 1e-8);
    let there = 1.2 - 0.1 * 0.367_879_44;
    close("LAT 100 at 1/alpha and 1/beta", coefficient(&LAT100, 2e5, 0.2), there, 1e-8);
    // The limits, without a trace of the exponentials, in either precision.
    assert_eq!(coefficient(&LAT100, 0.0, 0.0), 1.2);
    assert_eq!(LAT100.coefficient(Sliding { pressure: 0.0f32, slip_speed: 0.0 }), 1.2f32);
}

const MASS: f64 = 2e-3;
const STEP: StepSize<f64> = StepSize { dt: 1.1e-5, dtm: 1e-5 };
const AREA: f64 = 4e-6;

/// A node on a resting road that would have velocity `v` after the step and had `before`, its area known.
fn touch_from(law: &Friction, before: [f64; 3], v: [f64; 3]) -> Touch<f64> {
    let node = Node { inertia: MASS, x: [0.0; 3], v: before, v_star: v };
    contact::project(&GROUND, Some(law), || 1.0 / AREA, STEP, &node).expect("it falls")
}

fn touch(law: &Friction, v: [f64; 3]) -> Touch<f64> {
    touch_from(law, v, v)
}

/// Work of friction over a step that began with velocity `before`, as every work is booked: with the mean of the velocities
/// before and after, each over half of its step.
fn friction_work(t: &Touch<f64>, before: [f64; 3]) -> f64 {
    let dt_before = 2.0 * STEP.dtm - STEP.dt;
    dot(t.tangential_force, axpy(t.v, 0.5 * STEP.dt, before.map(|c| 0.5 * dt_before * c)))
}

/// On a resting road friction opposes the velocity after the step. So it takes energy, but from a node that turns round within
/// the step: that one gets no more than the force times the half step it still went the other way.
#[test]
fn friction_gives_energy_only_where_a_node_turns_round() {
    let mut random = Random::new(11);
    let (mut losses, mut gains) = (0, 0);
    for law in [Friction::Coulomb(Coulomb { mu: 0.8 }), VISCOUS, STRIBECK, FIT, LAT100] {
        for _ in 0..2000 {
            let (before, mut v) = (random.vector(), random.vector());
            v[2] = -v[2].abs();
            let t = touch_from(&law, before, v);
            let (force, work) = (t.tangential_force, friction_work(&t, before));
            // Rounding of the three products of a dot product.
            let rounding = 4.0 * f64::EPSILON * dot(force, force).sqrt();
            assert!(dot(force, t.v) <= rounding, "{law:?} {before:?} {v:?}");
            let back = dot(force, before).max(0.0);
            assert!(work <= 0.5 * (2.0 * STEP.dtm - STEP.dt) * back + rounding * STEP.dt, "{law:?} {work}");
            losses += u32::from(work < 0.0);
            gains += u32::from(work > 0.0);
        }
    }
    // Of velocities that have nothing to do with each other some turn round; fewer than half gain, since those also lose.
    assert!(gains > 100 && losses > gains, "{gains} gains, {losses} losses");
}

/// A sliding node has friction mu(p, v) times its normal force at its own pressure and at the speed that remains;
/// within the second order of the loss of speed in this step.
#[test]
fn friction_is_taken_at_the_speed_that_remains() {
    let mut random = Random::new(31);
    for law in [VISCOUS, STRIBECK, FIT, LAT100] {
        let mut slid = 0;
        for _ in 0..2000 {
            let v = [random.signed(), random.signed(), -0.01 * (1.0 + random.signed())];
            let t = touch(&law, v);
            if t.sticks || dot(t.normal_force, t.normal_force) == 0.0 {
                continue;
            }
            let push = t.normal_force[2];
            let remains = t.v[0].hypot(t.v[1]);
            let friction = t.tangential_force[0].hypot(t.tangential_force[1]);
            let before = v[0].hypot(v[1]);
            let mu = expected(&law, push / AREA, remains);
            // Secant over the loss: its square times the curvature of mu, some 1/speed^2.
            let loss = (before - remains) / 0.1;
            let tolerance = 1e-9 + loss * loss * (0.1 / before).min(1.0);
            assert!((friction / push - mu).abs() <= tolerance, "{law:?}: {} for {mu}", friction / push);
            assert!(dot(t.tangential_force, t.v) <= 0.0, "friction acts against the slip");
            assert!(before >= remains);
            slid += 1;
        }
        assert!(slid > 500, "{law:?} slid {slid} times");
    }
}

/// A viscous film holds nothing and stops nothing, however steep: v = v* / (1 + slope dv), dv the speed of landing.
#[test]
fn a_steep_viscous_film_is_solved_exactly() {
    for slope in [0.1, 10.0, 1e4] {
        let t = touch(&Friction::Viscous(Viscous { slope }), [0.3, 0.0, -0.02]);
        close("speed that remains", t.v[0], 0.3 / (1.0 + slope * 0.02), 1e-12);
        assert!(!t.sticks);
    }
}

/// At rest the static coefficient decides: just below it a node sticks, just above it slides, at the kinetic one if fast.
#[test]
fn the_static_coefficient_decides_at_rest() {
    let fall = 0.02;
    let most = 1.2 * fall;
    let rest = [0.0; 3];
    let below = touch_from(&STRIBECK, rest, [0.999 * most, 0.0, -fall]);
    assert!(below.sticks && below.v[0] == 0.0 && below.v[1] == 0.0, "it does not creep");
    assert!(!touch_from(&STRIBECK, rest, [1.001 * most, 0.0, -fall]).sticks);
    let fast = touch(&STRIBECK, [2.0, 0.0, -fall]);
    close("fast", -fast.tangential_force[0] / fast.normal_force[2], 0.7 + 0.05 * fast.v[0], 1e-6);
}

/// A node that slides fast is stopped by its sliding friction or not at all: the grip of rest does not catch it, though
/// within one step it could.
#[test]
fn rest_does_not_catch_what_slides() {
    let push = 1.0;
    // Static friction could stop 1.2 m/s in this step, sliding friction about 0.75.
    let t = touch_from(&STRIBECK, [1.0, 0.0, 0.0], [1.0, 0.0, -push]);
    assert!(!t.sticks, "{t:?}");
    close("speed that remains", t.v[0], 1.0 - 0.7 - 0.05 * t.v[0], 0.02);
    assert!(touch_from(&STRIBECK, [0.0; 3], [1.0, 0.0, -push]).sticks, "at rest it holds");
    assert!(touch_from(&STRIBECK, [0.6, 0.0, 0.0], [0.6, 0.0, -push]).sticks, "slow enough to stop");
    // Steady sliding on what pulls with just the friction: exact.
    let mu = expected(&STRIBECK, 0.0, 0.5);
    let steady = touch_from(&STRIBECK, [0.5, 0.0, 0.0], [0.5 + mu * push, 0.0, -push]);
    close("steady speed", steady.v[0], 0.5, 1e-14);
}

/// The same load on a smaller area slides with less friction, by the law's own factor.
#[test]
fn pressure_is_force_over_area() {
    for area in [1e-6, 1e-5, 1e-4] {
        let node = Node { inertia: MASS, x: [0.0; 3], v: [3.0, 0.0, 0.0], v_star: [3.0, 0.0, -0.01] };
        let t = contact::project(&GROUND, Some(&FIT), || 1.0 / area, STEP, &node).unwrap();
        let push = t.normal_force[2];
        let mu = 0.4 + 0.5 * (-push / area / 2e5f64).exp() + 0.3 * (-t.v[0] / 0.2).exp();
        close("mu", -t.tangential_force[0] / push, mu, 1e-9);
    }
}

const TWO: Friction = Friction::StaticKinetic(StaticKinetic { still: 1.0, kinetic: 0.6 });

/// Two coefficients: what stands is held by the static one, what slides is slowed by the kinetic one alone, and what the
/// kinetic one can stop within the step sticks.
#[test]
fn two_coefficients_hold_what_stands_and_slow_what_slides() {
    let (rest, fall) = ([0.0; 3], 0.02);
    let held = touch_from(&TWO, rest, [0.999 * fall, 0.0, -fall]);
    assert!(held.sticks && held.v[0] == 0.0);
    let torn = touch_from(&TWO, rest, [1.001 * fall, 0.0, -fall]);
    assert!(!torn.sticks);
    close("torn off", torn.v[0], (1.001 - 0.6) * fall, 1e-12);
    let slid = touch_from(&TWO, [0.9 * fall, 0.0, 0.0], [0.9 * fall, 0.0, -fall]);
    assert!(!slid.sticks, "the grip of rest does not catch it");
    close("slides on", slid.v[0], (0.9 - 0.6) * fall, 1e-12);
    assert!(touch_from(&TWO, [0.5 * fall, 0.0, 0.0], [0.5 * fall, 0.0, -fall]).sticks, "slow enough to stop");
}

/// What rounding leaves of a stuck node's slip on an oblique moving road is none: it is held by the static coefficient.
#[test]
fn rounding_of_a_stuck_node_is_no_slip() {
    let (normal, surface) = ([0.6, 0.0, 0.8], [0.8 * 1.3, 0.7, -0.6 * 1.3]);
    let road = Road::Plane(Plane { point: [0.1, 0.2, 0.3], normal, velocity: surface });
    let (mut x, mut v) = ([0.1, 0.2, 0.3], surface);
    for _ in 0..1000 {
        // Pulled by 0.8 of the normal force: between the two coefficients.
        let push = axpy(normal, -0.01, axpy([0.0, 1.0, 0.0], 0.008, v));
        let node = Node { inertia: MASS, x, v, v_star: push };
        let t = contact::project(&road, Some(&TWO), || 0.0, STEP, &node).expect("it is pressed");
        assert!(t.sticks, "{v:?}");
        (x, v) = (t.x, t.v);
    }
}

/// A block that is let go on a slope: it stays where even the kinetic coefficient holds it, and slides with
/// g (sin - mu_kinetic cos) where not even the static one does. (Between the two its landing decides.)
#[test]
fn a_block_slides_down_a_slope_by_its_kinetic_coefficient() {
    for (tangent, slides) in [(0.5f64, false), (1.1, true)] {
        let (sin, cos) = tangent.atan().sin_cos();
        let mut scene = block([0.02, 0.02, 0.005], [4, 4, 1]);
        scene.body.viscosity = Some(200.0);
        scene.road = Some(GROUND);
        scene.friction = Some(TWO);
        scene.gravity = [9.81 * sin, 0.0, -9.81 * cos];
        scene.stages[0].duration = 0.02;
        scene.output.sample = 1e-3;
        let outcome = run(&scene);
        let last = outcome.snapshots.last().unwrap();
        let speed = last.v.iter().map(|v| v[0]).sum::<f64>() / last.v.len() as f64;
        if slides {
            // It lands at once, swings for some 2 ms, then falls freely along the slope.
            close("speed", speed, 9.81 * (sin - 0.6 * cos) * 0.02, 0.06);
        } else {
            assert!(speed.abs() < 1e-4, "{speed} m/s");
        }
    }
}
