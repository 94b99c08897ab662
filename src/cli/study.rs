//! `hexroll study`.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use clap::Args;
use image::{ImageFormat, RgbaImage};

use super::batch::{Case, run_all, settled, side_by_side};
use super::choose::EngineArgs;
use super::recorder::listen_for_interrupts;
use super::terminal;
use hexroll::output::folder::write_whole;
use hexroll::scene::Scene;
use hexroll::study::axis::{Axis, Value};
use hexroll::study::index::{self, Index, Place, Planned};
use hexroll::study::report::{Run, Study};
use hexroll::{Error, Result};

pub const HELP: &str = "\
Runs every scene on refined meshes (or with smaller time steps, or in several precisions) and writes a table and a
picture of every mean force, moment and the contact area, with the value extrapolated to zero size and the grid
convergence index as its error bar. A sequence that is not monotone is not extrapolated, and said to be so. Runs that
have finished are kept: the same command goes on where it was stopped.

Examples:
  hexroll study scenes/lat100_straight_viscous.toml --refine 1,2,3,4
  hexroll study scenes/lat100_static_height.toml scenes/lat100_slip5_viscous.toml --refine 1,2,3 --report mesh.md
  hexroll study scenes/lat100_slip5_viscous.toml --over dt-safety=0.9,0.45,0.225
  hexroll study scenes/lat100_slip5_viscous.toml --over precision=f64,f32";

#[derive(Debug, Args)]
pub struct StudyArgs {
    /// Scene files (TOML)
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Multiply the generator's element counts by these
    #[arg(
        long,
        value_name = "N,N,..",
        value_delimiter = ',',
        conflicts_with = "over",
        required_unless_present = "over"
    )]
    refine: Vec<f64>,
    /// Vary something else: dt-safety=.. or precision=..
    #[arg(long, value_name = "KEY=VALUES", value_parser = axis)]
    over: Option<Axis>,
    /// Change an entry of every scene; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Report to write (Markdown), with .csv and .png files of its name beside it; default <out>/study.md
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Folder of the runs
    #[arg(long, value_name = "DIR", default_value = "runs/study")]
    out: PathBuf,
    /// Runs side by side, each on its share of the cores; 0: one a core
    #[arg(long, value_name = "N", default_value_t = 1)]
    jobs: usize,
    #[command(flatten)]
    pub engine: EngineArgs,
}

/// An axis of an argument.
pub fn axis(text: &str) -> std::result::Result<Axis, String> {
    Axis::parse(text)
}

pub fn execute(args: &StudyArgs) -> Result<()> {
    let axis = match &args.over {
        Some(axis) => axis.clone(),
        None => Axis::of_numbers("refine", &args.refine),
    };
    let engine = settled(&args.engine);
    let mut cases = Vec::new();
    for file in &args.scenes {
        cases.extend(of_scene(args, file, &axis, &engine)?);
    }
    listen_for_interrupts()?;
    index(args, &axis, &cases).write(&args.out, index::STUDY)?;
    let summaries = run_all(&cases, side_by_side(args.jobs, &engine))?;
    let report = args.report.clone().unwrap_or_else(|| args.out.join("study.md"));
    let mut studies = Vec::new();
    let each = axis.values.len();
    for ((file, cases), summaries) in args.scenes.iter().zip(cases.chunks(each)).zip(summaries.chunks(each)) {
        let run = |((case, summary), value): ((&Case, &_), _)| Run {
            label: label(&axis, value, &case.scene),
            size: axis.size(value),
            summary: Clone::clone(summary),
        };
        studies.push(Study {
            name: stem(file),
            title: cases[0].scene.title.clone(),
            axis: axis.label(),
            runs: cases.iter().zip(summaries).zip(&axis.values).map(run).collect(),
        });
    }
    write(&studies, &report)
}

/// What is to be run, for the folder.
fn index(args: &StudyArgs, axis: &Axis, cases: &[Case]) -> Index {
    let place = |(case, value): (&Case, &Value)| Place {
        folder: below(&args.out, &case.out),
        label: label(axis, value, &case.scene),
        size: axis.size(value),
        ..Place::default()
    };
    let scene = |(file, cases): (&PathBuf, &[Case])| Planned {
        name: stem(file),
        title: cases[0].scene.title.clone(),
        axes: vec![axis.label()],
        runs: cases.iter().zip(&axis.values).map(place).collect(),
    };
    let scenes = args.scenes.iter().zip(cases.chunks(axis.values.len())).map(scene).collect();
    Index { command: typed(), version: env!("CARGO_PKG_VERSION").into(), scenes }
}

/// A run's folder as its index has it.
pub fn below(dir: &Path, run: &Path) -> String {
    run.strip_prefix(dir).unwrap_or(run).to_string_lossy().into_owned()
}

fn of_scene(args: &StudyArgs, file: &Path, axis: &Axis, engine: &EngineArgs) -> Result<Vec<Case>> {
    let scene = Scene::load(file, &args.sets)?;
    let case = |value| {
        let changes = [axis.changes(value, &scene)?];
        let name = format!("{} {} {}", stem(file), axis.label(), value.text);
        let folder = args.out.join(stem(file)).join(format!("{}_{}", axis.key, value.text));
        Case::new(name, file, &args.sets, &changes, engine, folder)
    };
    axis.values.iter().map(case).collect()
}

/// What a table calls a run: its mesh, or the value.
fn label(axis: &Axis, value: &Value, scene: &Scene) -> String {
    if axis.key != "refine" {
        return value.text.clone();
    }
    scene
        .body
        .mesh
        .elements()
        .map_or_else(|| value.text.clone(), |counts| counts.map(|n| n.to_string()).join("x"))
}

/// A file's name without its ending.
pub fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or("scene".as_ref()).to_string_lossy().into_owned()
}

/// Writes the report, the numbers and the pictures, and prints the report.
fn write(studies: &[Study], report: &Path) -> Result<()> {
    let mut text = String::from("# Study\n\n");
    text += &made_by();
    let mut numbers = String::new();
    for study in studies {
        let picture = report.with_file_name(format!("{}-{}.png", stem(report), study.name));
        save_picture(&study.picture()?, &picture)?;
        text += &study.markdown(&picture.file_name().unwrap_or_default().to_string_lossy());
        text.push('\n');
        numbers += &study.csv();
    }
    save_text(&text, report)?;
    save_text(&numbers, &report.with_extension("csv"))?;
    terminal::print(&format!("{text}\nwritten: {} and files of its name\n", report.display()))
}

/// The command and the program, for the head of a report.
pub fn made_by() -> String {
    format!("`{}`, version {}.\n\n", typed(), env!("CARGO_PKG_VERSION"))
}

/// The command as it was typed.
pub fn typed() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    format!("hexroll {}", arguments.join(" "))
}

/// Writes a text; its folder is made if it is missing.
pub fn save_text(text: &str, path: &Path) -> Result<()> {
    make_folder_of(path)?;
    write_whole(path, |out| out.write_all(text.as_bytes()))
}

/// Writes a PNG.
pub fn save_picture(picture: &RgbaImage, path: &Path) -> Result<()> {
    make_folder_of(path)?;
    let mut png = Cursor::new(Vec::new());
    let encoded = picture.write_to(&mut png, ImageFormat::Png);
    encoded.map_err(|e| Error::Picture { problem: format!("PNG encoding failed: {e}") })?;
    write_whole(path, |out| out.write_all(png.get_ref()))
}

fn make_folder_of(path: &Path) -> Result<()> {
    match path.parent().filter(|p| !p.as_os_str().is_empty()) {
        Some(folder) => std::fs::create_dir_all(folder).map_err(Error::io(folder, "create this folder")),
        None => Ok(()),
    }
}
