//! `[stage.implicit]`: how an implicit stage is solved.

use crate::error::Result;
use crate::scene::reader::{Bound, Table};
use crate::scene::units::TIME;
use crate::scene::{Implicit, ImplicitScheme, ImplicitSolver, Linear};

const COMMON: [&str; 4] = ["scheme", "tolerance", "iterations", "solver"];

/// Reads the section of a stage whose method is implicit.
pub(super) fn implicit(stage: &Table) -> Result<Implicit> {
    let header = "[stage.implicit] with scheme = \"static\" or \"dynamic\"";
    let table = stage.section("implicit", header)?.table()?;
    let names = [("static", true), ("dynamic", false)];
    let is_static = table.need("scheme", "\"static\"")?.choice(&names, &[])?;
    let names = [("active-set", true), ("relaxation", false)];
    let active_set = table.get("solver").map_or(Ok(true), |item| item.choice(&names, &[]))?;
    let of_scheme: &[&str] = if is_static { &["increments"] } else { &["step", "damping"] };
    let of_solver: &[&str] =
        if active_set { &["linear"] } else { &["omega", "relaxation_tolerance", "sweeps", "corrections"] };
    table.only(&[&COMMON, of_scheme, of_solver].concat(), &[])?;
    Ok(Implicit {
        scheme: if is_static { statics(stage, &table)? } else { dynamics(stage, &table)? },
        tolerance: table.number_or("tolerance", 1e-8, Bound::Positive)?,
        iterations: count_or(&table, "iterations", 25, "is needed to get anywhere")?,
        solver: if active_set { linear(&table)? } else { relaxation(&table)? },
    })
}

fn count_or(table: &Table, key: &str, default: usize, why: &str) -> Result<usize> {
    table.get(key).map_or(Ok(default), |item| item.count(1, why))
}

fn statics(stage: &Table, table: &Table) -> Result<ImplicitScheme> {
    for (key, why) in [
        ("mass_damping", "nothing moves in statics, so nothing is damped"),
        ("initial_velocity", "nothing moves in statics"),
    ] {
        if let Some(item) = stage.get(key) {
            return Err(item.error(why, "remove the key, or write scheme = \"dynamic\""));
        }
    }
    Ok(ImplicitScheme::Static { increments: count_or(table, "increments", 10, "is needed to arrive")? })
}

fn dynamics(stage: &Table, table: &Table) -> Result<ImplicitScheme> {
    let step = table.quantity("step", &TIME, Bound::Positive)?;
    let duration = stage.quantity("duration", &TIME, Bound::Positive)?;
    if step > duration {
        return Err(table.at("step").error(
            format!("{step} s is longer than the stage of {duration} s"),
            "write a shorter step or a longer duration",
        ));
    }
    Ok(ImplicitScheme::Dynamic { step, damping: table.number_or("damping", 0.0, Bound::NotNegative)? })
}

const LINEAR: [(&str, Linear); 4] = [
    ("auto", Linear::Auto),
    ("direct", Linear::Direct),
    ("multigrid", Linear::Multigrid),
    ("block-jacobi", Linear::BlockJacobi),
];

fn linear(table: &Table) -> Result<ImplicitSolver> {
    let linear = table.get("linear").map_or(Ok(Linear::Auto), |item| item.choice(&LINEAR, &[]))?;
    Ok(ImplicitSolver::ActiveSet(linear))
}

fn relaxation(table: &Table) -> Result<ImplicitSolver> {
    let omega = table.number_or("omega", 1.0, Bound::Positive)?;
    if omega >= 2.0 {
        return Err(table
            .at("omega")
            .error(format!("relaxation diverges at omega = {omega}"), "write a number between 0 and 2"));
    }
    let names: Vec<_> = LINEAR.map(|(name, l)| (name, Some(l))).into_iter().chain([("none", None)]).collect();
    Ok(ImplicitSolver::Relaxation {
        omega,
        tolerance: table.number_or("relaxation_tolerance", 1e-9, Bound::Positive)?,
        sweeps: count_or(table, "sweeps", 100_000, "is needed to relax anything")?,
        corrections: table.get("corrections").map_or(Ok(None), |item| item.choice(&names, &[]))?,
    })
}
