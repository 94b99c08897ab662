//! `hexroll report`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Subcommand};

use super::{page, terminal};
use hexroll::gpu::Gpu;
use hexroll::{Error, Result};
use hexroll_lab::bench::machine::Machine;
use hexroll_lab::report::accuracy::{self, Matrix, Measured, Problem};
use hexroll_lab::report::page::{self as claims, Finding};
use hexroll_lab::report::{Case, parity, stability, verification};

pub const HELP: &str = "\
`verification`, `accuracy`, `parity` and `stability` measure this program: nothing is cached, every number is computed
now, on this machine, and the page says on which. `run`, `study` and `sweep` make a page of what a folder holds, finished
or not, and compute nothing.

Examples:
  hexroll report run runs/lat100_straight       # writes runs/lat100_straight/report.html
  hexroll report study runs/study --out mesh.html
  hexroll report verification
  hexroll report verification --only hertz_line --only hertz_point --out -
  hexroll report verification --everyday
  hexroll report parity --out -
  hexroll report accuracy --gpu 1               # an hour of one core
  hexroll report accuracy --retime              # its times again, on a machine that does nothing else: a minute";

#[derive(Debug, Args)]
pub struct ReportArgs {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Debug, Subcommand)]
enum Kind {
    /// Claims against closed forms and other codes: docs/verification.md
    Verification(CasesArgs),
    /// Speed against error for every engine, formulation, mesh and step: docs/accuracy.md
    Accuracy(AccuracyArgs),
    /// The GPU engine against the CPU's f64, and its bits from run to run, on the first adapter that can be used
    Parity(CasesArgs),
    /// Hard cases and the largest safety factor each survives: docs/stability.md
    Stability(CasesArgs),
    /// A page on a run, from its folder: one HTML file to send, to print, to open without a network
    Run(page::RunPageArgs),
    /// The same on a mesh study, with its curves
    Study(page::BatchPageArgs),
    /// The same on a sweep
    Sweep(page::BatchPageArgs),
}

/// Rows of a measurement that has not ended.
const PARTIAL: &str = "accuracy.partial.csv";

/// What is measured.
#[derive(Debug, Args)]
struct AccuracyArgs {
    /// Problems: static, straight, slip-5, wave; default all. What accuracy.csv has of the others is kept
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Finest mesh, as a multiple of 44 x 4 x 5: 1, 2, 4, ... up to it are measured
    #[arg(long, value_name = "N", default_value_t = 4)]
    finest: usize,
    /// Finest mesh of the reference, where it is to be finer than what is measured; x8 takes a quarter of an hour a problem on two
    /// cores
    #[arg(long, value_name = "N", default_value_t = 1)]
    reference: usize,
    /// Finest mesh with every safety factor, and errors split into space, step and rounding
    #[arg(long, value_name = "N", default_value_t = 2)]
    split: usize,
    /// Finest mesh that the GPU engine is measured on too; 0: none
    #[arg(long, value_name = "N", default_value_t = 0)]
    gpu: usize,
    /// Threads of the CPU engine; 0: one a core
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// Keep the errors in accuracy.csv, and measure the wall times again
    #[arg(long)]
    retime: bool,
    /// Folder for accuracy.md, accuracy.csv and accuracy.png; rows so far are in accuracy.partial.csv until all are there
    #[arg(long, value_name = "DIR", default_value = "docs")]
    out: PathBuf,
}

/// Which cases, and where the page goes.
#[derive(Debug, Clone, Args)]
struct CasesArgs {
    /// Only this case; may be repeated
    #[arg(long, value_name = "CASE")]
    only: Vec<String>,
    /// Only the cases of the everyday suite
    #[arg(long)]
    everyday: bool,
    /// File to write, or - for the terminal
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub fn execute(args: &ReportArgs) -> Result<()> {
    match &args.kind {
        Kind::Verification(args) => {
            let intro = "Every number is the program's own of this run; what it should be is a closed form, \
                         another code's number or a conservation law.";
            cases(args, verification::CASES, "Verification", intro, "verification")
        }
        Kind::Accuracy(args) => accuracy(args),
        Kind::Parity(args) => {
            let gpu = Gpu::open(None)?.report;
            let kind = if gpu.software { "software: a processor's arithmetic" } else { "a GPU" };
            let intro = format!("Adapter: {} ({kind}), driver {}.", gpu.name, gpu.driver);
            // Of this adapter: no page of the documentation.
            let out = args.out.clone().or(Some("-".into()));
            cases(&CasesArgs { out, ..args.clone() }, parity::CASES, "Parity", &intro, "parity")
        }
        Kind::Stability(args) => hard_cases(args),
        Kind::Run(args) => page::run(args),
        Kind::Study(args) => page::study(args),
        Kind::Sweep(args) => page::sweep(args),
    }
}

fn cases(args: &CasesArgs, all: &[Case], title: &str, intro: &str, kind: &str) -> Result<()> {
    let chosen = chosen(args, all)?;
    let findings: Vec<Finding> = chosen.into_iter().map(find).collect();
    let whole = args.only.is_empty() && !args.everyday;
    let command = format!("hexroll report {kind}{}", if args.everyday { " --everyday" } else { "" });
    let text = claims::page(title, intro, &command, &findings);
    // A part of the cases does not replace the page of all.
    let default = if whole { PathBuf::from(format!("docs/{kind}.md")) } else { PathBuf::from("-") };
    write(args.out.as_deref().unwrap_or(&default), &text)?;
    let failed: Vec<&str> = findings.iter().filter(|f| !f.holds()).map(|f| f.case.name).collect();
    if failed.is_empty() { Ok(()) } else { Err(Error::Claims { cases: failed.join(", ") }) }
}

/// Hard cases whose limit is searched, then those with claims of their own.
fn hard_cases(args: &CasesArgs) -> Result<()> {
    let hard: Vec<&stability::Hard> = (stability::HARD.iter())
        .filter(|h| args.only.is_empty() || args.only.iter().any(|name| name == h.name))
        .filter(|h| h.everyday || !args.everyday)
        .collect();
    let own = CasesArgs {
        only: args.only.iter().filter(|n| hard.iter().all(|h| h.name != **n)).cloned().collect(),
        ..args.clone()
    };
    let cases = if own.only.is_empty() && !args.only.is_empty() {
        Vec::new()
    } else {
        chosen(&own, stability::CASES)?
    };
    let mut failed = Vec::new();
    let mut rows = Vec::new();
    for case in hard {
        let limit = stability::find(case)?;
        eprintln!("{}  {}", if case.holds(&limit) { "holds" } else { "FAILS" }, case.name);
        if !case.holds(&limit) {
            failed.push(case.name);
        }
        rows.push(case.cells(&limit));
    }
    let findings: Vec<Finding> = cases.into_iter().map(find).collect();
    failed.extend(findings.iter().filter(|f| !f.holds()).map(|f| f.case.name));
    let body = format!(
        "Errors are of the run at the default safety factor of 0.9, over its largest energy term: of the accumulated \
         work (round-off) and of the stored energy (the step). The safety factor is raised through 0.97, 1.03, 1.1, \
         1.3 until a run fails; where 0.9 fails, 0.45 and 0.2 are tried. A run that ends with energies that do not add \
         up counts as a failure of the program, not of the scene.\n\n{}\n{}",
        claims::table(&HARD_HEAD, rows),
        claims::sections(&findings)
    );
    let intro = "Where the program stops being stable, and what it says then.";
    let text = claims::titled("Stability", intro, "hexroll report stability", &body);
    let whole = args.only.is_empty() && !args.everyday;
    let default = if whole { PathBuf::from("docs/stability.md") } else { PathBuf::from("-") };
    write(args.out.as_deref().unwrap_or(&default), &text)?;
    if failed.is_empty() { Ok(()) } else { Err(Error::Claims { cases: failed.join(", ") }) }
}

const HARD_HEAD: [&str; 9] = [
    "case",
    "steps",
    "work error",
    "stored-energy error",
    "allowed",
    "smallest det F",
    "stable up to safety",
    "what ends it beyond",
    "pass",
];

/// Speed against error.
fn accuracy(args: &AccuracyArgs) -> Result<()> {
    let known: Vec<&str> = Problem::ALL.iter().map(|p| p.name()).collect();
    if let Some(unknown) = args.only.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(no_such("problem", unknown, &known));
    }
    let table = args.out.join("accuracy.csv");
    let mut measured = if args.retime {
        let text = std::fs::read_to_string(&table).map_err(Error::io(&table, "read the errors"))?;
        accuracy::parse(&table, &text)?
    } else {
        let before = match std::fs::read_to_string(&table) {
            Ok(text) if !args.only.is_empty() => accuracy::parse(&table, &text)?,
            _ => Measured::default(),
        };
        // Errors are dear: whatever ends this, the rows there are so far are kept.
        let partial = args.out.join(PARTIAL);
        std::fs::create_dir_all(&args.out).map_err(Error::io(&args.out, "make the folder"))?;
        let mut measured = accuracy::measure(&matrix(args), |so_far, line| {
            eprintln!("{line}");
            std::fs::write(&partial, accuracy::csv(so_far))
                .map_err(Error::io(&partial, "keep the rows so far"))
        })?;
        let from = origin(&measured);
        measured.references.iter_mut().for_each(|r| r.from.clone_from(&from));
        measured.keep(before);
        measured.times_from = "none".into();
        write(&table, &accuracy::csv(&measured))?;
        std::fs::remove_file(&partial).map_err(Error::io(&partial, "remove the rows so far"))?;
        measured
    };
    let windows = accuracy::time(&mut measured.rows, args.threads)?;
    measured.times_from = origin(&measured);
    write(&table, &accuracy::csv(&measured))?;
    write(&args.out.join("accuracy.md"), &accuracy_page(&measured, &windows))?;
    let picture = args.out.join("accuracy.png");
    let problem = |e: image::ImageError| Error::Picture { problem: e.to_string() };
    accuracy::picture(&measured)?.save(&picture).map_err(problem)
}

fn matrix(args: &AccuracyArgs) -> Matrix {
    let wanted = |p: &Problem| args.only.is_empty() || args.only.iter().any(|name| name == p.name());
    let finest = args.finest.max(1);
    let mut meshes: Vec<usize> = (0..).map(|k| 1 << k).take_while(|m| *m < finest).collect();
    meshes.push(finest);
    Matrix {
        problems: Problem::ALL.into_iter().filter(wanted).collect(),
        elements: accuracy::ELEMENTS.to_vec(),
        meshes,
        reference: args.reference,
        safeties: vec![0.9, 0.45],
        split: args.split,
        gpu: args.gpu,
        threads: args.threads,
    }
}

/// Command, machine, adapter, commit and day of a measurement that is made now.
fn origin(measured: &Measured) -> String {
    let on_gpu = measured.rows.iter().any(|r| r.setting.machine.on_gpu());
    let report = if on_gpu { hexroll::gpu::Gpu::open(None).ok().map(|gpu| gpu.report) } else { None };
    let m = Machine::describe(report.as_ref());
    let adapter = m.adapter.map_or(String::new(), |a| format!(", {a} ({})", m.driver.unwrap_or_default()));
    let load = m.load.map_or(String::new(), |l| format!(", load {l:.1} at the end"));
    format!(
        "`{}`, {}, {} cores{adapter}, {} build, commit {}, {}{load}",
        m.command, m.processor, m.cores, m.profile, m.commit, m.date
    )
}

fn accuracy_page(measured: &Measured, windows: &[accuracy::Window]) -> String {
    let intro = "What an error costs. *Discretisation* is what double precision with a third of the step leaves, *time step* \
                 is what the step adds, *rounding* is what the precision adds (what a cell does not say was not \
                 measured). Elastic rolling and 45 degrees do not converge with the mesh and are not here. Wall time is \
                 the time of a step, measured by itself, times the steps of the whole run, pressing included, with the \
                 force passes that find the critical step, without output.";
    let errors: String = (measured.references.iter())
        .map(|r| format!("- errors of {}: {}\n", r.problem.name(), r.from))
        .collect();
    format!(
        "# Speed against error\n\n{intro}\n\n{errors}- times: {}\n\n![wall time against error](accuracy.png)\n\n\
         ## What errors are against\n\n{}\n## The fastest setting within an error\n\nThe reference's own error counts.\n\n{}\n\
         ## What output windows cost\n\nStraight run, x1, cpu f64, q1p0. Forces are impulses over a window, from every \
         step: the mean does not depend on it.\n\n{}{}",
        measured.times_from,
        accuracy::references(measured),
        accuracy::advice(measured),
        accuracy::windows(windows),
        accuracy::markdown(&measured.rows)
    )
}

fn no_such(what: &str, given: &str, known: &[&str]) -> Error {
    Error::Scene {
        file: "command line".into(),
        line: None,
        key: "--only".into(),
        problem: format!("there is no {what} {given:?}"),
        remedy: format!("known: {}", known.join(", ")),
    }
}

fn chosen<'a>(args: &CasesArgs, all: &'a [Case]) -> Result<Vec<&'a Case>> {
    if let Some(unknown) = args.only.iter().find(|name| all.iter().all(|c| c.name != **name)) {
        let names: Vec<&str> = all.iter().map(|c| c.name).collect();
        return Err(no_such("case", unknown, &names));
    }
    let wanted = |c: &&Case| args.only.is_empty() || args.only.iter().any(|name| name == c.name);
    Ok(all.iter().filter(wanted).filter(|c| c.everyday || !args.everyday).collect())
}

fn find(case: &Case) -> Finding<'_> {
    let start = Instant::now();
    let claims = (case.run)().map_err(|e| e.to_string());
    let finding = Finding { case, claims, wall: start.elapsed() };
    let word = if finding.holds() { "holds" } else { "FAILS" };
    eprintln!("{word}  {} ({:.1} s)", case.name, finding.wall.as_secs_f64());
    finding
}

fn write(path: &Path, text: &str) -> Result<()> {
    if path == Path::new("-") {
        return terminal::print(text);
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(Error::io(folder, "make the folder"))?;
    }
    std::fs::write(path, text).map_err(Error::io(path, "write the report"))?;
    eprintln!("wrote {}", path.display());
    Ok(())
}
