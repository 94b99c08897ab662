//! Scenes, engines and plans that the trials share, and how two runs are compared.

use hexroll::cpu::CpuEngine;
use hexroll::engine::{Engine, StageSetup, State, Step, SurfaceSum, Window, Works};
use hexroll::gpu::{Gpu, GpuEngine, Precision};
use hexroll::model::Model;
use hexroll::physics::rim::Coordinates;
use hexroll::run::{Motion, stability};
use hexroll::scene::Scene;

pub use hexroll_lab::rig::{Random, relative, shipped as scene};

/// Who computes. `Gpu` keeps plain f32 positions, `Plus` hi + lo pairs; `Double` is f64 on the device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Who {
    Cpu64,
    Cpu32,
    Gpu,
    Plus,
    Double,
}

/// An engine, which says itself that it is the one asked for.
pub fn engine(gpu: &Gpu, who: Who, model: &Model, scene: &Scene) -> Box<dyn Engine> {
    let (engine, expected): (Box<dyn Engine>, _) = match who {
        Who::Cpu64 => (Box::new(CpuEngine::<f64>::new(model, scene, 1)), ["cpu", "f64"]),
        Who::Cpu32 => (Box::new(CpuEngine::<f32>::new(model, scene, 1)), ["cpu", "f32"]),
        Who::Gpu => (Box::new(on_device(gpu, model, scene, Precision::F32)), ["gpu", "f32"]),
        Who::Plus => (Box::new(on_device(gpu, model, scene, Precision::F32Plus)), ["gpu", "f32+"]),
        Who::Double => (Box::new(on_device(gpu, model, scene, Precision::F64)), ["gpu", "f64"]),
    };
    let info = engine.info();
    assert_eq!([info.engine.as_str(), info.precision.name()], expected);
    engine
}

/// With small meshes in one work group, as on real adapters.
pub fn on_device(gpu: &Gpu, model: &Model, scene: &Scene, precision: Precision) -> GpuEngine {
    let mut engine = GpuEngine::new(gpu, model, scene, precision).unwrap_or_else(|e| panic!("{e}"));
    engine.set_resident(true).unwrap();
    engine
}

/// The same adapter, with meshes laid out as for one that is no software.
pub fn as_hardware(gpu: &Gpu) -> Gpu {
    let mut gpu = gpu.clone();
    gpu.report.software = false;
    gpu
}

/// Random numbers that every trial has its own of: bounds and what must slide or stick are measured with these.
pub fn noise(seed: u64) -> Random {
    Random::from_state(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
}

/// What engines are given to do: every engine gets the same.
#[derive(Clone)]
pub struct Plan {
    pub setup: StageSetup,
    pub velocity: Option<(Vec<[f64; 3]>, Coordinates)>,
    /// Steps of each window, and the step after the last.
    pub windows: Vec<Vec<Step>>,
    pub next: Step,
}

impl Plan {
    /// Windows of equal steps through the scene's first stage.
    pub fn of_first_stage(scene: &Scene, model: &Model, dt: f64, windows: usize, steps: usize) -> Plan {
        let [x, y, z] = model.mesh.axle;
        let rim = [x, y, z, 0.0, 0.0, 0.0];
        let stage = &scene.stages[0];
        let motion = Motion::at_rest(rim, scene.gravity).next(stage, 0.0, rim, [0.0; 6]);
        let mut all = motion.plan(0.0, dt, 0.0, windows * steps + 1);
        let next = all.pop().expect("one more than the windows hold");
        let windows = all.chunks(steps).map(<[Step]>::to_vec).collect();
        Plan { setup: motion.setup(stage.mass_damping), velocity: None, windows, next }
    }

    /// The same, starting with velocities given at the reference positions.
    pub fn starting(
        mut self,
        model: &Model,
        field: impl FnMut([f64; 3]) -> [f64; 3],
        rate: Coordinates,
    ) -> Plan {
        self.velocity = Some((model.mesh.nodes.iter().copied().map(field).collect(), rate));
        self
    }

    /// Kinetic energy put in at the start [J].
    pub fn given(&self, model: &Model) -> f64 {
        let Some((v, _)) = &self.velocity else { return 0.0 };
        v.iter().zip(&model.mass).map(|(v, m)| 0.5 * m * dot(*v, *v)).sum()
    }
}

/// A step that single elements are stable with, by the usual margin.
pub fn safe_step(model: &Model) -> f64 {
    0.9 * stability::element_bound(model).unwrap()
}

/// What came of a plan.
pub struct Outcome {
    pub windows: Vec<Window>,
    pub state: State,
}

pub fn drive(engine: &mut dyn Engine, plan: &Plan) -> hexroll::Result<Outcome> {
    engine.begin_stage(&plan.setup)?;
    if let Some((v, rate)) = &plan.velocity {
        engine.set_velocity(v, rate)?;
    }
    let mut windows = Vec::new();
    for (k, steps) in plan.windows.iter().enumerate() {
        engine.advance(steps)?;
        let next = plan.windows.get(k + 1).map_or(&plan.next, |w| &w[0]);
        windows.push(engine.sample(next)?);
    }
    Ok(Outcome { windows, state: engine.state()? })
}

pub fn outcome(gpu: &Gpu, who: Who, model: &Model, scene: &Scene, plan: &Plan) -> Outcome {
    drive(&mut *engine(gpu, who, model, scene), plan).unwrap_or_else(|e| panic!("{who:?}: {e}"))
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|d| a[d] * b[d]).sum()
}

/// Displacements from the reference shape.
pub fn displacement(model: &Model, state: &State) -> Vec<[f64; 3]> {
    let from = |(x, X): (&[f64; 3], &[f64; 3])| std::array::from_fn(|d| x[d] - X[d]);
    state.x.iter().zip(&model.mesh.nodes).map(from).collect()
}

fn works(w: &Works) -> [f64; 7] {
    [w.internal, w.viscous, w.damping, w.body_force, w.rim, w.normal, w.friction]
}

/// A field of a window: its values, and what size of error counts as whole.
struct Field {
    name: &'static str,
    values: Vec<f64>,
    scale: f64,
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Fields of a window of `length` seconds on a body of `size` metres. Energies and works are measured by the largest
/// of them, rim impulses (which may cancel to nothing) by the internal force, all else by its own largest.
fn fields(w: &Window, length: f64, size: f64) -> Vec<Field> {
    let all = works(&w.works);
    let energies = [w.kinetic, w.probe.mixed_kinetic, w.strain, w.hourglass];
    let energy = largest(&all).max(largest(&energies));
    let impulse = largest(&w.rim_impulse).max(length * w.probe.internal_force);
    let surface = |of: fn(&SurfaceSum) -> Vec<f64>| w.surface.iter().flat_map(of).collect::<Vec<f64>>();
    let mut fields = Vec::new();
    let mut add = |name, values: Vec<f64>, scale: f64| fields.push(Field { name, values, scale });
    add("works", all.to_vec(), energy);
    add("half works", works(&w.probe.half_works).to_vec(), energy);
    add("energies", energies.to_vec(), energy);
    add("rim impulse", w.rim_impulse.to_vec(), impulse);
    add("rim moment", w.rim_moment_impulse.to_vec(), impulse * size);
    let mut own = |name, values: Vec<f64>| {
        let scale = largest(&values);
        add(name, values, scale);
    };
    own("contact impulse", surface(|s| s.impulse.to_vec()));
    own("surface x", surface(|s| s.x.to_vec()));
    own("surface v", surface(|s| s.v.to_vec()));
    own("axle", w.rim[..3].to_vec());
    own("angles", w.rim[3..].to_vec());
    own("axle's velocity", w.rim_rate[..3].to_vec());
    own("angular rates", w.rim_rate[3..].to_vec());
    own("residual forces", vec![w.probe.net_force, w.probe.internal_force]);
    own("min J", vec![w.min_jacobian]);
    fields
}

/// Steps in contact by node: how many differ, of how many.
fn contact_steps(a: &Window, b: &Window) -> [u32; 2] {
    let pairs = a.surface.iter().zip(&b.surface);
    let differ = pairs.map(|(a, b)| a.touching.abs_diff(b.touching) + a.sticking.abs_diff(b.sticking));
    [differ.sum(), b.surface.iter().map(|s| s.touching + s.sticking).sum()]
}

/// Largest error of every field over all windows, relative to the field's largest scale; and the share of the
/// contact's node-steps that differ.
pub fn errors(plan: &Plan, size: f64, a: &Outcome, b: &Outcome) -> Vec<(&'static str, f64)> {
    let mut all: Vec<(&'static str, f64, f64)> = Vec::new();
    let (mut differ, mut contacts) = (0, 0);
    for (steps, (a, b)) in plan.windows.iter().zip(a.windows.iter().zip(&b.windows)) {
        assert_eq!((a.steps, a.surface.len()), (b.steps, b.surface.len()));
        let length = steps.iter().map(Step::dtm).sum::<f64>();
        for (k, (a, b)) in fields(a, length, size).into_iter().zip(fields(b, length, size)).enumerate() {
            // A NaN must not vanish in a maximum.
            assert!(a.values.iter().chain(&b.values).all(|v| v.is_finite()), "{}: not finite", a.name);
            let error = largest(&a.values.iter().zip(&b.values).map(|(a, b)| a - b).collect::<Vec<f64>>());
            if all.len() <= k {
                all.push((a.name, 0.0, f64::MIN_POSITIVE));
            }
            (all[k].1, all[k].2) = (all[k].1.max(error), all[k].2.max(b.scale));
        }
        let [d, c] = contact_steps(a, b);
        (differ, contacts) = (differ + d, contacts + c);
    }
    let share = ("contact steps", f64::from(differ) / f64::from(contacts.max(1)));
    all.into_iter().map(|(name, error, scale)| (name, error / scale)).chain([share]).collect()
}

/// The same for the final state: displacements and velocities, relative in the L2 norm.
pub fn state_errors(model: &Model, a: &Outcome, b: &Outcome) -> Vec<(&'static str, f64)> {
    let u = relative(&displacement(model, &a.state), &displacement(model, &b.state));
    vec![("displacement", u), ("velocity", relative(&a.state.v, &b.state.v))]
}

/// Sum of everything booked [J]: all works, and what the two balances leave, with the largest term.
pub fn balances(given: f64, windows: &[Window]) -> [f64; 3] {
    let mut total = Works::default();
    windows.iter().for_each(|w| total.accumulate(&w.works));
    let last = windows.last().expect("a plan has windows");
    let balance = last.kinetic - given - total.internal - total.without_internal();
    let stored = last.strain + last.hourglass + last.probe.mixed_kinetic
        - given
        - total.without_internal()
        - last.probe.half_works.without_internal();
    let most = works(&total).iter().fold(given.max(last.kinetic).max(last.strain), |m, w| m.max(w.abs()));
    [balance, stored, most]
}

/// Prints what was measured, if asked to.
pub fn note(text: impl FnOnce() -> String) {
    if std::env::var_os("HEXROLL_TEST_PRINT").is_some() {
        println!("    {}", text());
    }
}

/// Fields beyond their bounds; those not named in `bounds` have the bound `otherwise`.
pub fn beyond(
    errors: &[(&'static str, f64)],
    bounds: &[(&str, f64)],
    otherwise: f64,
) -> Vec<(&'static str, f64)> {
    for (name, _) in bounds {
        assert!(errors.iter().any(|(n, _)| n == name), "no field is called {name}");
    }
    let bound = |name: &str| bounds.iter().find(|(n, _)| *n == name).map_or(otherwise, |b| b.1);
    errors.iter().filter(|(name, error)| *error > bound(name)).copied().collect()
}

/// Every field within its bound.
pub fn within(who: &str, errors: &[(&'static str, f64)], bounds: &[(&str, f64)], otherwise: f64) {
    note(|| format!("{who}: {}", list(errors)));
    let beyond = beyond(errors, bounds, otherwise);
    assert!(beyond.is_empty(), "{who} is off by {}", list(&beyond));
}

pub fn list(errors: &[(&'static str, f64)]) -> String {
    errors.iter().map(|(name, e)| format!("{name} {e:.1e}")).collect::<Vec<_>>().join(", ")
}
