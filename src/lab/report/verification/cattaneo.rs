//! Cattaneo's and Mindlin's partial slip: a pressed cylinder is then pushed sideways, by less than mu P.
//!
//! Johnson, sec. 7.2: the middle |x| < c sticks, c / a = sqrt(1 - Q / (mu P)); q = mu p0 sqrt(1 - x^2/a^2) outside, less
//! mu p0 (c / a) sqrt(1 - x^2/c^2) inside. An incompressible body on a rigid plane has no coupling of p and q.
//!
//! The split is taken from moments, which no single node decides: a^2 = 4 <x^2> weighted with p, and, weighted with q,
//! <x^2> = (a^2 + c^2) / 4.

use super::cylinder::{EDGE, STIFF, WIDTH, half_width, press, relaxing, slice};
use crate::report::{Case, Claim};
use crate::rig::{HELD, Outcome, simulate};
use hexroll::Result;
use hexroll::physics::friction::Coulomb;
use hexroll::record::{ContactState, Snapshot};
use hexroll::scene::{Drive, Friction, RimMotion};

pub const CASE: Case = Case {
    name: "cattaneo_mindlin",
    theorem: "a_pressed_cylinder_pushed_sideways_slips_at_its_edges",
    title: "Cattaneo and Mindlin: partial slip under a tangential load",
    source: "Johnson, Contact Mechanics, sec. 7.2",
    setup: "the cylinder of the line contact, kappa / G = 100, mu = 0.3, pressed by 0.06 mm, its axle then moved sideways \
            by 14 and by 26 um, slowly and damped at the wall's own frequency, so that nothing slides back",
    everyday: true,
    run,
};

const MU: f64 = 0.3;
const WAYS: [f64; 2] = [1.4e-5, 2.6e-5];

fn run() -> Result<Vec<Claim>> {
    let mut scene = slice(STIFF, 0.12, Some(Friction::Coulomb(Coulomb { mu: MU })));
    let push = |to: f64| {
        let aside = Drive::Displacement { to, ramp: 4e-3 };
        relaxing(&format!("{:.0} um", 1e6 * to), RimMotion { x: aside, ..HELD }, 0.02)
    };
    scene.stages = vec![press(), push(WAYS[0]), push(WAYS[1])];
    let outcome = simulate(&scene)?;
    let mut claims = Vec::new();
    for (k, way) in WAYS.into_iter().enumerate() {
        claims.extend(pushed(&outcome, &outcome.snapshots[k + 1], &format!("{:.0} um", 1e6 * way)));
    }
    Ok(claims)
}

/// What is claimed at the end of a push.
fn pushed(outcome: &Outcome, snapshot: &Snapshot, at: &str) -> Vec<Claim> {
    let touching: Vec<_> = snapshot.contact.iter().filter(|n| n.state != ContactState::Free).collect();
    let x = |n: u32| snapshot.x[n as usize][0];
    let sum = |f: &dyn Fn(&hexroll::record::ContactNode) -> f64| touching.iter().map(|n| f(n)).sum::<f64>();
    let (force, push) = (sum(&|n| n.force[2]), -sum(&|n| n.force[0]));
    let middle = sum(&|n| n.force[2] * x(n.node)) / force;
    let square = |n: u32| (x(n) - middle).powi(2);
    let a = 2.0 * (sum(&|n| n.force[2] * square(n.node)) / force).sqrt();
    let spread = -sum(&|n| n.force[0] * square(n.node)) / push;
    let share = push / (MU * force);
    let c = (1.0 - share).sqrt();
    let hertz = half_width(&STIFF, force);
    let p0 = 2.0 * force / WIDTH / (std::f64::consts::PI * hertz);
    let semi = |s: f64, a: f64| (1.0 - s * s / (a * a)).max(0.0).sqrt();
    // Pressing with friction leaves a traction that is odd in x: the mean of both sides has none.
    let even = |n: u32| {
        let place = outcome.model.mesh.nodes[n as usize];
        let same = |m: u32| {
            let other = outcome.model.mesh.nodes[m as usize];
            (other[0].abs() - place[0].abs()).abs() < 1e-9 && other[1] == place[1]
        };
        let pair: Vec<f64> =
            touching.iter().filter(|m| same(m.node)).map(|m| -m.force[0] / m.area / (MU * p0)).collect();
        pair.iter().sum::<f64>() / pair.len() as f64
    };
    let place = |n: u32| outcome.model.mesh.nodes[n as usize][0] / hertz;
    let errors = touching.iter().filter(|n| place(n.node).abs() < 0.8).map(|n| {
        let s = place(n.node);
        (even(n.node) - (semi(s, 1.0) - c * semi(s, c))).abs()
    });
    // At rest everything sticks; what slipped on the way is at the limit. Two nodes a row.
    let within = touching.iter().filter(|n| -n.force[0] < 0.97 * MU * n.force[2]).count() / 2;
    vec![
        Claim::at_least(format!("{at}: Q / (mu P)"), "", share, 0.3, "the load is partial: not all stuck,"),
        Claim::at_most(format!("{at}: Q / (mu P)"), "", share, 0.9, "and not all sliding"),
        Claim::relative(
            format!("{at}: stuck half width over a, from the second moment of q"),
            "",
            (4.0 * spread / (a * a) - 1.0).max(0.0).sqrt(),
            c,
            0.02,
            "(a / R)^2, (a / wall)^2 of 1 %, and (h / a)^2 of the mesh",
        ),
        Claim::absolute(
            format!("{at}: nodes below 0.97 of the limit, times the element over 2 a"),
            "",
            0.5 * within as f64 * EDGE / hertz,
            c,
            0.5 * EDGE / hertz,
            "counted in whole elements: half of one at each end",
        ),
        Claim::at_most(
            format!("{at}: largest error of q / (mu p0) within 0.8 a"),
            "",
            errors.fold(0.0, f64::max),
            0.05,
            "q has a kink at c, of infinite slope, that a mesh of h = a / 9 rounds off over half an element",
        ),
    ]
}
