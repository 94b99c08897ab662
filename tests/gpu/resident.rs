//! Small meshes in one work group's memory: the same steps, with forces summed in another order.

use crate::rig::{
    Plan, Who, as_hardware, drive, errors, on_device, outcome, safe_step, scene, state_errors, within,
};
use hexroll::engine::Engine;
use hexroll::gpu::{Gpu, Precision};
use hexroll::model::Model;
use hexroll_lab::rig::given::OUTER_RADIUS;

/// Everything a resident stage can have (gravity, damping, viscosity, friction, a rim that turns), against the f64
/// engine and against the passes. Bounds as in steps.rs for the former; the latter differ by the same roundings.
pub fn agrees(gpu: &Gpu) {
    // Chains as long as they can be, and as long as the work group's threads ask.
    agrees_on(gpu);
    agrees_on(&as_hardware(gpu));
}

fn agrees_on(gpu: &Gpu) {
    for (stem, changes) in [
        (
            "lat100_straight_viscous",
            &["gravity=[\"100 m/s2\", \"200 m/s2\", \"-981 m/s2\"]", "friction.coefficient=0.3"][..],
        ),
        ("lat100_straight", &["body.element=uniform-gradient"]),
        ("spinning_block", &[""; 0]),
    ] {
        let scene = scene(stem, changes);
        let model = Model::new(&scene).unwrap();
        let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 3, 80);
        // A block with nothing to deform it would have no forces to compare.
        let shear = if stem == "spinning_block" { 30.0 } else { 0.0 };
        let plan = plan.starting(&model, |x| [1.0 + shear * x[1], 0.2 * x[0], -1.0 + x[1]], [0.0; 6]);
        let exact = outcome(gpu, Who::Cpu64, &model, &scene, &plan);
        let [resident, passes] = [true, false].map(|allowed| {
            let mut engine = on_device(gpu, &model, &scene, Precision::F32);
            engine.set_resident(allowed).unwrap();
            engine.begin_stage(&plan.setup).unwrap();
            assert_eq!(engine.is_resident(), allowed, "{stem}");
            drive(&mut engine, &plan).unwrap()
        });
        // A coordinate's rounding, 4e-9 m, beside the 2e-5 m of a step's way; contact may come a step sooner or later.
        let bounds = [
            ("contact steps", 2e-2),
            ("surface v", 1e-2),
            ("residual forces", 2e-2),
            ("contact impulse", 1e-3),
        ];
        for (who, other) in [("resident and f64", &exact), ("resident and passes", &passes)] {
            within(&format!("{stem}: {who}"), &errors(&plan, OUTER_RADIUS, &resident, other), &bounds, 1e-3);
            within(
                &format!("{stem}: {who}"),
                &state_errors(&model, &resident, other),
                &[("displacement", 1e-4)],
                1e-2,
            );
        }
    }
}
