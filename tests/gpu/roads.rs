//! Every road on every engine: a block pressed on it and dragged along.

use crate::rig::{Plan, Who, balances, errors, note, outcome, safe_step, scene, within};
use hexroll::gpu::Gpu;
use hexroll::model::Model;

/// The block of 40 x 40 x 20 mm, placed on the road, pressed by 1 mm and dragged by 0.4 mm; nodes 10 mm apart.
const DRAGGED: [&str; 4] = [
    "body.mesh.elements=[4, 4, 2]",
    "body.place=\"on-road\"",
    "stage.0.rim.z={ displacement = \"-1 mm\", ramp = \"2 ms\" }",
    "stage.0.rim.x={ displacement = \"0.4 mm\", ramp = \"2 ms\" }",
];

const ROADS: [(&str, &[&str]); 6] = [
    (
        "a drum inside",
        &["road.shape=drum", "road.radius=90 mm", "road.side=inside", "road.angular_velocity=-5 rad/s"],
    ),
    (
        "a disk",
        &["road.shape=disk", "road.centre=[\"20 mm\", \"-60 mm\", \"0 m\"]", "road.angular_velocity=8 rad/s"],
    ),
    (
        "a cosine at an angle",
        &[
            "road.shape=profile",
            "road.form=cosine",
            "road.wavelength=35 mm",
            "road.amplitude=0.5 mm",
            "road.angle=30 deg",
        ],
    ),
    (
        "cleats with round corners",
        &[
            "road.shape=profile",
            "road.form=cleat",
            "road.height=2 mm",
            "road.length=9 mm",
            "road.radius=1.5 mm",
            "road.spacing=20 mm",
        ],
    ),
    (
        "a tilted step with sharp ones",
        &[
            "road.shape=profile",
            "road.form=step",
            "road.height=0.7 mm",
            "road.normal=[0.05, 0.02, 1]",
            "road.point=[\"15 mm\", \"0 m\", \"0 m\"]",
        ],
    ),
    (
        "a rough field",
        &[
            "road.shape=height-field",
            "road.generate=self-affine",
            "road.seed=3",
            "road.length=64 mm",
            "road.spacing=1 mm",
            "road.shortest=8 mm",
            "road.hurst=0.8",
            "road.rms=0.3 mm",
            "road.angle=10 deg",
        ],
    ),
];

/// Contact in single precision lands a node now and then a step sooner or later, whose force the step's length then shares out.
/// Bounds are estimates from that, not measurements; a software adapter keeps them.
const FIELDS: [(&str, f64); 9] = [
    ("works", 2e-4),
    ("half works", 2e-4),
    ("energies", 2e-4),
    ("rim impulse", 2e-4),
    ("contact impulse", 1e-3),
    ("surface v", 2e-2),
    ("residual forces", 2e-2),
    ("contact steps", 2e-2),
    ("min J", 1e-5),
];

pub fn every_road(gpu: &Gpu) {
    for (name, road) in ROADS {
        let scene = scene("pressed_block", &[&DRAGGED, road].concat());
        let model = Model::new(&scene).unwrap();
        let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 4, 50);
        let exact = outcome(gpu, Who::Cpu64, &model, &scene, &plan);
        let touching: u32 = exact.windows.iter().flat_map(|w| &w.surface).map(|s| s.touching).sum();
        assert!(touching > 500, "{name}: {touching} node-steps in contact");
        for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
            let got = outcome(gpu, who, &model, &scene, &plan);
            within(&format!("{name}, {who:?}"), &errors(&plan, 0.04, &got, &exact), &FIELDS, 1e-5);
            let [balance, _, largest] = balances(0.0, &got.windows);
            note(|| format!("{name}, {who:?}: balance {:.1e}", balance / largest));
            assert!(balance.abs() < 2e-6 * largest, "{name}, {who:?}: {balance} of {largest} J");
        }
        if gpu.report.doubles {
            let got = outcome(gpu, Who::Double, &model, &scene, &plan);
            within(
                &format!("{name}, doubles"),
                &errors(&plan, 0.04, &got, &exact),
                &[("surface v", 1e-8), ("contact steps", 5e-3)],
                1e-9,
            );
        }
    }
}
