//! A block on a slope, above and below the angle of friction, at three sizes.
//!
//! a = g (sin th - mu cos th), whatever the size. An FE code was 31 % wrong at 1/10 scale.

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, G, GROUND, Outcome, block, explicit, simulate};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::run::stability;
use hexroll::scene::{Friction, Method, Scene, Stage};

pub const CASE: Case = Case {
    name: "slope",
    theorem: "a_block_slides_down_a_slope",
    title: "A block on a slope of 30 degrees",
    source: "Newton and Coulomb: a = g (sin th - mu cos th)",
    setup: "viscous rubber block (damping ratio 0.03 of its highest mode), 6 x 3 x 3 elements, 1 m, 0.1 m and 10 mm long, \
            settled by mass damping, then left to slide with mu = 0.4 or to stay with mu = tan th / 0.9",
    everyday: true,
    run,
};

const GRAVITY: f64 = 9.81;
const ANGLE: f64 = std::f64::consts::FRAC_PI_6;

fn slope(size: f64, mu: f64, steps: f64) -> Result<Scene> {
    let mut scene = block([size, 0.5 * size, 0.5 * size], [6, 3, 3]);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu }));
    scene.road = Some(GROUND);
    scene.gravity = [GRAVITY * ANGLE.sin(), 0.0, -GRAVITY * ANGLE.cos()];
    let dt = 0.9 * stability::element_bound(&Model::new(&scene)?)?;
    scene.body.viscosity = Some(0.03 * 1.5 * scene.body.law.wave_modulus() * dt / 2.0);
    // Near critical for the slowest mode: shear over the height.
    let alpha = std::f64::consts::PI * (G / DENSITY).sqrt() / size;
    let method = Method::QuasiStatic { kinetic_ratio: f64::INFINITY, residual: 1e-6 };
    let settle = Stage { method, mass_damping: alpha, ..explicit("settle", 100.0 / alpha) };
    scene.stages = vec![settle, explicit("free", steps * dt)];
    scene.output.sample = 50.0 * dt;
    Ok(scene)
}

/// Speed down the slope at a snapshot [m/s].
fn speed(outcome: &Outcome, k: usize) -> f64 {
    let mass: f64 = outcome.model.mass.iter().sum();
    outcome.snapshots[k].v.iter().zip(&outcome.model.mass).map(|(v, m)| v[0] * m).sum::<f64>() / mass
}

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for size in [1.0, 0.1, 0.01] {
        let outcome = simulate(&slope(size, 0.4, 2000.0)?)?;
        let time = outcome.snapshots[1].time - outcome.snapshots[0].time;
        claims.push(Claim::relative(
            format!("{size} m long: acceleration"),
            "m/s2",
            (speed(&outcome, 1) - speed(&outcome, 0)) / time,
            GRAVITY * (ANGLE.sin() - 0.4 * ANGLE.cos()),
            5e-3,
            "what is left of the settling, over 2000 steps",
        ));
    }
    let outcome = simulate(&slope(0.1, ANGLE.tan() / 0.9, 14_000.0)?)?;
    let [before, after] = [&outcome.snapshots[0], &outcome.snapshots[1]];
    let drift = before.x.iter().zip(&after.x).map(|(a, b)| (b[0] - a[0]).abs()).fold(0.0, f64::max);
    claims.push(Claim::at_most(
        "0.1 m long, below the angle of friction: drift over the length in 10,000 steps",
        "",
        drift / 0.1,
        1e-6,
        "it settled to 1e-6 of its forces; nodes that stick do not move at all",
    ));
    Ok(claims)
}
