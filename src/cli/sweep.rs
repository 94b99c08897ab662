//! `hexroll sweep`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::batch::{Case, run_all, run_together, settled, side_by_side};
use super::choose::{EngineArgs, EngineChoice};
use super::recorder::listen_for_interrupts;
use super::study::{axis, below, made_by, save_picture, save_text, stem, typed};
use super::terminal;
use hexroll::scene::Scene;
use hexroll::study::axis::{Axis, Value};
use hexroll::study::index::{self, Index, Place, Planned};
use hexroll::study::sweep::{Point, Sweep};
use hexroll::{Error, Precision, Result};

pub const HELP: &str = "\
Runs the scene for every combination of the values and writes one table and one plot: forces, moments, radii, footprint,
and the cornering stiffness where the slip angle is varied. KEY is slip-angle [deg], load [N], deflection [mm], slip,
refine, dt-safety, precision or any key of the scene; VALUES a list a,b,c or a range from:to:count. Runs that have
finished are kept: the same command goes on where it was stopped.

Examples:
  hexroll sweep scenes/lat100_slip5_viscous.toml --over slip-angle=-10:10:9
  hexroll sweep scenes/lat100_slip5_viscous.toml --over slip-angle=-6:6:5 --over deflection=1.8,2.2,2.6
  hexroll sweep scenes/lat100_straight_viscous.toml --over friction.coefficient=0.4:1.2:5 --jobs 1
  hexroll sweep scenes/lat100_slip5_viscous.toml --over slip-angle=-15:15:61 --ensemble
  hexroll sweep scenes/lat100_slip5_viscous.toml --over slip-angle=-5:5:5 --study runs/study/study.csv";

#[derive(Debug, Args)]
pub struct SweepArgs {
    /// Scene file (TOML)
    scene: PathBuf,
    /// What to vary; may be repeated: the first is the abscissa of the plot
    #[arg(long, value_name = "KEY=VALUES", value_parser = axis, required = true)]
    over: Vec<Axis>,
    /// Change an entry of the scene; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Numbers of a mesh study of this scene (its .csv): gives the cornering stiffness the error bar of the side force
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
    /// Report to write (Markdown), with .csv and .png files of its name beside it; default <out>/sweep.md
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Folder of the runs; default runs/sweep/<name of the scene file>
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Runs side by side, each on its share of the cores; 0: one a core
    #[arg(long, value_name = "N", default_value_t = 0, conflicts_with = "ensemble")]
    jobs: usize,
    /// All runs at the same time on one GPU, each in a work group of its own, in f32: for wheels of about a thousand
    /// elements
    #[arg(long)]
    ensemble: bool,
    #[command(flatten)]
    pub engine: EngineArgs,
}

impl SweepArgs {
    /// Arguments that exclude each other.
    pub fn conflict(&self) -> Option<&'static str> {
        if !self.ensemble {
            return None;
        }
        if self.engine.engine == EngineChoice::Cpu {
            return Some("--ensemble runs on a GPU, --engine cpu does not");
        }
        if self.engine.precision.is_some_and(|p| p != Precision::F32) {
            return Some("--ensemble computes in f32: leave --precision out");
        }
        let varied = self.over.iter().any(|axis| axis.key == "precision");
        varied.then_some("--ensemble computes in f32: no precision can be varied")
    }

    fn engine(&self) -> EngineArgs {
        if self.ensemble {
            let (engine, precision) = (EngineChoice::Gpu, Some(Precision::F32));
            return EngineArgs { engine, precision, ..self.engine.clone() };
        }
        settled(&self.engine)
    }
}

pub fn execute(args: &SweepArgs) -> Result<()> {
    let out = args.out.clone().unwrap_or_else(|| Path::new("runs/sweep").join(stem(&args.scene)));
    let error = args.study.as_deref().map(|file| side_force_error(file, &stem(&args.scene))).transpose()?;
    let engine = args.engine();
    let scene = Scene::load(&args.scene, &args.sets)?;
    let combinations = combinations(&args.over);
    let case = |values: &Vec<&Value>| {
        let pairs = || args.over.iter().zip(values);
        let changes = pairs().map(|(axis, value)| axis.changes(value, &scene)).collect::<Result<Vec<_>>>()?;
        let named =
            |between: &str| pairs().map(|(a, v)| format!("{}{between}{}", a.key, v.text)).collect::<Vec<_>>();
        let folder = out.join(named("_").join("_").replace(['/', ' '], "-"));
        Case::new(named(" ").join(", "), &args.scene, &args.sets, &changes, &engine, folder)
    };
    let cases = combinations.iter().map(case).collect::<Result<Vec<_>>>()?;
    listen_for_interrupts()?;
    index(args, &scene, &out, &combinations, &cases).write(&out, index::SWEEP)?;
    let summaries = if args.ensemble {
        run_together(&cases, &engine)?
    } else {
        run_all(&cases, side_by_side(args.jobs, &engine))?
    };
    let point = |(i, (values, summary)): (usize, (&Vec<&Value>, _))| Point {
        values: texts(values),
        x: values[0].number.unwrap_or(i as f64),
        summary,
    };
    let sweep = Sweep {
        name: stem(&args.scene),
        title: scene.title.clone(),
        axes: args.over.iter().map(Axis::label).collect(),
        points: combinations.iter().zip(summaries).enumerate().map(point).collect(),
    };
    let report = args.report.clone().unwrap_or_else(|| out.join("sweep.md"));
    let picture = report.with_extension("png");
    save_picture(&sweep.picture()?, &picture)?;
    let name = picture.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let text = format!("# Sweep\n\n{}{}", made_by(), sweep.markdown(&name, error));
    save_text(&text, &report)?;
    save_text(&sweep.csv(), &report.with_extension("csv"))?;
    terminal::print(&format!("{text}\nwritten: {} and files of its name\n", report.display()))
}

/// What is to be run, for the folder `out`.
fn index(args: &SweepArgs, scene: &Scene, out: &Path, combinations: &[Vec<&Value>], cases: &[Case]) -> Index {
    let place = |(i, (values, case)): (usize, (&Vec<&Value>, &Case))| Place {
        folder: below(out, &case.out),
        label: case.name.clone(),
        values: texts(values),
        x: values[0].number.unwrap_or(i as f64),
        size: None,
    };
    let planned = Planned {
        name: stem(&args.scene),
        title: scene.title.clone(),
        axes: args.over.iter().map(Axis::label).collect(),
        runs: combinations.iter().zip(cases).enumerate().map(place).collect(),
    };
    Index { command: typed(), version: env!("CARGO_PKG_VERSION").into(), scenes: vec![planned] }
}

fn texts(values: &[&Value]) -> Vec<String> {
    values.iter().map(|v| v.text.clone()).collect()
}

/// Every combination of the axes' values, the first axis running fastest.
fn combinations(axes: &[Axis]) -> Vec<Vec<&Value>> {
    axes.iter().fold(vec![Vec::new()], |so_far, axis| {
        let extended = axis.values.iter().flat_map(|value| {
            so_far.iter().map(move |before: &Vec<&Value>| {
                let mut values = before.clone();
                values.push(value);
                values
            })
        });
        extended.collect()
    })
}

/// Relative error bar of the side force in a study's numbers.
fn side_force_error(file: &Path, scene: &str) -> Result<f64> {
    let bad = |problem: String| Error::Format { path: file.into(), problem };
    let text = std::fs::read_to_string(file).map_err(Error::io(file, "read this file"))?;
    let mut columns: Vec<String> = Vec::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        if cells.first() == Some(&"scene") {
            columns = cells.iter().map(|c| c.to_string()).collect();
        }
        if cells.first() != Some(&scene) || cells.get(1) != Some(&"road_fy") {
            continue;
        }
        let cell = |name: &str| {
            let at = columns.iter().position(|c| c == name);
            at.and_then(|i| cells.get(i)?.parse::<f64>().ok())
        };
        return match (cell("value"), cell("error_bar")) {
            (Some(value), Some(error)) if value != 0.0 => Ok((error / value).abs()),
            _ => Err(bad(format!("the side force of {scene} has no error bar"))),
        };
    }
    Err(bad(format!(
        "no side force (road_fy) of a scene {scene}; a study writes it: hexroll study {scene}.toml --refine .."
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_axis_runs_fastest() {
        let axes = ["a=1,2", "b=3,4,5"].map(|a| Axis::parse(a).unwrap());
        let texts: Vec<String> =
            combinations(&axes).iter().map(|c| c.iter().map(|v| v.text.as_str()).collect()).collect();
        assert_eq!(texts, ["13", "23", "14", "24", "15", "25"]);
    }

    #[test]
    fn the_error_bar_is_found_by_scene_and_column() {
        let temp = tempfile::tempdir().unwrap();
        let file = temp.path().join("study.csv");
        let head = "scene,quantity,unit,44x4x5,88x8x10,verdict,order,value,error_bar\n";
        let rows = "other,road_fy,N,1,1,extrapolated,2,1e2,5e1\nwheel,road_fz,N,1,1,constant,,1,0\n\
                    wheel,road_fy,N,-103,-99,extrapolated,1.9,-9.8e1,4.9e-1\n";
        std::fs::write(&file, format!("{head}{rows}")).unwrap();
        assert!((side_force_error(&file, "wheel").unwrap() - 0.005).abs() < 1e-15);
        assert!(side_force_error(&file, "none").unwrap_err().to_string().contains("no side force"));
    }
}
