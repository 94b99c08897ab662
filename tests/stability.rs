//! The critical step: against a known value, and against what the scheme does on either side of it.

use hexroll::engine::State;
use hexroll::error::Error;
use hexroll::model::Model;
use hexroll::run::stability::{self, Critical};
use hexroll::scene::{Drive, Lumping, Scene};
use hexroll_lab::rig::given::{DEPTH, VISCOSITY};
use hexroll_lab::rig::{self, Driver, Random, block, close, reference, wheel};

/// Critical step in the reference shape.
fn at_rest(driver: &mut Driver, model: &Model) -> Critical {
    let guess = stability::element_bound(model).unwrap();
    stability::assembled(&mut *driver.engine, model, &model.mesh.nodes, guess, None).unwrap()
}

/// Steps of `dt` from a random velocity of 1e-6 m/s; what ends them, if anything.
fn shaken(scene: &Scene, dt: f64, steps: usize) -> hexroll::Result<f64> {
    shaken_from(scene, None, dt, steps)
}

/// The same from a state and a pose of the rim.
fn shaken_from(
    scene: &Scene,
    from: Option<&(State, [f64; 6])>,
    dt: f64,
    steps: usize,
) -> hexroll::Result<f64> {
    let model = Model::new(scene).unwrap();
    let mut driver = Driver::new(&model, scene).unwrap();
    if let Some((state, rim)) = from {
        driver.engine.set_state(state, rim, &[0.0; 6]).unwrap();
        driver.rim = *rim;
    }
    let mut random = Random::new(5);
    let held = |n: usize| model.mesh.rim.binary_search(&(n as u32)).is_ok();
    let v: Vec<[f64; 3]> = (0..model.node_count())
        .map(|n| if held(n) { [0.0; 3] } else { random.vector().map(|v| 1e-6 * v) })
        .collect();
    driver.engine.set_velocity(&v, &[0.0; 6]).unwrap();
    driver.advance(std::iter::repeat_n(dt, steps))?;
    Ok(rig::largest(&driver.engine.state().unwrap().v))
}

/// At 0.97 of the critical step nothing grows, at 1.03 an element fails and the error names it and the step.
fn assert_sharp(scene: &Scene, critical: f64) {
    let speed = shaken(scene, 0.97 * critical, 3000).expect("stable below the critical step");
    // A mode of frequency w at dt overshoots by up to 1/sqrt(1 - (w dt / 2)^2) = 4.
    assert!(speed < 1e-5, "grew to {speed} m/s from 1e-6");
    assert_fails(scene, None, critical);
}

fn assert_fails(scene: &Scene, from: Option<&(State, [f64; 6])>, critical: f64) {
    let elements = Model::new(scene).unwrap().element_count();
    // The worst mode grows by exp(2 acosh 1.03) = 1.6 a step: from 1e-12 m to a millimetre in 50, with viscosity later.
    let error =
        shaken_from(scene, from, 1.03 * critical, 3000).expect_err("unstable above the critical step");
    let (Error::Inverted { step, element, .. } | Error::NotFinite { step, element, .. }) = error else {
        panic!("not a numerical failure: {error}")
    };
    assert!(step > 10 && step < 3000 && element < elements, "{error}");
    let text = error.to_string();
    assert!(text.contains(&format!("element {element}")) && text.contains(&format!("step {step}")), "{text}");
}

/// The paper's wheel at rest with equal masses, by an independent program. The bound from single elements is below.
#[test]
fn the_wheels_critical_step_is_the_known_one() {
    let mut scene = wheel([44, 4, 5], 0.0);
    scene.body.lumping = Lumping::Equal;
    scene.road = None;
    let model = Model::new(&scene).unwrap();
    let mut driver = Driver::new(&model, &scene).unwrap();
    let critical = at_rest(&mut driver, &model);
    reference("at-rest.dt").assert(critical.dt);
    let bound = stability::element_bound(&model).unwrap();
    assert!(
        bound < critical.dt && bound > 0.5 * critical.dt,
        "single elements: {bound}, assembled {}",
        critical.dt
    );
    assert_sharp(&scene, critical.dt);
}

/// Kelvin-Voigt viscosity shortens the step, and the shorter step is sharp too.
#[test]
fn the_critical_step_of_a_viscous_block_is_sharp() {
    let mut scene = block([0.02, 0.015, 0.01], [4, 3, 2]);
    let critical_of = |scene: &Scene| {
        let model = Model::new(scene).unwrap();
        let bound = stability::element_bound(&model).unwrap();
        let critical = at_rest(&mut Driver::new(&model, scene).unwrap(), &model).dt;
        assert!(bound < critical, "single elements: {bound}, assembled {critical}");
        critical
    };
    let elastic = critical_of(&scene);
    scene.body.viscosity = Some(60.0);
    let viscous = critical_of(&scene);
    // Design page, section 1: dt = (2/w)(sqrt(1 + xi^2) - xi) with the damping ratio xi of a volumetric mode; the
    // highest modes also shear, hence 5 %.
    let xi = 4.0 / 3.0 * 60.0 * (2.0 / elastic) / (2.0 * (rig::KAPPA + 4.0 / 3.0 * rig::G));
    close("viscous over elastic step", viscous / elastic, (1.0 + xi * xi).sqrt() - xi, 0.05);
    assert_sharp(&scene, viscous);
}

/// The wheel as it stands on the road, 2.2 mm down with friction, elastic and with the 20 Pa s of the viscous scenes.
#[test]
fn the_critical_step_of_the_pressed_wheel_is_sharp() {
    for viscosity in [None, Some(VISCOSITY)] {
        let mut scene = wheel([44, 4, 5], 1.0);
        scene.body.lumping = Lumping::Equal;
        scene.body.viscosity = viscosity;
        scene.stages = vec![rig::press(Drive::Displacement { to: -DEPTH, ramp: 5e-3 })];
        let model = Model::new(&scene).unwrap();
        let pressed = rig::run(&scene).snapshots.pop().expect("a pressed shape");
        let still = vec![[0.0; 3]; model.node_count()];
        let [x, y, z] = model.mesh.axle;
        let rim = [x, y, z - DEPTH, 0.0, 0.0, 0.0];
        let state = State { x: pressed.x.clone(), v: still };
        let mut driver = Driver::new(&model, &scene).unwrap();
        driver.engine.set_state(&state, &rim, &[0.0; 6]).unwrap();
        // Each search starts where the one before ended, until the step stands: 0.1 % of the frequency.
        let guess = stability::element_bound(&model).unwrap();
        let mut found = stability::assembled(&mut *driver.engine, &model, &state.x, guess, None).unwrap();
        for search in 1.. {
            let next =
                stability::assembled(&mut *driver.engine, &model, &state.x, found.dt, Some(&found)).unwrap();
            let moved = (next.dt / found.dt - 1.0).abs();
            found = next;
            if moved < 1e-3 {
                break;
            }
            assert!(search < 10, "the critical step does not settle: {} s", found.dt);
        }
        let from = (state, rim);
        let speed = shaken_from(&scene, Some(&from), 0.97 * found.dt, 3000).expect("stable below it");
        // As above; the pressed shape itself still moves by what its residual of 1e-4 lets it.
        assert!(speed < 1e-2, "grew to {speed} m/s, viscosity {viscosity:?}");
        assert_fails(&scene, Some(&from), found.dt);
    }
}

/// Lanczos started from other vectors finds the same step, within its residual (1e-3 of the eigenvalue, twice).
#[test]
fn the_critical_step_does_not_depend_on_the_start() {
    let mut scene = wheel([24, 3, 3], 0.0);
    scene.road = None;
    let model = Model::new(&scene).unwrap();
    let mut driver = Driver::new(&model, &scene).unwrap();
    let cold = at_rest(&mut driver, &model);
    let mut random = Random::new(6);
    for _ in 0..3 {
        // The critical mode of another shape as the start.
        let moved: Vec<[f64; 3]> = model
            .mesh
            .nodes
            .iter()
            .map(|x| {
                let by = random.vector();
                std::array::from_fn(|d| x[d] + 2e-4 * by[d])
            })
            .collect();
        let other = stability::assembled(&mut *driver.engine, &model, &moved, cold.dt, None).unwrap();
        assert!(other.dt < cold.dt, "a crumpled mesh has stiffer elements");
        let warm =
            stability::assembled(&mut *driver.engine, &model, &model.mesh.nodes, other.dt, Some(&other))
                .unwrap();
        close("critical step", warm.dt, cold.dt, 1e-3);
    }
}

/// Compression shortens the critical step, and a run follows it.
#[test]
fn a_run_follows_the_critical_step_under_compression() {
    use hexroll::scene::{Rim, Stage};
    let mut scene = block([0.02, 0.02, 0.02], [3, 3, 3]);
    scene.road = Some(rig::GROUND);
    scene.rim = Some(Rim { nodes: "z-max".into() });
    scene.output.sample = 1e-4;
    let down = Drive::Displacement { to: -0.007, ramp: 0.02 };
    scene.stages = vec![Stage { duration: 0.03, ..rig::press(down) }];
    scene.stages[0].method = hexroll::scene::Method::Explicit;
    let outcome = rig::run(&scene);
    let totals = &outcome.totals;
    assert!(totals.critical_min < 0.9 * totals.critical_first, "{totals:?}");
    let last = outcome.last();
    // Step used over critical step: never above the safety factor by more than the step moves between two looks.
    assert!(last.dt_s <= 0.9 * 1.02 * totals.critical_min && totals.dt_max > last.dt_s, "{totals:?}");
}

/// A block that hits the road after thousands of steps of flight, when nothing has changed for long: the run looks at the critical
/// step as soon as it is squeezed. At 30 m/s, a third of the speed of waves in a bar, an element would turn inside out if
/// it did not (seen: at the first step that had been due, and with the first look after 200 steps).
#[test]
fn a_run_follows_the_critical_step_through_an_impact() {
    for (speed, flight) in [(20.0, 0.001), (30.0, 0.001), (30.0, 0.3)] {
        let mut scene = block([0.02, 0.02, 0.02], [6, 6, 6]);
        scene.road = Some(rig::GROUND);
        scene.body.offset = [0.0, 0.0, flight];
        scene.body.velocity = [0.0, 0.0, -speed];
        scene.output.sample = 1e-4;
        scene.stages[0].duration = flight / speed + 1.5e-3;
        let outcome = rig::run(&scene);
        let ledger = &outcome.totals.ledger;
        let error = ledger.worst_stored_balance / ledger.largest_term;
        assert!(
            outcome.totals.critical_min < 0.95 * outcome.totals.critical_first,
            "{speed} m/s: nothing to follow: {:?}",
            outcome.totals
        );
        // Of second order in the step where the step is stable: 0.3 to 0.8 % here; 30 to 70 % where it was not.
        assert!(error < 0.03, "{speed} m/s after {flight} m: {error}");
    }
}
