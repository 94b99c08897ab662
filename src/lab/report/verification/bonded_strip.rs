//! A thin rubber strip bonded between rigid plates and pressed, in plane strain: nearly incompressible flow sideways.
//!
//! Pressure method with compressible rubber (Chalhoub & Kelly, J. Eng. Mech. 117, 1991; Gent & Lindley 1959 for
//! kappa -> infinity): b the half width, t the thickness, B^2 = 12 G / (kappa t^2), T = tanh(b B)/(b B) the share of the
//! squeezed volume that flows out. The pressure gives kappa (1 - T), for kappa -> infinity 4 G S^2, S = b / t; what the
//! strip resists without pressure is 4/3 G where it cannot flow and 4 G where it does:
//! E_c = kappa (1 - T) + G (4/3 + 8/3 T).
//!
//! It stands for Cook's membrane, which asks for a traction on an edge: a scene has held components, rims and roads, and no
//! surface loads.

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, G, HELD, block, explicit, hold, simulate};
use hexroll::Result;
use hexroll::physics::material::NeoHookean;
use hexroll::scene::{Drive, Element, Law, Method, Rim, RimMotion, Stage};

pub const CASE: Case = Case {
    name: "bonded_strip",
    theorem: "a_bonded_strip_does_not_lock",
    title: "Bonded rubber strip: no volumetric locking",
    source: "pressure method for bonded strips: Gent & Lindley 1959; Chalhoub & Kelly 1991",
    setup: "strip 40 mm wide, 2 mm thick, plane strain (y held), bottom held, top a rigid plate pressed by 0.1 %; \
            kappa / G = 25, 1000, 10^4; 20 x 4 and 40 x 8 elements over the half, symmetry plane held",
    everyday: true,
    run,
};

const HALF: f64 = 0.02;
const THICK: f64 = 0.002;
const STRAIN: f64 = 1e-3;

/// Apparent modulus over G.
fn modulus(ratio: f64, element: Element, [nx, nz]: [usize; 2]) -> Result<f64> {
    let depth = THICK / nz as f64;
    let mut scene = block([HALF, depth, THICK], [nx, 1, nz]);
    scene.body.element = element;
    scene.body.law = Law::NeoHookean(NeoHookean { g0: ratio * G, g1: G });
    scene.holds = vec![hold("all", "y"), hold("x-min", "x"), hold("z-min", "xyz")];
    scene.rim = Some(Rim { nodes: "z-max".into() });
    // Slowest: shear of the layer, pi c_s / t and, where the bulk modulus lets the pressure spread, slower still.
    let shear = std::f64::consts::PI / THICK * (G / DENSITY).sqrt();
    let down = Drive::Displacement { to: -STRAIN * THICK, ramp: 60.0 / shear };
    scene.stages = vec![Stage {
        method: Method::QuasiStatic { kinetic_ratio: 1e-8, residual: 1e-4 },
        mass_damping: shear,
        rim: RimMotion { z: down, ..HELD },
        ..explicit("press", 600.0 / shear)
    }];
    scene.output.sample = 5.0 / shear;
    let outcome = simulate(&scene)?;
    Ok(-outcome.last().rim_fz_N / (HALF * depth * STRAIN * G))
}

fn expected(ratio: f64) -> f64 {
    let reach = HALF / THICK * (12.0 / ratio).sqrt();
    let flows = reach.tanh() / reach;
    ratio * (1.0 - flows) + 4.0 / 3.0 + 8.0 / 3.0 * flows
}

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for ratio in [25.0, 1e3, 1e4] {
        let formula = expected(ratio);
        let [coarse, fine] = [[20, 4], [40, 8]];
        let q = [modulus(ratio, Element::Q1p0, coarse)?, modulus(ratio, Element::Q1p0, fine)?];
        claims.push(Claim::relative(
            format!("kappa / G = {ratio}: E_c / G, q1p0, two meshes extrapolated"),
            "",
            (4.0 * q[1] - q[0]) / 3.0,
            formula,
            0.03,
            "the pressure method neglects the free edges: of order t / b of E_c there, squared in the mean: 2 %",
        ));
        claims.push(Claim::relative(
            format!("kappa / G = {ratio}: q1p0, 20 x 4 elements against 40 x 8"),
            "",
            q[0],
            q[1],
            0.08,
            "second order: the parabola of the flow over four elements, 1 / 4^2",
        ));
        let full = modulus(ratio, Element::Full, coarse)?;
        if ratio > 100.0 {
            let least = if ratio > 2e3 { 2.0 } else { 1.1 };
            claims.push(Claim::at_least(
                format!("kappa / G = {ratio}: full, 20 x 4 elements, over the formula (it locks)"),
                "",
                full / formula,
                least,
                "full integration ties the volume of every point: by 1/10 where q1p0 is off by 1/25, then by twice",
            ));
        }
    }
    Ok(claims)
}
