//! Shear vibration of a free column whose material relaxes: its amplitude follows one oscillator with a Maxwell element.
//!
//! Nodes move along y alone, by cos(pi z / L): with masses at the nodes that is a mode of the mesh too, of the frequency
//! w = 2 c_s / h sin(pi h / 2 L), in pure shear.

use std::f64::consts::PI;

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, Driver, ELEMENTS, G, block, hold};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::physics::material::{Relaxation, Term};
use hexroll::run::stability;
use hexroll::scene::Element;

pub const CASE: Case = Case {
    name: "relaxation",
    theorem: "a_relaxing_column_rings_down_as_the_series_says",
    title: "Shear vibration of a column that relaxes",
    source: "a mode of the mesh in closed form, and a standard linear solid: a'' = -w^2 (a + h), h' = r a' - h / tau",
    setup: "column of 20 mm, 8 elements, free, all nodes held along x and z; one term of r = 0.5; the mode as initial velocity, strain \
            1e-5, six periods",
    everyday: true,
    run,
};

const LENGTH: f64 = 0.02;
const COUNT: usize = 8;
const RATIO: f64 = 0.5;

fn shape(x: [f64; 3]) -> f64 {
    (PI * x[2] / LENGTH).cos()
}

/// Angular frequency without relaxation [rad/s].
fn omega() -> f64 {
    let h = LENGTH / COUNT as f64;
    2.0 / h * (G / DENSITY).sqrt() * (0.5 * PI / COUNT as f64).sin()
}

/// Largest velocity at the start [m/s].
fn peak() -> f64 {
    1e-5 * LENGTH * omega()
}

/// A column that rings: times [s], amplitudes [m], energy put in and lost [J].
struct Ringing {
    times: Vec<f64>,
    amplitudes: Vec<f64>,
    given: f64,
    lost: f64,
    dt: f64,
}

fn ring(element: Element, term: Term, periods: f64) -> Result<Ringing> {
    let h = LENGTH / COUNT as f64;
    let mut scene = block([h, h, LENGTH], [1, 1, COUNT]);
    scene.body.element = element;
    scene.body.relaxation = Relaxation { terms: vec![term] };
    scene.holds = vec![hold("all", "xz")];
    let model = Model::new(&scene)?;
    let mut driver = Driver::new(&model, &scene)?;
    let nodes = &model.mesh.nodes;
    let v: Vec<[f64; 3]> = nodes.iter().map(|&x| [0.0, peak() * shape(x), 0.0]).collect();
    driver.engine.set_velocity(&v, &[0.0; 6])?;
    // The series' rule is off by (dt / tau)^2 / 24, the scheme by (w dt)^2 / 24.
    let dt = (0.05 * term.time).min(0.02 / omega()).min(0.5 * stability::element_bound(&model)?);
    let norm: f64 = nodes.iter().zip(&model.mass).map(|(x, m)| m * shape(*x).powi(2)).sum();
    let given = 0.5 * peak().powi(2) * norm;
    let (mut times, mut amplitudes, mut lost) = (Vec::new(), Vec::new(), 0.0);
    while driver.time < periods * 2.0 * PI / omega() {
        driver.advance([dt; 12])?;
        let x = driver.engine.state()?.x;
        let part = |n: usize| model.mass[n] * (x[n][1] - nodes[n][1]) * shape(nodes[n]);
        times.push(driver.time);
        amplitudes.push((0..x.len()).map(part).sum::<f64>() / norm);
        lost += driver.sample(dt)?.dissipated;
    }
    Ok(Ringing { times, amplitudes, given, lost, dt })
}

/// Largest difference of the amplitudes from the oscillator's, over the largest amplitude: Runge and Kutta's rule in steps so short
/// that its own error is 1e-9.
fn deviation(ringing: &Ringing, term: Term) -> f64 {
    let square = omega().powi(2);
    let rate = |[a, v, h]: [f64; 3]| [v, -square * (a + h), term.ratio * v - h / term.time];
    let mut state = [0.0, peak(), 0.0];
    let (mut time, mut worst, mut largest) = (0.0, 0.0f64, 0.0f64);
    for (&at, &amplitude) in ringing.times.iter().zip(&ringing.amplitudes) {
        let steps = ((at - time) / (0.1 * ringing.dt)).ceil();
        let dt = (at - time) / steps;
        for _ in 0..steps as usize {
            let along = |k: [f64; 3], s: f64| std::array::from_fn(|i| state[i] + s * dt * k[i]);
            let k1 = rate(state);
            let k2 = rate(along(k1, 0.5));
            let k3 = rate(along(k2, 0.5));
            let k4 = rate(along(k3, 1.0));
            state = std::array::from_fn(|i| state[i] + dt / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        time = at;
        worst = worst.max((amplitude - state[0]).abs());
        largest = largest.max(state[0].abs());
    }
    worst / largest
}

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for element in ELEMENTS {
        let name = match element {
            Element::Q1p0 => "q1p0",
            Element::Full => "full",
            Element::UniformGradient { .. } => "uniform-gradient",
        };
        for product in [0.1, 1.0, 10.0] {
            let term = Term { ratio: RATIO, time: product / omega() };
            claims.push(Claim::at_most(
                format!("{name}, w tau = {product}: amplitude over six periods, off by"),
                "",
                deviation(&ring(element, term, 6.0)?, term),
                2e-3,
                "(dt / tau)^2 / 24 of the term's stress and (w dt)^2 / 24 of the frequency, over 40 radians: 1e-3",
            ));
        }
        let term = Term { ratio: RATIO, time: 1.0 / omega() };
        let Ringing { given, lost, .. } = ring(element, term, 16.0)?;
        claims.push(Claim::relative(
            format!("{name}: energy lost once the column has come to rest"),
            "J",
            lost,
            given,
            2e-3,
            "the energy put in, of which 1e-6 is left; what a step loses is taken at its end",
        ));
    }
    Ok(claims)
}
