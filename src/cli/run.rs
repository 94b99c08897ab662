//! `hexroll run`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;

use super::choose::{self, Chosen, EngineArgs};
use super::format::plural;
use super::pictures::{self, Style};
use super::progress::Display;
use super::recorder::{Recorder, listen_for_interrupts};
use super::scene::SceneArgs;
use super::terminal;
use super::{estimate, table, warnings};
use hexroll::engine::EngineInfo;
use hexroll::model::Model;
use hexroll::output::summary::{HourglassShare, StageMeans, Versions, WorstBalance};
use hexroll::output::{RunWriter, Summary};
use hexroll::run::{self, Totals};
use hexroll::scene::Scene;
use hexroll::{Error, Result};

pub const HELP: &str = "\
Writes history.csv, snapshot_<k>.vtu, contact_<k>.csv, run.pvd, pictures and summary.json as it goes. Ctrl-C ends
the run within about a second and keeps everything: the window on its way is cut short (exit code 130).

Examples:
  hexroll run scenes/lat100_straight.toml
  hexroll run scenes/lat100_straight.toml --engine cpu --precision f32 --threads 1
  hexroll run scenes/lat100_static.toml --set friction.coefficient=0 --out runs/frictionless
  hexroll run scenes/lat100_straight.toml --set 'stage.1.duration=50 ms' --set body.mesh.elements='[88, 8, 10]'";

#[derive(Debug, Args)]
pub struct RunArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    pub engine: EngineArgs,
    /// Folder to write; default runs/<name of the scene file>. A run that is there is replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl RunArgs {
    fn out(&self) -> PathBuf {
        let stem = self.scene.scene.file_stem().unwrap_or("scene".as_ref());
        self.out.clone().unwrap_or_else(|| Path::new("runs").join(stem))
    }
}

pub fn execute(args: &RunArgs) -> Result<()> {
    let (scene, text) = args.scene.load()?;
    listen_for_interrupts()?;
    let out = args.out();
    let title = scene.title.clone();
    let model = choose::model(&args.engine, &scene)?;
    let chosen = choose::choose(&args.engine, &model, &scene)?;
    let announced = chosen.rate.map(|rate| estimate::announcement(&scene, &model, rate)).transpose()?;
    let display = |elements, info: &EngineInfo, reason: &str| {
        eprintln!("{title}\n{} {} ({reason})", info.engine, info.precision);
        announced.flatten().into_iter().for_each(|line| eprintln!("{line}"));
        Display::new(elements)
    };
    let done = simulate_with(chosen, (&scene, &text, &model), &out, display)?;
    let printed = terminal::print(&table::text(&done.summary, &out, &done.files));
    done.error.map_or(printed, Err)
}

/// A run that has ended, with everything on disk.
pub struct Done {
    pub summary: Summary,
    /// What is in the folder besides history and summary.
    pub files: String,
    /// Why it ended early.
    pub error: Option<Error>,
}

/// Runs a scene into the folder `out`; `display` makes what shows its progress, given the number of elements, the engine
/// and the reason for it.
///
/// # Errors
/// What keeps the run from starting, or its results from being written; a failure of the run itself is in [`Done`].
pub fn simulate(
    scene: &Scene,
    text: &str,
    engine: &EngineArgs,
    out: &Path,
    display: impl FnOnce(usize, &EngineInfo, &str) -> Display,
) -> Result<Done> {
    let model = choose::model(engine, scene)?;
    let chosen = choose::choose(engine, &model, scene)?;
    simulate_with(chosen, (scene, text, &model), out, display)
}

/// The same with an engine that is there already.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_with(
    Chosen { mut engine, reason, .. }: Chosen,
    (scene, text, model): (&Scene, &str, &Model),
    out: &Path,
    display: impl FnOnce(usize, &EngineInfo, &str) -> Display,
) -> Result<Done> {
    let mut writer = RunWriter::create(out, &model.mesh, Some(text))?;
    let info = engine.info();
    let start = Instant::now();
    let mut recorder = Recorder::new(&mut writer, display(model.element_count(), &info, &reason));
    let result = run::run(scene, model, &mut *engine, &mut recorder);
    // Others may wait for it.
    drop(engine);
    recorder.finish();
    let (totals, error) = match result {
        Ok(t) if t.interrupted => {
            let error = Error::Interrupted { time: t.time, out: out.into() };
            (t, Some(error))
        }
        Ok(totals) => (totals, None),
        Err(error) => (recorder.totals.clone(), Some(in_the_files_numbers(error, model))),
    };
    let mut report = Report { scene, model, info, reason, out, summary: Summary::default() };
    report.fill(&recorder, &totals, start.elapsed(), error.as_ref());
    let (snapshots, files) = (recorder.snapshots, std::mem::take(&mut recorder.files));
    match report.finish(&mut writer, snapshots) {
        Ok(drawn) => {
            let files = [vec![drawn], files].concat().join(", ");
            Ok(Done { summary: report.summary, files, error })
        }
        // A failure of the run matters more than one of its report.
        Err(failure) => Err(error.unwrap_or(failure)),
    }
}

/// What is said of a run when it has ended.
struct Report<'a> {
    scene: &'a Scene,
    model: &'a Model,
    info: EngineInfo,
    reason: String,
    out: &'a Path,
    summary: Summary,
}

impl Report<'_> {
    fn fill(&mut self, recorder: &Recorder, totals: &Totals, wall: Duration, error: Option<&Error>) {
        let (scene, info) = (self.scene, &self.info);
        let on_gpu = (info.engine == "gpu").then_some(());
        let computing = wall.saturating_sub(recorder.output).as_secs_f64();
        let updates = totals.steps as f64 * self.model.element_count() as f64;
        let stages = StageMeans::of_run(scene, &recorder.history, &totals.noise, totals.free_radius);
        let mut warnings = warnings::of(scene, self.model);
        warnings.extend(self.model.mesh.notes.iter().map(|note| format!("of the mesh's file: {note}")));
        let stored_balance = WorstBalance::of_stored(&recorder.history);
        let hourglass = HourglassShare::of(&recorder.history, totals.energy_rounding);
        warnings.extend(warnings::of_run(scene, &stages, &stored_balance, hourglass.as_ref(), totals));
        warnings.extend(error.map(|e| format!("the run did not finish: {e}")));
        // Of a run that took no step there is no smallest one.
        let known = |dt: f64| if dt.is_finite() { dt } else { 0.0 };
        self.summary = Summary {
            scene_file: scene.file.display().to_string(),
            title: scene.title.clone(),
            scene_hash: scene.hash.clone(),
            mesh_hash: self.model.mesh.labels.as_ref().map(|labels| labels.hash.clone()),
            adapter: on_gpu.map(|()| info.device.clone()),
            driver: on_gpu.map(|()| info.driver.clone()),
            engine: info.engine.clone(),
            engine_reason: self.reason.clone(),
            precision: info.precision,
            threads: info.threads,
            elements: self.model.element_count(),
            nodes: self.model.node_count(),
            steps: totals.steps,
            time_s: totals.time,
            dt_min_s: known(totals.dt_min),
            dt_max_s: totals.dt_max,
            critical_dt_s: totals.critical_first,
            wall_time_s: wall.as_secs_f64(),
            element_updates_per_s: updates / computing,
            balance: WorstBalance::of(&recorder.history),
            stored_balance,
            hourglass,
            round_off_J: totals.energy_round_off(),
            errors: totals.estimate.into(),
            // + 0.0: no road was pierced is 0, not -0.
            worst_penetration_m: scene.road.as_ref().map(|_| -totals.ledger.worst_gap + 0.0),
            finished: error.is_none(),
            stages,
            versions: Versions::current(),
            warnings,
        };
    }

    /// Writes the summary and draws the pictures; says what is in the folder.
    fn finish(&mut self, writer: &mut RunWriter, snapshots: usize) -> Result<String> {
        writer.finish(&self.summary)?;
        let drawn = match self.draw() {
            Ok(drawn) => drawn,
            // Pictures are worth a warning, not a failure: `hexroll render` draws them later.
            Err(error) => {
                self.summary.warnings.push(format!("no pictures: {error}"));
                writer.finish(&self.summary)?;
                0
            }
        };
        Ok(format!("{}, {}", plural(snapshots, "snapshot"), plural(drawn, "picture")))
    }

    fn draw(&self) -> Result<usize> {
        let style =
            Style { title: self.scene.title.clone(), road: self.scene.road.clone(), ..Style::default() };
        let stored = hexroll::output::read::snapshots(self.out)?;
        let wanted: Vec<usize> = (0..stored.len()).collect();
        let drawn = pictures::draw(&stored, &wanted, &self.scene.output.pictures, &style, self.out)?;
        Ok(drawn.len())
    }
}

/// An element that failed by the number that it has in the file of the mesh; parts that count from one again have no such number.
fn in_the_files_numbers(mut error: Error, model: &Model) -> Error {
    if let (Error::Inverted { element, .. } | Error::NotFinite { element, .. }, Some(labels)) =
        (&mut error, &model.mesh.labels)
        && labels.elements.parts.len() <= 1
        && let Some(&number) = labels.elements.of.get(*element)
    {
        *element = number as usize;
    }
    error
}
