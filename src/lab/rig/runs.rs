//! Engines driven through a scene or step by step, and what comes of it.

use hexroll::Result;
use hexroll::cpu::{self, Precision};
use hexroll::engine::{Engine, StageSetup, Step, Window};
use hexroll::model::Model;
use hexroll::record::{History, NewtonRow, Reaction, Sample, Snapshot};
use hexroll::run::{self, Observer, Progress, Totals};
use hexroll::scene::Scene;

use super::references;

/// Keeps all that a run tells, of a run that fails too.
#[derive(Debug, Default)]
pub struct Recorder {
    pub samples: Vec<Sample>,
    pub reactions: Vec<Vec<Reaction>>,
    pub snapshots: Vec<Snapshot>,
    pub iterations: Vec<NewtonRow>,
    pub notes: Vec<String>,
    pub histories: Vec<History>,
}

impl Observer for Recorder {
    fn sample(&mut self, sample: &Sample, _: &Progress) -> Result<()> {
        self.samples.push(sample.clone());
        Ok(())
    }
    fn reactions(&mut self, _: &Sample, sets: &[Reaction]) -> Result<()> {
        self.reactions.push(sets.to_vec());
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Snapshot, _: &str) -> Result<()> {
        self.snapshots.push(snapshot.clone());
        Ok(())
    }
    fn histories(&mut self, histories: Vec<History>) -> Result<()> {
        self.histories = histories;
        Ok(())
    }
    fn increment(&mut self, iterations: &[NewtonRow]) -> Result<()> {
        self.iterations.extend_from_slice(iterations);
        Ok(())
    }
    fn note(&mut self, line: &str) -> Result<()> {
        self.notes.push(line.into());
        Ok(())
    }
}

/// What a run produced.
pub struct Outcome {
    pub model: Model,
    pub samples: Vec<Sample>,
    /// By window; empty without driven sets.
    pub reactions: Vec<Vec<Reaction>>,
    pub snapshots: Vec<Snapshot>,
    pub totals: Totals,
}

impl Outcome {
    /// The last sample.
    ///
    /// # Panics
    /// If the run had none, as everywhere here: a run that ends without an error has samples.
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has samples")
    }

    /// Samples of the stage with this name.
    pub fn stage(&self, name: &str) -> Vec<&Sample> {
        self.samples.iter().filter(|s| s.stage == name).collect()
    }

    /// Mean of a column over the last `share` of a stage; NaN of a stage without samples.
    pub fn mean(&self, stage: &str, share: f64, column: impl Fn(&Sample) -> f64) -> f64 {
        let rows: Vec<f64> = self.stage(stage).into_iter().map(column).collect();
        let from = ((1.0 - share) * rows.len() as f64) as usize;
        rows[from..].iter().sum::<f64>() / (rows.len() - from) as f64
    }

    /// Asserts that the means over the last 30 % of a stage are those of a run of the references: forces of the road and
    /// moments of the rim, as many as it has.
    ///
    /// # Panics
    /// If one is not, or there is none.
    #[track_caller]
    pub fn assert_means(&self, stage: &str, run: &str) {
        let mut found = 0;
        for (quantity, expected) in references::quantities(run) {
            if let Some(column) = column(quantity) {
                expected.assert(self.mean(stage, 0.3, column));
                found += 1;
            }
        }
        assert!(found > 0, "{run} has no means");
    }
}

/// The column of a sample that references call so, if it is one.
pub fn column(name: &str) -> Option<fn(&Sample) -> f64> {
    Some(match name {
        "road_fx" => |s| s.road_fx_N,
        "road_fy" => |s| s.road_fy_N,
        "road_fz" => |s| s.road_fz_N,
        "rim_mx" => |s| s.rim_mx_Nm,
        "rim_my" => |s| s.rim_my_Nm,
        "rim_mz" => |s| s.rim_mz_Nm,
        _ => return None,
    })
}

/// Runs a scene on the CPU engine in double precision, on one thread.
///
/// # Errors
/// What the run reports.
pub fn simulate(scene: &Scene) -> Result<Outcome> {
    simulate_with(scene, Model::new(scene)?, Precision::F64, 1)
}

/// The same with a mesh of one's own, in any precision, on `threads` threads.
///
/// # Errors
/// What the run reports.
pub fn simulate_with(scene: &Scene, model: Model, precision: Precision, threads: usize) -> Result<Outcome> {
    let mut engine = cpu::engine(&model, scene, precision, threads)?;
    let mut recorder = Recorder::default();
    let totals = simulate_on(scene, &model, &mut *engine, &mut recorder)?;
    let reactions = recorder.reactions;
    Ok(Outcome { samples: recorder.samples, reactions, snapshots: recorder.snapshots, totals, model })
}

/// The same on an engine that the caller made, into a recorder that keeps what came before a failure.
///
/// # Errors
/// What the run reports.
pub fn simulate_on(
    scene: &Scene,
    model: &Model,
    engine: &mut dyn Engine,
    recorder: &mut Recorder,
) -> Result<Totals> {
    run::run(scene, model, engine, recorder)
}

/// [`simulate`] where a failure is the caller's failure.
///
/// # Panics
/// If the run fails.
pub fn run(scene: &Scene) -> Outcome {
    simulate(scene).unwrap_or_else(|e| panic!("{e}"))
}

/// An engine in double precision driven step by step.
pub struct Driver {
    pub engine: Box<dyn Engine>,
    /// Rim coordinates of the steps to come; at first those of the reference shape.
    pub rim: [f64; 6],
    pub time: f64,
    pub dt_before: f64,
}

impl Driver {
    /// On one thread.
    ///
    /// # Errors
    /// If the engine cannot begin.
    pub fn new(model: &Model, scene: &Scene) -> Result<Driver> {
        let mut engine = cpu::engine(model, scene, Precision::F64, 1)?;
        engine.begin_stage(&StageSetup::default())?;
        let [x, y, z] = model.mesh.axle;
        Ok(Driver { engine, rim: [x, y, z, 0.0, 0.0, 0.0], time: 0.0, dt_before: 0.0 })
    }

    /// The next step of `dt`.
    pub fn step(&self, dt: f64) -> Step {
        Step { time: self.time, dt, dt_before: self.dt_before, rim: self.rim, load: [0.0; 6] }
    }

    /// Takes steps of the given lengths [s].
    ///
    /// # Errors
    /// An element that is inverted or not finite.
    pub fn advance(&mut self, lengths: impl IntoIterator<Item = f64>) -> Result<()> {
        let mut steps = Vec::new();
        for dt in lengths {
            steps.push(self.step(dt));
            (self.time, self.dt_before) = (self.time + dt, dt);
        }
        self.engine.advance(&steps)
    }

    /// Closes the window; the probe looks `dt` ahead.
    ///
    /// # Errors
    /// An element that is inverted or not finite in the probe.
    pub fn sample(&mut self, dt: f64) -> Result<Window> {
        let next = self.step(dt);
        self.engine.sample(&next)
    }
}
