//! A run's summary as a short table.

use std::fmt::Write;
use std::path::Path;

use super::format::{count, duration, si, updates};
use hexroll::output::summary::{Errors, StageMeans, WorstBalance};
use hexroll::output::{ContactScatter, Rolling, Summary, Verdict};

/// The table; `files` says what else is in the folder `out`.
pub fn text(summary: &Summary, out: &Path, files: &str) -> String {
    let mut text = format!("{}\n", summary.title);
    for (name, value) in lines(summary) {
        _ = writeln!(text, "  {name:<12} {value}");
    }
    text += &means(&summary.stages);
    summary.stages.iter().for_each(|s| text += &rolling(s));
    _ = writeln!(text, "  {:<12} {}: history.csv, {files}, summary.json", "files", out.display());
    for warning in &summary.warnings {
        _ = writeln!(text, "  warning: {warning}");
    }
    text
}

pub fn lines(s: &Summary) -> Vec<(&'static str, String)> {
    let device = s.adapter.as_deref().map_or(format!("{} threads", s.threads), |a| format!("on {a}"));
    let balance = |b: &WorstBalance| match b.share_of_largest_term {
        // A share of what is round-off too says nothing.
        share if share > 1e-3 && b.worst_error_J <= s.round_off_J => {
            format!("{:.2e} J, which is round-off", b.worst_error_J)
        }
        share => format!("{:.2e} J, {share:.1e} of the largest term", b.worst_error_J),
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
        ("errors", errors(&s.errors)),
        ("balance", format!("by work done {}", balance(&s.balance))),
        ("", format!("by stored energy {}", balance(&s.stored_balance))),
    ];
    let depth = s.worst_penetration_m.map(|d| format!("at most {} at the ends of windows", si(d, "m")));
    lines.extend(depth.map(|d| ("penetration", d)));
    lines
}

/// Classes of error, of a power of ten each.
fn errors(e: &Errors) -> String {
    let class = |name: &str, v: Option<f64>| {
        let power = v.filter(|v| *v > 0.0)?.log10().ceil();
        Some(format!("{name} 1e{power:.0}"))
    };
    let kinds =
        [class("time step", e.time_step), class("rounding", e.rounding), class("residual", e.residual)];
    let named: Vec<String> = kinds.into_iter().flatten().collect();
    match named.is_empty() {
        true => "not estimated".into(),
        false => format!("of forces, estimated, at most about: {}", named.join(", ")),
    }
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

/// What a tyre engineer reads first, and whether the contact force is smooth.
fn rolling(stage: &StageMeans) -> String {
    let mut lines = stage.rolling.as_ref().map(figures).unwrap_or_default();
    lines.extend(stage.contact.as_ref().map(|c| ("contact force", scatter(c))));
    let mut text = String::new();
    if !lines.is_empty() {
        _ = writeln!(text, "  {}", stage.stage);
    }
    for (name, value) in lines {
        _ = writeln!(text, "    {name:<20} {value}");
    }
    text
}

pub fn figures(r: &Rolling) -> Vec<(&'static str, String)> {
    let newtons = |f: f64| format!("{} N", four_digits(f));
    let mm = |l: f64| format!("{} mm", four_digits(1e3 * l));
    let trail = r.pneumatic_trail_m.map_or(String::new(), |t| format!(", pneumatic trail {}", mm(t)));
    let slip =
        r.longitudinal_slip.map_or(String::new(), |k| format!(", longitudinal slip {:.2} %", 100.0 * k));
    let free = r.free_rolling_radius_m.map_or("", |_| " (rolls freely)");
    vec![
        (
            "motion",
            format!(
                "{} m/s, {} rad/s, slip angle {:.2} deg{slip}",
                four_digits(r.speed_m_s),
                four_digits(r.spin_rad_s),
                r.slip_angle_deg
            ),
        ),
        ("longitudinal force", newtons(r.longitudinal_force_N)),
        (
            "side force",
            format!(
                "{}, aligning moment {} N m{trail}",
                newtons(r.side_force_N),
                four_digits(r.aligning_moment_Nm)
            ),
        ),
        (
            "rolling resistance",
            format!(
                "{}: friction {}, viscosity {}, other {}",
                newtons(r.rolling_resistance_N),
                newtons(r.friction_loss_N),
                newtons(r.viscous_loss_N),
                newtons(r.other_loss_N)
            ),
        ),
        ("radii", format!("loaded {}, effective {}{free}", mm(r.loaded_radius_m), mm(r.effective_radius_m))),
        (
            "footprint",
            format!(
                "{} x {}, {} mm2, pressure {} mean, {} peak",
                mm(r.footprint_length_m),
                mm(r.footprint_width_m),
                four_digits(1e6 * r.footprint_area_m2),
                si(r.mean_pressure_Pa, "Pa"),
                si(r.peak_pressure_Pa, "Pa")
            ),
        ),
    ]
}

pub fn scatter(c: &ContactScatter) -> String {
    let verdict = match c.verdict {
        Verdict::Smooth => "smooth",
        Verdict::Tone => "hums with the mesh",
        Verdict::Chattering => "CHATTERING",
        Verdict::Rounding => "ROUNDING",
    };
    let tone = c
        .tone_Hz
        .map_or(String::new(), |f| format!("tone of the mesh at {f:.0} Hz {:.2} %, ", 100.0 * c.tone_share));
    format!(
        "{verdict}: {tone}rest {:.2} % of the normal force; {:.2} % of the touching nodes change state in a step",
        100.0 * c.remaining_share,
        100.0 * c.changing_share
    )
}

/// Four digits or so, without an exponent where people expect none.
pub fn four_digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-3..1e6).contains(&size) => format!("{value:.2e}"),
        size => format!("{value:.*}", (3 - size.log10().floor() as i32).clamp(1, 5) as usize),
    }
}
