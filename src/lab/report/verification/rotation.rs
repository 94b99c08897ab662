//! Rigid rotation makes no force: a block spun ten turns, a wheel that rolls without load.

use std::f64::consts::TAU;

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, Driver, G, HELD, block, explicit, given, simulate, wheel};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::physics::tensor::{cross, sub};
use hexroll::run::stability;
use hexroll::scene::{Drive, Element, InitialVelocity, RimMotion, Stage};

pub const CASE: Case = Case {
    name: "rotation",
    theorem: "rigid_rotation_makes_no_force",
    title: "Ten turns of a free block; a wheel that rolls without load",
    source: "conservation of angular momentum; steady spin of an elastic body; an unloaded wheel pushes nothing",
    setup: "block of 20 mm, 4 x 4 x 4 elements, 200 rad/s about a skew axis, ten turns; the paper's wheel just \
            touching the road, 0.26 m/s and 6.67 rad/s, mu = 1, 10 ms",
    everyday: true,
    run,
};

const SPIN: f64 = 200.0;

/// Drift of the angular momentum over its size, and the largest strain of an edge after ten turns.
fn ten_turns(element: Element) -> Result<[f64; 2]> {
    let edge = 0.02;
    let mut scene = block([edge; 3], [4; 3]);
    scene.body.element = element;
    let model = Model::new(&scene)?;
    let mut driver = Driver::new(&model, &scene)?;
    let axis = [1.0, 2.0, 2.0].map(|c| SPIN * c / 3.0);
    let centre = [0.5 * edge; 3];
    let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|&x| cross(axis, sub(x, centre))).collect();
    driver.engine.set_velocity(&v, &[0.0; 6])?;
    let momentum = |driver: &mut Driver| -> Result<[f64; 3]> {
        let state = driver.engine.state()?;
        let mut sum = [0.0; 3];
        for ((x, v), m) in state.x.iter().zip(&state.v).zip(&model.mass) {
            let l = cross(*x, *v);
            (0..3).for_each(|d| sum[d] += m * l[d]);
        }
        Ok(sum)
    };
    let before = momentum(&mut driver)?;
    let dt = 0.9 * stability::element_bound(&model)?;
    driver.advance(std::iter::repeat_n(dt, (10.0 * TAU / SPIN / dt) as usize))?;
    let after = momentum(&mut driver)?;
    let size = |a: [f64; 3]| a.iter().map(|c| c * c).sum::<f64>().sqrt();
    let x = driver.engine.state()?.x;
    let mut strain = 0.0f64;
    for hex in &model.mesh.hexes {
        for [a, b] in [[0, 1], [1, 2], [0, 4], [6, 7], [5, 6], [2, 6]] {
            let length = |p: &[[f64; 3]]| size(sub(p[hex[a] as usize], p[hex[b] as usize]));
            strain = strain.max((length(&x) / length(&model.mesh.nodes) - 1.0).abs());
        }
    }
    Ok([size(sub(after, before)) / size(before), strain])
}

/// Largest road force of a rolling wheel that only touches [N].
fn unloaded(element: Element) -> Result<f64> {
    let mut scene = wheel([44, 4, 5], 1.0);
    scene.body.element = element;
    let at = |to: f64| Drive::Velocity { to, ramp: 0.0 };
    let rim = RimMotion { x: at(0.26), spin: at(0.26 / given::OUTER_RADIUS), ..HELD };
    scene.stages =
        vec![Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", 0.01) }];
    let outcome = simulate(&scene)?;
    let force = |s: &hexroll::record::Sample| {
        [s.road_fx_N, s.road_fy_N, s.road_fz_N].into_iter().fold(0.0f64, |m, f| m.max(f.abs()))
    };
    Ok(outcome.samples.iter().map(force).fold(0.0, f64::max))
}

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    // Centrifugal load rho w^2 r over the half edge: a stretch of order rho (w L)^2 / (8 E), twice that let go at once.
    let stretch = DENSITY * (SPIN * 0.02f64).powi(2) / (8.0 * 3.0 * G);
    // The corners' circle is wider than the edge by sqrt(3); a wheel's rim speed is that of its roll.
    let grown = DENSITY * 0.26f64.powi(2) * given::OUTER_RADIUS * given::WIDTH;
    for (name, element) in [
        ("q1p0", Element::Q1p0),
        ("full", Element::Full),
        ("uniform-gradient", Element::UniformGradient { hourglass: 0.15 }),
    ] {
        let [drift, strain] = ten_turns(element)?;
        claims.push(Claim::at_most(
            format!("{name}: drift of angular momentum over ten turns"),
            "",
            drift,
            1e-12,
            "round-off of some thousand steps, a random walk",
        ));
        claims.push(Claim::at_most(
            format!("{name}: largest strain after ten turns"),
            "",
            strain,
            6.0 * stretch,
            "six times the mean centrifugal stretch rho (w L)^2 / (8 E): overshoot 2, corners sqrt(3) out",
        ));
        claims.push(Claim::at_most(
            format!("{name}: road force of the unloaded wheel"),
            "N",
            unloaded(element)?,
            grown,
            "rho v^2 times half the wheel's outline: what its centrifugal growth can press",
        ));
    }
    Ok(claims)
}
