//! The command line: arguments in, files and tables out.
//!
//! Results go to stdout, progress and warnings to stderr; exit codes are those of
//! [`Error::exit_code`](hexroll::Error::exit_code).

#![allow(non_snake_case)] // F, J, W, N: the field's own symbols

mod adapters;
mod animate;
mod batch;
mod bench;
mod check;
pub mod choose;
mod compare;
mod estimate;
mod format;
mod manual;
mod mesh;
mod new;
mod page;
mod pictures;
mod plot;
mod progress;
mod recorder;
mod render;
mod report;
mod run;
mod scene;
mod spectrum;
mod study;
mod sweep;
mod table;
mod terminal;
mod warnings;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};

use hexroll::Result;

const EXIT_CODES: &str = "\
Exit codes:
  0    done
  2    a wrong argument, or a scene that cannot be used: the message names file, line and key
  3    something a scene may name one day, but that this version does not have
  4    no usable GPU adapter, one too small for the scene, or one that failed
  5    the run failed numerically (an element inverted, a value not finite, a stage that did not settle)
  6    a file or folder that cannot be read or written, or holds something else
  130  interrupted: everything computed so far is on disk";

const EXAMPLES: &str = "\
Examples:
  hexroll new wheel
  hexroll check scenes/lat100_straight.toml
  hexroll run scenes/lat100_straight.toml
  hexroll report run runs/lat100_straight
  hexroll render runs/lat100_straight --view side --field pressure
  hexroll run scenes/lat100_straight.toml --set body.element=full --out runs/full
  hexroll compare runs/lat100_straight runs/full
  hexroll study scenes/lat100_straight_viscous.toml --refine 1,2,3
  hexroll sweep scenes/lat100_slip5_viscous.toml --over slip-angle=-10:10:9";

/// Rubber wheels of eight-node hexahedra, rolling and sliding on rigid roads: explicit dynamics on the GPU and the CPU.
#[derive(Debug, Parser)]
#[command(name = "hexroll", version, after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"))]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write a commented scene to begin with
    #[command(after_help = new::HELP)]
    New(new::NewArgs),
    /// Simulate a scene and write histories, fields, pictures and a summary
    #[command(after_help = run::HELP)]
    Run(run::RunArgs),
    /// Say what would be modelled and what it would cost; runs nothing
    #[command(after_help = check::HELP)]
    Check(check::CheckArgs),
    /// Draw the mesh of a scene and write it for other programs; runs nothing
    #[command(after_help = mesh::HELP)]
    Mesh(mesh::MeshArgs),
    /// Draw pictures from the folder of a finished or killed run
    #[command(after_help = render::HELP)]
    Render(render::RenderArgs),
    /// Run scenes on refined meshes: tables with extrapolated values and error bars
    #[command(after_help = study::HELP)]
    Study(study::StudyArgs),
    /// Run a scene over slip angles, loads or any of its keys: one table, one plot
    #[command(after_help = sweep::HELP)]
    Sweep(sweep::SweepArgs),
    /// Errors between two runs of one mesh, history by history and field by field
    #[command(after_help = compare::HELP)]
    Compare(compare::CompareArgs),
    /// Pages: on a run, a study or a sweep, to send; or on what can be believed: claims, limits of stability, speed against error
    #[command(after_help = report::HELP)]
    Report(report::ReportArgs),
    /// Overlay columns of several runs' histories in one plot
    #[command(after_help = plot::HELP)]
    Plot(plot::PlotArgs),
    /// Power spectra and one-third-octave bands of a run's histories
    #[command(after_help = spectrum::HELP)]
    Spectrum(spectrum::SpectrumArgs),
    /// List the GPU adapters, their limits, and the one that `--engine auto` takes
    Adapters(adapters::AdaptersArgs),
    /// Time every engine against the machine's measured limits
    #[command(after_help = bench::HELP)]
    Bench(bench::BenchArgs),
    /// Print the completions of a shell
    #[command(after_help = manual::COMPLETIONS)]
    Completions(manual::CompletionsArgs),
    /// Print or write the manual's pages
    #[command(after_help = manual::MAN)]
    Man(manual::ManArgs),
}

impl Cli {
    /// The process's own arguments; help, version and mistakes in them end the process (0, 0, 2).
    pub fn from_arguments() -> Cli {
        let cli = Cli::parse();
        let engine = match &cli.command {
            Command::Run(args) => Some(&args.engine),
            Command::Study(args) => Some(&args.engine),
            Command::Sweep(args) => Some(&args.engine),
            _ => None,
        };
        let own = match &cli.command {
            Command::Sweep(args) => args.conflict(),
            _ => None,
        };
        if let Some(conflict) = engine.and_then(|e| e.conflict()).or(own) {
            Cli::command().error(ErrorKind::ArgumentConflict, conflict).exit();
        }
        cli
    }

    /// Does what was asked.
    ///
    /// # Errors
    /// Whatever ends a command: see [`Error`](hexroll::Error).
    pub fn execute(self) -> Result<()> {
        match self.command {
            Command::New(args) => new::execute(&args),
            Command::Run(args) => run::execute(&args),
            Command::Check(args) => check::execute(&args),
            Command::Mesh(args) => mesh::execute(&args),
            Command::Render(args) => render::execute(&args),
            Command::Study(args) => study::execute(&args),
            Command::Sweep(args) => sweep::execute(&args),
            Command::Compare(args) => compare::execute(&args),
            Command::Report(args) => report::execute(&args),
            Command::Plot(args) => plot::execute(&args),
            Command::Spectrum(args) => spectrum::execute(&args),
            Command::Adapters(args) => adapters::execute(&args),
            Command::Bench(args) => bench::execute(&args),
            Command::Completions(args) => manual::completions(&args, Cli::command()),
            Command::Man(args) => manual::man(&args, Cli::command()),
        }
    }
}
