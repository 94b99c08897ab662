//! Carter's rolling cylinder: creep force and the split into stick and slip.
//!
//! Carter 1926; Johnson, sec. 8.3: creepage xi = (mu a / R)(1 - sqrt(1 - Q / (mu P))), stick over the leading 2 c,
//! c / a = sqrt(1 - Q / (mu P)). It holds for like bodies and for an incompressible one on a rigid plane.
//!
//! Two things make it a steady state that a short run can show. The wall between rim and road gives way sideways, so that
//! a creepage builds its force up over four contact widths and more; here the wall is first wound up, at rest, to about the
//! force that is expected. And a wall of nearly incompressible rubber that is pressed does not roll freely at V / R:
//! creepage is counted from the spin at which the same mesh rolls without a force.

use super::cylinder::{RADIUS, STIFF, half_width, press, relaxing, slice};
use crate::report::{Case, Claim};
use crate::rig::{HELD, explicit, simulate};
use hexroll::Result;
use hexroll::physics::friction::Coulomb;
use hexroll::record::Sample;
use hexroll::scene::{Drive, Friction, InitialVelocity, RimMotion, Stage};

pub const CASE: Case = Case {
    name: "carter",
    theorem: "a_rolling_cylinder_creeps_as_carter_says",
    title: "Carter: creep force of a rolling cylinder",
    source: "Carter 1926; Johnson, Contact Mechanics, sec. 8.3",
    setup: "the cylinder of the line contact, kappa / G = 100, mu = 0.3, viscosity 10 Pa s, pressed by 0.06 mm, wound up at \
            rest to about the expected force, then rolling 10 mm (seven half widths) at 2 m/s at creepages of 0, 0.3, 0.6, \
            -0.6 and 1.2 of mu a / R from free rolling; means over the last quarter",
    everyday: false,
    run,
};

const MU: f64 = 0.3;
const SPEED: f64 = 2.0;
/// Way rolled [m].
const WAY: f64 = 0.01;
/// omega R / V - 1 of free rolling of this wall under this load, found by trial; the run at zero says how nearly.
const FREE: f64 = -9.5e-4;
/// Arc by which the rim leads the road when the wall carries mu P [m]: only where a run starts from.
const WOUND: f64 = 3.25e-5;

/// What a run at a creepage comes to.
struct Rolled {
    /// Q / (mu P), its change from the third quarter of the way to the last, and the load [N].
    share: f64,
    change: f64,
    load: f64,
    /// Share of the contact that sticks.
    stick: f64,
}

/// Rolls at the spin (1 + `creep`) V / R, wound up to `start` of mu P.
fn rolled(creep: f64, start: f64) -> Result<Rolled> {
    // Equal elements wherever the contact comes, and its own width on either side.
    let mut scene = slice(STIFF, (2.0 * WAY + 0.005) / RADIUS, Some(Friction::Coulomb(Coulomb { mu: MU })));
    // With less of it what slides chatters; eta V / (a G) = 0.006.
    scene.body.viscosity = Some(10.0);
    let at = |to: f64| Drive::Velocity { to, ramp: 0.0 };
    let angle = Drive::Displacement { to: WOUND * start / RADIUS, ramp: 2e-3 };
    let wind = relaxing("wind", RimMotion { spin: angle, ..HELD }, 0.02);
    let rim = RimMotion { x: at(SPEED), spin: at((1.0 + creep) * SPEED / RADIUS), ..HELD };
    let roll = Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", WAY / SPEED) };
    scene.stages = if start == 0.0 { vec![press(), roll] } else { vec![press(), wind, roll] };
    let outcome = simulate(&scene)?;
    let mean = |share: f64, column: fn(&Sample) -> f64| outcome.mean("roll", share, column);
    let load = mean(0.25, |s| s.road_fz_N);
    let force = |share: f64| mean(share, |s| s.road_fx_N) / (MU * load);
    Ok(Rolled {
        share: force(0.25),
        // Of both quarters together the mean is half way.
        change: 2.0 * (force(0.25) - force(0.5)),
        load,
        stick: mean(0.25, |s| s.sticking_share),
    })
}

fn run() -> Result<Vec<Claim>> {
    let idle = rolled(FREE, 0.0)?;
    let unit = MU * half_width(&STIFF, idle.load) / RADIUS;
    let mut claims = vec![Claim::at_most(
        "|Q| / (mu P) at the spin taken for free rolling",
        "",
        idle.share.abs(),
        0.01,
        "half of it is an error of the creepage, over mu a / R: 0.005",
    )];
    for wanted in [0.3, 0.6, -0.6, 1.2] {
        let held = (1.0 - f64::abs(wanted)).max(0.0);
        let force = wanted.signum() * (1.0 - held * held);
        let found = rolled(FREE + wanted * unit, force)?;
        claims.push(Claim::absolute(
            format!("Q / (mu P) at xi = {wanted} mu a / R"),
            "",
            found.share,
            force,
            0.02,
            "2 % of mu P: (a / wall)^2 = 1 %, a / R = 3 % of the closed form's small strains, Dundurs' 0.01",
        ));
        claims.push(Claim::absolute(
            format!("stuck share of the contact at xi = {wanted} mu a / R"),
            "",
            found.stick,
            held,
            0.02,
            "the same; node-steps that stick, so not counted in whole elements",
        ));
        claims.push(Claim::at_most(
            format!(
                "change of Q / (mu P) from the third quarter of the way to the last, xi = {wanted} mu a / R"
            ),
            "",
            found.change.abs(),
            0.01,
            "steady: half of the tolerance above",
        ));
    }
    Ok(claims)
}
