//! `hexroll compare`.

use std::path::PathBuf;

use clap::Args;

use super::terminal;
use hexroll::Result;
use hexroll::output::compare::compare;

pub const HELP: &str = "\
Rows and snapshots are matched by stage and by time since the start of that stage; A is the reference.
A difference is no failure: the exit code is 0.

Examples:
  hexroll compare runs/lat100_straight runs/finer_step
  hexroll compare --json runs/cpu runs/gpu > difference.json";

#[derive(Debug, Args)]
pub struct CompareArgs {
    /// Folder of the run that is the reference
    a: PathBuf,
    /// Folder of the run compared with it
    b: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn execute(args: &CompareArgs) -> Result<()> {
    let comparison = compare(&args.a, &args.b)?;
    if args.json { terminal::print_json(&comparison) } else { terminal::print(&comparison.to_string()) }
}
