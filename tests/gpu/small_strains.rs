//! Stored energies at small strains, where C and its invariants have lost the digits of the strain.

use crate::rig::{Who, engine, note};
use hexroll::engine::{StageSetup, State, Step};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll_lab::rig::{ELEMENTS, block, laws};

/// A block sheared by gamma stores G/2 gamma^2 V, exactly but for terms of gamma^4 in the laws of a kind that knows ln J, from
/// strains of a tenth down to where the rounding of positions is a strain of its own.
pub fn shear(gpu: &Gpu) {
    let size = [0.1, 0.1, 0.02];
    let volume: f64 = size.iter().product();
    for (element, law) in ELEMENTS.into_iter().flat_map(|e| laws().map(move |l| (e, l))) {
        let mut scene = block(size, [8, 8, 2]);
        (scene.body.element, scene.body.law) = (element, law);
        let model = Model::new(&scene).unwrap();
        let [G, kappa] = [law.shear_modulus(), law.bulk_modulus()];
        for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
            for gamma in [1e-2, 1e-3, 1e-4, 1e-5] {
                let mut engine = engine(gpu, who, &model, &scene);
                engine.begin_stage(&StageSetup::default()).unwrap();
                let x = model.mesh.nodes.iter().map(|&[x, y, z]| [x + gamma * z, y, z]).collect();
                let rim = [0.0; 6];
                engine.set_state(&State { x, v: vec![[0.0; 3]; model.node_count()] }, &rim, &rim).unwrap();
                let window = engine
                    .sample(&Step { time: 0.0, dt: 1e-6, dt_before: 0.0, rim, load: [0.0; 6] })
                    .unwrap();
                let error = window.strain / (0.5 * G * gamma * gamma * volume) - 1.0;
                // Differences of the positions of nodes 10 mm apart are good to 7e-9 m in plain singles, and their squares to
                // 1e-7 in all: strains of 7e-7 and 2e-7, some of them in the volume, whose energy is theirs squared with kappa
                // for G. What they have in common with the shear averages out over 1,024 points.
                let strain: f64 = if who == Who::Plus { 2e-7 } else { 7e-7 };
                let rounding = (1.0 + kappa / G) * (strain / gamma).powi(2) + 0.2 * strain / gamma;
                let bound = rounding + 1e-6 + 20.0 * gamma * gamma;
                note(|| {
                    format!(
                        "{element:?} {} {who:?} gamma {gamma:.0e}: {error:.1e}, bound {bound:.1e}",
                        law.name()
                    )
                });
                assert!(
                    error.abs() < bound,
                    "{element:?} {law:?} {who:?} at {gamma}: off by {error:e}, bound {bound:e}"
                );
            }
        }
    }
}
