//! A run's summary as a short table.

use std::fmt::Write;
use std::path::Path;

use super::format::{count, duration, si, updates};
use crate::output::Summary;
use crate::output::summary::{StageMeans, WorstBalance};

/// The table; `files` says what else is in the folder `out`.
pub fn text(summary: &Summary, out: &Path, files: &str) -> String {
    let mut text = format!("{}\n", summary.title);
    for (name, value) in lines(summary) {
        _ = writeln!(text, "  {name:<12} {value}");
    }
    text += &means(&summary.stages);
    _ = writeln!(text, "  {:<12} {}: history.csv, {files}, summary.json", "files", out.display());
    for warning in &summary.warnings {
        _ = writeln!(text, "  warning: {warning}");
    }
    text
}

fn lines(s: &Summary) -> Vec<(&'static str, String)> {
    let device = s.adapter.as_deref().map_or(format!("{} threads", s.threads), |a| format!("on {a}"));
    let balance = |b: &WorstBalance| {
        format!("{:.2e} J, {:.1e} of the largest term", b.worst_error_J, b.share_of_largest_term)
    };
    let mut lines = vec![
        ("engine", format!("{} {}, {device} ({})", s.engine, s.precision, s.engine_reason)),
        ("body", format!("{} elements, {} nodes", count(s.elements as u64), count(s.nodes as u64))),
        ("steps", format!("{} over {}", count(s.steps), si(s.time_s, "s"))),
        (
            "time step",
            format!(
                "{} to {} (critical at the start: {})",
                si(s.dt_min_s, "s"),
                si(s.dt_max_s, "s"),
                si(s.critical_dt_s, "s")
            ),
        ),
        ("wall time", format!("{}, {}", duration(s.wall_time_s), updates(s.element_updates_per_s))),
        ("balance", format!("by work done {}", balance(&s.balance))),
        ("", format!("by stored energy {}", balance(&s.stored_balance))),
    ];
    let depth = s.worst_penetration_m.map(|d| format!("at most {} at the ends of windows", si(d, "m")));
    lines.extend(depth.map(|d| ("penetration", d)));
    lines
}

/// Means of every stage, a line each.
fn means(stages: &[StageMeans]) -> String {
    let width = stages.iter().map(|s| s.stage.len()).max().unwrap_or(0).max("means of".len());
    let names = ["road fx", "fy", "fz [N]", "rim mx", "my", "mz [N m]", "axle z [mm]", "area [mm2]"];
    let mut text = format!("\n  {:<width$} {:>21}", "means of", "from .. to [s]");
    names.iter().for_each(|name| _ = write!(text, " {name:>11}"));
    text.push('\n');
    for s in stages {
        let span = format!("{:.4} .. {:.4}", s.means_from_s, s.end_s);
        _ = write!(text, "  {:<width$} {span:>21}", s.stage);
        let [fx, fy, fz] = [s.mean_road_fx_N, s.mean_road_fy_N, s.mean_road_fz_N];
        let [mx, my, mz] = [s.mean_rim_mx_Nm, s.mean_rim_my_Nm, s.mean_rim_mz_Nm];
        for value in [fx, fy, fz, mx, my, mz, 1e3 * s.mean_axle_z_m, 1e6 * s.mean_contact_area_m2] {
            _ = write!(text, " {:>11}", four_digits(value));
        }
        text.push('\n');
    }
    text + "\n"
}

/// Four digits or so, without an exponent where people expect none.
fn four_digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-3..1e6).contains(&size) => format!("{value:.2e}"),
        size => format!("{value:.*}", (3 - size.log10().floor() as i32).clamp(1, 5) as usize),
    }
}
