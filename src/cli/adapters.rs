//! `hexroll adapters`.

use std::fmt::Write;

use clap::Args;
use serde::Serialize;

use super::choose::{LARGE, usable};
use super::format::bytes;
use super::terminal;
use hexroll::Result;
use hexroll::gpu::{AdapterReport, adapters};

#[derive(Debug, Args)]
pub struct AdaptersArgs {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    adapters: Vec<AdapterReport>,
    /// What `--engine auto` does with them, in words.
    auto: String,
}

pub fn execute(args: &AdaptersArgs) -> Result<()> {
    let adapters = adapters();
    let auto = auto(&adapters);
    let report = Report { adapters, auto };
    if args.json { terminal::print_json(&report) } else { terminal::print(&text(&report)) }
}

fn auto(adapters: &[AdapterReport]) -> String {
    match usable(adapters, None) {
        Some(a) if !a.software => format!(
            "the faster of the CPU engine and {} ({}), tried on the scene; the CPU engine at once if that run is \
             short, the GPU at once from {} elements on",
            a.name, a.backend, LARGE
        ),
        Some(a) => format!(
            "the faster of the CPU engine and the software adapter {}, tried on the scene; the CPU engine at once \
             if that run is short",
            a.name
        ),
        None => "the CPU engine: no adapter can be used".into(),
    }
}

fn text(report: &Report) -> String {
    let mut text = String::new();
    if report.adapters.is_empty() {
        text += "wgpu sees no adapter; a Vulkan driver is needed for the GPU engine and for pictures\n\
                 (Debian: mesa-vulkan-drivers)\n";
    }
    for a in &report.adapters {
        let kind = if a.software { ", software" } else { "" };
        let mut line = |name: &str, value: String| _ = writeln!(text, "  {name:<18} {value}");
        line("adapter", format!("{} ({}{kind})", a.name, a.backend));
        line("driver", a.driver.clone());
        line("buffers", format!("{}, {} a storage binding", bytes(a.buffer), bytes(a.storage_binding)));
        line("storage buffers", format!("{} a stage", a.storage_buffers));
        line("work groups", format!("{} a dimension", a.workgroups));
        line("shared memory", bytes(a.shared_memory.into()));
        line("double precision", if a.doubles { "yes" } else { "no" }.into());
        line("timestamps", if a.timestamps { "yes" } else { "no" }.into());
        line("usable", a.unusable.as_ref().map_or("yes".into(), |why| format!("no: {why}")));
        text += "\n";
    }
    _ = writeln!(text, "--engine auto takes {}", report.auto);
    text
}
