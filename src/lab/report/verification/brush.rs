//! The brush model: a thin soft tread on a rigid wheel, rolling at a slip angle.
//!
//! Pacejka, Tyre and Vehicle Dynamics, sec. 3.2: bristles of lateral stiffness k = G / t per area, pressure of a thin
//! compressible layer p = M d(x) / t with d(x) = (a^2 - x^2) / (2 R), M = kappa + 4/3 G. With s = tan(alpha) / tan(alpha_m),
//! tan(alpha_m) = 3 mu Fz / C, C = 2 k a^2 w: Fy = mu Fz (3 s - 3 s^2 + s^3) up to s = 1, and mu Fz beyond.

use crate::report::{Case, Claim};
use crate::rig::{G, GROUND, HELD, explicit, scene, simulate};
use hexroll::Result;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::NeoHookean;
use hexroll::scene::*;

pub const CASE: Case = Case {
    name: "brush",
    theorem: "a_thin_tread_is_a_brush",
    title: "Brush model: side force of a thin soft tread",
    source: "Pacejka, Tyre and Vehicle Dynamics, sec. 3.2",
    setup: "tread 1 mm thick on a rigid wheel of 39 mm, kappa = 2/3 G (no lateral strain), 10 mm wide, 600 x 2 x 2 \
            elements, pressed by 0.1 mm, mu = 0.5, rolling 12 mm at 1 m/s",
    everyday: false,
    run,
};

const RADIUS: f64 = crate::rig::given::OUTER_RADIUS;
const TREAD: f64 = 1e-3;
const WIDTH: f64 = 0.01;
const DEPTH: f64 = 1e-4;
const MU: f64 = 0.5;

/// Side force and load at a slip angle.
fn rolled(tangent: f64) -> Result<[f64; 2]> {
    let mut scene = scene(MeshSpec::Ring {
        outer_radius: RADIUS,
        inner_radius: RADIUS - TREAD,
        width: WIDTH,
        elements: [600, 2, 2],
    });
    scene.body.law = Law::NeoHookean(NeoHookean { g0: 2.0 / 3.0 * G, g1: G });
    scene.body.element = Element::Full;
    scene.body.viscosity = Some(1.0);
    scene.rim = Some(Rim { nodes: "inner".into() });
    scene.road = Some(GROUND);
    scene.friction = Some(Friction::Coulomb(Coulomb { mu: MU }));
    scene.output.sample = 2e-4;
    let at = |to: f64| Drive::Velocity { to, ramp: 0.0 };
    let rim = RimMotion { x: at(1.0), y: at(tangent), spin: at(1.0 / (RADIUS - DEPTH / 3.0)), ..HELD };
    // The layer's own frequency is 12 kHz: two milliseconds are slow.
    let z = Drive::Displacement { to: -DEPTH, ramp: 2e-3 };
    let down = Stage { mass_damping: 4e4, rim: RimMotion { z, ..HELD }, ..explicit("press", 4e-3) };
    let roll = Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", 0.012) };
    scene.stages = vec![down, roll];
    let outcome = simulate(&scene)?;
    Ok([-outcome.mean("roll", 0.2, |s| s.road_fy_N), outcome.mean("roll", 0.2, |s| s.road_fz_N)])
}

fn run() -> Result<Vec<Claim>> {
    let a = (2.0 * RADIUS * DEPTH).sqrt();
    let stiffness = 2.0 * G / TREAD * a * a * WIDTH;
    let modulus = 2.0 / 3.0 * G + 4.0 / 3.0 * G;
    let load = modulus / TREAD * WIDTH * 4.0 * a.powi(3) / (6.0 * RADIUS);
    let limit = 3.0 * MU * load / stiffness;
    let mut claims = Vec::new();
    for s in [0.05, 0.3, 0.6, 1.5] {
        let [side, fz] = rolled(s * limit)?;
        let t = s.min(1.0);
        if claims.is_empty() {
            claims.push(Claim::relative(
                "load over that of the thin layer",
                "",
                fz / load,
                1.0,
                0.08,
                "the layer is a third of the contact's half width: its ends and sides carry t / (2 a) more or less",
            ));
        }
        claims.push(Claim::absolute(
            format!("Fy / (mu Fz) at tan(alpha) = {s} of full sliding"),
            "",
            side / (MU * fz),
            3.0 * t - 3.0 * t * t + t.powi(3),
            if s > 1.0 { 5e-3 } else { 0.05 },
            "shear spreads over one thickness at either end, t / (2 a) of the force in adhesion; none when all slides",
        ));
    }
    Ok(claims)
}
