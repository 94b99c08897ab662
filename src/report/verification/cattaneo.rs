//! Cattaneo's and Mindlin's partial slip: a pressed cylinder is then pushed sideways, less than mu P.
//!
//! Johnson, sec. 7.2: the middle |x| < c sticks, c / a = sqrt(1 - Q / (mu P)); q = mu p0 sqrt(1 - x^2/a^2) outside, less
//! mu p0 (c / a) sqrt(1 - x^2/c^2) inside. An incompressible body on a rigid plane has no coupling of p and q.

use super::cylinder::{EDGE, STIFF, WIDTH, half_width, press, relaxing, slice};
use crate::Result;
use crate::record::ContactState;
use crate::report::bench::{HELD, simulate};
use crate::report::{Case, Claim};
use crate::scene::{Drive, Friction, RimMotion};

pub const CASE: Case = Case {
    name: "cattaneo_mindlin",
    title: "Cattaneo and Mindlin: partial slip under a tangential load",
    source: "Johnson, Contact Mechanics, sec. 7.2",
    setup: "the cylinder of the line contact, mu = 1, pressed by 0.06 mm and then moved sideways by 0.05 mm",
    everyday: false,
    run,
};

const MU: f64 = 1.0;

fn run() -> Result<Vec<Claim>> {
    let mut scene = slice(STIFF, 0.12, Some(Friction::Coulomb { mu: MU }));
    let aside = Drive::Displacement { to: 5e-5, ramp: 3e-3 };
    scene.stages = vec![press(), relaxing("push", RimMotion { x: aside, ..HELD }, 0.02)];
    let outcome = simulate(&scene)?;
    let snapshot = &outcome.snapshots[1];
    let last = outcome.last();
    let (force, push) = (last.road_fz_N, -last.road_fx_N);
    let a = half_width(&STIFF, force);
    let share = push / (MU * force);
    let c = (1.0 - share).sqrt();
    let p0 = 2.0 * force / WIDTH / (std::f64::consts::PI * a);
    let touching = || snapshot.contact.iter().filter(|n| n.state != ContactState::Free);
    let s = |n: u32| snapshot.x[n as usize][0] / a;
    let semi = |s: f64, a: f64| (1.0 - s * s / (a * a)).max(0.0).sqrt();
    let expected = |s: f64| semi(s, 1.0) - c * semi(s, c);
    let errors = touching().filter(|n| s(n.node).abs() < 0.8).map(|n| {
        let q = -n.force[0] / n.area / (MU * p0);
        (q - expected(s(n.node))).abs()
    });
    // At rest everything sticks; what slipped on the way is at the limit of friction. Two nodes a row.
    let within = touching().filter(|n| -n.force[0] < 0.98 * MU * n.force[2]).count() / 2;
    let stuck = 0.5 * within as f64 * EDGE / a;
    Ok(vec![
        Claim::at_least("Q / (mu P)", "", share, 0.3, "the load is partial: neither all stuck"),
        Claim::at_most("Q / (mu P)", "", share, 0.9, "nor all sliding"),
        Claim::absolute(
            "half width of the stuck middle over a",
            "",
            stuck,
            c,
            0.12,
            "counted in whole elements: h / a",
        ),
        Claim::at_most(
            "largest error of q / (mu p0) within 0.8 a",
            "",
            errors.fold(0.0, f64::max),
            0.06,
            "q has a kink at c that a mesh rounds off: its slope there is infinite, h / a of it is sqrt(h / a) / 4",
        ),
    ])
}
