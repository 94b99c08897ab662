//! The record as a page: machine, limits, rows, reasons.

use std::fmt::Write;

use super::critical::CriticalReport;
use super::gpu_limits::GpuLimits;
use super::report::{Missing, Report, Row};
use super::straight::StraightRun;

/// The whole page.
pub fn page(report: &Report) -> String {
    let mut page = heading(report);
    if !report.rows.is_empty() {
        page += &rows(&report.rows);
        page += &limits(report);
    }
    if !report.missing.is_empty() {
        page += &missing(&report.missing);
    }
    if let Some(critical) = &report.critical {
        page += &steps(critical);
    }
    if !report.straight.is_empty() {
        page += &straight(&report.straight);
    }
    page
}

fn heading(report: &Report) -> String {
    let m = &report.machine;
    let mut text = format!("# hexroll bench, {}\n\n    {}\n\n", m.date, m.command);
    let gib = m.memory_bytes as f64 / f64::from(1 << 30);
    _ = writeln!(text, "{}, {} cores, {gib:.0} GiB, {}.", m.processor, m.cores, m.system);
    if let (Some(adapter), Some(driver)) = (&m.adapter, &m.driver) {
        _ = writeln!(text, "Adapter: {adapter}, driver {driver}.");
    }
    _ = writeln!(text, "hexroll {}, commit {}, {} build.", m.hexroll, m.commit, m.profile);
    match m.load {
        Some(load) if load > 0.2 => {
            _ = writeln!(
                text,
                "Load average at the start: {load:.2}; above 0.2 other work may have shared the machine."
            );
        }
        _ => {}
    }
    text + "\n"
}

/// One line of a table.
fn line(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

fn header(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(ToString::to_string).collect();
    line(&names) + &line(&vec!["---".to_string(); names.len()])
}

/// Three or four digits without an exponent where people expect none.
fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if v >= 1000.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.1 => format!("{value:.2}"),
        _ => format!("{value:.2e}"),
    }
}

/// Name of a row's engine with what it ran on.
pub fn engine(row: &Row) -> String {
    let mut name = row.engine.name().to_string();
    if row.threads > 0 {
        _ = write!(name, " {} x{}", row.lanes, row.threads);
    }
    if row.copies > 1 {
        _ = write!(name, ", {} copies", row.copies);
    }
    if row.mesh != "structured" {
        _ = write!(name, ", {}", row.mesh);
    }
    name
}

fn rows(rows: &[Row]) -> String {
    let mut text = header(&[
        "engine",
        "element",
        "elements",
        "contact",
        "eta [Pa s]",
        "us/step min",
        "median",
        "max",
        "updates/s",
        "B/update",
        "flop/update",
        "floor us",
        "fraction",
        "bound by",
        "B/element",
        "error",
    ]);
    for r in rows {
        text += &line(&[
            engine(r),
            r.element.clone(),
            r.elements.to_string(),
            if r.contact { "on" } else { "off" }.into(),
            short(r.viscosity),
            short(r.us_per_step.min),
            short(r.us_per_step.median),
            short(r.us_per_step.max),
            format!("{:.3e}", r.updates_per_s),
            format!("{:.0}", r.bytes_per_update),
            format!("{:.0}", r.flops_per_update),
            short(r.floor_us),
            format!("{:.2}", r.fraction),
            r.bound_by.name().into(),
            r.memory_per_element.map_or(String::new(), |m| format!("{m:.0}")),
            error(r),
        ]);
    }
    text += &times_by_pass(rows);
    let slow: Vec<&Row> = rows.iter().filter(|r| r.reason.is_some()).collect();
    if !slow.is_empty() {
        text += "\nFraction below one half:\n\n";
        for r in slow {
            let why = r.reason.as_deref().unwrap_or_default();
            _ = writeln!(text, "- {} {} {}: {why}", engine(r), r.element, r.elements);
        }
    }
    text + "\n"
}

fn error(row: &Row) -> String {
    let value = row.error.map_or("not finite".into(), |e| format!("{e:.1e}"));
    if row.failed() { format!("**{value}, failed**") } else { value }
}

fn times_by_pass(rows: &[Row]) -> String {
    let mut text = String::new();
    for r in rows.iter().filter(|r| !r.pass_us.is_empty()) {
        let each: Vec<String> =
            r.passes.iter().zip(&r.pass_us).map(|(p, us)| format!("{} {} us", p.name, short(*us))).collect();
        let submit = r.steps_per_submit.map_or(String::new(), |n| format!(", {n} steps a submission"));
        _ = writeln!(text, "- {} {} {}: {}{submit}", engine(r), r.element, r.elements, each.join(", "));
    }
    if text.is_empty() { text } else { format!("\nTime by pass:\n\n{text}") }
}

fn limits(report: &Report) -> String {
    let mut text = String::from("Limits, measured in the same run:\n\n");
    text += &header(&[
        "engine",
        "lanes",
        "threads",
        "copy, one core's cache [GB/s]",
        "copy, last cache",
        "copy, memory",
        "multiply-add [Gflop/s]",
        "meeting [us]",
    ]);
    for l in &report.limits.cpu {
        let mut cells = vec![format!("cpu-{}", l.precision), l.lanes.clone(), l.threads.to_string()];
        cells.extend(l.copy.iter().map(|c| short(1e-9 * c.bytes_per_s)));
        cells.extend([short(1e-9 * l.flops_per_s), short(1e6 * l.barrier_s)]);
        text += &line(&cells);
    }
    text += &report.limits.gpu.as_ref().map_or(String::new(), gpu_limits);
    text + "\n"
}

fn gpu_limits(l: &GpuLimits) -> String {
    let copies: Vec<String> = l
        .copy
        .iter()
        .map(|c| format!("{} GB/s ({} MiB)", short(1e-9 * c.bytes_per_s), c.bytes >> 20))
        .collect();
    let double = match l.flops_double_per_s {
        Some(rate) => format!("{} in double precision", short(1e-9 * rate)),
        None => "no double precision".into(),
    };
    format!(
        "\nAdapter: copy {}; multiply-add {} Gflop/s ({double}); empty dispatch {} us, empty submission {} us.\n",
        copies.join(", "),
        short(1e-9 * l.flops_per_s),
        short(1e6 * l.dispatch_s),
        short(1e6 * l.submit_s)
    )
}

fn missing(rows: &[Missing]) -> String {
    let mut text = String::from("Not in the table:\n\n");
    for m in rows {
        let what = if m.failed { "failed" } else { "skipped" };
        _ = writeln!(text, "- {} {} {} {what}: {}", m.engine.name(), m.element, m.elements, m.reason);
    }
    text + "\n"
}

/// In one piece: tables, column by column.
fn steps(report: &CriticalReport) -> String {
    let mut text = String::from("Critical step [us], paper's wheel, rim held:\n\n");
    text += &header(&[
        "element",
        "elements",
        "eta [Pa s]",
        "state",
        "h/c",
        "worst element",
        "assembled",
        "over h/c",
        "over worst element",
        "iterations",
    ]);
    for s in &report.steps {
        text += &line(&[
            s.element.clone(),
            s.elements.to_string(),
            short(s.viscosity),
            s.state.clone(),
            format!("{:.2}", 1e6 * s.edge_over_speed),
            format!("{:.2}", 1e6 * s.element_bound),
            format!("{:.2}", 1e6 * s.assembled),
            format!("{:+.1} %", 100.0 * (s.assembled / s.edge_over_speed - 1.0)),
            format!("{:+.1} %", 100.0 * (s.assembled / s.element_bound - 1.0)),
            s.iterations.to_string(),
        ]);
    }
    if report.runs.is_empty() {
        return text + "\n";
    }
    text += "\n0.1 s of rolling (straight run, mu = 1) at several safety factors:\n\n";
    text += &header(&[
        "element",
        "eta [Pa s]",
        "safety",
        "dt [us]",
        "steps",
        "balance by work",
        "by stored energy, first half",
        "second half",
        "road fx [N]",
        "fz [N]",
        "end",
    ]);
    for r in &report.runs {
        text += &line(&[
            r.element.clone(),
            short(r.viscosity),
            r.safety.to_string(),
            format!("{:.2}", 1e6 * r.dt),
            r.steps.to_string(),
            format!("{:.1e}", r.work_error),
            format!("{:.1e}", r.stored_error[0]),
            format!("{:.1e}", r.stored_error[1]),
            short(r.road[0]),
            short(r.road[1]),
            r.failure.clone().unwrap_or("reached".into()),
        ]);
    }
    text + "\n"
}

fn straight(runs: &[StraightRun]) -> String {
    let mut text =
        String::from("The paper's straight run, 0.1 s of rolling (880 elements, mu = 1), best of three:\n\n");
    text += &header(&[
        "engine",
        "threads",
        "element",
        "eta [Pa s]",
        "rolling [s]",
        "with pressing [s]",
        "steps of rolling",
        "road fx [N]",
        "fz [N]",
    ]);
    for r in runs {
        text += &line(&[
            r.engine.name().into(),
            r.threads.to_string(),
            r.element.clone(),
            short(r.viscosity),
            format!("{:.3}", r.roll_s),
            format!("{:.3}", r.whole_s),
            r.steps.to_string(),
            short(r.road_fx_N),
            short(r.road_fz_N),
        ]);
    }
    text + "\n"
}
