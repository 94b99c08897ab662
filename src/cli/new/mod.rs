//! `hexroll new`: a commented scene to begin with.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::terminal;
use hexroll::{Error, Result};

pub const HELP: &str = "\
The file says in its first lines how to run it, and each key says what it does.

Examples:
  hexroll new wheel
  hexroll new block scenes/my_block.toml";

#[derive(Debug, Args)]
pub struct NewArgs {
    /// What the scene is about
    #[arg(value_enum)]
    kind: Kind,
    /// File to write; default <kind>.toml. A file that is there is left alone
    file: Option<PathBuf>,
}

/// Scenes to begin with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// A rubber wheel that is pressed on a road and rolls
    Wheel,
    /// A rubber block that is pressed on a road and pulled along it
    Block,
    /// A wheel at a slip angle, for `hexroll sweep`
    Sweep,
}

pub fn execute(args: &NewArgs) -> Result<()> {
    let (name, text) = match args.kind {
        Kind::Wheel => ("wheel", include_str!("wheel.toml")),
        Kind::Block => ("block", include_str!("block.toml")),
        Kind::Sweep => ("sweep", include_str!("sweep.toml")),
    };
    let usual = format!("{name}.toml");
    let path = args.file.clone().unwrap_or_else(|| usual.clone().into());
    let shown = path.display().to_string();
    // The commands in its first lines name the file and the folder of its run.
    let stem = path.file_stem().unwrap_or("scene".as_ref()).to_string_lossy();
    let text = text.replace(&usual, &shown).replace(&format!("runs/{name}"), &format!("runs/{stem}"));
    let text = text.replace(&format!("runs/{stem}/{name}"), &format!("runs/sweep/{stem}"));
    let write = || std::fs::File::create_new(&path)?.write_all(text.as_bytes());
    write().map_err(Error::io(&path, "write this file (one that is there is left alone)"))?;
    let next = match args.kind {
        Kind::Sweep => format!("hexroll sweep {shown} --over slip-angle=-8:8:5"),
        _ => format!("hexroll run {shown}"),
    };
    terminal::print(&format!("{shown}\nnext: {next}\n"))
}
