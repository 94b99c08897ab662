//! Hertz's point contact: a quarter of a rounded block on a rigid plane without friction.
//!
//! Johnson, Contact Mechanics, sec. 4.2 (a): a^3 = 3 P R / (4 E*), p0 = 3 P / (2 pi a^2), p = p0 sqrt(1 - r^2 / a^2).

use std::f64::consts::PI;

use crate::report::{Case, Claim};
use crate::rig::{GROUND, HELD, RUBBER, block, elastic_constants, explicit, hold, simulate_with};
use hexroll::Result;
use hexroll::cpu::Precision;
use hexroll::error::Error;
use hexroll::model::Model;
use hexroll::scene::*;

pub const CASE: Case = Case {
    name: "hertz_point",
    theorem: "a_pressed_ball_is_hertzs",
    title: "Hertz: point contact",
    source: "Johnson, Contact Mechanics, sec. 4.2",
    setup: "quarter block of 10 mm, its lower face a paraboloid of radius 50 mm, symmetry planes held, 24 x 24 x 20 \
            elements that grow twentyfold away from the contact, pressed by 0.025 mm, no friction",
    everyday: false,
    run,
};

const EDGE: f64 = 0.01;
const RADIUS: f64 = 0.05;

fn scene() -> Scene {
    let mut scene = block([EDGE; 3], [24, 24, 20]);
    scene.body.grading = Grading { ratio: [20.0; 3], fine_arc: 0.0 };
    scene.holds = vec![hold("x-min", "x"), hold("y-min", "y")];
    scene.rim = Some(Rim { nodes: "z-max".into() });
    scene.road = Some(GROUND);
    scene.output.sample = 1e-4;
    let z = Drive::Displacement { to: -2.5e-5, ramp: 1.5e-3 };
    scene.stages = vec![Stage {
        method: Method::QuasiStatic { kinetic_ratio: 1e-7, residual: 3e-4 },
        // Twice the block's own frequency, c_s / (4 L) of 1.2 kHz.
        mass_damping: 1.5e4,
        rim: RimMotion { z, ..HELD },
        ..explicit("press", 0.02)
    }];
    scene
}

fn run() -> Result<Vec<Claim>> {
    let scene = scene();
    let mut mesh = Model::new(&scene)?.mesh;
    for x in &mut mesh.nodes {
        x[2] += (x[0] * x[0] + x[1] * x[1]) / (2.0 * RADIUS) * (1.0 - x[2] / EDGE);
    }
    let model = Model::from_mesh(mesh, &scene.body).map_err(|element| Error::Inverted {
        step: 0,
        time: 0.0,
        element,
    })?;
    let outcome = simulate_with(&scene, model, Precision::F64, 1)?;
    let snapshot = &outcome.snapshots[0];
    let [e, nu] = elastic_constants(&RUBBER);
    // Four quarters make the ball.
    let force = 4.0 * outcome.last().road_fz_N;
    let a = (0.75 * force * RADIUS * (1.0 - nu * nu) / e).cbrt();
    let p0 = 1.5 * force / (PI * a * a);
    let radius = |n: u32| snapshot.x[n as usize][0].hypot(snapshot.x[n as usize][1]) / a;
    let moment: f64 = snapshot.contact.iter().map(|n| n.force[2] * radius(n.node).powi(2)).sum();
    let touching = || snapshot.contact.iter().filter(|n| n.force[2] > 0.0);
    let off = |n: &hexroll::record::ContactNode| {
        (n.pressure / p0 - (1.0 - radius(n.node).powi(2)).max(0.0).sqrt()).abs()
    };
    let core = touching().filter(|n| radius(n.node) < 0.8).map(off).fold(0.0, f64::max);
    let peak = touching().map(|n| n.pressure / p0).fold(0.0, f64::max);
    const REASON: &str = "(a / L)^2 and (a / R)^2 of 1 %, (h / a)^2 of the mesh: 2 %";
    Ok(vec![
        Claim::at_least("block over contact radius", "", EDGE / a, 7.0, "a half-space needs a << L"),
        // <r^2> = 2/5 a^2
        Claim::relative(
            "radius from the second moment of pressure over Hertz's",
            "",
            (2.5 * moment / outcome.last().road_fz_N).sqrt(),
            1.0,
            0.02,
            REASON,
        ),
        Claim::relative("largest pressure over p0", "", peak, 1.0, 0.03, REASON),
        Claim::at_most("largest error of p / p0 within 0.8 a", "", core, 0.05, "the same, at single nodes"),
    ])
}
