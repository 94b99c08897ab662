//! `[body.mesh]` with a `file`.

use std::path::Path;

use crate::error::Result;
use crate::scene::reader::{Bound, Item, Table, one_of};
use crate::scene::units::{ANGLE, LENGTH};
use crate::scene::{Axis, Gaps, LengthUnit, MeshFile, Revolve};

const KEYS: [&str; 8] = ["file", "unit", "axis", "axle", "merge", "gaps", "revolve", "drop"];

/// `file`: the item of that key.
pub(super) fn read(table: &Table, file: &Item) -> Result<MeshFile> {
    if let Some(generator) = table.get("generator") {
        return Err(generator.error("given besides file", "write either a generator or a file"));
    }
    table.only(&KEYS, &[])?;
    let name = file.text()?;
    if name.is_empty() {
        return Err(file.error("an empty name", "write the file of a mesh, e.g. \"wheel.inp\""));
    }
    Ok(MeshFile {
        path: Path::new(file.file).parent().unwrap_or(Path::new("")).join(name),
        unit: unit(table)?,
        axis: table.get("axis").map_or(Ok(Axis::Y), |item| {
            item.choice(&[("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)], &[])
        })?,
        axle: table.get("axle").map(|item| item.vector(&LENGTH, Bound::Any)).transpose()?,
        merge: table.get("merge").map(|item| item.quantity(&LENGTH, Bound::Positive)).transpose()?,
        gaps: table.get("gaps").map_or(Ok(Gaps::Refuse), |item| {
            item.choice(&[("refuse", Gaps::Refuse), ("keep", Gaps::Keep)], &[])
        })?,
        revolve: table.get("revolve").map(|item| revolve(&item, table)).transpose()?,
        drop: table.get("drop").map_or(Ok(Vec::new()), |item| {
            item.entries()?.iter().map(|entry| entry.text().map(Into::into)).collect()
        })?,
    })
}

fn revolve(item: &Item, mesh: &Table) -> Result<Revolve> {
    for key in ["axis", "axle"] {
        if let Some(other) = mesh.get(key) {
            return Err(other.error("given besides revolve, which turns about y at x = 0", "remove the key"));
        }
    }
    let table = item.table()?;
    table.only(&["sectors", "grading", "fine_arc"], &[])?;
    let sectors = table.need("sectors", "96")?.count(3, "are needed to close a ring")?;
    let grading = table.number_or("grading", 1.0, Bound::Positive)?;
    let fine_arc = table.quantity_or("fine_arc", 0.0, &ANGLE, Bound::NotNegative)?;
    if !(1e-4..=1e4).contains(&grading) {
        return Err(table
            .at("grading")
            .error("element sizes that differ too much", "write a ratio between 1e-4 and 1e4"));
    }
    match table.get("fine_arc") {
        Some(item) if fine_arc >= std::f64::consts::TAU => {
            Err(item.error("a whole turn of equal elements", "remove the key, or write less than 360 deg"))
        }
        Some(item) if grading == 1.0 => {
            Err(item.error("all elements round the wheel are equal", "remove the key, or write grading = 4"))
        }
        _ => Ok(Revolve { sectors, grading, fine_arc }),
    }
}

/// The unit of a file's coordinates has no default: a wheel of 39 m rolls too, and nobody sees that it is wrong.
fn unit(table: &Table) -> Result<LengthUnit> {
    let problem = "missing: files of meshes have no units";
    let units = LENGTH.names();
    let Some(item) = table.get("unit") else {
        let remedy =
            format!("add unit = \"mm\", or what the file's coordinates are in: {}", units.join(", "));
        return Err(table.at("unit").error(problem, remedy));
    };
    let name = item.text()?;
    match LENGTH.unit(name) {
        Some(metres) => Ok(LengthUnit { name: name.into(), metres }),
        None => Err(item.error(format!("{name:?} is not a unit of a length"), one_of(name, &units))),
    }
}
