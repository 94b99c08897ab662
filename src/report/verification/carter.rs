//! Carter's rolling cylinder: creep force and the split into stick and slip.
//!
//! Carter 1926; Johnson, sec. 8.3: creepage xi = (mu a / R)(1 - sqrt(1 - Q / (mu P))), stick over the leading 2 c,
//! c / a = sqrt(1 - Q / (mu P)). It holds for like bodies and for an incompressible one on a rigid plane.

use super::cylinder::{RADIUS, STIFF, half_width, press, slice};
use crate::Result;
use crate::report::bench::{HELD, explicit, simulate};
use crate::report::{Case, Claim};
use crate::scene::{Drive, Friction, InitialVelocity, RimMotion, Stage};

pub const CASE: Case = Case {
    name: "carter",
    title: "Carter: creep force of a rolling cylinder",
    source: "Carter 1926; Johnson, Contact Mechanics, sec. 8.3",
    setup: "the cylinder of the line contact, mu = 0.3, viscosity 2 Pa s, pressed by 0.06 mm, rolling 9 mm at 2 m/s at \
            creepages of 0, 0.3, 0.6 and 1.2 of mu a / R; R_free from the run at zero",
    everyday: false,
    run,
};

const MU: f64 = 0.3;
const SPEED: f64 = 2.0;
/// Way rolled: more than three contact widths [m].
const WAY: f64 = 0.009;

/// Q / (mu P), the load and the stuck share of the contact at a spin over V / R of 1 + `creep`.
fn rolled(creep: f64) -> Result<[f64; 3]> {
    // Equal elements wherever the contact comes, and its own width on either side.
    let mut scene = slice(STIFF, (2.0 * WAY + 0.006) / RADIUS, Some(Friction::Coulomb { mu: MU }));
    scene.body.viscosity = Some(2.0);
    let at = |to: f64| Drive::Velocity { to, ramp: 0.0 };
    let rim = RimMotion { x: at(SPEED), spin: at((1.0 + creep) * SPEED / RADIUS), ..HELD };
    let roll = Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", WAY / SPEED) };
    scene.stages = vec![press(), roll];
    let outcome = simulate(&scene)?;
    let mean = |column: fn(&crate::record::Sample) -> f64| outcome.mean("roll", 0.25, column);
    let (q, p) = (mean(|s| s.road_fx_N), mean(|s| s.road_fz_N));
    Ok([q / (MU * p), p, mean(|s| s.sticking_share)])
}

/// xi R / (mu a) at a share of the force.
fn creepage(share: f64) -> f64 {
    share.signum() * (1.0 - (1.0 - share.abs()).sqrt())
}

fn run() -> Result<Vec<Claim>> {
    let [idle, load, _] = rolled(0.0)?;
    let unit = MU * half_width(&STIFF, load) / RADIUS;
    let mut claims = vec![Claim::at_most(
        "|Q| / (mu P) at omega = V / R",
        "",
        idle.abs(),
        0.15,
        "R_free is not quite R: pressed by 0.06 of 39 mm it may differ by as much",
    )];
    for wanted in [0.3, 0.6, 1.2] {
        // The spin whose creepage from free rolling is the wanted one.
        let [share, p, stick] = rolled((wanted - creepage(idle)) * unit)?;
        let held = (1.0 - wanted).max(0.0);
        claims.push(Claim::absolute(
            format!("Q / (mu P) at xi = {wanted} mu a / R"),
            "",
            share,
            1.0 - held * held,
            0.02,
            "2 %: (h / a)^2 of the mesh, (a / R)^2 of the closed form, Dundurs' 0.01",
        ));
        claims.push(Claim::absolute(
            format!("stuck share of the contact at xi = {wanted} mu a / R"),
            "",
            stick,
            held,
            0.08,
            "one element of twenty at the edge, and edges that touch by half a node",
        ));
        claims.push(Claim::relative("load over the load at zero", "", p / load, 1.0, 0.01, "the same depth"));
    }
    Ok(claims)
}
