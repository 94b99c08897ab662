//! Hertz's line contact: a cylinder on a rigid plane without friction.
//!
//! K. L. Johnson, Contact Mechanics, sec. 4.2 (c): a^2 = 4 P R / (pi E*), p0 = 2 P / (pi a),
//! p = p0 sqrt(1 - x^2 / a^2), P per length.

use super::cylinder::{WIDTH, half_width, press, slice};
use crate::report::{Case, Claim};
use crate::rig::{RUBBER, simulate};
use hexroll::Result;

pub const CASE: Case = Case {
    name: "hertz_line",
    theorem: "a_pressed_cylinder_is_hertzs",
    title: "Hertz: line contact",
    source: "Johnson, Contact Mechanics, sec. 4.2",
    setup: "rubber cylinder (39 mm, rim at 27 mm, kappa / G = 25) in plane strain on a rigid plane, no friction, \
            pressed by 0.06 mm; elements of 0.15 mm, about twenty over the contact",
    everyday: true,
    run,
};

fn run() -> Result<Vec<Claim>> {
    let mut scene = slice(RUBBER, 0.12, None);
    scene.stages = vec![press()];
    let outcome = simulate(&scene)?;
    let contact = &outcome.snapshots[0].contact;
    let force = outcome.last().road_fz_N;
    let a = half_width(&RUBBER, force);
    let p0 = 2.0 * force / WIDTH / (std::f64::consts::PI * a);
    let at = |n: u32| outcome.snapshots[0].x[n as usize][0];
    // Both ends of a node row have half its force and area.
    let inside: Vec<(f64, f64)> =
        (contact.iter().filter(|n| n.force[2] > 0.0)).map(|n| (at(n.node) / a, n.pressure / p0)).collect();
    let expected = |s: f64| (1.0 - s * s).max(0.0).sqrt();
    let core: Vec<f64> =
        inside.iter().filter(|(s, _)| s.abs() < 0.8).map(|&(s, p)| (p - expected(s)).abs()).collect();
    // From the second moment, which no single node decides: a^2 = 4 <x^2>.
    let moment: f64 = contact.iter().map(|n| n.force[2] * at(n.node).powi(2)).sum();
    let peak = inside.iter().map(|(_, p)| *p).fold(0.0, f64::max);
    Ok(vec![
        Claim::at_least(
            "contact half width over wall thickness, inverse",
            "",
            0.012 / a,
            6.0,
            "a half-space needs a << wall",
        ),
        Claim::relative(
            "half width from the second moment of pressure over Hertz's",
            "",
            2.0 * (moment / force).sqrt() / a,
            1.0,
            0.02,
            "(a / R)^2, (a / wall)^2 of 1 %, and (h / a)^2 of the mesh",
        ),
        Claim::relative("largest pressure over p0", "", peak, 1.0, 0.02, "the same"),
        Claim::at_most(
            "largest error of p / p0 within 0.8 a",
            "",
            core.into_iter().fold(0.0, f64::max),
            0.03,
            "the same, and a node's pressure is a mean over its share of the surface",
        ),
    ])
}
