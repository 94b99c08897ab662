//! Plane waves of dilatation and of shear in a bar whose other components are held: one-dimensional, exactly.
//!
//! d'Alembert: a body at rest with velocity V(x) moves by u = 1/(2c) int_{x-ct}^{x+ct} V, c^2 = (kappa + 4/3 G) / rho for
//! dilatation, G / rho for shear. Dispersion of linear elements with lumped mass under central differences (Belytschko,
//! Liu, Moran, Nonlinear Finite Elements, ch. 6): sin(w dt / 2) = (c dt / h) sin(k h / 2).

use std::f64::consts::PI;

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, Driver, G, KAPPA, block, hold, order};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::scene::Scene;

pub const CASE: Case = Case {
    name: "waves",
    theorem: "plane_waves_have_their_speed_order_and_dispersion",
    title: "Waves of dilatation and shear: speed, order, dispersion",
    source: "d'Alembert; dispersion of the semi-discrete wave equation (Belytschko, Liu, Moran, ch. 6)",
    setup: "bar of 1 m, elements of length h in one row, two of three components held everywhere; \
            velocity pulse of 0.4 m, strains of 1e-6",
    everyday: true,
    run,
};

const LENGTH: f64 = 1.0;
const PULSE: f64 = 0.4;
/// Peak velocity over wave speed: the strain, small enough to be linear.
const STRAIN: f64 = 1e-6;

/// Which component moves, those that are held, and the wave's speed.
#[derive(Clone, Copy)]
struct Wave {
    name: &'static str,
    component: usize,
    held: &'static str,
    speed: f64,
}

fn dilatation() -> Wave {
    let speed = ((KAPPA + 4.0 / 3.0 * G) / DENSITY).sqrt();
    Wave { name: "dilatation", component: 0, held: "yz", speed }
}

fn shear() -> Wave {
    Wave { name: "shear", component: 1, held: "xz", speed: (G / DENSITY).sqrt() }
}

fn bar(wave: Wave, elements: usize) -> Scene {
    let h = LENGTH / elements as f64;
    // Tall in y: a row's own stretching in y, which a shear wave does not excite, must not limit the step.
    let mut scene = block([LENGTH, 8.0 * h, h], [elements, 1, 1]);
    scene.holds = vec![hold("all", wave.held)];
    scene
}

/// V / peak = cos^4 within the pulse, and its integral from the middle.
fn pulse(s: f64) -> f64 {
    if s.abs() < 0.5 * PULSE { (PI * s / PULSE).cos().powi(4) } else { 0.0 }
}

fn integral(s: f64) -> f64 {
    let a = PI * s.clamp(-0.5 * PULSE, 0.5 * PULSE) / PULSE;
    PULSE / PI * (0.375 * a + 0.25 * (2.0 * a).sin() + (4.0 * a).sin() / 32.0)
}

/// Displacements by node plane at `time` over the strain, from a start with velocity `field`(x).
fn moved(
    wave: Wave,
    elements: usize,
    time: f64,
    courant: f64,
    field: impl Fn(f64) -> f64,
) -> Result<Vec<f64>> {
    let scene = bar(wave, elements);
    let model = Model::new(&scene)?;
    let mut driver = Driver::new(&model, &scene)?;
    let peak = STRAIN * wave.speed;
    let velocity = |x: &[f64; 3]| {
        let mut v = [0.0; 3];
        v[wave.component] = peak * field(x[0]);
        v
    };
    let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(velocity).collect();
    driver.engine.set_velocity(&v, &[0.0; 6])?;
    let h = LENGTH / elements as f64;
    let count = (time * wave.speed / (courant * h) - 1e-9).ceil();
    driver.advance(std::iter::repeat_n(time / count, count as usize))?;
    let x = driver.engine.state()?.x;
    let mut planes = vec![0.0; elements + 1];
    for (X, x) in model.mesh.nodes.iter().zip(&x) {
        let plane = (X[0] / h).round() as usize;
        planes[plane] += 0.25 * (x[wave.component] - X[wave.component]) / STRAIN;
    }
    Ok(planes)
}

/// Root mean square of differences over the largest expected displacement.
fn rms(got: &[f64], expected: impl Fn(usize) -> f64) -> f64 {
    let sum: f64 = got.iter().enumerate().map(|(i, u)| (u - expected(i)).powi(2)).sum();
    let top = (0..got.len()).map(|i| expected(i).abs()).fold(0.0, f64::max);
    (sum / got.len() as f64).sqrt() / top
}

/// Error against d'Alembert when each half has run 0.2 m.
fn error(wave: Wave, elements: usize, courant: f64) -> Result<f64> {
    let way = 0.2;
    let got = moved(wave, elements, way / wave.speed, courant, |x| pulse(x - 0.5))?;
    let h = LENGTH / elements as f64;
    Ok(rms(&got, |i| {
        let s = i as f64 * h - 0.5;
        0.5 * (integral(s + way) - integral(s - way))
    }))
}

/// Error of the time integration alone: against a step sixteen times shorter.
fn time_error(wave: Wave, courant: f64) -> Result<f64> {
    let run = |courant| moved(wave, 80, 0.2 / wave.speed, courant, |x| pulse(x - 0.5));
    let fine = run(0.05)?;
    Ok(rms(&run(courant)?, |i| fine[i]))
}

/// Frequency over c k of a standing wave of `kh`, free ends, from u(n+1) + u(n-1) = 2 cos(w dt) u(n).
fn frequency(wave: Wave, half_waves: usize, elements: usize, courant: f64) -> Result<f64> {
    let k = PI * half_waves as f64 / LENGTH;
    let h = LENGTH / elements as f64;
    let dt = courant * h / wave.speed;
    let shape = |x: f64| (k * x).cos();
    let mode = |count: usize| -> Result<f64> {
        let planes = moved(wave, elements, dt * count as f64, courant, shape)?;
        let share = |i: usize| if i == 0 || i == elements { 0.5 } else { 1.0 };
        Ok((0..=elements).map(|i| share(i) * planes[i] * shape(i as f64 * h)).sum())
    };
    // Near a quarter of a period, where the displacement is largest.
    let quarter = ((0.25 * 2.0 * PI / (k * wave.speed) / dt).round() as usize).max(2);
    let [before, at, after] = [mode(quarter - 1)?, mode(quarter)?, mode(quarter + 1)?];
    Ok(((before + after) / (2.0 * at)).acos() / (dt * k * wave.speed))
}

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for wave in [dilatation(), shear()] {
        let errors = [error(wave, 40, 0.5)?, error(wave, 80, 0.5)?, error(wave, 160, 0.5)?];
        claims.push(Claim::at_most(
            format!("{}: rms displacement error, 160 elements", wave.name),
            "",
            errors[2],
            1e-3,
            "(k h)^2 / 24 of the pulse's leading waves over a way of half its length: 4e-4",
        ));
        for (pair, name) in errors.windows(2).zip(["40 to 80", "80 to 160"]) {
            claims.push(Claim::absolute(
                format!("{}: order in h and dt, {name} elements", wave.name),
                "",
                order(pair[0], pair[1]),
                2.0,
                0.1,
                "second order, less what the next order leaves on the coarse mesh",
            ));
        }
        claims.push(Claim::absolute(
            format!("{}: order in dt alone, courant 0.8 to 0.4", wave.name),
            "",
            order(time_error(wave, 0.8)?, time_error(wave, 0.4)?),
            2.0,
            0.1,
            "second order; the reference's own step is sixteen times shorter",
        ));
        for (half_waves, courant) in [(8, 0.5), (16, 0.5), (32, 0.5), (48, 0.5), (32, 0.9)] {
            let kh = PI * half_waves as f64 / 64.0;
            let expected = 2.0 / (courant * kh) * (courant * (0.5 * kh).sin()).asin();
            claims.push(Claim::relative(
                format!("{}: phase speed over c at k h = {:.3} pi, courant {courant}", wave.name, kh / PI),
                "",
                frequency(wave, half_waves, 64, courant)?,
                expected,
                1e-5,
                "a discrete eigenmode, so exact but for strains of 1e-6 and round-off of their differences",
            ));
        }
    }
    Ok(claims)
}
