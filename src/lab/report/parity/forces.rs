//! Forces of one element pass and its gather, of every formulation and law.

use super::rig::{BLOCK, adapter, kinds, model, relative, scene};
use crate::bench::kind::Kind;
use crate::report::{Case, Claim};
use hexroll::gpu::Gpu;
use hexroll::scene::Scene;
use hexroll::{Precision, Result};

pub const CASE: Case = Case {
    name: "parity_forces",
    theorem: "forces_on_a_gpu_are_the_cpus",
    title: "Forces of every formulation and law",
    source: "the CPU engine in f64",
    setup: "block of 30 x 27 x 24 mm, 3 x 3 x 3 elements, every element of its own shape, strains and rates of some 10 %, \
            bulk modulus four shear moduli",
    everyday: true,
    run,
};

/// Formulation, law, and whether there is viscosity: each of them with the others' usual choice.
const COMPOSITIONS: [(&str, &str, bool); 8] = [
    ("q1p0", "mooney-rivlin", false),
    ("q1p0", "mooney-rivlin", true),
    ("q1p0", "mooney-rivlin-eq4", false),
    ("q1p0", "neo-hookean", false),
    ("full", "mooney-rivlin", false),
    ("full", "mooney-rivlin", true),
    ("uniform-gradient", "mooney-rivlin", false),
    ("uniform-gradient", "mooney-rivlin", true),
];

fn composed((element, law, viscous): (&str, &str, bool)) -> Result<Scene> {
    let sets = [
        "body.mesh.size=[\"30 mm\", \"27 mm\", \"24 mm\"]".to_string(),
        "body.mesh.elements=[3, 3, 3]".into(),
        "body.material.bulk_modulus=\"10 MPa\"".into(),
        format!("body.element={element}"),
        format!("body.material.law={law}"),
    ];
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let mut scene = scene(BLOCK, &sets)?;
    scene.body.viscosity = viscous.then_some(20.0);
    Ok(scene)
}

/// Numbers in -1..1, the same in every run.
fn noise(seed: &mut u64) -> f64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Relative error of the forces of one composition.
fn error(scene: &Scene, kind: Kind, gpu: &Gpu) -> Result<f64> {
    let mut seed = 0x9e37_79b9_7f4a_7c15;
    let mut near = |x: &[f64; 3], by: f64| x.map(|c| c + by * noise(&mut seed));
    let mut mesh = hexroll::model::mesh::Mesh::generate(&scene.body.mesh);
    mesh.nodes = mesh.nodes.iter().map(|x| near(x, 0.8e-3)).collect();
    let stretched = |x: &[f64; 3]| [1.05 * x[0] + 0.08 * x[1], 0.97 * x[1] - 0.05 * x[2], x[2] + 0.06 * x[0]];
    let x: Vec<[f64; 3]> = mesh.nodes.iter().map(|x| near(&stretched(x), 0.5e-3)).collect();
    let v: Vec<[f64; 3]> = x.iter().map(|_| near(&[0.0; 3], 20.0)).collect();
    let model = model(mesh, &scene.body)?;
    let forces = |kind: Kind| kind.engine(&model, scene, 1, Some(gpu))?.force(&x, &v);
    Ok(relative(&forces(kind)?, &forces(Kind::CpuF64)?))
}

fn run() -> Result<Vec<Claim>> {
    let gpu = adapter()?;
    let mut claims = Vec::new();
    for kind in kinds(&gpu) {
        for composition in COMPOSITIONS {
            let (bound, reason) = match kind.precision() {
                Precision::F64 => (
                    1e-12,
                    "rounding of some hundred operations, relative to stresses a tenth of the largest",
                ),
                Precision::F32 | Precision::F32Plus => (
                    5e-6,
                    "6e-8 of a coordinate of 30 mm is 2e-7 of an edge of 9 mm, where strains are 0.1; as much in J - 1",
                ),
            };
            let (element, law, viscous) = composition;
            let what = format!("{}: {element}, {law}{}", kind.name(), if viscous { ", viscous" } else { "" });
            let error = error(&composed(composition)?, kind, &gpu)?;
            claims.push(Claim::at_most(what, "", error, bound, reason));
        }
    }
    Ok(claims)
}
