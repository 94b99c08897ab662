//! A bar that meets a rigid wall: one wave up and down, and it leaves as fast as it came.
//!
//! St Venant (Timoshenko & Goodier, Theory of Elasticity, sec. 168): contact lasts 2 L / c, the force is rho c v A
//! all the while, and all of the momentum is returned. With the sides held the bar's waves are plane, c^2 = (kappa +
//! 4/3 G) / rho.

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, G, KAPPA, block, hold, simulate};
use hexroll::Result;
use hexroll::physics::road::Plane;
use hexroll::scene::Road;

pub const CASE: Case = Case {
    name: "bar_impact",
    theorem: "a_bar_meets_a_wall_as_st_venant_says",
    title: "A bar meets a rigid wall, once and a hundred times",
    source: "St Venant's bar: force rho c v A for 2 L / c (Timoshenko & Goodier, sec. 168)",
    setup: "bar of 0.1 m, 200 elements of 0.5 mm, sides held, 0.1 m/s onto a wall; then 25 elements between gravity \
            and the wall for a hundred bounces",
    everyday: true,
    run,
};

const LENGTH: f64 = 0.1;
const SPEED: f64 = 0.1;
const WALL: Road = Road::Plane(Plane { point: [0.0; 3], normal: [1.0, 0.0, 0.0], velocity: [0.0; 3] });

fn once() -> Result<Vec<Claim>> {
    let count = 200;
    let h = LENGTH / count as f64;
    let c = ((KAPPA + 4.0 / 3.0 * G) / DENSITY).sqrt();
    let mut scene = block([LENGTH, h, h], [count, 1, 1]);
    scene.holds = vec![hold("all", "yz")];
    scene.road = Some(WALL);
    scene.body.velocity = [-SPEED, 0.0, 0.0];
    let contact = 2.0 * LENGTH / c;
    scene.output.sample = contact / 100.0;
    scene.stages[0].duration = 1.5 * contact;
    let outcome = simulate(&scene)?;
    let force = DENSITY * c * SPEED * h * h;
    let during = |s: &&hexroll::record::Sample| (0.1..0.9).contains(&(s.time_s / contact));
    let rows: Vec<f64> = outcome.samples.iter().filter(during).map(|s| s.road_fx_N).collect();
    let impulse: f64 = outcome.samples.iter().map(|s| s.road_fx_N * scene.output.sample).sum();
    let last = outcome.samples.iter().rev().find(|s| s.road_fx_N > 0.05 * force).map_or(0.0, |s| s.time_s);
    let mass: f64 = outcome.model.mass.iter().sum();
    let v = &outcome.snapshots[0].v;
    let momentum: f64 = v.iter().zip(&outcome.model.mass).map(|(v, m)| v[0] * m).sum();
    let start = 0.5 * mass * SPEED * SPEED;
    let loss = -outcome.last().contact_work_J / start;
    Ok(vec![
        Claim::relative(
            "force while it lasts over rho c v A",
            "",
            rows.iter().sum::<f64>() / rows.len() as f64 / force,
            1.0,
            5e-3,
            "the front is a few elements wide: h / L",
        ),
        Claim::relative("impulse over 2 m v", "", impulse / (2.0 * mass * SPEED), 1.0, 0.01, "2 h / L"),
        Claim::relative(
            "duration of contact over 2 L / c",
            "",
            last / contact,
            1.0,
            0.03,
            "windows of 1 %, and a front that dispersion has widened to some elements on a way of 400",
        ),
        Claim::relative("speed after over before", "", momentum / mass / SPEED, 1.0, 0.01, "2 h / L"),
        Claim::absolute(
            "energy lost at the contact over m v^2 / 2",
            "",
            loss,
            1.0 / 400.0,
            5e-4,
            "the end node has h / 2 of the bar and stops at once: h / (2 L) of the kinetic energy",
        ),
        Claim::at_least("deepest gap", "m", outcome.totals.ledger.worst_gap, 0.0, "contact is exact"),
    ])
}

fn often() -> Result<Vec<Claim>> {
    let count = 25;
    let h = LENGTH / count as f64;
    let mut scene = block([LENGTH, h, h], [count, 1, 1]);
    scene.holds = vec![hold("all", "yz")];
    scene.road = Some(WALL);
    let (g, drop) = (9.81, 1e-3);
    scene.gravity = [-g, 0.0, 0.0];
    scene.body.offset = [drop, 0.0, 0.0];
    // Free flight up and down from the first drop.
    let flight = 2.0 * (2.0 * drop / g).sqrt();
    scene.output.sample = flight / 20.0;
    scene.stages[0].duration = 100.0 * flight;
    let outcome = simulate(&scene)?;
    let mass: f64 = outcome.model.mass.iter().sum();
    let start = mass * g * drop;
    // What is there: kinetic and stored energy and height, from the works on the body.
    let total = |s: &hexroll::record::Sample| s.kinetic_J + s.strain_J - s.external_work_J;
    let highest = outcome.samples.iter().map(|s| total(s) / start).fold(f64::NEG_INFINITY, f64::max);
    let grows = outcome.samples.windows(2).map(|w| w[1].contact_work_J - w[0].contact_work_J);
    let touched =
        outcome.samples.windows(2).filter(|w| w[0].road_fx_N == 0.0 && w[1].road_fx_N > 0.0).count();
    Ok(vec![
        Claim::at_least("bounces", "", touched as f64, 50.0, "it falls again and again"),
        Claim::at_most(
            "kinetic + stored energy - work of gravity, over m g h, at most",
            "",
            highest,
            0.01,
            "starts at zero and may only fall; 1 % for the second-order error of the stored energy in an impact",
        ),
        Claim::at_most(
            "largest work of the contact in a window over m g h",
            "",
            grows.fold(f64::NEG_INFINITY, f64::max) / start,
            1e-14,
            "normal contact never gives energy: round-off of a sum",
        ),
        Claim::at_most(
            "error of the work balance over its largest term",
            "",
            outcome.totals.ledger.worst_balance / outcome.totals.ledger.largest_term,
            1e-11,
            "round-off of some hundred thousand steps",
        ),
    ])
}

fn run() -> Result<Vec<Claim>> {
    Ok([once()?, often()?].concat())
}
