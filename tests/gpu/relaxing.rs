//! A Prony series on the device: what its points remember is what the CPU's do, for every element, in a lattice and by tables; and
//! samples, trial forces and states that are set leave in it what they leave there.

use crate::forces::notched;
use crate::rig::{
    Plan, Who, drive, engine, errors, list, noise, outcome, safe_step, scene, state_errors, within,
};
use hexroll::engine::{StageSetup, State, Step};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::physics::material::Term;
use hexroll::scene::{Element, Relaxation, Scene};
use hexroll_lab::rig::given::OUTER_RADIUS;
use hexroll_lab::rig::{ELEMENTS, distort};

/// Times of a few hundred and of ten thousand steps, and ratios that make a stress of their own.
fn series() -> Relaxation {
    Relaxation { terms: vec![Term { ratio: 0.7, time: 1e-4 }, Term { ratio: 0.4, time: 3e-3 }] }
}

/// A small body that nothing holds, of any element: a wheel whose nodes stand in a lattice, with a viscosity, or a block without its
/// elements along an edge, in any shape.
fn body(element: Element, lattice: bool) -> (Scene, Model) {
    let mut scene = match lattice {
        true => scene("lat100_straight_viscous", &["body.mesh.elements=[9, 2, 3]"]),
        false => scene("spinning_block", &["body.mesh.elements=[4, 3, 3]"]),
    };
    scene.body.element = element;
    scene.body.relaxation = series();
    scene.body.viscosity = lattice.then_some(20.0);
    (scene.rim, scene.road, scene.friction) = (None, None, None);
    let mut mesh = Model::new(&scene).unwrap().mesh;
    if !lattice {
        mesh = notched(&mesh).expect("more than a column of elements");
        distort(&mut mesh, 3e-3, 0.1);
    }
    let model = Model::from_mesh(mesh, &scene.body).unwrap();
    (scene, model)
}

/// Windows of steps whose lengths change, from velocities at random.
fn plan(model: &Model) -> Plan {
    let dt = safe_step(model);
    let (mut time, mut before) = (0.0, 0.0);
    let mut step = |dt: f64| {
        let planned = Step { time, dt, dt_before: before, rim: [0.0; 6], load: [0.0; 6] };
        (time, before) = (time + dt, dt);
        planned
    };
    let windows = [3, 20, 57].map(|n| (0..n).map(|k| step(if k % 5 < 2 { dt } else { 0.7 * dt })).collect());
    let next = step(dt);
    let mut random = noise(5);
    Plan { setup: StageSetup::default(), velocity: None, windows: windows.into(), next }.starting(
        model,
        |_| random.within(2.0),
        [0.0; 6],
    )
}

/// Largest error of the energy lost in each window, over the largest of them.
fn loss_error(a: &crate::rig::Outcome, b: &crate::rig::Outcome) -> f64 {
    let most = b.windows.iter().fold(0.0f64, |m, w| m.max(w.dissipated));
    assert!(b.windows.iter().all(|w| w.dissipated > 0.0), "nothing is lost");
    a.windows.iter().zip(&b.windows).fold(0.0f64, |m, (a, b)| m.max((a.dissipated - b.dissipated).abs()))
        / most
}

/// Single precision as in `steps`: rounding of a coordinate, 4e-9 m, is 1e-6 of the strain. Each force that it changes changes
/// velocities.
const SINGLE: f64 = 3e-5;
const STATE: [(&str, f64); 1] = [("velocity", 5e-4)];

pub fn agrees(gpu: &Gpu) {
    for element in ELEMENTS {
        for lattice in [true, false] {
            let (scene, model) = body(element, lattice);
            let plan = plan(&model);
            let exact = outcome(gpu, Who::Cpu64, &model, &scene, &plan);
            for who in [Who::Gpu, Who::Plus] {
                let name = format!("{who:?} {element:?} lattice {lattice}");
                let got = outcome(gpu, who, &model, &scene, &plan);
                within(
                    &name,
                    &errors(&plan, OUTER_RADIUS, &got, &exact),
                    &[("residual forces", 2e-4), ("contact steps", 0.0)],
                    SINGLE,
                );
                within(&name, &state_errors(&model, &got, &exact), &STATE, SINGLE);
                let lost = loss_error(&got, &exact);
                assert!(lost < SINGLE, "{name}: loss off by {lost:.1e}");
            }
            mutants(gpu, &plan, element, lattice);
        }
    }
}

/// A ratio off by 1 % is seen, and a time off by 5 %.
fn mutants(gpu: &Gpu, plan: &Plan, element: Element, lattice: bool) {
    let (scene, model) = body(element, lattice);
    let got = outcome(gpu, Who::Gpu, &model, &scene, plan);
    for k in 0..series().terms.len() {
        for time in [false, true] {
            let mut wrong = model.clone();
            let term = &mut wrong.relaxation.terms[k];
            *(if time { &mut term.time } else { &mut term.ratio }) *= if time { 1.05 } else { 1.01 };
            let exact = outcome(gpu, Who::Cpu64, &wrong, &scene, plan);
            let errors = state_errors(&model, &got, &exact);
            let lost = loss_error(&got, &exact);
            assert!(
                errors.iter().any(|(_, e)| *e > 5e-4) || lost > 5.0 * SINGLE,
                "{element:?} term {k}, time {time}: unseen, {} loss {lost:.1e}",
                list(&errors)
            );
        }
    }
}

/// In double precision: the CPU's numbers to rounding.
pub fn doubles(gpu: &Gpu) {
    for element in ELEMENTS {
        let (scene, model) = body(element, true);
        let plan = plan(&model);
        let [exact, got] = [Who::Cpu64, Who::Double].map(|who| outcome(gpu, who, &model, &scene, &plan));
        within("doubles", &errors(&plan, OUTER_RADIUS, &got, &exact), &[("contact steps", 0.0)], 1e-11);
        within("doubles", &state_errors(&model, &got, &exact), &[], 1e-11);
        assert!(loss_error(&got, &exact) < 1e-11);
    }
}

/// What a solver has set is at rest, whatever the points remembered; trial forces are those of the whole modulus, and change nothing.
pub fn disturbed(gpu: &Gpu) {
    let (scene, model) = body(Element::Q1p0, true);
    let plan = plan(&model);
    let go = |who| {
        let mut engine = engine(gpu, who, &model, &scene);
        drive(&mut *engine, &plan).unwrap();
        let State { x, v } = engine.state().unwrap();
        let squeezed: Vec<[f64; 3]> = x.iter().map(|x| x.map(|c| 0.98 * c)).collect();
        let forces = engine.force(&squeezed, &v).unwrap();
        let set = State { x: squeezed, v: vec![[0.0; 3]; v.len()] };
        engine.set_state(&set, &[0.0; 6], &[0.0; 6]).unwrap();
        let first = Step { dt_before: 0.0, ..plan.windows[1][0] };
        engine.advance(&[first]).unwrap();
        engine.advance(&plan.windows[1][1..]).unwrap();
        (forces, engine.state().unwrap())
    };
    let [exact, got] = [Who::Cpu64, Who::Gpu].map(go);
    let error = crate::rig::relative(&got.0, &exact.0);
    assert!(error < 1e-4, "trial forces: {error:.1e}");
    let error = crate::rig::relative(&got.1.v, &exact.1.v);
    assert!(error < 1e-4, "velocities: {error:.1e}");
}
