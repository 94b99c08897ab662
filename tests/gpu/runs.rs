//! Run level: a thousand steps, the same on every engine.

use crate::rig::{
    Plan, Who, balances, displacement, note, outcome, relative, safe_step, scene, within, worst_errors,
};
use hexroll::gpu::Gpu;
use hexroll::model::Model;

pub fn spinning_block(gpu: &Gpu) {
    let scene = scene("spinning_block", &[]);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 10, 100);
    // Turning at 377 rad/s about its middle, and stretching.
    let field = |x: [f64; 3]| {
        let r = [x[0] - 0.05, x[1] - 0.02];
        [1.0 - 377.0 * r[1] + 60.0 * r[0], 377.0 * r[0] - 20.0 * r[1], 3.0 * (x[0] / 0.05).sin()]
    };
    let plan = plan.starting(&model, field, [0.0; 6]);
    compare(gpu, &scene, &model, &plan);
}

pub fn pressed_wheel(gpu: &Gpu) {
    let scene = scene("lat100_static_height", &[]);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 10, 100);
    compare(gpu, &scene, &model, &plan);
}

fn compare(gpu: &Gpu, scene: &hexroll::scene::Scene, model: &Model, plan: &Plan) {
    let exact = outcome(gpu, Who::Cpu64, model, scene, plan);
    for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
        let got = outcome(gpu, who, model, scene, plan);
        let u = relative(&displacement(model, &got.state), &displacement(model, &exact.state));
        let v = relative(&got.state.v, &exact.state.v);
        let [balance, stored, largest] = balances(plan.given(model), &got.windows);
        let [_, stored_exact, _] = balances(plan.given(model), &exact.windows);
        note(|| {
            format!(
                "{who:?}: u {u:.1e} v {v:.1e} balance {:.1e} stored {:.1e} (f64 {:.1e}) of {largest:.2e} J",
                balance / largest,
                stored / largest,
                stored_exact / largest
            )
        });
        within(&format!("{who:?}"), &worst_errors(&got, &exact), &[], 1.0);
    }
}
