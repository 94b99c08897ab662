//! `accuracy.csv`, the Markdown tables, and the advice that follows.

use super::cases::{Problem, element_name};
use super::runs::Row;
use crate::report::claim::short;
use crate::report::page;

/// Every measurement, one a line.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "problem,machine,element,mesh,elements,safety,steps,wall_s,updates_per_s,value,error,discretisation_error,\
         time_step_error,rounding_error,area_error,displacement_error,stored_balance_error\n",
    );
    for r in rows {
        let s = &r.setting;
        text += &format!(
            "{},{},{},{},{},{},{},{:.4},{:.4e},{:.6e},{:.3e},{:.3e},{:.3e},{:.3e},{:.3e},{:.3e},{:.3e}\n",
            r.problem.name(),
            s.machine.name(),
            element_name(s.element),
            s.mesh,
            r.elements,
            s.safety,
            r.steps,
            r.wall,
            r.updates_per_s,
            r.value,
            r.error,
            r.discretisation,
            r.time_step,
            r.rounding,
            r.area,
            r.displacement,
            r.balance
        );
    }
    text
}

fn percent(v: f64) -> String {
    if v.is_nan() { "-".into() } else { format!("{} %", short(100.0 * v)) }
}

/// A table a problem.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = String::new();
    for problem in Problem::ALL {
        let of: Vec<&Row> = rows.iter().filter(|r| r.problem == problem).collect();
        if of.is_empty() {
            continue;
        }
        text += &format!("\n## {}: {}\n\n", problem.name(), problem.quantity());
        let cells = of.iter().map(|r| {
            vec![
                r.setting.machine.name().into(),
                element_name(r.setting.element).into(),
                format!("x{} ({})", r.setting.mesh, r.elements),
                r.setting.safety.to_string(),
                format!("{:.3} s", r.wall),
                format!("{:.1} M/s", 1e-6 * r.updates_per_s),
                percent(r.error),
                percent(r.discretisation),
                percent(r.time_step),
                percent(r.rounding),
                percent(r.area),
                percent(r.displacement),
                percent(r.balance),
            ]
        });
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
        text += &page::table(&head, cells);
    }
    text
}

/// For each problem the fastest setting within 10, 5, 2 and 1 %.
pub fn advice(rows: &[Row]) -> String {
    let mut cells = Vec::new();
    for problem in Problem::ALL {
        for limit in [0.1, 0.05, 0.02, 0.01] {
            let within = rows.iter().filter(|r| r.problem == problem && r.error <= limit);
            let Some(best) = within.min_by(|a, b| a.wall.total_cmp(&b.wall)) else { continue };
            let s = &best.setting;
            cells.push(vec![
                format!("{} within {} %", problem.quantity(), 100.0 * limit),
                problem.name().into(),
                format!(
                    "{}, {}, mesh x{}, safety {}",
                    s.machine.name(),
                    element_name(s.element),
                    s.mesh,
                    s.safety
                ),
                format!("{:.3} s", best.wall),
                percent(best.error),
            ]);
        }
    }
    page::table(&["for", "problem", "take", "wall", "its error"], cells)
}
