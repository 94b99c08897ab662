//! Run level: a thousand steps, the same on every engine.

use crate::rig::{
    self, Outcome, Plan, Who, balances, engine, errors, list, note, outcome, relative, safe_step, scene,
    state_errors, within,
};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::scene::Scene;

/// Bounds of one scene, three to four times what is measured on a software adapter.
struct Bounds {
    fields: &'static [(&'static str, f64)],
    otherwise: f64,
    /// Displacement and velocity after the last step, relative L2: plain f32, and pairs.
    single: [f64; 2],
    pairs: [f64; 2],
    /// Balance of all works, and how far the stored balance may be from the f64 one, relative to the largest term.
    balance: f64,
    stored: f64,
    /// Forces at the last state.
    force: f64,
}

/// Smooth: 13 rad of spin with a strain of some percent. Displacements are as large as the block.
const BLOCK: Bounds = Bounds {
    fields: &[("min J", 2e-5), ("residual forces", 1.5e-3)],
    otherwise: 2e-6,
    single: [3e-6, 3e-4],
    pairs: [1.5e-6, 1.5e-4],
    balance: 1e-6,
    stored: 1e-5,
    force: 1e-3,
};

/// Displacements of a millimetre, of which single precision resolves 2e-6, and nodes that land a step sooner or later.
/// The energy of 880 elements that store nothing is the sum of their rounding, 1e-5 J beside 0.03 J.
const WHEEL: Bounds = Bounds {
    fields: &[
        ("works", 6e-5),
        ("half works", 3e-5),
        ("energies", 4e-3),
        ("rim impulse", 2e-4),
        ("contact impulse", 4e-5),
        ("surface v", 3e-2),
        ("residual forces", 6e-3),
        ("contact steps", 6e-2),
    ],
    otherwise: 5e-6,
    single: [4e-5, 6e-3],
    pairs: [8e-6, 1.5e-3],
    balance: 1e-6,
    stored: 2e-3,
    force: 1e-3,
};

pub fn spinning_block(gpu: &Gpu) {
    let scene = scene("spinning_block", &[""; 0]);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 10, 100);
    // Turning at 377 rad/s about its middle, and stretching.
    let field = |x: [f64; 3]| {
        let r = [x[0] - 0.05, x[1] - 0.02];
        [1.0 - 377.0 * r[1] + 60.0 * r[0], 377.0 * r[0] - 20.0 * r[1], 3.0 * (x[0] / 0.05).sin()]
    };
    let plan = plan.starting(&model, field, [0.0; 6]);
    let exact = compare(gpu, &scene, &model, &plan, &BLOCK);
    // A shear modulus off by 0.1 % must show.
    let stiffer = rig::scene("spinning_block", &["body.material.shear_modulus=\"2.64264 MPa\""]);
    let mutant = outcome(gpu, Who::Cpu64, &Model::new(&stiffer).unwrap(), &stiffer, &plan);
    let found = state_errors(&model, &mutant, &exact);
    note(|| format!("shear modulus off: {}", list(&found)));
    assert!(found[0].1 > 3.0 * BLOCK.single[0], "a shear modulus off by 0.1 % is not noticed: {found:?}");
}

pub fn pressed_wheel(gpu: &Gpu) {
    let scene = scene("lat100_static_height", &[""; 0]);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 10, 100);
    let exact = compare(gpu, &scene, &model, &plan, &WHEEL);
    let stiffer = rig::scene("lat100_static_height", &["body.material.shear_modulus=\"2.64264 MPa\""]);
    let mutant = outcome(gpu, Who::Cpu64, &Model::new(&stiffer).unwrap(), &stiffer, &plan);
    let found = state_errors(&model, &mutant, &exact);
    note(|| format!("shear modulus off: {}", list(&found)));
    assert!(found[0].1 > 3.0 * WHEEL.pairs[0], "a shear modulus off by 0.1 % is not noticed: {found:?}");
}

/// A thousand steps in double precision, of the pressed wheel.
pub fn doubles(gpu: &Gpu) {
    let scene = scene("lat100_static_height", &[""; 0]);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 10, 100);
    let [exact, got] = [Who::Cpu64, Who::Double].map(|who| outcome(gpu, who, &model, &scene, &plan));
    // A wheel at rest but for its tread: speeds are small, and there is nothing else to measure their errors by.
    let fields = [("contact steps", 0.0), ("surface v", 1e-10)];
    within("Double", &errors(&plan, 0.04, &got, &exact), &fields, 1e-12);
    within("Double", &state_errors(&model, &got, &exact), &[("velocity", 3e-11)], 1e-12);
    let [balance, stored, largest] = balances(0.0, &got.windows);
    let [_, stored_exact, _] = balances(0.0, &exact.windows);
    let [balance, stored] = [balance, stored - stored_exact].map(|e| e.abs() / largest);
    note(|| format!("Double: balance {balance:.1e}, stored {stored:.1e}"));
    // Round-off of some thousand sums, measured 6e-17; and of stored energies that all engines get alike, 2e-14.
    assert!(balance < 1e-13 && stored < 1e-12, "balance {balance:.2e}, stored {stored:.2e} from the CPU's");
}

/// Runs the plan on every engine, and gives back what the CPU makes of it in f64.
fn compare(gpu: &Gpu, scene: &Scene, model: &Model, plan: &Plan, bounds: &Bounds) -> Outcome {
    let exact = outcome(gpu, Who::Cpu64, model, scene, plan);
    let given = plan.given(model);
    let [_, stored_exact, _] = balances(given, &exact.windows);
    for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
        let got = outcome(gpu, who, model, scene, plan);
        within(&format!("{who:?}"), &errors(plan, 0.04, &got, &exact), bounds.fields, bounds.otherwise);
        let [u, v] = if who == Who::Plus { bounds.pairs } else { bounds.single };
        within(&format!("{who:?}"), &state_errors(model, &got, &exact), &[("displacement", u)], v);
        let [balance, stored, largest] = balances(given, &got.windows);
        let [balance, stored] = [balance, stored - stored_exact].map(|e| e.abs() / largest);
        let forces = [who, Who::Cpu64].map(|who| forces_at(gpu, who, model, scene, &exact));
        let force = relative(&forces[0], &forces[1]);
        note(|| {
            let stored_exact = stored_exact / largest;
            format!(
                "{who:?}: balance {balance:.1e}, stored {stored:.1e} from {stored_exact:.1e}, force {force:.1e}"
            )
        });
        assert!(balance < bounds.balance, "{who:?}: balance {balance:.2e}");
        assert!(stored < bounds.stored, "{who:?}: stored balance {stored:.2e} from that in f64");
        assert!(force < bounds.force, "{who:?}: forces are off by {force:.2e}");
    }
    exact
}

fn forces_at(gpu: &Gpu, who: Who, model: &Model, scene: &Scene, at: &Outcome) -> Vec<[f64; 3]> {
    engine(gpu, who, model, scene).force(&at.state.x, &at.state.v).unwrap()
}
