//! Bodies that take their steps together have the bits they would have alone.

use crate::rig::{Outcome, Plan, drive, on_device, safe_step, scene};
use hexroll::Error;
use hexroll::engine::Engine;
use hexroll::gpu::{Gpu, GpuEngine, Precision, advance_together, ensemble};
use hexroll::model::Model;
use hexroll::physics::friction::PressureVelocity;
use hexroll::scene::{Friction, Scene};

/// A body and what it does.
struct Body {
    scene: Scene,
    model: Model,
    plan: Plan,
}

/// A wheel that rolls from the first step with this side speed; `share`: of the usual step.
fn wheel(changes: &[&str], side: f64, share: f64, steps: usize) -> Body {
    let own = ["body.mesh.elements=[20, 3, 3]"];
    let scene = scene("lat100_straight_viscous", &[&own[..], changes].concat());
    let model = Model::new(&scene).unwrap();
    let plan = Plan::of_first_stage(&scene, &model, share * safe_step(&model), 3, steps);
    let plan = plan.starting(&model, |x| [1.0, side + 0.2 * x[0], -1.0 + x[1]], [0.0; 6]);
    Body { scene, model, plan }
}

fn bodies() -> Vec<Body> {
    let damped = |mut body: Body| {
        body.plan.setup.mass_damping = 300.0;
        body
    };
    let pressed = |mut body: Body| {
        let law = Friction::PressureVelocity(PressureVelocity {
            a: 0.3,
            b: 0.4,
            pressure: 2e5,
            c: 0.3,
            speed: 0.5,
        });
        body.scene.friction = Some(law);
        body
    };
    vec![
        // Four that share a dispatch, of other motion, step, number of steps, and kind of stage.
        wheel(&[], 0.0, 1.0, 75),
        wheel(&[], 0.3, 1.0, 75),
        wheel(&[], -0.2, 0.8, 40),
        damped(wheel(&[], 0.1, 0.9, 60)),
        // Other constants, other tables, other kernels.
        wheel(&["friction.coefficient=0.3"], 0.3, 1.0, 75),
        wheel(&["body.mesh.elements=[16, 2, 3]"], 0.3, 1.0, 75),
        wheel(
            &["body.element=uniform-gradient", "gravity=[\"9 m/s2\", \"0 m/s2\", \"-81 m/s2\"]"],
            0.3,
            1.0,
            50,
        ),
        // Two whose friction looks at areas, each at its own.
        pressed(wheel(&[], 0.3, 0.7, 30)),
        pressed(wheel(&[], -0.3, 0.8, 35)),
    ]
}

fn same(name: &str, a: &Outcome, b: &Outcome) {
    assert!(a.state == b.state, "{name}: another state");
    for (k, (a, b)) in a.windows.iter().zip(&b.windows).enumerate() {
        assert!(a == b, "{name}: window {k} is {a:?}, was {b:?}");
    }
}

/// Drives each engine with a thread of its own.
fn together(engines: Vec<GpuEngine>, bodies: &[Body]) -> Vec<hexroll::Result<Outcome>> {
    std::thread::scope(|scope| {
        let drivers: Vec<_> = (engines.into_iter().zip(bodies))
            .map(|(mut engine, body)| scope.spawn(move || drive(&mut engine, &body.plan)))
            .collect();
        drivers.into_iter().map(|d| d.join().unwrap()).collect()
    })
}

fn engines(gpu: &Gpu, bodies: &[Body]) -> Vec<GpuEngine> {
    let pairs: Vec<(&Model, &Scene)> = bodies.iter().map(|b| (&b.model, &b.scene)).collect();
    ensemble(gpu, &pairs).unwrap_or_else(|e| panic!("{e}"))
}

/// Bodies alike and unlike, each to the bit what it is alone; one whose plan fails says so, and the others go on.
pub fn as_alone(gpu: &Gpu) {
    let mut bodies = bodies();
    let node = 57;
    bodies[1].plan.velocity.as_mut().unwrap().0[node] = [0.0, f64::NAN, 0.0];
    let found = together(engines(gpu, &bodies), &bodies);
    for (k, (body, found)) in bodies.iter().zip(found).enumerate() {
        let mut engine = on_device(gpu, &body.model, &body.scene, Precision::F32);
        let alone = drive(&mut engine, &body.plan);
        assert!(engine.is_resident());
        match (k, alone, found) {
            (1, Err(alone), Err(found)) => {
                assert!(matches!(found, Error::NotFinite { .. }), "{found}");
                assert_eq!(alone.to_string(), found.to_string());
            }
            (_, Ok(alone), Ok(found)) => {
                assert!(
                    found.windows.iter().any(|w| w.surface.iter().any(|s| s.touching > 0)),
                    "{k}: nothing touches"
                );
                same(&format!("body {k}"), &alone, &found);
            }
            (_, alone, found) => panic!("body {k}: {:?} alone, {:?} together", alone.err(), found.err()),
        }
    }
}

/// Engines driven by one thread are where those are that have one each, and alone; bodies that are alike share a dispatch.
pub fn by_one_thread(gpu: &Gpu) {
    let bodies = [
        wheel(&[], 0.0, 1.0, 30),
        wheel(&[], 0.3, 1.0, 30),
        wheel(&["friction.coefficient=0.3"], 0.3, 1.0, 30),
    ];
    let mut engines = engines(gpu, &bodies);
    assert!(engines[0].shares_dispatches(&engines[1]) && !engines[0].shares_dispatches(&engines[2]));
    let steps = bodies[0].plan.windows.concat();
    for (engine, body) in engines.iter_mut().zip(&bodies) {
        engine.set_steps_per_submit(Some(32));
        start(engine, &body.plan);
    }
    advance_together(&mut engines, &steps).unwrap();
    for (k, (engine, body)) in engines.iter_mut().zip(&bodies).enumerate() {
        let mut alone = on_device(gpu, &body.model, &body.scene, Precision::F32);
        start(&mut alone, &body.plan);
        alone.advance(&steps).unwrap();
        let (found, expected) = (engine.state().unwrap(), alone.state().unwrap());
        assert!(found == expected, "body {k}: another state");
        let next = &body.plan.next;
        assert!(engine.sample(next).unwrap() == alone.sample(next).unwrap(), "body {k}: another window");
    }
}

fn start(engine: &mut GpuEngine, plan: &Plan) {
    engine.begin_stage(&plan.setup).unwrap();
    let (v, rate) = plan.velocity.as_ref().expect("wheels start with a velocity");
    engine.set_velocity(v, rate).unwrap();
}

/// A body that has no place in a work group is refused, with what would be right.
pub fn too_large(gpu: &Gpu) {
    let small = wheel(&[], 0.0, 1.0, 5);
    let large = wheel(&["body.mesh.elements=[88, 8, 10]"], 0.0, 1.0, 5);
    let pairs = [(&small.model, &small.scene), (&large.model, &large.scene)];
    let Err(error) = ensemble(gpu, &pairs) else { panic!("7,040 elements fit into a work group's memory") };
    assert!(matches!(error, Error::Unsupported { .. }) && error.to_string().contains("7040"), "{error}");
}
