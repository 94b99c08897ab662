//! Lame's mode of a free cube: the one vibration of a free block in closed form.
//!
//! u = (cos kx sin ky, -sin kx cos ky, 0), k = pi / L: equivoluminal and free of traction on all six faces, so its
//! frequency is sqrt(2) k c_s whatever the bulk modulus (Lame 1852; Lamb, Proc. Lond. Math. Soc. 13, 1881).

use std::f64::consts::PI;

use crate::report::{Case, Claim};
use crate::rig::{DENSITY, Driver, G, block, order};
use hexroll::Result;
use hexroll::model::Model;
use hexroll::run::stability;
use hexroll::scene::Element;

pub const CASE: Case = Case {
    name: "vibration",
    theorem: "a_free_cube_vibrates_in_lames_mode",
    title: "Lame's mode of a free cube",
    source: "Lame 1852: w = sqrt(2) pi c_s / L",
    setup: "cube of 20 mm, 8 and 16 elements an edge, free; the mode as initial velocity, strain 1e-5, three periods",
    everyday: true,
    run,
};

const EDGE: f64 = 0.02;

fn shape(x: [f64; 3]) -> [f64; 3] {
    let [a, b] = [PI * x[0] / EDGE, PI * x[1] / EDGE];
    [a.cos() * b.sin(), -a.sin() * b.cos(), 0.0]
}

/// Angular frequency [rad/s] from the zero crossings of the mode's amplitude over three periods.
fn frequency(element: Element, count: usize) -> Result<f64> {
    let mut scene = block([EDGE; 3], [count; 3]);
    scene.body.element = element;
    let model = Model::new(&scene)?;
    let mut driver = Driver::new(&model, &scene)?;
    let exact = 2.0f64.sqrt() * PI / EDGE * (G / DENSITY).sqrt();
    let peak = 1e-5 * EDGE * exact;
    let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|&x| shape(x).map(|s| peak * s)).collect();
    driver.engine.set_velocity(&v, &[0.0; 6])?;
    let dt = 0.5 * stability::element_bound(&model)?;
    let amplitude = |driver: &mut Driver| -> Result<f64> {
        let x = driver.engine.state()?.x;
        let part = |n: usize| -> f64 {
            let X = model.mesh.nodes[n];
            let s = shape(X);
            model.mass[n] * (0..3).map(|d| (x[n][d] - X[d]) * s[d]).sum::<f64>()
        };
        Ok((0..x.len()).map(part).sum())
    };
    // Zeros at half periods 1 and 6, each between two steps.
    let period = 2.0 * PI / exact;
    let mut zeros = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    while driver.time < 3.3 * period {
        driver.advance([dt; 4])?;
        let now = (driver.time, amplitude(&mut driver)?);
        if let Some(before) = last.filter(|b| b.1 * now.1 < 0.0) {
            zeros.push(before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1));
        }
        last = Some(now);
    }
    Ok(PI * (zeros.len() - 1) as f64 / (zeros[zeros.len() - 1] - zeros[0]))
}

fn run() -> Result<Vec<Claim>> {
    let exact = 2.0f64.sqrt() * PI / EDGE * (G / DENSITY).sqrt();
    let mut claims = Vec::new();
    for (name, element) in
        [("q1p0", Element::Q1p0), ("uniform-gradient", Element::UniformGradient { hourglass: 0.15 })]
    {
        let found = [frequency(element, 8)?, frequency(element, 16)?];
        let limit = (4.0 * found[1] - found[0]) / 3.0;
        claims.push(Claim::relative(
            format!("{name}: frequency extrapolated from 8 and 16 elements"),
            "rad/s",
            limit,
            exact,
            2e-3,
            "what Richardson's rule leaves: fourth order, (pi/16)^4 and the mode's impurity on the mesh",
        ));
        claims.push(Claim::absolute(
            format!("{name}: order of the frequency, 8 to 16 elements"),
            "",
            order((found[0] - exact).abs(), (found[1] - exact).abs()),
            2.0,
            0.35,
            "second order; eight elements carry half a wave, so the next order still shows",
        ));
    }
    Ok(claims)
}
