//! `hexroll bench`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::choose::usable;
use super::terminal;
use hexroll::gpu::{Gpu, adapters};
use hexroll::physics::lanes::Level;
use hexroll::{Error, Result};
use hexroll_lab::bench::critical::{self, CriticalReport};
use hexroll_lab::bench::kind::Kind;
use hexroll_lab::bench::record::{self, Record};
use hexroll_lab::bench::report::{Missing, Report};
use hexroll_lab::bench::rows::{self, Options, Order};
use hexroll_lab::bench::{machine::Machine, markdown, straight, wheel};

pub const HELP: &str = "\
Times whole steps (forces, assembly, integration, contact, all works booked) of the paper's wheel while it rolls, on
every engine and mesh asked for; measures what the machine can do at most; and compares the state that was reached
with cpu-f64 after the same steps. A row whose error is above its limit makes the command fail. docs/speed.md
says what each column means. Nothing else should run on the machine.

Examples:
  hexroll bench --sizes 880,56320 --elements q1p0 --threads 1,2
  hexroll bench --engines cpu-f64 --viscosity both --contact both --json speed.json
  hexroll bench --parts table,critical,straight --out benches/results";

#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Engines; default: those of this machine
    #[arg(long, value_delimiter = ',', value_name = "ENGINE")]
    engines: Option<Vec<Kind>>,
    /// Element formulations
    #[arg(long, value_delimiter = ',', value_name = "ELEMENT", default_value = "q1p0,uniform-gradient,full",
          value_parser = ["q1p0", "uniform-gradient", "full"])]
    elements: Vec<String>,
    /// Elements of the wheel: 880 n^3
    #[arg(long, value_delimiter = ',', value_name = "N", default_value = "880,7040,56320,450560,3604480",
          value_parser = size)]
    sizes: Vec<usize>,
    /// Whether there is a road
    #[arg(long, value_enum, default_value_t = Switch::On)]
    contact: Switch,
    /// Shear viscosity: off, on (20 Pa s), both, or a value in Pa s
    #[arg(long, value_name = "ETA", default_value = "off", value_parser = viscosity,
          allow_hyphen_values = true)]
    viscosity: Viscosities,
    /// Threads of the CPU engines; 0: one a core
    #[arg(long, value_delimiter = ',', value_name = "N", default_value = "0")]
    threads: Vec<usize>,
    /// Instructions of the CPU engines: portable, avx2, avx512, best (of this machine; the default)
    #[arg(long, value_delimiter = ',', value_name = "LANES", value_parser = lanes)]
    lanes: Option<Vec<Level>>,
    /// The mesh as generated, with its numbers in random order, with every element of its own shape
    #[arg(long, value_enum, value_delimiter = ',', default_value = "structured")]
    meshes: Vec<Order>,
    /// Independent wheels at the same time: one a thread, in place of threads; on a GPU one a work group (gpu-f32, 880
    /// elements)
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    copies: u16,
    /// Time measured a row [s]
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = seconds)]
    seconds: f64,
    /// What to measure
    #[arg(long, value_enum, value_delimiter = ',', default_value = "table")]
    parts: Vec<Part>,
    /// Time steps against estimates, and rolling runs at several safeties (the same as --parts critical)
    #[arg(long)]
    dt: bool,
    /// Take the GPU adapter whose name contains this
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Write the record as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Make a folder <date>-<adapter or cpu> in this one: JSON, Markdown, scaling picture
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Parts of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Rates of every engine on every mesh
    Table,
    /// Critical step against estimates at rest, for every size up to 60,000 elements
    Steps,
    /// The same at rest and pressed, for 880 elements; stability at several safeties
    Critical,
    /// The paper's 0.1 s of straight rolling, from the start to the end
    Straight,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Switch {
    Off,
    On,
    Both,
}

#[derive(Debug, Clone, PartialEq)]
struct Viscosities(Vec<Option<f64>>);

fn size(text: &str) -> std::result::Result<usize, String> {
    let number: usize = text.parse().map_err(|_| "a whole number is needed".to_string())?;
    match wheel::refinement(number) {
        Some(_) => Ok(number),
        None => {
            Err("the wheel has 880 n^3 elements: 880, 7040, 23760, 56320, .., 450560, .., 3604480".into())
        }
    }
}

fn viscosity(text: &str) -> std::result::Result<Viscosities, String> {
    const ON: Option<f64> = Some(20.0);
    match text {
        "off" => return Ok(Viscosities(vec![None])),
        "on" => return Ok(Viscosities(vec![ON])),
        "both" => return Ok(Viscosities(vec![None, ON])),
        _ => {}
    }
    let value: f64 = text.parse().map_err(|_| "off, on, both, or a number of Pa s is needed".to_string())?;
    if !(value >= 0.0 && value.is_finite()) {
        return Err("a viscosity is not negative".into());
    }
    Ok(Viscosities(vec![(value > 0.0).then_some(value)]))
}

fn lanes(text: &str) -> std::result::Result<Level, String> {
    match text {
        "best" => Ok(Level::detect()),
        "portable" | "avx2" | "avx512" => {
            Level::named(text).ok_or("this machine does not have these instructions".into())
        }
        _ => Err("portable, avx2, avx512 or best is needed".into()),
    }
}

fn seconds(text: &str) -> std::result::Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "a number of seconds is needed".to_string())?;
    if value > 0.0 && value <= 3600.0 { Ok(value) } else { Err("between 0 and 3600 s is needed".into()) }
}

/// Threads as asked, 0 replaced by the number of cores, each number once.
fn threads(asked: &[usize]) -> Vec<usize> {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let mut list = Vec::new();
    for n in asked.iter().map(|&n| if n == 0 { cores } else { n }) {
        if !list.contains(&n) {
            list.push(n);
        }
    }
    list
}

pub fn execute(args: &BenchArgs) -> Result<()> {
    let parts = if args.dt { &[Part::Critical][..] } else { &args.parts };
    let mut report = Report::default();
    // Time steps are found in f64, on the CPU.
    let (engines, gpu) = match parts {
        [Part::Critical | Part::Steps] => (Vec::new(), None),
        _ => engines(args, &mut report)?,
    };
    report.machine = Machine::describe(gpu.as_ref().map(|g| &g.report));
    warn(&report.machine);
    let record = args.out.as_deref().map(|out| Record::create(out, &report)).transpose()?;
    let mut save = |report: &Report| -> Result<()> {
        args.json.as_deref().map_or(Ok(()), |path| record::write_json(path, report))?;
        record.as_ref().map_or(Ok(()), |record| record.write(report))
    };
    save(&report)?;
    for part in parts {
        match part {
            Part::Table => table(args, &engines, gpu.as_ref(), &mut report, &mut save)?,
            Part::Steps | Part::Critical => report.critical = Some(time_steps(args, *part)?),
            Part::Straight => straight_runs(args, &engines, gpu.as_ref(), &mut report)?,
        }
        save(&report)?;
    }
    terminal::print(&markdown::page(&report))?;
    if let Some(record) = &record {
        eprintln!("record: {}", record.folder.display());
    }
    match report.failures() {
        failures if failures.is_empty() => Ok(()),
        failures => Err(Error::Bench { detail: failures.join("; ") }),
    }
}

/// Engines to time, and the adapter of those on a GPU. Without `--engines`, what is not there is left out.
fn engines(args: &BenchArgs, report: &mut Report) -> Result<(Vec<Kind>, Option<Gpu>)> {
    let asked = args.engines.clone().unwrap_or(Kind::value_variants().to_vec());
    if !asked.iter().any(|k| k.on_gpu()) {
        return Ok((asked, None));
    }
    let optional = args.engines.is_none() && args.adapter.is_none();
    if optional && usable(&adapters(), None).is_none() {
        let missing = |kind: &Kind| Missing {
            engine: *kind,
            element: String::new(),
            elements: 0,
            failed: false,
            reason: "no adapter can be used here".into(),
        };
        let (gpu, cpu): (Vec<Kind>, Vec<Kind>) = asked.into_iter().partition(|k| k.on_gpu());
        report.missing.extend(gpu.iter().map(missing));
        return Ok((cpu, None));
    }
    Ok((asked, Some(Gpu::open(args.adapter.as_deref())?)))
}

fn warn(machine: &Machine) {
    if machine.profile != "release" {
        eprintln!(
            "warning: this is a {} build; only a release build's figures mean anything",
            machine.profile
        );
    }
    if let Some(load) = machine.load.filter(|l| *l > 0.2) {
        eprintln!("warning: load average {load:.2}: other work may share the machine");
    }
}

fn table(
    args: &BenchArgs,
    engines: &[Kind],
    gpu: Option<&Gpu>,
    report: &mut Report,
    save: &mut dyn FnMut(&Report) -> Result<()>,
) -> Result<()> {
    let options = Options {
        engines: engines.to_vec(),
        elements: args.elements.clone(),
        sizes: args.sizes.clone(),
        contact: match args.contact {
            Switch::Off => vec![false],
            Switch::On => vec![true],
            Switch::Both => vec![false, true],
        },
        viscosity: args.viscosity.0.clone(),
        threads: threads(&args.threads),
        lanes: args.lanes.clone().unwrap_or(vec![Level::detect()]),
        meshes: args.meshes.clone(),
        copies: args.copies.into(),
        seconds: args.seconds,
    };
    let mut told = 0;
    rows::fill(report, &options, gpu, &mut |report| {
        for row in &report.rows[told..] {
            let (engine, rate) = (markdown::engine(row), row.updates_per_s);
            eprintln!("{engine} {} {}: {rate:.3e} updates/s", row.element, row.elements);
        }
        told = report.rows.len();
        save(report)
    })
}

fn time_steps(args: &BenchArgs, part: Part) -> Result<CriticalReport> {
    let elements: Vec<&str> = args.elements.iter().map(String::as_str).collect();
    let mut note = |line: &str| eprintln!("{line}");
    match part {
        Part::Critical => critical::measure(&elements, &mut note),
        _ => critical::at_rest(&elements, &args.sizes, &args.viscosity.0, &mut note),
    }
}

fn straight_runs(args: &BenchArgs, engines: &[Kind], gpu: Option<&Gpu>, report: &mut Report) -> Result<()> {
    for &kind in engines {
        for threads in if kind.on_gpu() { vec![0] } else { threads(&args.threads) } {
            for element in &args.elements {
                for &eta in &args.viscosity.0 {
                    let run = straight::best(kind, threads, element, eta, gpu)?;
                    eprintln!("{} x{threads} {element}: rolls in {:.3} s", run.engine.name(), run.roll_s);
                    report.straight.push(run);
                }
            }
        }
    }
    Ok(())
}
