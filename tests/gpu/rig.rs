//! Scenes, engines and plans that the trials share, and how two runs are compared.

use hexroll::cpu::CpuEngine;
use hexroll::engine::{Engine, StageSetup, State, Step, Window, Works};
use hexroll::gpu::{Gpu, GpuEngine};
use hexroll::model::Model;
use hexroll::physics::rim::Coordinates;
use hexroll::run::{Motion, stability};
use hexroll::scene::Scene;
use std::path::Path;

/// A shipped scene with changes.
pub fn scene(stem: &str, changes: &[&str]) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{stem}.toml"));
    let changes: Vec<String> = changes.iter().map(|c| c.to_string()).collect();
    Scene::load(&file, &changes).unwrap_or_else(|e| panic!("{e}"))
}

/// Who computes. `Gpu` keeps plain f32 positions, `Plus` hi + lo pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Who {
    Cpu64,
    Cpu32,
    Gpu,
    Plus,
}

/// An engine, which says itself that it is the one asked for.
pub fn engine(gpu: &Gpu, who: Who, model: &Model, scene: &Scene) -> Box<dyn Engine> {
    let (engine, expected): (Box<dyn Engine>, _) = match who {
        Who::Cpu64 => (Box::new(CpuEngine::<f64>::new(model, scene, 1)), ["cpu", "f64"]),
        Who::Cpu32 => (Box::new(CpuEngine::<f32>::new(model, scene, 1)), ["cpu", "f32"]),
        Who::Gpu => (Box::new(on_device(gpu, model, scene, false)), ["gpu", "f32"]),
        Who::Plus => (Box::new(on_device(gpu, model, scene, true)), ["gpu", "f32+"]),
    };
    let info = engine.info();
    assert_eq!([info.engine.as_str(), info.precision.as_str()], expected);
    engine
}

pub fn on_device(gpu: &Gpu, model: &Model, scene: &Scene, plus: bool) -> GpuEngine {
    GpuEngine::new(gpu, model, scene, plus).unwrap_or_else(|e| panic!("{e}"))
}

/// Numbers in -1..1, the same in every run.
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Noise {
        Noise(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, scale: f64) -> [f64; 3] {
        [0; 3].map(|_| scale * self.next())
    }
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
        let motion = Motion::at_rest(rim).next(stage, 0.0, rim);
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

/// |a - b| / |b| over all components, in the L2 norm.
pub fn relative(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let square = |i: usize| (0..3).map(|d| (a[i][d] - b[i][d]).powi(2)).sum::<f64>();
    let difference: f64 = (0..a.len()).map(square).sum();
    (difference / b.iter().map(|b| dot(*b, *b)).sum::<f64>()).sqrt()
}

/// Displacements from the reference shape.
pub fn displacement(model: &Model, state: &State) -> Vec<[f64; 3]> {
    let from = |(x, X): (&[f64; 3], &[f64; 3])| std::array::from_fn(|d| x[d] - X[d]);
    state.x.iter().zip(&model.mesh.nodes).map(from).collect()
}

/// Largest |a - b| relative to the largest |b|.
fn worst<const N: usize>(pairs: impl Iterator<Item = ([f64; N], [f64; N])>) -> f64 {
    let (mut error, mut scale) = (0.0f64, f64::MIN_POSITIVE);
    for (a, b) in pairs {
        for k in 0..N {
            // A NaN must not vanish in a maximum.
            assert!(a[k].is_finite() && b[k].is_finite(), "{a:?} {b:?}");
            error = error.max((a[k] - b[k]).abs());
            scale = scale.max(b[k].abs());
        }
    }
    error / scale
}

fn works(w: &Works) -> [f64; 7] {
    [w.internal, w.viscous, w.damping, w.body_force, w.rim, w.normal, w.friction]
}

/// Errors of one window against another, by field; each relative to the largest of its kind.
pub fn window_errors(a: &Window, b: &Window) -> Vec<(&'static str, f64)> {
    assert_eq!((a.steps, a.surface.len()), (b.steps, b.surface.len()));
    let one = |x: f64, y: f64| worst([([x], [y])].into_iter());
    let surface = |of: fn(&hexroll::engine::SurfaceSum) -> [f64; 3]| {
        worst(a.surface.iter().zip(&b.surface).map(|(a, b)| (of(a), of(b))))
    };
    let counts = a.surface.iter().zip(&b.surface);
    let different = counts.filter(|(a, b)| {
        (a.touching, a.sticking, a.touches, a.sticks) != (b.touching, b.sticking, b.touches, b.sticks)
    });
    let forces = |w: &Window| [w.probe.net_force, w.probe.internal_force];
    vec![
        ("works", worst([(works(&a.works), works(&b.works))].into_iter())),
        ("half works", worst([(works(&a.probe.half_works), works(&b.probe.half_works))].into_iter())),
        ("rim impulse", worst([(a.rim_impulse, b.rim_impulse)].into_iter())),
        ("rim moment", worst([(a.rim_moment_impulse, b.rim_moment_impulse)].into_iter())),
        ("surface x", surface(|s| s.x)),
        ("surface v", surface(|s| s.v)),
        ("contact impulse", surface(|s| s.impulse)),
        ("contact states", different.count() as f64),
        ("rim", worst([(a.rim, b.rim)].into_iter())),
        ("rim rate", worst([(a.rim_rate, b.rim_rate)].into_iter())),
        ("kinetic", one(a.kinetic, b.kinetic)),
        ("mixed kinetic", one(a.probe.mixed_kinetic, b.probe.mixed_kinetic)),
        ("net, internal force", worst([(forces(a), forces(b))].into_iter())),
        ("strain", one(a.strain + a.hourglass, b.strain + b.hourglass)),
        ("hourglass", one(a.hourglass, b.hourglass)),
        ("min J", one(a.min_jacobian, b.min_jacobian)),
    ]
}

/// Largest error of every field over all windows.
pub fn worst_errors(a: &Outcome, b: &Outcome) -> Vec<(&'static str, f64)> {
    let mut all = Vec::new();
    for (a, b) in a.windows.iter().zip(&b.windows) {
        for (k, (name, error)) in window_errors(a, b).into_iter().enumerate() {
            match all.get_mut(k) {
                None => all.push((name, error)),
                Some((_, most)) => *most = f64::max(*most, error),
            }
        }
    }
    all
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
    let largest = works(&total).iter().fold(given.max(last.kinetic).max(last.strain), |m, w| m.max(w.abs()));
    [balance, stored, largest]
}

/// Prints what was measured, if asked to.
pub fn note(text: impl FnOnce() -> String) {
    if std::env::var_os("HEXROLL_TEST_PRINT").is_some() {
        println!("    {}", text());
    }
}

/// Every field within its bound; those not named within `otherwise`.
pub fn within(who: &str, errors: &[(&'static str, f64)], bounds: &[(&str, f64)], otherwise: f64) {
    note(|| {
        let list: Vec<String> = errors.iter().map(|(name, e)| format!("{name} {e:.1e}")).collect();
        format!("{who}: {}", list.join(", "))
    });
    for (name, _) in bounds {
        assert!(errors.iter().any(|(n, _)| n == name), "no field is called {name}");
    }
    for (name, error) in errors {
        let bound = bounds.iter().find(|(n, _)| n == name).map_or(otherwise, |b| b.1);
        assert!(*error <= bound, "{who}: {name} is off by {error:.2e}, more than {bound:.0e}");
    }
}
