//! Free rims: the axle finds its own way, on the device.

use crate::rig::{Outcome, Plan, Who, engine, note, outcome, safe_step, scene};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::scene::Scene;
use hexroll_lab::rig::{Recorder, close, simulate_on};

/// Errors of the free coordinates over all windows, relative to how far each goes, and of their rates, relative to
/// the fastest.
fn errors(a: &Outcome, b: &Outcome, component: usize) -> [f64; 2] {
    let start = b.windows[0].rim[component];
    let (mut moved, mut rate, mut error, mut rate_error) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for (a, b) in a.windows.iter().zip(&b.windows) {
        assert!(a.rim[component].is_finite() && a.rim_rate[component].is_finite());
        moved = moved.max((b.rim[component] - start).abs());
        rate = rate.max(b.rim_rate[component].abs());
        error = error.max((a.rim[component] - b.rim[component]).abs());
        rate_error = rate_error.max((a.rim_rate[component] - b.rim_rate[component]).abs());
    }
    [error / moved, rate_error / rate]
}

fn check(gpu: &Gpu, scene: &Scene, model: &Model, plan: &Plan, free: &[usize], bounds: [f64; 2]) {
    let exact = outcome(gpu, Who::Cpu64, model, scene, plan);
    for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
        let got = outcome(gpu, who, model, scene, plan);
        for &component in free {
            let found = errors(&got, &exact, component);
            note(|| format!("{who:?}, component {component}: {:.1e} {:.1e}", found[0], found[1]));
            assert!(
                found[0] < bounds[0] && found[1] < bounds[1],
                "{who:?}, component {component}: {found:?}"
            );
        }
    }
    // The rim's own mass off by 1 % must show.
    for &component in free {
        let mut mutant = plan.clone();
        *mutant.setup.free[component].as_mut().unwrap() *= 1.01;
        let found = errors(&outcome(gpu, Who::Cpu64, model, scene, &mutant), &exact, component);
        note(|| format!("mass of component {component} off: {:.1e} {:.1e}", found[0], found[1]));
        assert!(found[0] > 3.0 * bounds[0] || found[1] > 3.0 * bounds[1], "component {component}: {found:?}");
    }
}

/// The paper's static wheel: 300 N within 20 ms on a rim of 50 g, mass-damped.
pub fn pressed_by_a_force(gpu: &Gpu) {
    let scene = scene("lat100_static_relaxed", &[""; 0]);
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 20, 100);
    assert_eq!(plan.setup.free[2], Some(0.05));
    check(gpu, &scene, &model, &plan, &[2], [1e-4, 1e-3]);
}

/// Free to roll: pushed along by 5 N, pressed by 150 N, torque-free spin, starting faster than it rolls.
pub fn free_to_spin(gpu: &Gpu) {
    let (scene, model, plan) = rolling_free();
    check(gpu, &scene, &model, &plan, &[0, 2, 5], [1e-4, 1e-3]);
}

/// The same in double precision; ten times what is measured, 1e-13 of a rate after 2,000 steps in contact.
pub fn doubles(gpu: &Gpu) {
    let (scene, model, plan) = rolling_free();
    let [exact, got] = [Who::Cpu64, Who::Double].map(|who| outcome(gpu, who, &model, &scene, &plan));
    for component in [0, 2, 5] {
        let found = errors(&got, &exact, component);
        note(|| format!("Double, component {component}: {:.1e} {:.1e}", found[0], found[1]));
        assert!(found[0] < 1e-12 && found[1] < 1e-12, "Double, component {component}: {found:?}");
    }
}

/// A block whose top is a rim of 500 g, thrown down at 1 m/s: both fall by t + g t^2/2, whatever is computed. Single precision: a
/// coordinate of 70 mm is rounded to 4e-9 m, in each of the windows, beside 0.5 mm and more.
pub fn falls(gpu: &Gpu) {
    let sets = [
        "body.offset=[\"0 mm\", \"0 mm\", \"50 mm\"]",
        "body.mesh.elements=[3, 3, 3]",
        "rim={ nodes = \"z-max\" }",
        "stage.0.rim={ z = { force = \"0 N\", mass = \"500 g\" } }",
        "stage.0.duration=4 ms",
        "output.sample=0.5 ms",
        "output.snapshots=none",
    ];
    let scene = scene("bouncing_block", &sets);
    let model = Model::new(&scene).unwrap();
    let total = model.mass.iter().sum::<f64>() + 0.5;
    for who in [Who::Cpu64, Who::Gpu, Who::Plus] {
        let mut kept = Recorder::default();
        simulate_on(&scene, &model, &mut *engine(gpu, who, &model, &scene), &mut kept).unwrap();
        for s in &kept.samples {
            let fallen = s.time_s + 0.5 * 9.81 * s.time_s * s.time_s;
            close("fallen", model.mesh.axle[2] - s.axle_z_m, fallen, 2e-5);
            // Velocities are half a step old.
            let speed = 1.0 + 9.81 * (s.time_s - 0.5 * s.dt_s);
            close("kinetic energy", s.kinetic_J, 0.5 * total * speed * speed, 2e-5);
        }
    }
}

fn rolling_free() -> (Scene, Model, Plan) {
    let scene = scene("lat100_straight_viscous", &["body.mesh.elements=[20, 2, 3]"]);
    let model = Model::new(&scene).unwrap();
    let mut plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 20, 100);
    plan.setup.mass_damping = 0.0;
    plan.setup.free = [Some(0.2), None, Some(0.2), None, None, Some(2e-5)];
    for step in plan.windows.iter_mut().flatten().chain([&mut plan.next]) {
        step.load = [5.0, 0.0, -150.0 * (step.time / 0.01).min(1.0), 0.0, 0.0, 0.0];
    }
    let (speed, spin) = (2.0, 70.0);
    let field = |x: [f64; 3]| {
        let r: [f64; 3] = std::array::from_fn(|d| x[d] - model.mesh.axle[d]);
        [speed + spin * r[2], 0.0, -spin * r[0]]
    };
    let plan = plan.starting(&model, field, [speed, 0.0, 0.0, 0.0, 0.0, spin]);
    (scene, model, plan)
}
