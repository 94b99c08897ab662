//! Hertz's line contact on a drum: the relative curvature 1/R = 1/R1 + 1/R2 outside, 1/R1 - 1/R2 inside.
//!
//! Johnson, Contact Mechanics, sec. 4.2 (c): a^2 = 4 P R / (pi E*), p0 = 2 P / (pi a), P per length.

use super::cylinder::{RADIUS, WIDTH, plane_strain_modulus, press, slice};
use crate::report::{Case, Claim};
use crate::rig::{RUBBER, simulate};
use hexroll::Result;
use hexroll::physics::road::Drum;

pub const CASE: Case = Case {
    name: "hertz_drum",
    theorem: "a_cylinder_pressed_on_a_drum_is_hertzs",
    title: "Hertz: line contact on a drum",
    source: "Johnson, Contact Mechanics, sec. 4.2",
    setup: "the rubber cylinder of the line contact (39 mm) outside and inside a rigid drum of 150 mm, no friction, pressed by 0.06 mm",
    everyday: true,
    run,
};

const DRUM: f64 = 0.15;

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for (name, side) in [("outside", 1.0), ("inside", -1.0)] {
        let [width, peak] = pressed(side)?;
        const REASON: &str = "(a / R)^2, (a / wall)^2 of 1 %, and (h / a)^2 of the mesh, as on the plane";
        let width_name = format!("{name}: half width from the second moment of pressure over Hertz's");
        claims.push(Claim::relative(width_name, "", width, 1.0, 0.02, REASON));
        claims.push(Claim::relative(
            format!("{name}: largest pressure over p0"),
            "",
            peak,
            1.0,
            0.02,
            REASON,
        ));
    }
    Ok(claims)
}

/// Half width and largest pressure over Hertz's.
fn pressed(side: f64) -> Result<[f64; 2]> {
    let mut scene = slice(RUBBER, 0.12, None);
    let curvature = side / DRUM;
    let axes = [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    scene.road = Some(Drum { point: axes[0], normal: axes[1], axis: axes[2], curvature, speed: 0.0 }.into());
    scene.stages = vec![press()];
    let outcome = simulate(&scene)?;
    let contact = &outcome.snapshots[0].contact;
    let force = outcome.last().road_fz_N;
    let radius = 1.0 / (1.0 / RADIUS + curvature);
    let a = (4.0 * force / WIDTH * radius / (std::f64::consts::PI * plane_strain_modulus(&RUBBER))).sqrt();
    let p0 = 2.0 * force / WIDTH / (std::f64::consts::PI * a);
    let at = |n: u32| outcome.snapshots[0].x[n as usize][0];
    // From the second moment, which no single node decides: a^2 = 4 <x^2>.
    let moment: f64 = contact.iter().map(|n| n.force[2] * at(n.node).powi(2)).sum();
    let peak = contact.iter().map(|n| n.pressure / p0).fold(0.0, f64::max);
    Ok([2.0 * (moment / force).sqrt() / a, peak])
}
