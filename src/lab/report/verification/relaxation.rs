//! Lame's mode of a free cube whose material relaxes: its amplitude follows one oscillator with a Maxwell element.

use std::f64::consts::PI;

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, Driver, G, block};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::physics::material::{Relaxation, Term};
use hexroll::run::stability;
use hexroll::scene::Element;

pub const CASE: Case = Case {
    name: "relaxation",
    theorem: "a_relaxing_cube_rings_down_as_the_series_says",
    title: "Lame's mode of a cube that relaxes",
    source: "Lame 1852 with a standard linear solid in shear: a'' = -w^2 (a + h), h' = r a' - h / tau",
    setup: "cube of 20 mm, 8 elements an edge, free; one term of r = 0.5; the mode as initial velocity, strain 1e-5, six periods",
    everyday: true,
    run,
};

const EDGE: f64 = 0.02;
const RATIO: f64 = 0.5;

fn shape(x: [f64; 3]) -> [f64; 3] {
    let [a, b] = [PI * x[0] / EDGE, PI * x[1] / EDGE];
    [a.cos() * b.sin(), -a.sin() * b.cos(), 0.0]
}

/// A cube that rings: times [s], amplitudes [m], energy put in and lost [J].
struct Ringing {
    times: Vec<f64>,
    amplitudes: Vec<f64>,
    given: f64,
    lost: f64,
    dt: f64,
}

fn ring(element: Element, term: Option<Term>, periods: f64) -> Result<Ringing> {
    let mut scene = block([EDGE; 3], [8; 3]);
    scene.body.element = element;
    scene.body.relaxation = Relaxation { terms: term.into_iter().collect() };
    let model = Model::new(&scene)?;
    let mut driver = Driver::new(&model, &scene)?;
    let peak = 1e-5 * EDGE * exact();
    let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|&x| shape(x).map(|s| peak * s)).collect();
    driver.engine.set_velocity(&v, &[0.0; 6])?;
    let dt = 0.5 * stability::element_bound(&model)?;
    let norm: f64 = (0..v.len()).map(|n| model.mass[n] * square(shape(model.mesh.nodes[n]))).sum();
    let given = 0.5 * peak * peak * norm;
    let (mut times, mut amplitudes, mut lost) = (Vec::new(), Vec::new(), 0.0);
    while driver.time < periods * 2.0 * PI / exact() {
        driver.advance([dt; 4])?;
        let x = driver.engine.state()?.x;
        let part = |n: usize| -> f64 {
            let X = model.mesh.nodes[n];
            let s = shape(X);
            model.mass[n] * (0..3).map(|d| (x[n][d] - X[d]) * s[d]).sum::<f64>()
        };
        times.push(driver.time);
        amplitudes.push((0..x.len()).map(part).sum::<f64>() / norm);
        lost += driver.sample(dt)?.dissipated;
    }
    Ok(Ringing { times, amplitudes, given, lost, dt })
}

fn square(a: [f64; 3]) -> f64 {
    a.iter().map(|c| c * c).sum()
}

/// Angular frequency of the elastic cube [rad/s].
fn exact() -> f64 {
    2.0f64.sqrt() * PI / EDGE * (G / DENSITY).sqrt()
}

/// That of the mesh, from the first and the last zero of an elastic cube's amplitude.
fn frequency(element: Element) -> Result<f64> {
    let Ringing { times, amplitudes, .. } = ring(element, None, 6.3)?;
    let zeros: Vec<f64> = (1..times.len())
        .filter(|&n| amplitudes[n - 1] * amplitudes[n] < 0.0)
        .map(|n| {
            let [a, b] = [amplitudes[n - 1], amplitudes[n]];
            times[n - 1] + (times[n] - times[n - 1]) * a / (a - b)
        })
        .collect();
    Ok(PI * (zeros.len() - 1) as f64 / (zeros[zeros.len() - 1] - zeros[0]))
}

/// Largest difference of the amplitudes from the oscillator's, over the largest amplitude: Runge and Kutta's rule in steps so short
/// that its own error is 1e-9.
fn deviation(ringing: &Ringing, omega: f64, term: Term) -> f64 {
    let peak = 1e-5 * EDGE * exact();
    let rate = |[a, v, h]: [f64; 3]| [v, -omega * omega * (a + h), term.ratio * v - h / term.time];
    let mut state = [0.0, peak, 0.0];
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
    for (name, element) in
        [("q1p0", Element::Q1p0), ("uniform-gradient", Element::UniformGradient { hourglass: 0.15 })]
    {
        let omega = frequency(element)?;
        for product in [0.1, 1.0, 10.0] {
            let term = Term { ratio: RATIO, time: product / omega };
            claims.push(Claim::at_most(
                format!("{name}, w tau = {product}: amplitude over six periods, off by"),
                "",
                deviation(&ring(element, Some(term), 6.0)?, omega, term),
                3e-3,
                "the mode's impurity on eight elements, and the hourglass stiffness, which does not relax: 1e-3 in phase",
            ));
        }
        let term = Term { ratio: RATIO, time: 1.0 / omega };
        let Ringing { given, lost, .. } = ring(element, Some(term), 16.0)?;
        claims.push(Claim::relative(
            format!("{name}: energy lost once the cube has come to rest"),
            "J",
            lost,
            given,
            2e-3,
            "the energy put in, of which 1e-6 is left; what a step loses is taken at its end, and what rings in other modes",
        ));
    }
    Ok(claims)
}
