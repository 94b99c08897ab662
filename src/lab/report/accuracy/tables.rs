//! `accuracy.csv`, the Markdown tables, and the advice that follows.

use std::collections::HashMap;
use std::path::Path;

use super::cases::{ELEMENTS, Problem, Setting, element_name, machine_name, machine_named};
use super::reference::Reference;
use super::runs::{Measured, Row};
use super::timing::Window;
use crate::report::claim::short;
use crate::report::page;
use hexroll::{Error, Result};

const COLUMNS: [&str; 21] = [
    "problem",
    "machine",
    "element",
    "mesh",
    "elements",
    "safety",
    "steps",
    "eigenvalue_iterations",
    "wall_s",
    "updates_per_s",
    "value",
    "error",
    "discretisation_error",
    "time_step_error",
    "rounding_error",
    "area_error",
    "displacement_error",
    "stored_balance_error",
    "reference",
    "reference_within",
    "reference_from",
];

/// Lines before the table: where errors, by problem, and times were measured.
const ERRORS: &str = "# errors of ";
const TIMES: &str = "# times: ";

/// Every measurement, one a line, with what it was measured against.
pub fn csv(measured: &Measured) -> String {
    let mut text = String::new();
    for known in &measured.references {
        text += &format!("{ERRORS}{}: {}\n", known.problem.name(), known.from);
    }
    text += &format!("{TIMES}{}\n{}\n", measured.times_from, COLUMNS.join(","));
    for r in &measured.rows {
        let s = &r.setting;
        let reference = measured.references.iter().find(|known| known.problem == r.problem);
        let (value, within, how) = match reference {
            Some(known) => (known.value, known.within, known.how.replace(',', ";")),
            None => (f64::NAN, f64::NAN, String::new()),
        };
        let names = [r.problem.name(), machine_name(s.machine), element_name(s.element)].join(",");
        let counts = format!("{},{},{},{},{}", s.mesh, r.elements, s.safety, r.steps, r.eigenvalue);
        let numbers = [
            r.wall,
            r.updates_per_s,
            r.value,
            r.error,
            r.discretisation,
            r.time_step,
            r.rounding,
            r.area,
            r.displacement,
            r.balance,
            value,
            within,
        ];
        let numbers: Vec<String> = numbers.iter().map(|v| format!("{v:.6e}")).collect();
        text += &format!("{names},{counts},{},{how}\n", numbers.join(","));
    }
    text
}

/// Reads what [`csv`] wrote.
///
/// # Errors
/// [`Error::Scene`] naming file and line where it is not such a table.
pub fn parse(file: &Path, text: &str) -> Result<Measured> {
    let mut measured = Measured::default();
    let mut origins = HashMap::new();
    let mut lines = text.lines().enumerate().peekable();
    while let Some((_, line)) = lines.next_if(|(_, l)| l.starts_with('#')) {
        if let Some(from) = line.strip_prefix(TIMES) {
            measured.times_from = from.into();
        } else if let Some((problem, from)) = line.strip_prefix(ERRORS).and_then(|l| l.split_once(": ")) {
            origins.insert(problem.to_string(), from.to_string());
        }
    }
    match lines.next() {
        Some((_, line)) if line == COLUMNS.join(",") => {}
        other => {
            let number = other.map_or(1, |(number, _)| number + 1);
            return Err(mistake(file, number, "its columns are not those of accuracy.csv"));
        }
    }
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let (row, mut reference) = parse_row(&cells)
            .ok_or_else(|| mistake(file, number + 1, "a cell is missing, or is not what its column says"))?;
        if measured.references.iter().all(|known| known.problem != row.problem) {
            reference.from = origins.remove(row.problem.name()).unwrap_or_default();
            measured.references.push(reference);
        }
        measured.rows.push(row);
    }
    Ok(measured)
}

fn mistake(file: &Path, line: usize, problem: &str) -> Error {
    Error::Scene {
        file: file.display().to_string(),
        line: Some(line),
        key: "accuracy.csv".into(),
        problem: problem.into(),
        remedy: "measure anew: hexroll report accuracy".into(),
    }
}

fn parse_row(cells: &[&str]) -> Option<(Row, Reference)> {
    if cells.len() != COLUMNS.len() {
        return None;
    }
    let cell: HashMap<&str, &str> = COLUMNS.into_iter().zip(cells.iter().copied()).collect();
    let number = |name: &str| cell[name].parse::<f64>().ok();
    let problem = Problem::named(cell["problem"])?;
    let setting = Setting {
        machine: machine_named(cell["machine"])?,
        element: ELEMENTS.into_iter().find(|e| element_name(*e) == cell["element"])?,
        mesh: cell["mesh"].parse().ok()?,
        safety: number("safety")?,
    };
    let row = Row {
        problem,
        setting,
        elements: cell["elements"].parse().ok()?,
        steps: cell["steps"].parse().ok()?,
        eigenvalue: cell["eigenvalue_iterations"].parse().ok()?,
        wall: number("wall_s")?,
        updates_per_s: number("updates_per_s")?,
        value: number("value")?,
        error: number("error")?,
        discretisation: number("discretisation_error")?,
        time_step: number("time_step_error")?,
        rounding: number("rounding_error")?,
        area: number("area_error")?,
        displacement: number("displacement_error")?,
        balance: number("stored_balance_error")?,
    };
    let reference = Reference {
        problem,
        value: number("reference")?,
        within: number("reference_within")?,
        how: cell["reference_from"].replace(';', ","),
        from: String::new(),
        area: f64::NAN,
        field: Vec::new(),
    };
    Some((row, reference))
}

fn percent(v: f64) -> String {
    if v.is_nan() { "-".into() } else { format!("{} %", short(100.0 * v)) }
}

/// What errors are against.
pub fn references(measured: &Measured) -> String {
    let rows = measured.references.iter().map(|r| {
        let known = r.problem != Problem::Wave;
        vec![
            r.problem.name().into(),
            r.problem.quantity().into(),
            if known { format!("{} N", short(r.value)) } else { "-".into() },
            if known { percent(r.uncertainty()) } else { "-".into() },
            r.how.clone(),
        ]
    });
    page::table(&["problem", "error of the", "reference", "known within", "from"], rows)
}

/// A table a problem.
pub fn markdown(rows: &[Row]) -> String {
    let head = [
        "engine",
        "element",
        "mesh",
        "safety",
        "wall",
        "updates",
        "error",
        "discretisation",
        "time step",
        "rounding",
        "area",
        "displacement",
        "energy",
    ];
    let mut text = String::new();
    for problem in Problem::ALL {
        let of: Vec<&Row> = rows.iter().filter(|r| r.problem == problem).collect();
        if of.is_empty() {
            continue;
        }
        text += &format!("\n## {}: {}\n\n", problem.name(), problem.quantity());
        text += &page::table(&head, of.into_iter().map(cells));
    }
    text
}

fn cells(r: &Row) -> Vec<String> {
    let seconds = |v: f64| if v.is_nan() { "-".into() } else { format!("{} s", short(v)) };
    let rate = |v: f64| if v.is_nan() { "-".into() } else { format!("{:.1} M/s", 1e-6 * v) };
    vec![
        machine_name(r.setting.machine).into(),
        element_name(r.setting.element).into(),
        format!("x{} ({})", r.setting.mesh, r.elements),
        r.setting.safety.to_string(),
        seconds(r.wall),
        rate(r.updates_per_s),
        percent(r.error),
        percent(r.discretisation),
        percent(r.time_step),
        percent(r.rounding),
        percent(r.area),
        percent(r.displacement),
        percent(r.balance),
    ]
}

/// For each problem the fastest setting within 10, 5, 2 and 1 %: its error and what the reference is known to count. Steps and
/// engines that say nothing of the processor timed here (GPU rows of a software adapter) are left to the caller.
pub fn advice(measured: &Measured) -> String {
    let mut lines = Vec::new();
    for reference in &measured.references {
        let problem = reference.problem;
        for limit in [0.1, 0.05, 0.02, 0.01] {
            let fits = |r: &&Row| r.problem == problem && r.error + reference.uncertainty() <= limit;
            let within = measured.rows.iter().filter(fits);
            let best = within.min_by(|a, b| a.wall.total_cmp(&b.wall));
            let goal = format!("{} % in the {}", 100.0 * limit, problem.quantity());
            lines.push(match best {
                None => vec![goal, problem.name().into(), "none of these".into(), "-".into(), "-".into()],
                Some(best) => {
                    let s = &best.setting;
                    let (machine, element) = (machine_name(s.machine), element_name(s.element));
                    vec![
                        goal,
                        problem.name().into(),
                        format!("{machine}, {element}, mesh x{}, safety {}", s.mesh, s.safety),
                        format!("{} s", short(best.wall)),
                        format!(
                            "{} (reference within {})",
                            percent(best.error),
                            percent(reference.uncertainty())
                        ),
                    ]
                }
            });
        }
    }
    page::table(&["for", "problem", "take", "wall", "its error"], lines)
}

/// What output windows cost.
pub fn windows(windows: &[Window]) -> String {
    let rows = windows.iter().map(|w| {
        vec![
            format!("{} ms", 1e3 * w.sample),
            format!("{} s", short(w.wall)),
            format!("{} N", short(w.value)),
        ]
    });
    page::table(&["`output.sample`", "wall", "longitudinal force, 40 to 50 ms"], rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::kind::Kind;

    fn row(machine: Kind, mesh: usize, error: f64, wall: f64) -> Row {
        Row {
            problem: Problem::Slip5,
            setting: Setting { machine, element: ELEMENTS[1], mesh, safety: 0.45 },
            elements: 880,
            steps: 12,
            eigenvalue: 7,
            wall,
            updates_per_s: 1e6,
            value: -98.5,
            error,
            discretisation: 0.01,
            time_step: f64::NAN,
            rounding: 1e-5,
            area: -0.02,
            displacement: 0.03,
            balance: 1e-4,
        }
    }

    fn measured() -> Measured {
        let rows = vec![
            row(Kind::CpuF64, 1, 0.03, 1.0),
            row(Kind::CpuF32, 2, 0.004, 5.0),
            row(Kind::CpuF64, 2, 0.004, 9.0),
        ];
        let reference = Reference {
            problem: Problem::Slip5,
            value: -98.0,
            within: 0.49,
            how: "the finest, not monotone (x2, x3, x4)".into(),
            from: "`a: b`, commit 540bd3d".into(),
            area: f64::NAN,
            field: Vec::new(),
        };
        Measured { rows, references: vec![reference], times_from: "none".into() }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = csv(&measured());
        let read = parse(Path::new("accuracy.csv"), &text).unwrap();
        assert_eq!(csv(&read), text);
        assert_eq!(read.references[0].how, measured().references[0].how);
        assert_eq!(read.references[0].from, measured().references[0].from);
        let broken = text.replace("slip-5,cpu f32", "slip-5,cpu f16");
        let error = parse(Path::new("accuracy.csv"), &broken).unwrap_err().to_string();
        assert!(error.contains("accuracy.csv") && error.contains(":5:"), "{error}");
        assert!(parse(Path::new("accuracy.csv"), "a,b\n1,2\n").is_err());
    }

    #[test]
    fn advice_is_the_fastest_that_fits_with_the_references_own_error() {
        let text = advice(&measured());
        let line = |goal: &str| text.lines().find(|l| l.contains(goal)).unwrap_or_else(|| panic!("{text}"));
        assert!(line("| 5 %").contains("cpu f64, uniform-gradient, mesh x1"), "{text}");
        assert!(line("| 2 %").contains("cpu f32, uniform-gradient, mesh x2"), "{text}");
        // 0.4 % and the reference's 0.5 %: just.
        assert!(line("| 1 %").contains("cpu f32"), "{text}");
        let mut vague = measured();
        vague.references[0].within = 0.98;
        assert!(advice(&vague).contains("| 1 % in the side force | slip-5 | none of these"));
    }
}
