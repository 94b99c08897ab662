//! Pages that one can send: on a run, a study, a sweep, from what their folders hold.

mod batch;
mod histories;
mod run;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::format::bytes;
use super::study::save_text;
use super::terminal;
use hexroll::output::folder::REPORT;
use hexroll::plot::page::Page;
use hexroll::{Error, Result};

#[derive(Debug, Args)]
pub struct RunPageArgs {
    /// Folder of the run, finished or not
    dir: PathBuf,
    /// File to write; default <DIR>/report.html
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Which of the folder's pictures the page has: those of the last snapshot, all, or none
    #[arg(long, value_enum, default_value_t = Pictures::Last)]
    pictures: Pictures,
}

/// Pictures of a run that its page has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Pictures {
    Last,
    All,
    None,
}

#[derive(Debug, Args)]
pub struct BatchPageArgs {
    /// The --out folder of the study or sweep, finished or not
    dir: PathBuf,
    /// File to write; default <DIR>/report.html
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub fn run(args: &RunPageArgs) -> Result<()> {
    write(&run::page(&args.dir, args.pictures)?, args.out.as_deref(), &args.dir)
}

pub fn study(args: &BatchPageArgs) -> Result<()> {
    write(&batch::study(&args.dir)?, args.out.as_deref(), &args.dir)
}

pub fn sweep(args: &BatchPageArgs) -> Result<()> {
    write(&batch::sweep(&args.dir)?, args.out.as_deref(), &args.dir)
}

fn write(page: &Page, out: Option<&Path>, dir: &Path) -> Result<()> {
    let path = out.map_or_else(|| dir.join(REPORT), Path::to_path_buf);
    let html = page.html();
    save_text(&html, &path)?;
    terminal::print(&format!("{} ({})\n", path.display(), bytes(html.len() as u64)))
}

/// An error that says that a folder holds no run.
fn no_run(dir: &Path) -> Error {
    let problem = match dir.exists() {
        true => {
            "this folder holds no run; `hexroll run` writes one, and studies and sweeps have pages of their own"
        }
        false => "there is no such folder",
    };
    Error::Format { path: dir.into(), problem: problem.into() }
}
