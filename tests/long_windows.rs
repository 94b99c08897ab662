//! Windows of very many steps: memory does not grow with them, progress is told inside, and an interruption cuts them short
//! with everything booked.

use std::cell::Cell;

use hexroll::cpu::{self, Precision};
use hexroll::engine::{Engine, EngineInfo, StageSetup, State, Step, Window};
use hexroll::model::Model;
use hexroll::physics::rim::Coordinates;
use hexroll::record::{Sample, Snapshot};
use hexroll::run::{Observer, Progress, Totals};
use hexroll::scene::{Implicit, ImplicitScheme, ImplicitSolver, Linear, Method, Scene, Snapshots};
use hexroll::{Result, run};
use hexroll_lab::rig::{GROUND, block, run as simulate};

/// An engine that counts the steps between two samples.
struct Watched {
    engine: Box<dyn Engine>,
    since: usize,
    most: usize,
}

impl Engine for Watched {
    fn info(&self) -> EngineInfo {
        self.engine.info()
    }
    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        self.engine.begin_stage(setup)
    }
    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        self.since += steps.len();
        self.most = self.most.max(self.since);
        self.engine.advance(steps)
    }
    fn sample(&mut self, next: &Step) -> Result<Window> {
        self.since = 0;
        self.engine.sample(next)
    }
    fn state(&mut self) -> Result<State> {
        self.engine.state()
    }
    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.engine.set_velocity(v, rim_rate)
    }
    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        self.engine.set_state(state, rim, rim_rate)
    }
    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.engine.force(x, v)
    }
}

/// Keeps what it hears, and interrupts when it has been asked `patience` times.
struct Impatient {
    patience: Cell<usize>,
    samples: Vec<Sample>,
    snapshots: Vec<Snapshot>,
    /// Times and steps told inside windows.
    inside: Vec<(f64, u64)>,
}

impl Impatient {
    fn new(patience: usize) -> Impatient {
        let patience = Cell::new(patience);
        Impatient { patience, samples: Vec::new(), snapshots: Vec::new(), inside: Vec::new() }
    }
}

impl Observer for Impatient {
    fn sample(&mut self, sample: &Sample, _: &Progress) -> Result<()> {
        self.samples.push(sample.clone());
        Ok(())
    }
    fn advanced(&mut self, progress: &Progress) {
        self.inside.push((progress.time, progress.steps));
    }
    fn snapshot(&mut self, snapshot: &Snapshot, _: &str) -> Result<()> {
        self.snapshots.push(snapshot.clone());
        Ok(())
    }
    fn interrupted(&self) -> bool {
        self.patience.set(self.patience.get().saturating_sub(1));
        self.patience.get() == 0
    }
}

/// A small block that falls on the road and bounces, in one window.
fn bouncing(duration: f64, sample: f64) -> Scene {
    let mut scene = block([0.01, 0.01, 0.01], [1, 1, 1]);
    scene.road = Some(GROUND);
    scene.body.offset = [0.0, 0.0, 1e-5];
    scene.body.velocity = [0.0, 0.0, -0.5];
    scene.stages[0].duration = duration;
    scene.output.sample = sample;
    scene.output.snapshots = Snapshots::StageEnds;
    scene
}

fn watched(scene: &Scene, observer: &mut Impatient) -> (Totals, usize) {
    let model = Model::new(scene).unwrap();
    let engine = cpu::engine(&model, scene, Precision::F64, 1).unwrap();
    let mut engine = Watched { engine, since: 0, most: 0 };
    let totals = run::run(scene, &model, &mut engine, observer).unwrap();
    (totals, engine.most)
}

#[test]
fn steps_of_a_window_are_not_remembered() {
    // The block is put down: the road's force swings about its weight, 0.3 ms in more than 300,000 steps. (An
    // impact's first step has a force that depends on where in the step the node lands, which no other step repeats.)
    let mut scene = bouncing(3e-4, 3e-4);
    (scene.body.offset, scene.body.velocity) = ([0.0; 3], [0.0; 3]);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.safety = 1e-5;
    let mut observer = Impatient::new(usize::MAX);
    let (totals, most) = watched(&scene, &mut observer);
    // At most 2^17 steps are kept one by one, and the batch on its way then, of 6,400 or less.
    assert!(totals.steps > 300_000 && most <= (1 << 17) + 6_400, "{most} of {} steps", totals.steps);
    assert_eq!(observer.samples.len(), 1);
    let told = &observer.inside;
    assert!(told.len() > 10 && told.is_sorted() && told.iter().all(|(t, _)| *t > 0.0 && *t < 3e-4));

    // The same in windows of which each step is kept: mean and scatter of the force agree. The deviation over the whole
    // is that within the windows and that of their means.
    scene.output.sample = 3e-5;
    let parts = simulate(&scene);
    let whole = &observer.samples[0];
    let mean = |f: &dyn Fn(&Sample) -> f64| parts.samples.iter().map(f).sum::<f64>() / 10.0;
    let force = mean(&|s| s.road_fz_N);
    let square = mean(&|s| s.road_fz_std_N.powi(2) + (s.road_fz_N - force).powi(2));
    // A weight of 11 mN.
    assert!(force > 5e-3 && whole.road_fz_std_N > 2e-3, "{whole:?}");
    // Windows end at whole steps of slightly different lengths: one in 50,000 each.
    assert!((whole.road_fz_N / force - 1.0).abs() < 1e-4, "{} and {force} N", whole.road_fz_N);
    let (a, b) = (whole.road_fz_std_N, square.sqrt());
    assert!((a / b - 1.0).abs() < 1e-3, "{a} and {b} N");
    let noise = totals.noise[0].as_ref().unwrap();
    // The last 30 % in whole pieces of 2^17 steps: the last piece at least.
    assert!(noise.steps < totals.steps && noise.steps > totals.steps / 10, "{noise:?}");
}

#[test]
fn an_interruption_cuts_a_window_short_with_everything_booked() {
    let mut scene = bouncing(2e-3, 2e-3);
    scene.safety = 1e-4;
    let mut observer = Impatient::new(20);
    let (totals, _) = watched(&scene, &mut observer);
    let [row] = &observer.samples[..] else { panic!("{} rows", observer.samples.len()) };
    assert!(totals.interrupted && row.time_s > 0.0 && row.time_s < 2e-3, "{row:?}");
    assert_eq!(row.time_s, totals.time);
    assert_eq!(observer.snapshots.len(), 1);
    assert_eq!((observer.snapshots[0].time, observer.snapshots[0].step), (totals.time, totals.steps));
    // The row is of the shorter window: its mean force times its length is the change of momentum.
    let model = Model::new(&scene).unwrap();
    let momentum = |v: &dyn Fn(usize) -> f64| (0..8).map(|n| model.mass[n] * v(n)).sum::<f64>();
    let gained = momentum(&|n| observer.snapshots[0].v[n][2]) - momentum(&|_| -0.5);
    let impulse = row.road_fz_N * (totals.time - 0.5 * row.dt_s);
    assert!(gained > 1e-5 && (impulse / gained - 1.0).abs() < 1e-9, "{impulse} and {gained} N s");
    assert!(row.balance_error_J.abs() < 1e-12 && row.stored_balance_error_J.abs() < 1e-4 * row.kinetic_J);
}

/// Newmark in time, interrupted once in the middle of a window and once in the middle of an increment.
#[test]
fn an_interruption_cuts_an_implicit_window_short() {
    let scheme = ImplicitScheme::Dynamic { step: 1e-4, damping: 0.0 };
    let solver = ImplicitSolver::ActiveSet(Linear::Direct);
    let mut scene = bouncing(5e-3, 5e-3);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.road = None;
    scene.stages[0].method = Method::Implicit(Implicit { scheme, solver, tolerance: 1e-9, iterations: 20 });
    for patience in 6..12 {
        let mut observer = Impatient::new(patience);
        let (totals, _) = watched(&scene, &mut observer);
        assert!(totals.interrupted && totals.time < 4e-3 && totals.time > 0.0, "{patience}: {}", totals.time);
        let [row] = &observer.samples[..] else { panic!("{} rows", observer.samples.len()) };
        assert_eq!(row.time_s, totals.time);
        assert_eq!(observer.snapshots.len(), 1);
        // Free fall: the state is that of the row's time.
        let v = observer.snapshots[0].v[0][2];
        assert!((v + 0.5 + 9.81 * totals.time).abs() < 1e-9, "{v} m/s at {} s", totals.time);
    }
}
