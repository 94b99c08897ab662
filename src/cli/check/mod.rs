//! `hexroll check`: what will be modelled, with which programs, at what cost. Nothing is simulated, and nothing written but
//! programs and the law's curves.

mod body;
mod curves;
mod display;
mod memory;
mod programs;
pub mod stages;

use clap::Args;
use serde::Serialize;
use std::path::PathBuf;

use super::choose;
use super::estimate::{self, Steps};
use super::scene::SceneArgs;
use super::terminal;
use super::warnings;
pub use body::Body;
use curves::Curves;
use hexroll::engine::Engine;
use hexroll::gpu::adapters;
use hexroll::model::Model;
use hexroll::scene::Scene;
use hexroll::{Precision, Result, cpu};
use memory::CpuMemory;
use programs::GpuPlan;
use stages::StagePlan;

pub const HELP: &str = "\
Reads and meshes the scene, composes its GPU programs, and times a few steps for the estimate; simulates nothing, and
writes nothing but, if asked to, the programs and the law's curves.

Examples:
  hexroll check scenes/lat100_straight.toml
  hexroll check scenes/lat100_straight.toml --set body.mesh.elements='[132, 12, 15]'
  hexroll check scenes/lat100_straight.toml --json | jq .gpu.programs
  hexroll check scenes/lat100_straight.toml --programs wgsl
  hexroll check scenes/lat100_straight.toml --curves law";

#[derive(Debug, Args)]
pub struct CheckArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Write the WGSL of every GPU program to this folder
    #[arg(long, value_name = "DIR")]
    programs: Option<PathBuf>,
    /// Write the law's stress against stretch to this folder: curves.csv and curves.png
    #[arg(long, value_name = "DIR")]
    curves: Option<PathBuf>,
}

/// Everything the command has to say.
#[derive(Debug, Serialize)]
struct Check {
    scene_file: String,
    scene_hash: String,
    title: String,
    expected: String,
    body: Body,
    /// The law in tension, and where it is stable.
    curves: Curves,
    /// Optional parts of the physics.
    pieces: Vec<Piece>,
    stages: Vec<StagePlan>,
    steps: Steps,
    /// Time estimates, one an engine that was timed.
    estimates: Vec<Estimate>,
    cpu: CpuMemory,
    gpu: GpuPlan,
    outputs: Vec<String>,
    warnings: Vec<String>,
}

/// A part of the physics that a scene may leave out.
#[derive(Debug, Serialize)]
pub struct Piece {
    pub name: &'static str,
    /// What is modelled; none: left out, with all of its code.
    pub detail: Option<String>,
}

/// How long a run would take.
#[derive(Debug, Serialize)]
struct Estimate {
    engine: String,
    /// Measured on this machine over the scene's first steps.
    updates_per_s: f64,
    /// At most, if stages settle sooner.
    seconds: f64,
}

pub fn execute(args: &CheckArgs) -> Result<()> {
    let (scene, _) = args.scene.load()?;
    // Of what is timed below, the most.
    hexroll::memory::ensure(&scene, |scene| choose::need(scene, Some(Precision::F64)))?;
    let model = Model::new(&scene)?;
    let steps = Steps::of(&scene, &model)?;
    let (estimates, notes) = estimates(&scene, &model, &steps);
    let curves = Curves::of(&scene.body.law);
    let instability: Vec<_> = curves.warnings(scene.body.law.name()).collect();
    let check = Check {
        scene_file: scene.file.display().to_string(),
        scene_hash: scene.hash.clone(),
        title: scene.title.clone(),
        expected: scene.expected.clone(),
        body: Body::of(&scene, &model, &steps.bounds),
        curves,
        pieces: stages::pieces(&scene, &model.mesh.sets),
        stages: stages::plans(&scene, &steps),
        cpu: CpuMemory::of(&scene),
        gpu: GpuPlan::of(&scene, &model)?,
        steps,
        estimates,
        outputs: stages::outputs(&scene),
        warnings: warnings::of(&scene, &model).into_iter().chain(instability).chain(notes).collect(),
    };
    if let Some(folder) = &args.programs {
        check.gpu.write_sources(folder)?;
    }
    if let Some(folder) = &args.curves {
        curves::write(&scene.body.law, folder)?;
    }
    if args.json { terminal::print_json(&check) } else { terminal::print(&check.to_string()) }
}

/// Times the CPU engine, and a real GPU if there is one (a software adapter would take seconds to get ready). An
/// engine that fails is a note, not the end: the rest of the check stands.
fn estimates(scene: &Scene, model: &Model, steps: &Steps) -> (Vec<Estimate>, Vec<String>) {
    let reports = adapters();
    let real = choose::usable(&reports, None).filter(|a| !a.software);
    let mut engines = vec![cpu::engine(model, scene, Precision::F64, 0)];
    engines.extend(real.map(|a| choose::gpu(Some(&a.name), Precision::F32, model, scene)));
    let (mut estimates, mut notes) = (Vec::new(), Vec::new());
    for engine in engines {
        match engine.and_then(|engine| Estimate::of(engine, scene, model, steps)) {
            Ok(estimate) => estimates.push(estimate),
            Err(error) => notes.push(format!("no time estimate: {error}")),
        }
    }
    (estimates, notes)
}

impl Estimate {
    fn of(mut engine: Box<dyn Engine>, scene: &Scene, model: &Model, steps: &Steps) -> Result<Estimate> {
        let updates_per_s = estimate::rate(&mut *engine, model, scene, steps.element_bound_s)?;
        let info = engine.info();
        let device = if info.engine == "cpu" { format!("{} threads", info.threads) } else { info.device };
        let seconds = steps.seconds(model, updates_per_s);
        Ok(Estimate {
            engine: format!("{} {}, {device}", info.engine, info.precision),
            updates_per_s,
            seconds,
        })
    }
}
