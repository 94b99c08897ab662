//! `[[stage]]`: method, duration and rim motion.

use crate::error::Result;
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{RATE, TIME};
use crate::scene::{InitialVelocity, Method, Road, SetMotion, Stage};

use super::implicit;
use super::rim_motion::{Limits, rim_motion};

const KEYS: [&str; 8] =
    ["name", "method", "duration", "mass_damping", "initial_velocity", "settle", "implicit", "rim"];

const LATER: [Later; 2] = [
    ("friction", "friction is the same in every stage: set it in [friction]"),
    ("checkpoint", "run the scene in one piece"),
];

/// Every stage in order; where the rim has been displaced to is followed across them. `start`: a point of the body [m].
pub(super) fn stages(item: &Item, has_rim: bool, road: Option<&Road>, start: [f64; 3]) -> Result<Vec<Stage>> {
    let entries = item.entries()?;
    if entries.is_empty() {
        return Err(item.error("no stage", "add a section [[stage]]"));
    }
    let mut place = [Some(0.0); 6];
    let mut stages: Vec<Stage> = Vec::new();
    for (i, entry) in entries.iter().enumerate() {
        let stage = stage(entry, i, has_rim, &mut place)?;
        check_slip(entry, &stage, &stages, road, start, place[STEER])?;
        stages.push(stage);
    }
    Ok(stages)
}

/// A stage that waits for rest needs motions that come to rest.
pub(super) fn check_motions(item: &Item, stages: &[Stage], motions: &[SetMotion]) -> Result<()> {
    let moves_on = motions.iter().any(|motion| motion.end() == f64::INFINITY);
    for (stage, entry) in stages.iter().zip(item.entries()?) {
        if moves_on && stage.is_quasi_static() {
            let problem = "a [[motion]] that never comes to rest keeps this stage from settling";
            return Err(entry.error(problem, "write method = \"explicit\", or a motion that ends"));
        }
    }
    Ok(())
}

/// Index of the steer angle among the rim's components.
const STEER: usize = 3;

/// A slip needs a speed over the road, and a radius from somewhere.
fn check_slip(
    item: &Item,
    stage: &Stage,
    before: &[Stage],
    road: Option<&Road>,
    start: [f64; 3],
    steer: Option<f64>,
) -> Result<()> {
    let Some(slip) = stage.slip else { return Ok(()) };
    let table = item.table()?.at("rim").table()?.at("spin").table()?;
    if stage.heading_speed(road, start, steer.unwrap_or(0.0)) == 0.0 {
        let remedy = "write x = { velocity = .. }, or a road that moves, or spin = { velocity = .. }";
        return Err(table.at("slip").error("the rim does not move along its heading over a road", remedy));
    }
    if slip.free_radius.is_none() && !before.iter().any(Stage::rolls_freely) {
        return Err(table.at("free_radius").error(
            "no stage before this one spins freely",
            "write the free-rolling radius, or put a stage with spin = { moment = \"0 N m\", inertia = .. } before",
        ));
    }
    Ok(())
}

fn stage(item: &Item, index: usize, has_rim: bool, place: &mut [Option<f64>; 6]) -> Result<Stage> {
    let table = item.table()?;
    table.only(&KEYS, &LATER)?;
    let name = table.get("name").map_or(Ok(format!("stage {}", index + 1)), |n| n.text().map(Into::into))?;
    let duration = table.quantity("duration", &TIME, Bound::Positive)?;
    let (method, mass_damping) = method(&table)?;
    let limits = Limits { quasi_static: matches!(method, Method::QuasiStatic { .. }), duration };
    let (rim, slip) = rim_motion(&table, has_rim, limits, place)?;
    Ok(Stage {
        name,
        method,
        duration,
        mass_damping,
        initial_velocity: initial_velocity(&table, has_rim)?,
        rim,
        slip,
    })
}

/// Names of the methods.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Name {
    Explicit,
    QuasiStatic,
    Implicit,
}

/// Method with its criteria, and the mass damping.
fn method(stage: &Table) -> Result<(Method, f64)> {
    let names =
        [("explicit", Name::Explicit), ("quasi-static", Name::QuasiStatic), ("implicit", Name::Implicit)];
    let name = stage.need("method", "\"explicit\"")?.choice(&names, &[])?;
    let alpha = stage.quantity_or("mass_damping", 0.0, &RATE, Bound::NotNegative)?;
    let (settle, implicit) = (stage.get("settle"), stage.get("implicit"));
    if let Some(item) = settle.as_ref().filter(|_| name != Name::QuasiStatic) {
        let what = if name == Name::Explicit { "an explicit" } else { "an implicit" };
        return Err(item.error(
            format!("{what} stage lasts its whole duration"),
            "remove the key, or write method = \"quasi-static\"",
        ));
    }
    if let Some(item) = implicit.as_ref().filter(|_| name != Name::Implicit) {
        return Err(
            item.error("this stage is not implicit", "remove the key, or write method = \"implicit\"")
        );
    }
    match name {
        Name::Explicit => Ok((Method::Explicit, alpha)),
        Name::Implicit => Ok((Method::Implicit(implicit::implicit(stage)?), alpha)),
        Name::QuasiStatic => quasi_static(stage, settle, alpha),
    }
}

fn quasi_static(stage: &Table, settle: Option<Item>, alpha: f64) -> Result<(Method, f64)> {
    if alpha == 0.0 {
        // About twice the lowest angular frequency settles fastest.
        let example = "\"3000 1/s\"";
        let item = stage.need("mass_damping", example)?;
        return Err(item.error("without damping nothing settles", format!("write a rate such as {example}")));
    }
    let (mut kinetic_ratio, mut residual) = (1e-8, 1e-4);
    if let Some(table) = settle.map(|item| item.table()).transpose()? {
        table.only(&["kinetic_ratio", "residual"], &[])?;
        kinetic_ratio = table.number_or("kinetic_ratio", kinetic_ratio, Bound::Positive)?;
        residual = table.number_or("residual", residual, Bound::Positive)?;
    }
    Ok((Method::QuasiStatic { kinetic_ratio, residual }, alpha))
}

fn initial_velocity(stage: &Table, has_rim: bool) -> Result<Option<InitialVelocity>> {
    let Some(item) = stage.get("initial_velocity") else { return Ok(None) };
    let names = [("rim", InitialVelocity::Rim), ("zero", InitialVelocity::Zero)];
    let velocity = item.choice(&names, &[])?;
    if velocity == InitialVelocity::Rim && !has_rim {
        return Err(item.error("the scene has no rim", "add a section [rim], or write \"zero\""));
    }
    Ok(Some(velocity))
}
