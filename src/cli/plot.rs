//! `hexroll plot`: columns of several runs' histories in one figure.

use std::path::{Path, PathBuf};

use clap::Args;

use super::study::{save_picture, save_text};
use super::terminal;
use hexroll::output::read;
use hexroll::plot::page::Page;
use hexroll::plot::{Mark, Panel, Series, figure};
use hexroll::record::{Column, Sample};
use hexroll::{Error, Result};

pub const HELP: &str = "\
A panel a column, a curve a run. The file's ending chooses what is written: .png, or .html for one page with sharp curves
that tell their values to a pointer. Columns are those of history.csv.

Examples:
  hexroll plot runs/a runs/b
  hexroll plot runs/a runs/b --column road_fx_N --column rim_my_Nm --out forces.png
  hexroll plot runs/* --column road_fz_N --over axle_z_m --from 0.05 --out stiffness.html";

#[derive(Debug, Args)]
pub struct PlotArgs {
    /// Folders of runs, finished or not
    #[arg(required = true)]
    dirs: Vec<PathBuf>,
    /// Column to plot; may be repeated
    #[arg(long = "column", value_name = "NAME", default_value = "road_fz_N")]
    columns: Vec<String>,
    /// Column of the abscissa
    #[arg(long, value_name = "NAME", default_value = "time_s")]
    over: String,
    /// Leave out windows that end before this time [s]
    #[arg(long, value_name = "SECONDS")]
    from: Option<f64>,
    /// Leave out windows that end after this time [s]
    #[arg(long, value_name = "SECONDS")]
    to: Option<f64>,
    /// File to write: .png or .html
    #[arg(long, value_name = "FILE", default_value = "plot.png")]
    out: PathBuf,
}

pub fn execute(args: &PlotArgs) -> Result<()> {
    let ending = args.out.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !["png", "html"].contains(&ending.as_str()) {
        return Err(mistake(
            "--out",
            format!("{:?} is neither .png nor .html", args.out.display()),
            "write plot.png, say",
        ));
    }
    let over = column(&args.over, "--over")?;
    let columns = args.columns.iter().map(|name| column(name, "--column")).collect::<Result<Vec<_>>>()?;
    let mut runs = Vec::new();
    for dir in &args.dirs {
        let history = read::history(dir)?;
        let (from, to) = (args.from.unwrap_or(f64::NEG_INFINITY), args.to.unwrap_or(f64::INFINITY));
        let rows = history.into_iter().filter(|s| (from..=to).contains(&s.time_s)).collect::<Vec<_>>();
        runs.push((name(dir, &args.dirs), rows));
    }
    let panels: Vec<Panel> = columns.iter().map(|column| panel(over, *column, &runs)).collect();
    let title = format!("{} over {}", args.columns.join(", "), args.over);
    match ending.as_str() {
        "png" => save_picture(&figure(&title, &panels, 2)?, &args.out)?,
        _ => {
            let mut page = Page::new(&title, None);
            page.plots(&panels, &[]);
            save_text(&page.html(), &args.out)?;
        }
    }
    terminal::print(&format!("{}\n", args.out.display()))
}

fn panel((x, abscissa): Column, (y, value): Column, runs: &[(String, Vec<Sample>)]) -> Panel {
    let series = |(label, rows): &(String, Vec<Sample>)| Series {
        label: label.clone(),
        points: rows.iter().map(|s| [abscissa(s), value(s)]).collect(),
        bars: Vec::new(),
        mark: Mark::Curve,
    };
    Panel {
        title: y.into(),
        x: x.into(),
        y: y.into(),
        series: runs.iter().map(series).collect(),
        log_x: false,
    }
}

/// A run's name in the legend: its folder's, or the whole path where two folders have the same name.
fn name(dir: &Path, all: &[PathBuf]) -> String {
    let short = |dir: &Path| dir.file_name().map(|n| n.to_string_lossy().into_owned());
    let alone = all.iter().filter(|other| short(other) == short(dir)).count() == 1;
    short(dir).filter(|_| alone).unwrap_or_else(|| dir.display().to_string())
}

fn column(name: &str, argument: &str) -> Result<Column> {
    let known = || Sample::COLUMNS.iter().map(|(name, _)| *name);
    Sample::COLUMNS.iter().find(|(n, _)| *n == name).copied().ok_or_else(|| {
        let problem = format!("history.csv has no column {name:?}");
        mistake(argument, problem, &format!("known: {}", known().collect::<Vec<_>>().join(", ")))
    })
}

fn mistake(argument: &str, problem: String, remedy: &str) -> Error {
    Error::Scene {
        file: "command line".into(),
        line: None,
        key: argument.into(),
        problem,
        remedy: remedy.into(),
    }
}
