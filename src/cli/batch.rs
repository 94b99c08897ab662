//! Many runs for one command: each in its own folder, kept when they have finished, one after the other or side by side.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::choose::{self, Chosen, EngineArgs, EngineChoice};
use super::format::{count, duration};
use super::progress::Display;
use super::recorder;
use super::run::{Done, simulate, simulate_with};
use super::warnings;
use hexroll::engine::EngineInfo;
use hexroll::gpu::{Gpu, GpuEngine, adapters, ensemble};
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::output::read;
use hexroll::output::summary::Summary;
use hexroll::scene::{MeshSpec, Scene};
use hexroll::study::axis::Changes;
use hexroll::{Error, Precision, Result, cpu};

/// A run to be made, or found.
pub struct Case {
    /// What is printed of it.
    pub name: String,
    pub scene: Scene,
    pub text: String,
    pub engine: EngineArgs,
    pub out: PathBuf,
}

impl Case {
    /// The scene of `file` with `sets` and then `changes`; no pictures, and fields at the ends of stages only, unless
    /// `sets` says otherwise.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn new(
        name: String,
        file: &Path,
        sets: &[String],
        changes: &[Changes],
        engine: &EngineArgs,
        out: PathBuf,
    ) -> Result<Case> {
        let text = Scene::read_text(file)?;
        let file = file.to_string_lossy();
        let mut all: Vec<String> = vec!["output.pictures=[]".into(), "output.snapshots=stage-ends".into()];
        all.extend(sets.iter().cloned());
        all.extend(changes.iter().flat_map(|c| c.sets.iter().cloned()));
        let mut engine = engine.clone();
        for precision in changes.iter().filter_map(|c| c.precision) {
            // An engine that was settled without knowing better.
            if !cpu::PRECISIONS.contains(&precision) && engine.engine == EngineChoice::Cpu {
                engine.engine = EngineChoice::Gpu;
            }
            engine.precision = Some(precision);
        }
        let scene = Scene::parse(&text, &file, &all)?;
        Ok(Case { name, scene, text: Scene::effective_text(&text, &file, &all)?, engine, out })
    }

    /// The run's summary, if the folder holds this very run, finished.
    fn finished(&self) -> Option<Summary> {
        let summary = read::summary(&self.out).ok()??;
        let same = summary.finished
            && summary.scene_hash == self.scene.hash
            && summary.versions.hexroll == env!("CARGO_PKG_VERSION")
            && self.engine.precision.is_none_or(|p| p == summary.precision)
            && match self.engine.engine {
                EngineChoice::Auto => true,
                EngineChoice::Cpu => summary.engine == "cpu",
                EngineChoice::Gpu => summary.engine == "gpu",
            };
        (same && self.has_mesh(summary.mesh_hash.as_deref())).then_some(summary)
    }

    /// Whether the scene's mesh is still that of this hash: a scene's text does not say what is in a file.
    fn has_mesh(&self, hash: Option<&str>) -> bool {
        let MeshSpec::File(file) = &self.scene.body.mesh else { return hash.is_none() };
        let rim = self.scene.rim.as_ref().map(|rim| &rim.nodes);
        let now = Mesh::imported(file, rim).ok().and_then(|mesh| mesh.labels);
        now.is_some_and(|labels| Some(labels.hash.as_str()) == hash)
    }
}

/// The engine of every run of a command: runs that are compared are not raced for. A real GPU if there is one, else the
/// CPU; f32+, which only the GPU has, leaves the choice to each run.
pub fn settled(engine: &EngineArgs) -> EngineArgs {
    let real = || choose::usable(&adapters(), engine.adapter.as_deref()).is_some_and(|a| !a.software);
    let choice = match engine.engine {
        // Few GPUs are fast in doubles; who names one has chosen.
        EngineChoice::Auto if engine.precision == Some(Precision::F64) && engine.adapter.is_none() => {
            EngineChoice::Cpu
        }
        EngineChoice::Auto if engine.precision.is_none() && engine.adapter.is_none() && !real() => {
            EngineChoice::Cpu
        }
        choice => choice,
    };
    EngineArgs { engine: choice, ..engine.clone() }
}

/// How many runs go side by side: what was asked for, else one a core on the CPU and one on a GPU.
pub fn side_by_side(asked: usize, engine: &EngineArgs) -> usize {
    match (asked, engine.engine) {
        (0, EngineChoice::Cpu) => cores(),
        (0, _) => 1,
        (n, _) => n,
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Makes every run that is not there yet, `jobs` at a time, and returns all summaries in the order of the cases.
/// A run that fails does not keep the others from running.
///
/// # Errors
/// The first failure, after everything else has run; [`Error::Interrupted`] at once.
pub fn run_all(cases: &[Case], jobs: usize) -> Result<Vec<Summary>> {
    let jobs = jobs.clamp(1, cases.len().max(1));
    let next = AtomicUsize::new(0);
    let results: Vec<Mutex<Option<Result<Summary>>>> = cases.iter().map(|_| Mutex::new(None)).collect();
    let worker = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(i) else { return };
            if recorder::interrupted() {
                return;
            }
            let result = one(case, [i + 1, cases.len()], jobs);
            *held(&results[i]) = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..jobs {
            scope.spawn(worker);
        }
        worker();
    });
    let results =
        results.into_iter().map(|result| result.into_inner().unwrap_or_else(PoisonError::into_inner));
    gathered(cases, results)
}

/// All summaries, or the first failure; a run that was not made was interrupted.
fn gathered(cases: &[Case], results: impl Iterator<Item = Option<Result<Summary>>>) -> Result<Vec<Summary>> {
    let mut summaries = Vec::new();
    let mut failure = None;
    for (case, result) in cases.iter().zip(results) {
        match result {
            Some(Ok(summary)) => summaries.push(summary),
            Some(Err(error)) => failure = failure.or(Some(error)),
            None => failure = failure.or(Some(Error::Interrupted { time: 0.0, out: case.out.clone() })),
        }
    }
    failure.map_or(Ok(summaries), Err)
}

/// Makes every run that is not there yet at the same time on one GPU, each in a work group of its own; otherwise as
/// [`run_all`].
///
/// # Errors
/// Those of `run_all`, and before anything runs [`Error::Unsupported`] for a mesh that does not fit into a work group's
/// memory.
pub fn run_together(cases: &[Case], engine: &EngineArgs) -> Result<Vec<Summary>> {
    let found: Vec<Option<Summary>> = cases.iter().map(Case::finished).collect();
    let place = |i: usize| format!("[{}/{}] {}", i + 1, cases.len(), cases[i].name);
    for (i, summary) in found.iter().enumerate() {
        if let Some(summary) = summary {
            eprintln!("{}: kept, {}", place(i), line(summary));
            warn(&place(i), summary);
        }
    }
    let missing: Vec<usize> = (0..cases.len()).filter(|&i| found[i].is_none()).collect();
    let mut results: Vec<Option<Result<Summary>>> = found.into_iter().map(|s| s.map(Ok)).collect();
    if !missing.is_empty() {
        let gpu = Gpu::open(engine.adapter.as_deref())?;
        let models = missing.iter().map(|&i| Model::new(&cases[i].scene)).collect::<Result<Vec<_>>>()?;
        let bodies: Vec<(&Model, &Scene)> =
            models.iter().zip(&missing).map(|(model, &i)| (model, &cases[i].scene)).collect();
        let engines = ensemble(&gpu, &bodies)?;
        let reason = format!("asked for with --ensemble: {} runs at the same time", missing.len());
        let run = |(engine, (model, i)): (GpuEngine, (&Model, usize))| {
            let case = &cases[i];
            let chosen = Chosen { engine: Box::new(engine), reason: reason.clone(), rate: None };
            let display = |elements, _: &EngineInfo, _: &str| Display::quiet(elements, &place(i));
            eprintln!("{}: runs in {}", place(i), case.out.display());
            settled_run(
                &place(i),
                simulate_with(chosen, (&case.scene, &case.text, model), &case.out, display),
            )
        };
        std::thread::scope(|scope| {
            let runs: Vec<_> = engines
                .into_iter()
                .zip(models.iter().zip(missing.iter().copied()))
                .map(|of| scope.spawn(|| run(of)))
                .collect();
            for (&i, run) in missing.iter().zip(runs) {
                results[i] = Some(run.join().expect("a run ends with a result"));
            }
        });
    }
    gathered(cases, results.into_iter())
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes or finds one run, with a line before and a line after it.
fn one(case: &Case, [number, of]: [usize; 2], jobs: usize) -> Result<Summary> {
    let place = format!("[{number}/{of}] {}", case.name);
    if let Some(summary) = case.finished() {
        eprintln!("{place}: kept, {}", line(&summary));
        warn(&place, &summary);
        return Ok(summary);
    }
    let mut engine = case.engine.clone();
    if jobs > 1 {
        // Side by side each run has a core or its share of them.
        engine.threads = if engine.threads == 0 { (cores() / jobs).max(1) } else { engine.threads };
    }
    eprintln!("{place}: runs in {}", case.out.display());
    let done = simulate(&case.scene, &case.text, &engine, &case.out, |elements, _, _| {
        Display::quiet(elements, &place)
    });
    settled_run(&place, done)
}

/// What came of a run, with a line that says it.
fn settled_run(place: &str, done: Result<Done>) -> Result<Summary> {
    let done = done?;
    match done.error {
        Some(error) => {
            eprintln!("{place}: failed: {error}");
            Err(error)
        }
        None => {
            eprintln!("{place}: done, {}", line(&done.summary));
            warn(place, &done.summary);
            Ok(done.summary)
        }
    }
}

/// Says what must not be lost among many runs.
fn warn(place: &str, summary: &Summary) {
    if let Some(warning) = warnings::among_many(summary) {
        eprintln!("{place}: warning: {warning}");
    }
}

/// What a finished run comes to, in a line.
fn line(s: &Summary) -> String {
    let forces = s.stages.last().map_or(String::new(), |m| {
        format!(": road {:.2} {:.2} {:.2} N", m.mean_road_fx_N, m.mean_road_fy_N, m.mean_road_fz_N)
    });
    format!("{} steps in {}{forces}", count(s.steps), duration(s.wall_time_s))
}
