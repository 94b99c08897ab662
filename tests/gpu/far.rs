//! Single precision far from where the wheel started: positions are kept relative to a frame that follows the axle.

use crate::rig::{Plan, Who, engine, noise, note, on_device, outcome, relative, safe_step, scene};
use hexroll::engine::{Engine, State};
use hexroll::gpu::{Gpu, Precision};
use hexroll::model::Model;
use hexroll::scene::Scene;

fn wheel(changes: &[&str]) -> (Scene, Model) {
    let scene = scene("lat100_straight_viscous", &[&["body.mesh.elements=[16, 2, 3]"], changes].concat());
    let model = Model::new(&scene).unwrap();
    (scene, model)
}

/// A wheel built a kilometre away has the forces of one at the origin. Its coordinates are rounded to 1e-13 m there,
/// which changes the digits of single precision (4e-9 m) of one coordinate in 10,000. Without a frame, single
/// precision would know positions to 6e-5 m only.
pub fn offset(gpu: &Gpu) {
    let (near_scene, near) = wheel(&[]);
    let (far_scene, far) = wheel(&["body.offset=[\"1000 m\", \"0 m\", \"0 m\"]"]);
    assert_eq!(near.classes.len(), far.classes.len());
    let mut random = noise(11);
    let u: Vec<[f64; 3]> = near.mesh.nodes.iter().map(|_| random.within(0.3e-3)).collect();
    let v: Vec<[f64; 3]> = near.mesh.nodes.iter().map(|_| random.within(1.0)).collect();
    for precision in [Precision::F32, Precision::F32Plus] {
        let forces = |scene: &Scene, model: &Model| {
            let x: Vec<[f64; 3]> =
                model.mesh.nodes.iter().zip(&u).map(|(X, u)| std::array::from_fn(|d| X[d] + u[d])).collect();
            on_device(gpu, model, scene, precision).force(&x, &v).unwrap()
        };
        let error = relative(&forces(&far_scene, &far), &forces(&near_scene, &near));
        note(|| format!("{precision:?}: {error:.1e}"));
        assert!(error < 1e-6, "forces 1 km away are off by {error:.2e}");
    }
}

/// Shape: positions as seen from the axle.
fn shape(state: &State, axle: [f64; 3]) -> Vec<[f64; 3]> {
    state.x.iter().map(|x| std::array::from_fn(|d| x[d] - axle[d])).collect()
}

/// A wheel pressed while it flies along at 300 m/s: 100 times its radius in 15 ms, over which the frame moves in
/// steps. Positions of single precision 5 m away would be rounded to 5e-7 m, 1e-5 of the radius.
pub fn followed(gpu: &Gpu) {
    let (scene, model) = wheel(&["friction.coefficient=0"]);
    let mut plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 10, 80);
    plan.setup.mass_damping = 0.0;
    for step in plan.windows.iter_mut().flatten().chain([&mut plan.next]) {
        step.rim[0] += 300.0 * (step.time + step.dt);
        step.rim[5] += 70.0 * (step.time + step.dt);
    }
    let axle = plan.next.rim;
    let field = |x: [f64; 3]| {
        let r: [f64; 3] = std::array::from_fn(|d| x[d] - model.mesh.axle[d]);
        [300.0 + 70.0 * r[2], 0.0, -70.0 * r[0]]
    };
    let plan = plan.starting(&model, field, [0.0; 6]);
    let end = plan.windows.last().unwrap().last().unwrap().rim;
    let axle_now = [end[0], end[1], end[2]];
    assert!(axle[0] > 2.0, "the wheel goes only {} m", axle[0]);
    let exact = outcome(gpu, Who::Cpu64, &model, &scene, &plan);
    for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
        let got = outcome(gpu, who, &model, &scene, &plan);
        let error = relative(&shape(&got.state, axle_now), &shape(&exact.state, axle_now));
        let forces: Vec<f64> =
            [&got, &exact].map(|o| o.windows.iter().map(|w| w.rim_impulse[2]).sum::<f64>()).to_vec();
        note(|| format!("{who:?} after {:.2} m: shape {error:.1e}, impulse {forces:?}", end[0]));
        assert!(error < 5e-6, "{who:?}: the shape is off by {error:.2e}");
        let moved = moved_by_sampling(gpu, who, &model, &scene, &plan);
        note(|| format!("{who:?}: sampling moves nodes by {moved:.1e} m"));
        // A coordinate of 40 mm is rounded to 2e-9 m, that of a pair to 2^-48 of itself, beside 4 m in f64.
        let most = if who == Who::Plus { 2e-15 } else { 2e-9 };
        assert!(moved <= most, "{who:?}: moving the frame moves nodes by {moved:.2e} m");
        assert!((forces[0] / forces[1] - 1.0).abs() < 1e-3, "{who:?}: {forces:?}");
    }
}

/// Furthest that a node is moved by a sample, which may move the frame and nothing else [m].
fn moved_by_sampling(gpu: &Gpu, who: Who, model: &Model, scene: &Scene, plan: &Plan) -> f64 {
    let mut engine = engine(gpu, who, model, scene);
    engine.begin_stage(&plan.setup).unwrap();
    let (v, rate) = plan.velocity.as_ref().unwrap();
    engine.set_velocity(v, rate).unwrap();
    let mut most = 0.0f64;
    for (k, steps) in plan.windows.iter().enumerate() {
        engine.advance(steps).unwrap();
        let before = engine.state().unwrap();
        engine.sample(plan.windows.get(k + 1).map_or(&plan.next, |w| &w[0])).unwrap();
        let after = engine.state().unwrap();
        assert!(before.v == after.v);
        let nodes = before.x.as_flattened().iter().zip(after.x.as_flattened());
        most = nodes.fold(most, |m, (a, b)| m.max((a - b).abs()));
    }
    most
}
