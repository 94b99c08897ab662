//! `hexroll completions` and `hexroll man`: what shells and `man` want to know, from the arguments themselves.

use std::path::{Path, PathBuf};

use clap::Args;
use clap_complete::Shell;
use clap_mangen::Man;

use super::study::save_text;
use super::terminal;
use hexroll::{Error, Result};

pub const COMPLETIONS: &str = "\
Examples:
  hexroll completions bash > ~/.local/share/bash-completion/completions/hexroll
  hexroll completions zsh > ~/.zfunc/_hexroll
  hexroll completions fish > ~/.config/fish/completions/hexroll.fish";

pub const MAN: &str = "\
Examples:
  hexroll man | man -l -
  hexroll man --out ~/.local/share/man/man1    # a page a command: man hexroll, man hexroll-run";

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// Whose
    shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArgs {
    /// Folder to write the pages of all commands to; default: that of hexroll itself, to the terminal
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn completions(args: &CompletionsArgs, mut command: clap::Command) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "hexroll", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))
}

pub fn man(args: &ManArgs, command: clap::Command) -> Result<()> {
    let Some(dir) = &args.out else { return terminal::print(&page(command)?) };
    let mut written = String::new();
    pages(command, dir, &mut written)?;
    terminal::print(&written)
}

/// The page of a command and those of its subcommands, one a file.
fn pages(mut command: clap::Command, dir: &Path, written: &mut String) -> Result<()> {
    command.build();
    let mut open = vec![command];
    while let Some(command) = open.pop() {
        let below = command.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help").cloned();
        open.extend(below);
        let name = command.get_display_name().unwrap_or(command.get_name()).to_string();
        let path = dir.join(format!("{name}.1"));
        save_text(&page(command)?, &path)?;
        *written += &format!("{}\n", path.display());
    }
    Ok(())
}

fn page(command: clap::Command) -> Result<String> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text).map_err(Error::io("man page", "write it"))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
