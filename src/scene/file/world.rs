//! `[rim]`, `[[hold]]`, `[road]`, `[friction]`.

use crate::error::Result;
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{LENGTH, PRESSURE, SLOWNESS, VELOCITY};
use crate::scene::{Friction, Hold, MeshSpec, NodeSet, Rim, Road};

/// A road may move in its plane only, up to this share of its speed (round-off of a tilted normal).
const IN_PLANE: f64 = 1e-9;

const PLANE_INSTEAD: &str = "use shape = \"plane\"";

const LATER_ROADS: [Later; 6] = [
    ("disk", PLANE_INSTEAD),
    ("drum", PLANE_INSTEAD),
    ("cylinder", PLANE_INSTEAD),
    ("sphere", PLANE_INSTEAD),
    ("rough", PLANE_INSTEAD),
    ("heights", PLANE_INSTEAD),
];

const LATER_FRICTION: [Later; 1] =
    [("table", "use law = \"coulomb\", \"viscous\", \"stribeck\" or \"pressure-velocity\"")];

const FACES: [(&str, NodeSet); 6] = [
    ("x-min", NodeSet::XMin),
    ("x-max", NodeSet::XMax),
    ("y-min", NodeSet::YMin),
    ("y-max", NodeSet::YMax),
    ("z-min", NodeSet::ZMin),
    ("z-max", NodeSet::ZMax),
];

pub(super) fn rim(item: &Item, mesh: &MeshSpec) -> Result<Rim> {
    let table = item.table()?;
    table.only(&["nodes"], &[])?;
    let inner = [("inner", NodeSet::Inner)];
    let sets: &[_] = if matches!(mesh, MeshSpec::Ring { .. }) { &inner } else { &FACES };
    Ok(Rim { nodes: table.need("nodes", &format!("\"{}\"", sets[0].0))?.choice(sets, &[])? })
}

/// Every `[[hold]]`.
pub(super) fn holds(item: &Item, mesh: &MeshSpec) -> Result<Vec<Hold>> {
    item.entries()?.iter().map(|entry| hold(entry, mesh)).collect()
}

fn hold(item: &Item, mesh: &MeshSpec) -> Result<Hold> {
    let table = item.table()?;
    table.only(&["nodes", "components"], &[])?;
    let ring = [
        ("all", NodeSet::All),
        ("inner", NodeSet::Inner),
        ("outer", NodeSet::Outer),
        ("y-min", NodeSet::YMin),
        ("y-max", NodeSet::YMax),
    ];
    let block = [&[("all", NodeSet::All)], &FACES[..]].concat();
    let sets: &[_] = if matches!(mesh, MeshSpec::Ring { .. }) { &ring } else { &block };
    let nodes = table.need("nodes", "\"y-min\"")?.choice(sets, &[])?;
    let item = table.need("components", "\"y\"")?;
    let text = item.text()?;
    let components = ['x', 'y', 'z'].map(|c| text.contains(c));
    if text.is_empty() || !text.chars().all(|c| ('x'..='z').contains(&c)) {
        return Err(item.error(format!("{text:?} names no components"), "write some of x, y, z, e.g. \"xy\""));
    }
    Ok(Hold { nodes, components })
}

/// A held component must not be pushed by what acts on whole vectors: gravity and the road.
pub(super) fn check_holds(item: &Item, holds: &[Hold], gravity: [f64; 3], road: Option<&Road>) -> Result<()> {
    for (hold, entry) in holds.iter().zip(item.entries()?) {
        for (d, name) in ["x", "y", "z"].into_iter().enumerate().filter(|(d, _)| hold.components[*d]) {
            let Some(what) = (match road {
                _ if gravity[d] != 0.0 => Some("gravity acts"),
                Some(Road::Plane { normal, .. }) if normal[d] != 0.0 => Some("the road's normal points"),
                Some(Road::Plane { velocity, .. }) if velocity[d] != 0.0 => Some("the road moves"),
                _ => None,
            }) else {
                continue;
            };
            let problem = format!("{what} along the held component {name}");
            return Err(entry.error(problem, "hold another component, or hold these nodes with [rim]"));
        }
    }
    Ok(())
}

pub(super) fn road(item: &Item) -> Result<Road> {
    let table = item.table()?;
    if let Some(shape) = table.get("shape") {
        shape.choice(&[("plane", ())], &LATER_ROADS)?;
    }
    table.only(
        &["shape", "point", "normal", "velocity"],
        &[("roughness", "remove the key: the road is smooth")],
    )?;
    let normal = normal(&table)?;
    let velocity = table.vector_or_zero("velocity", &VELOCITY)?;
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if dot(velocity, normal).abs() > IN_PLANE * dot(velocity, velocity).sqrt() {
        return Err(table.at("velocity").error(
            format!("the road would leave its plane at {} m/s", dot(velocity, normal)),
            "write a velocity perpendicular to the normal",
        ));
    }
    Ok(Road::Plane { point: table.vector_or_zero("point", &LENGTH)?, normal, velocity })
}

/// Unit normal, +z by default.
fn normal(road: &Table) -> Result<[f64; 3]> {
    let Some(item) = road.get("normal") else { return Ok([0.0, 0.0, 1.0]) };
    let n = item.three("[0, 0, 1]", |entry| entry.number(Bound::Any))?;
    // Scaled first, so that no square overflows or vanishes.
    let largest = n.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if largest == 0.0 {
        return Err(item.error("the normal has no direction", "write the outward normal, e.g. [0, 0, 1]"));
    }
    let n = n.map(|c| c / largest);
    let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
    Ok(n.map(|c| c / length))
}

/// `None` for mu = 0: a frictionless scene has no friction code.
pub(super) fn friction(item: &Item, has_road: bool) -> Result<Option<Friction>> {
    let table = item.table()?;
    type Read = fn(&Table) -> Result<Option<Friction>>;
    let laws: [(&str, Read); 4] = [
        ("coulomb", coulomb),
        ("viscous", viscous),
        ("stribeck", stribeck),
        ("pressure-velocity", pressure_velocity),
    ];
    let read = table.get("law").map_or(Ok(laws[0].1), |law| law.choice(&laws, &LATER_FRICTION))?;
    let law = read(&table)?;
    if !has_road {
        return Err(item.error("friction without a road", "add a section [road], or remove [friction]"));
    }
    Ok(law)
}

fn coulomb(table: &Table) -> Result<Option<Friction>> {
    table.only(&["law", "coefficient"], &[])?;
    let mu = table.need("coefficient", "1.0")?.number(Bound::NotNegative)?;
    Ok((mu > 0.0).then_some(Friction::Coulomb { mu }))
}

fn viscous(table: &Table) -> Result<Option<Friction>> {
    table.only(&["law", "slope"], &[])?;
    Ok(Some(Friction::Viscous { slope: table.quantity("slope", &SLOWNESS, Bound::Positive)? }))
}

fn stribeck(table: &Table) -> Result<Option<Friction>> {
    table.only(&["law", "static", "kinetic", "speed", "slope"], &[])?;
    Ok(Some(Friction::Stribeck {
        still: table.need("static", "1.2")?.number(Bound::Positive)?,
        kinetic: table.need("kinetic", "0.8")?.number(Bound::NotNegative)?,
        speed: table.quantity("speed", &VELOCITY, Bound::Positive)?,
        slope: table.quantity_or("slope", 0.0, &SLOWNESS, Bound::NotNegative)?,
    }))
}

fn pressure_velocity(table: &Table) -> Result<Option<Friction>> {
    table.only(&["law", "a", "b", "pressure", "c", "speed"], &[])?;
    let number = |key, example| table.need(key, example).and_then(|item| item.number(Bound::Any));
    let (a, b, c) = (number("a", "0.5")?, number("b", "0.6")?, number("c", "0.3")?);
    let least = a + b.min(0.0) + c.min(0.0);
    if least < 0.0 {
        return Err(table.at("a").error(
            format!("the coefficient would fall to {least}"),
            "write a, b, c that stay positive at every pressure and speed",
        ));
    }
    Ok(Some(Friction::PressureVelocity {
        a,
        b,
        pressure: table.quantity("pressure", &PRESSURE, Bound::Positive)?,
        c,
        speed: table.quantity("speed", &VELOCITY, Bound::Positive)?,
    }))
}
