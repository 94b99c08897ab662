//! Pass level: one step, then some, of a small wheel with everything a scene can have: gravity, mass damping,
//! viscosity, sliding and sticking contact on a moving road, a rim that moves, steers and spins.

use crate::rig::{
    Outcome, Plan, Who, beyond, errors, list, noise, note, outcome, scene, state_errors, within,
};
use hexroll::engine::{StageSetup, Step};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::scene::Scene;
use hexroll_lab::rig::given::OUTER_RADIUS;

fn wheel(changes: &[&str]) -> (Scene, Model) {
    let all = [
        "body.mesh.elements=[12, 2, 2]",
        "gravity=[\"100 m/s2\", \"200 m/s2\", \"-981 m/s2\"]",
        "road.velocity=[\"1 m/s\", \"0.3 m/s\", \"0 m/s\"]",
        "friction.coefficient=0.3",
    ];
    let scene = scene("lat100_straight_viscous", &[&all, changes].concat());
    let model = Model::new(&scene).unwrap();
    (scene, model)
}

/// Rim coordinates at a time: forwards, down and sideways, steering, cambering, spinning.
fn rim(model: &Model, t: f64) -> [f64; 6] {
    let [x, y, z] = model.mesh.axle;
    [x + 2.0 * t, y + 0.1 * t, z - t, 0.02 + 5.0 * t, 3.0 * t, 60.0 * t]
}

/// One window a list of steps; every step has its own length.
fn plan(model: &Model, windows: &[&[f64]]) -> Plan {
    let (mut time, mut before) = (0.0, 0.0);
    let mut step = |dt: f64| {
        let planned = Step { time, dt, dt_before: before, rim: rim(model, time + dt), load: [0.0; 6] };
        (time, before) = (time + dt, dt);
        planned
    };
    let windows: Vec<Vec<Step>> = windows.iter().map(|w| w.iter().map(|&dt| step(dt)).collect()).collect();
    let next = step(4e-6);
    let setup = StageSetup { mass_damping: 500.0, ..Default::default() };
    let mut random = noise(3);
    let field = |_| {
        let v = random.within(0.5);
        [v[0] + 1.5, v[1], v[2] - 1.0]
    };
    Plan { setup, velocity: None, windows, next }.starting(model, field, [0.0; 6])
}

/// Bounds of a field, about four times what is measured (software adapter; the CPU in f32 is as far off): a rounding of
/// a coordinate, 4e-9 m, is 4e-6 of the way of a step and 1e-6 of the strain. Contact steps: nodes that land a step
/// sooner or later.
const BOUNDS: [(&str, f64); 9] = [
    ("works", 3e-5),
    ("energies", 3e-5),
    ("rim impulse", 1e-4),
    ("contact impulse", 1e-4),
    ("surface x", 2e-6),
    ("surface v", 3e-4),
    ("residual forces", 3e-4),
    ("min J", 5e-6),
    ("contact steps", 5e-3),
];
/// All other fields.
const OTHERWISE: f64 = 1e-5;
const STATE: [(&str, f64); 2] = [("displacement", 5e-5), ("velocity", 2e-4)];
/// Rim nodes of the CPU in f32 have velocities from differences of positions, good to 1e-4 only.
const STATE_SINGLE: [(&str, f64); 2] = [("displacement", 5e-5), ("velocity", 5e-4)];

pub fn everything(gpu: &Gpu) {
    let (scene, model) = wheel(&[]);
    let long = [5e-6; 300];
    // First one step alone; then steps of changing length; then on.
    let plans: [(&str, &[&[f64]]); 3] =
        [("one step", &[&[5e-6]]), ("three steps", &[&[5e-6], &[6e-6, 4e-6]]), ("300 steps", &[&long])];
    for (name, windows) in plans {
        let plan = plan(&model, windows);
        let exact = outcome(gpu, Who::Cpu64, &model, &scene, &plan);
        assert!(sliding(&exact) > 0 && sticking(&exact) > 0, "{name}: no node slides, or none sticks");
        let single = outcome(gpu, Who::Cpu32, &model, &scene, &plan);
        check(&format!("{name}, CPU f32"), &model, &plan, &single, &exact, &STATE_SINGLE);
        for who in [Who::Gpu, Who::Plus] {
            let got = outcome(gpu, who, &model, &scene, &plan);
            check(&format!("{name}, {who:?}"), &model, &plan, &got, &exact, &STATE);
            check(&format!("{name}, {who:?} and CPU f32"), &model, &plan, &got, &single, &STATE_SINGLE);
        }
    }
    mutants(gpu, &[&long]);
}

/// Bound of every field in double precision: ten times what is measured, most of which are speeds in contact (1e-13).
const DOUBLE: f64 = 1e-12;

/// The same in double precision: the CPU's numbers to rounding, and every node in contact in the same steps.
pub fn doubles(gpu: &Gpu) {
    for law in ["neo-hookean", "mooney-rivlin-eq4"] {
        let change = format!("body.material.law=\"{law}\"");
        let (scene, model) = wheel(&[&change]);
        let plan = plan(&model, &[&[5e-6], &[6e-6, 4e-6], &[5e-6; 300]]);
        let [exact, got] = [Who::Cpu64, Who::Double].map(|who| outcome(gpu, who, &model, &scene, &plan));
        assert!(sliding(&exact) > 0 && sticking(&exact) > 0, "no node slides, or none sticks");
        within(law, &errors(&plan, OUTER_RADIUS, &got, &exact), &[("contact steps", 0.0)], DOUBLE);
        within(law, &state_errors(&model, &got, &exact), &[], DOUBLE);
    }
}

fn sliding(outcome: &Outcome) -> usize {
    outcome.windows.iter().flat_map(|w| &w.surface).filter(|s| s.touching > s.sticking).count()
}

fn sticking(outcome: &Outcome) -> usize {
    outcome.windows.iter().flat_map(|w| &w.surface).filter(|s| s.sticking > 0).count()
}

fn check(who: &str, model: &Model, plan: &Plan, got: &Outcome, exact: &Outcome, state: &[(&str, f64)]) {
    within(who, &errors(plan, OUTER_RADIUS, got, exact), &BOUNDS, OTHERWISE);
    within(who, &state_errors(model, got, exact), state, OTHERWISE);
}

/// Every constant off by 0.1 % is seen by some field (a weak one: by 1 %).
fn mutants(gpu: &Gpu, windows: &[&[f64]]) {
    let (scene, model) = wheel(&[]);
    let right = plan(&model, windows);
    let exact = outcome(gpu, Who::Cpu64, &model, &scene, &right);
    let mut damped = right.clone();
    damped.setup.mass_damping *= 1.001;
    let mut turned = right.clone();
    turned.windows.iter_mut().flatten().for_each(|s| s.rim[5] *= 1.001);
    let changes = [
        ("mass damping", "", &damped),
        ("spin", "", &turned),
        ("gravity", "gravity=[\"100.1 m/s2\", \"200.2 m/s2\", \"-981.981 m/s2\"]", &right),
        ("friction", "friction.coefficient=0.3003", &right),
        ("road", "road.velocity=[\"1.001 m/s\", \"0.3 m/s\", \"0 m/s\"]", &right),
        ("density", "body.density=\"1101.1 kg/m3\"", &right),
        ("shear modulus", "body.material.shear_modulus=\"2.64264 MPa\"", &right),
        ("viscosity", "body.material.viscosity=\"20.2 Pa s\"", &right),
    ];
    for (name, change, plan) in changes {
        let change = if change.is_empty() { vec![] } else { vec![change] };
        let (scene, model) = wheel(&change);
        let mutant = outcome(gpu, Who::Cpu64, &model, &scene, plan);
        let found = [
            beyond(&errors(&right, OUTER_RADIUS, &mutant, &exact), &BOUNDS, OTHERWISE),
            beyond(&state_errors(&model, &mutant, &exact), &STATE, OTHERWISE),
        ]
        .concat();
        note(|| format!("{name} off: {}", list(&found)));
        assert!(!found.is_empty(), "{name} off by 0.1 % is not noticed");
    }
}
