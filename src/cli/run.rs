//! `hexroll run`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;

use super::SceneArgs;
use super::choose::{self, Chosen, EngineArgs};
use super::format::plural;
use super::pictures::{self, Style};
use super::recorder::{Recorder, listen_for_interrupts};
use super::{table, warnings};
use crate::engine::EngineInfo;
use crate::model::Model;
use crate::output::summary::{StageMeans, Versions, WorstBalance};
use crate::output::{RunWriter, Summary};
use crate::run::{self, Totals};
use crate::scene::{Method, Scene, Stage};
use crate::{Error, Result};

pub const HELP: &str = "\
Writes history.csv, snapshot_<k>.vtu, contact_<k>.csv, run.pvd, pictures and summary.json as it goes. Ctrl-C ends
the run after the current window and keeps everything (exit code 130).

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
    let model = Model::new(&scene)?;
    listen_for_interrupts()?;
    let Chosen { mut engine, reason } = choose::choose(&args.engine, &model, &scene)?;
    let out = args.out();
    let mut writer = RunWriter::create(&out, &model.mesh, Some(&text))?;
    let info = engine.info();
    eprintln!("{}\n{} {} ({reason})", scene.title, info.engine, info.precision);

    let start = Instant::now();
    let mut recorder = Recorder::new(&mut writer, model.element_count());
    let result = run::run(&scene, &model, &mut *engine, &mut recorder);
    recorder.finish();
    let (totals, error) = match result {
        Ok(t) if t.interrupted => {
            let error = Error::Interrupted { time: t.time, out: out.clone() };
            (t, Some(error))
        }
        Ok(totals) => (totals, None),
        Err(error) => (recorder.totals.clone(), Some(error)),
    };
    let mut report =
        Report { scene: &scene, model: &model, info, reason, out: &out, summary: Summary::default() };
    report.fill(&recorder, &totals, start.elapsed(), error.as_ref());
    let snapshots = recorder.snapshots;
    let saved = report.finish(&mut writer, snapshots);
    // A failure of the run matters more than one of its report.
    error.map_or(saved, Err)
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
        let mut warnings = warnings::of(scene, self.model);
        warnings.extend(warnings::of_history(scene, &recorder.history));
        warnings.extend(error.map(|e| format!("the run did not finish: {e}")));
        let settles = |s: &&Stage| matches!(s.method, Method::QuasiStatic { .. });
        let settling: Vec<&str> = scene.stages.iter().filter(settles).map(|s| s.name.as_str()).collect();
        // Of a run that took no step there is no smallest one.
        let known = |dt: f64| if dt.is_finite() { dt } else { 0.0 };
        self.summary = Summary {
            scene_file: scene.file.display().to_string(),
            title: scene.title.clone(),
            scene_hash: scene.hash.clone(),
            adapter: on_gpu.map(|()| info.device.clone()),
            driver: on_gpu.map(|()| info.driver.clone()),
            engine: info.engine.clone(),
            engine_reason: self.reason.clone(),
            precision: info.precision.clone(),
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
            stored_balance: WorstBalance::of_stored(&recorder.history),
            // + 0.0: no road was pierced is 0, not -0.
            worst_penetration_m: scene.road.map(|_| -totals.ledger.worst_gap + 0.0),
            stages: StageMeans::of(&recorder.history, &settling),
            versions: Versions::current(),
            warnings,
        };
    }

    /// Writes the summary, draws the pictures, prints the table.
    fn finish(&mut self, writer: &mut RunWriter, snapshots: usize) -> Result<()> {
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
        let files = format!("{}, {}", plural(snapshots, "snapshot"), plural(drawn, "picture"));
        super::print(&table::text(&self.summary, self.out, &files))
    }

    fn draw(&self) -> Result<usize> {
        let style = Style { title: self.scene.title.clone(), road: self.scene.road, ..Style::default() };
        let stored = crate::output::read::snapshots(self.out)?;
        let wanted: Vec<usize> = (0..stored.len()).collect();
        let drawn = pictures::draw(&stored, &wanted, &self.scene.output.pictures, &style, self.out)?;
        Ok(drawn.len())
    }
}
