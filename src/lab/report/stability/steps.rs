//! The critical step is sharp, and a mesh that cannot be computed is refused.

use crate::report::{Case, Claim};
use crate::rig::{Driver, Random, block, largest, wheel};
use hexroll::error::Error;
use hexroll::model::Model;
use hexroll::run::stability;
use hexroll::{Result, scene};

pub const SHARP: Case = Case {
    name: "critical_step",
    theorem: "the_critical_step_is_sharp",
    title: "Steps of 0.5 to 1.03 of the critical one",
    source: "von Neumann: bounded below the critical step, exponential growth above",
    setup: "24 x 3 x 3 wheel, rim held, random velocities of 1 um/s, 4000 steps; the critical step of the reference \
            shape, its eigenvalue to 0.1 %",
    everyday: true,
    run: sharp,
};

pub const REFUSED: Case = Case {
    name: "inside_out",
    theorem: "an_element_inside_out_is_refused",
    title: "A mesh with one element inside out",
    source: "det dX/dxi must be positive",
    setup: "block of 4 x 4 x 4 elements, one node pulled through the opposite face of element 21",
    everyday: true,
    run: refused,
};

/// Largest speed after the steps over the largest at the start, or the failure.
fn shaken(scene: &scene::Scene, share: f64) -> Result<f64> {
    let model = Model::new(scene)?;
    let mut driver = Driver::new(&model, scene)?;
    let guess = stability::element_bound(&model)?;
    let critical = stability::assembled(&mut *driver.engine, &model, &model.mesh.nodes, guess, None)?.dt;
    let mut random = Random::new(5);
    let rim = &model.mesh.rim;
    let mut velocity = |n: usize| match rim.binary_search(&(n as u32)) {
        Ok(_) => [0.0; 3],
        Err(_) => random.within(1e-6),
    };
    let v: Vec<[f64; 3]> = (0..model.node_count()).map(&mut velocity).collect();
    driver.engine.set_velocity(&v, &[0.0; 6])?;
    driver.advance(std::iter::repeat_n(share * critical, 4000))?;
    Ok(largest(&driver.engine.state()?.v) / largest(&v))
}

fn sharp() -> Result<Vec<Claim>> {
    let mut scene = wheel([24, 3, 3], 0.0);
    scene.road = None;
    let mut claims = Vec::new();
    for share in [0.5, 0.9, 0.97] {
        claims.push(Claim::at_most(
            format!("dt = {share} of the critical step: growth of the largest speed"),
            "",
            shaken(&scene, share)?,
            8.0,
            "a mode at the limit overshoots by 1 / sqrt(1 - 0.97^2) = 4, and some hundred modes meet",
        ));
    }
    let failure = shaken(&scene, 1.03);
    let step = match failure {
        Err(Error::Inverted { step, .. } | Error::NotFinite { step, .. }) => step as f64,
        _ => f64::NAN,
    };
    claims.push(Claim::at_most(
        "dt = 1.03 of the critical step: step at which it is reported",
        "",
        step,
        4000.0,
        "growth by exp(2 acosh 1.03) = 1.6 a step: from 1e-12 m to an element in 50; NaN would mean no report",
    ));
    Ok(claims)
}

fn refused() -> Result<Vec<Claim>> {
    let scene = block([0.04; 3], [4; 3]);
    let mut mesh = Model::new(&scene)?.mesh;
    // Element (1, 1, 1), its corner 0 beyond corner 6.
    let hex = mesh.hexes[21];
    mesh.nodes[hex[0] as usize] = mesh.nodes[hex[6] as usize].map(|c| c + 2e-3);
    let named = Model::from_mesh(mesh, &scene.body).err();
    // Whichever of the eight elements at the node comes first is named: all of them are broken.
    let first = named.map_or(f64::NAN, |e| e as f64);
    Ok(vec![
        Claim::at_most(
            "element that is named",
            "",
            first,
            21.0,
            "one of the eight at the node; NaN: accepted",
        ),
        Claim::at_least("element that is named", "", first, 0.0, "the same"),
    ])
}
