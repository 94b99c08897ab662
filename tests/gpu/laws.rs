//! Friction laws in pressure and speed, and held components, on the device as on the CPU.

use crate::rig::{
    Plan, Who, displacement, errors, note, outcome, relative, safe_step, scene, state_errors, within,
};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::scene::Scene;

/// Laws, and the windows of 40 steps over which they are compared. Friction that falls with pressure makes a sliding block
/// jump, and jumps amplify rounding without bound: that law is compared while the block is being pressed.
const LAWS: [(&str, usize); 4] = [
    ("friction={ law = \"viscous\", slope = \"2 s/m\" }", 20),
    (
        "friction={ law = \"stribeck\", static = 0.9, kinetic = 0.4, speed = \"0.1 m/s\", slope = \"0.2 s/m\" }",
        20,
    ),
    (
        "friction={ law = \"pressure-velocity\", a = 0.2, b = 0.5, pressure = \"0.2 MPa\", c = 0.1, speed = \"1 m/s\" }",
        5,
    ),
    ("friction={ law = \"lat100\", a = 0.6, b = -0.2, alpha = \"10 1/MPa\", c = 0.2, beta = \"10 s/m\" }", 5),
];

fn block(law: &str, windows: usize) -> (Scene, Model, Plan) {
    let changes = [
        "body.mesh.elements=[4, 4, 2]",
        "stage.0.rim.z={ displacement = \"-1 mm\", ramp = \"5 ms\" }",
        "road.velocity=[\"0.4 m/s\", \"0 m/s\", \"0 m/s\"]",
        "hold=[{ nodes = \"all\", components = \"y\" }]",
        law,
    ];
    let scene = scene("pressed_block", &changes);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), windows, 40);
    (scene, model, plan)
}

/// In double precision, with the exponential that the shaders bring with them.
pub fn doubles(gpu: &Gpu) {
    for (law, windows) in LAWS {
        let (scene, model, plan) = block(law, windows);
        let [exact, got] = [Who::Cpu64, Who::Double].map(|who| outcome(gpu, who, &model, &scene, &plan));
        // A node that slides as fast as not at all may be booked as either, and the block begins exactly on the road, where
        // rounding decides: two steps of 25 nodes are 0.8 % of the node-steps of five windows, and no other window
        // differs. Friction that falls with speed makes errors grow: single precision's, too, are a hundred times those with friction that rises.
        let fields = [("contact steps", 1e-2), ("surface v", 1e-9)];
        within(law, &errors(&plan, 0.04, &got, &exact), &fields, 1e-11);
        within(law, &state_errors(&model, &got, &exact), &[("velocity", 1e-9)], 1e-11);
    }
}

/// A block pressed on a road that slides under it, plane strain: in windows of 40 steps, so that areas are taken anew.
/// Positions of 40 mm in single precision against displacements of 1 mm: 4e-9 / 1e-3, grown by contact that starts
/// a step sooner or later.
pub fn friction_and_holds(gpu: &Gpu) {
    let mut works = Vec::new();
    for (law, windows) in LAWS {
        let (scene, model, plan) = block(law, windows);
        let reference = outcome(gpu, Who::Cpu64, &model, &scene, &plan);
        let expected = displacement(&model, &reference.state);
        let friction = |o: &crate::rig::Outcome| o.windows.iter().map(|w| w.works.friction).sum::<f64>();
        for who in [Who::Gpu, Who::Plus] {
            let found = outcome(gpu, who, &model, &scene, &plan);
            let moved = displacement(&model, &found.state);
            let off = relative(&moved, &expected);
            let work = friction(&found) / friction(&reference) - 1.0;
            note(|| format!("{law} {who:?}: displacement {off:.1e}, friction work {work:.1e}"));
            assert!(off < 1e-3, "{law} {who:?}: displacement off by {off:.1e}");
            assert!(work.abs() < 5e-3, "{law} {who:?}: friction work off by {work:.1e}");
            for (n, (u, v)) in moved.iter().zip(&found.state.v).enumerate() {
                let held = model.mesh.held[n] != 0;
                // The reference position itself is rounded once.
                assert!(!held || (u[1].abs() < 2e-9 && v[1] == 0.0), "{who:?}: node {n} moves across: {u:?}");
            }
        }
        works.push(friction(&reference));
    }
    // The laws are not each other: a composition that took the wrong one would be seen.
    for (i, j) in [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)] {
        assert!((works[i] / works[j] - 1.0).abs() > 0.02, "{works:?}");
    }
}
