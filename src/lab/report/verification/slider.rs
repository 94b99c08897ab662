//! A sliding block whose friction depends on speed: one degree of freedom, one equation of motion.
//!
//! m dv/dt = -mu(v) m g. Viscous: v = v0 exp(-slope g t). mu = a + c exp(-v/v0): with w = exp(v/v0),
//! a w + c = (a w0 + c) exp(-a g t / v0). Pressure enters as the block's weight over its base. Stribeck with a drive
//! faster than the fall of the curve slides steadily: no chatter (the slope of mu(v) decides, Heslot et al. 1994).

use crate::report::{Case, Claim};
use crate::rig::{GROUND, HELD, Outcome, block, explicit, simulate};
use hexroll::Result;
use hexroll::physics::friction::{PressureVelocity, Stribeck, Viscous};
use hexroll::physics::road::Plane;
use hexroll::scene::*;

pub const CASE: Case = Case {
    name: "slider",
    theorem: "a_slider_follows_its_equation_of_motion",
    title: "A slider with friction that depends on speed and pressure",
    source: "the equation of motion of a block, integrated in closed form",
    setup: "rubber block of 20 x 20 x 10 mm sliding on a level road; a flat block of 40 x 20 x 5 mm on a moving road; a pad \
            under a held plate on a moving road",
    everyday: true,
    run,
};

const GRAVITY: f64 = 9.81;
const SIZE: [f64; 3] = [0.02, 0.02, 0.01];

/// Settled with mass damping while it moves at `speed` with the road, which then stands still.
fn slider(law: Friction, speed: f64, duration: f64) -> Scene {
    let mut scene = block(SIZE, [2, 2, 1]);
    scene.body.viscosity = Some(100.0);
    scene.body.velocity = [speed, 0.0, 0.0];
    scene.road = Some(GROUND);
    scene.friction = Some(law);
    scene.gravity = [0.0, 0.0, -GRAVITY];
    scene.stages = vec![explicit("slide", duration)];
    scene.output.sample = duration / 50.0;
    scene
}

fn speed_at_end(outcome: &Outcome) -> f64 {
    let mass: f64 = outcome.model.mass.iter().sum();
    let v = &outcome.snapshots[outcome.snapshots.len() - 1].v;
    v.iter().zip(&outcome.model.mass).map(|(v, m)| v[0] * m).sum::<f64>() / mass
}

fn viscous() -> Result<Claim> {
    let (slope, v0, time) = (2.0, 0.5, 0.05);
    let outcome = simulate(&slider(Friction::Viscous(Viscous { slope }), v0, time))?;
    Ok(Claim::relative(
        "viscous, slope 2 s/m: speed after 50 ms over v0 exp(-slope g t)",
        "",
        speed_at_end(&outcome) / (v0 * (-slope * GRAVITY * time).exp()),
        1.0,
        5e-3,
        "the block lands on the road with its weight at once: some of the normal force comes a bounce late",
    ))
}

fn falling() -> Result<Claim> {
    let (a, c, scale, v0, time) = (0.3, 0.5, 0.1, 0.4, 0.05);
    let law = Friction::PressureVelocity(PressureVelocity { a, b: 0.0, pressure: 1.0, c, speed: scale });
    let outcome = simulate(&slider(law, v0, time))?;
    let w = ((a * (v0 / scale).exp() + c) * (-a * GRAVITY * time / scale).exp() - c) / a;
    Ok(Claim::relative(
        "mu = 0.3 + 0.5 exp(-v / 0.1 m/s): speed after 50 ms",
        "m/s",
        speed_at_end(&outcome),
        scale * w.ln(),
        5e-3,
        "the same",
    ))
}

/// A road that slides along under a flat block, at two weights: mu falls with pressure.
fn pressed() -> Result<Vec<Claim>> {
    let (a, b, scale) = (0.1, 0.3, 250.0);
    let size = [0.04, 0.02, 0.005];
    let mut claims = Vec::new();
    for gravity in [GRAVITY, 3.0 * GRAVITY] {
        let law = Friction::PressureVelocity(PressureVelocity { a, b, pressure: scale, c: 0.0, speed: 1.0 });
        let mut scene = slider(law, 0.0, 0.01);
        scene.body.mesh = MeshSpec::Block { size, elements: [8, 4, 1] };
        scene.body.viscosity = Some(300.0);
        scene.gravity = [0.0, 0.0, -gravity];
        scene.road =
            Some(Road::Plane(Plane { point: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [1.0, 0.0, 0.0] }));
        // Damped to rest first: the block would bounce on its own weight.
        scene.stages.insert(0, Stage { mass_damping: 2e3, ..explicit("settle", 0.01) });
        let outcome = simulate(&scene)?;
        let mu = outcome.mean("slide", 1.0, |s| s.road_fx_N) / outcome.mean("slide", 1.0, |s| s.road_fz_N);
        let pressure = outcome.model.density * gravity * size[2];
        claims.push(Claim::relative(
            format!("mu = 0.1 + 0.3 exp(-p / 250 Pa): friction over load at {pressure:.0} Pa"),
            "",
            mu,
            a + b * (-pressure / scale).exp(),
            0.02,
            "friction tilts the block: p varies by 10 % along it, which the curve's bend turns into 1 %",
        ));
    }
    Ok(claims)
}

/// A rubber pad under a plate on a road that slides where mu rises with speed again.
fn steady() -> Result<Vec<Claim>> {
    let (kinetic, still, fall, slope) = (0.2, 0.5, 0.02, 0.1);
    let law = Friction::Stribeck(Stribeck { still, kinetic, speed: fall, slope });
    let speed = 0.5;
    let mut scene = block(SIZE, [4, 4, 2]);
    scene.body.viscosity = Some(50.0);
    scene.road =
        Some(Road::Plane(Plane { point: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [speed, 0.0, 0.0] }));
    scene.friction = Some(law);
    scene.rim = Some(Rim { nodes: "z-max".into() });
    let down = Drive::Displacement { to: -2e-4, ramp: 1e-2 };
    let press = Stage { rim: RimMotion { z: down, ..HELD }, ..explicit("press", 0.015) };
    scene.stages = vec![press, explicit("slide", 0.02)];
    scene.output.sample = 2e-4;
    let outcome = simulate(&scene)?;
    let mean = outcome.mean("slide", 1.0, |s| s.road_fx_N);
    let square = outcome.mean("slide", 1.0, |s| (s.road_fx_N - mean).powi(2));
    Ok(vec![
        Claim::relative(
            "Stribeck at 0.5 m/s, 25 falls beyond its minimum: friction over load",
            "",
            mean / outcome.mean("slide", 1.0, |s| s.road_fz_N),
            kinetic + slope * speed,
            1e-6,
            "steady sliding at the speed of the road: nothing is left to approximate",
        ),
        Claim::at_most(
            "the same: scatter of the friction force over its mean",
            "",
            square.sqrt() / mean.abs(),
            5e-3,
            "rising mu(v) damps: nothing may chatter",
        ),
        Claim::at_most(
            "the same: sticking share",
            "",
            outcome.mean("slide", 1.0, |s| s.sticking_share),
            0.0,
            "every node slides",
        ),
    ])
}

fn run() -> Result<Vec<Claim>> {
    Ok([vec![viscous()?, falling()?], pressed()?, steady()?].concat())
}
