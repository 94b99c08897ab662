//! Samples as rubber is tested, as scenes: components of faces follow a motion, their reaction is recorded.

use crate::report::{Case, Claim};
use crate::rig::{Outcome, shipped, simulate};
use hexroll::Result;

pub const CASE: Case = Case {
    name: "coupons",
    theorem: "samples_in_tension_and_shear_carry_what_the_textbook_says",
    title: "Samples drawn and sheared",
    source: "Treloar's incompressible neo-Hookean solid: nominal stress 2 C10 (l - l^-2), 2 C10 (l - l^-3), energy C10 (l^2 + 2/l \
             - 3); simple shear 2 C10 g",
    setup: "cube of 10 mm, C10 = 0.9 MPa, kappa = 2 GPa; faces moved by [[motion]], free sides; explicit, relaxed to rest",
    everyday: true,
    run,
};

/// Mean force on the last set over the last window of a stage [N].
fn force(outcome: &Outcome, stage: &str, component: usize) -> f64 {
    let row = outcome.samples.iter().rposition(|s| s.stage == stage).expect("the stage has windows");
    let set = outcome.reactions[row].iter().find(|r| r.set == "z-max").expect("the scene moves this face");
    set.components[component].expect("the scene moves it so")[1]
}

fn run() -> Result<Vec<Claim>> {
    const REASON: &str = "kappa is 1,111 G, not infinite: stress / kappa is 5e-4";
    let drawn = |stem: &str| simulate(&shipped::<&str>(stem, &[]));
    let (uniaxial, planar) = (drawn("coupon_uniaxial")?, drawn("coupon_planar")?);
    let sheared = drawn("coupon_shear_turned")?;
    let mises = |k: usize| sheared.snapshots[sheared.snapshots.len() - k].von_mises[0];
    let tension = 1.8 * (1.5 - 1.0 / 2.25) * 100.0;
    let pure_shear = 1.8 * (1.5 - 1.0 / 3.375) * 100.0;
    Ok(vec![
        Claim::relative(
            "uniaxial stretch 1.5: force",
            "N",
            force(&uniaxial, "draw", 2),
            tension,
            1e-3,
            REASON,
        ),
        Claim::relative("stored energy", "J", uniaxial.last().strain_J, 0.525, 1e-3, REASON),
        Claim::relative(
            "planar stretch 1.5: force",
            "N",
            force(&planar, "draw", 2),
            pure_shear,
            1e-3,
            REASON,
        ),
        Claim::relative(
            "sheared by 1: force",
            "N",
            force(&sheared, "shear", 0),
            180.0,
            1e-3,
            "the mean over the last window of a smooth ramp, of which 3e-4 is missing",
        ),
        Claim::relative(
            "turned by 360 degrees: von Mises over that before",
            "",
            mises(1) / mises(2),
            1.0,
            1e-11,
            "round-off of positions, times kappa / G",
        ),
    ])
}
