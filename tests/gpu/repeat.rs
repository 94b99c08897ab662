//! Reruns have the same bits, however the work is cut up.

use crate::rig::{Outcome, Plan, drive, on_device, safe_step, scene};
use hexroll::engine::Engine;
use hexroll::gpu::{Gpu, Precision};
use hexroll::model::Model;

/// Two reruns, each also cut into submissions of one step and folded into dispatches of two groups a dimension, have
/// the same states and windows, to the bit; and what is sampled or asked for on the way does not touch the state.
pub fn bit_identical(gpu: &Gpu) {
    let scene = scene("lat100_straight_viscous", &["body.mesh.elements=[20, 3, 3]"]);
    let model = Model::new(&scene).unwrap();
    // 180 elements in 3 groups, 320 nodes in 5.
    let mut narrow = gpu.clone();
    narrow.report.workgroups = 2;
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 4, 75);
    let plan = plan.starting(&model, |x| [1.0, 0.2 * x[0], -1.0 + x[1]], [0.0; 6]);
    let all = Precision::ALL.into_iter().filter(|p| *p != Precision::F64 || gpu.report.doubles);
    for precision in all {
        let run = |gpu: &Gpu, submits: Option<usize>| {
            let mut engine = on_device(gpu, &model, &scene, precision);
            engine.set_steps_per_submit(submits);
            drive(&mut engine, &plan).unwrap()
        };
        let first = run(gpu, None);
        assert!(first.windows.iter().all(|w| w.surface.iter().any(|s| s.touching > 0)), "nothing touches");
        for (name, again) in [
            ("a rerun", run(gpu, None)),
            ("one step a submission", run(gpu, Some(1))),
            ("a window a submission", run(gpu, Some(1024))),
            ("folded dispatches", run(&narrow, Some(7))),
        ] {
            same(name, &first, &again);
        }
        undisturbed(gpu, &scene, &model, &plan, precision, &first);
    }
}

fn same(name: &str, a: &Outcome, b: &Outcome) {
    assert!(a.state == b.state, "{name}: another state");
    for (k, (a, b)) in a.windows.iter().zip(&b.windows).enumerate() {
        assert!(a == b, "{name}: window {k} is {a:?}, was {b:?}");
    }
}

/// One long window, with forces asked for before it, ends in the same state as four short ones.
fn undisturbed(
    gpu: &Gpu,
    scene: &hexroll::scene::Scene,
    model: &Model,
    plan: &Plan,
    precision: Precision,
    first: &Outcome,
) {
    let mut engine = on_device(gpu, model, scene, precision);
    let long = Plan { windows: vec![plan.windows.concat()], ..plan.clone() };
    let spoilt = vec![[f64::NAN; 3]; model.node_count()];
    engine.force(&spoilt, &spoilt).unwrap();
    let other = drive(&mut engine, &long).unwrap();
    assert!(other.state == first.state, "sampling or trial forces change the state");
    assert_eq!(other.windows[0].steps, 300);
}
