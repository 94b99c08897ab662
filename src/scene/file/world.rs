//! `[rim]`, `[[hold]]`, `[road]`, `[friction]`.

use super::parameters;
use crate::error::Result;
use crate::physics::road::{Drum, Plane};
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{ANGULAR_VELOCITY, LENGTH, VELOCITY};
use crate::scene::{Friction, Hold, NodeSet, Rim, Road, SetMotion};

/// A road may move in its plane only, up to this share of its speed (round-off of a tilted normal).
const IN_PLANE: f64 = 1e-9;

const PLANE_INSTEAD: &str = "use shape = \"plane\"";

const LATER_ROADS: [Later; 5] = [
    ("disk", PLANE_INSTEAD),
    ("cylinder", "use shape = \"drum\""),
    ("sphere", PLANE_INSTEAD),
    ("rough", PLANE_INSTEAD),
    ("heights", PLANE_INSTEAD),
];

const LATER_FRICTION: [Later; 1] =
    [("table", "use law = \"coulomb\", \"viscous\", \"stribeck\" or \"pressure-velocity\"")];

pub(super) fn rim(item: &Item) -> Result<Rim> {
    let table = item.table()?;
    table.only(&["nodes"], &[])?;
    Ok(Rim { nodes: NodeSet::read(&table.need("nodes", "\"inner\"")?)? })
}

/// Every `[[hold]]`.
pub(super) fn holds(item: &Item) -> Result<Vec<Hold>> {
    item.entries()?.iter().map(hold).collect()
}

fn hold(item: &Item) -> Result<Hold> {
    let table = item.table()?;
    table.only(&["nodes", "components", "reaction"], &[])?;
    let nodes = NodeSet::read(&table.need("nodes", "\"y-min\"")?)?;
    let item = table.need("components", "\"y\"")?;
    let text = item.text()?;
    let components = ['x', 'y', 'z'].map(|c| text.contains(c));
    if text.is_empty() || !text.chars().all(|c| ('x'..='z').contains(&c)) {
        return Err(item.error(format!("{text:?} names no components"), "write some of x, y, z, e.g. \"xy\""));
    }
    let reaction = table.get("reaction").map_or(Ok(false), |item| item.choice(&[("recorded", true)], &[]))?;
    Ok(Hold { nodes, components, reaction })
}

/// The road, which acts on whole vectors, must not push a held component.
pub(super) fn check_holds(item: &Item, holds: &[Hold], road: Option<&Road>) -> Result<()> {
    check_fixed(item, holds.iter().map(|hold| hold.components), road, "held")
}

/// The same of components that follow a motion.
pub(super) fn check_motions(item: &Item, motions: &[SetMotion], road: Option<&Road>) -> Result<()> {
    check_fixed(item, motions.iter().map(SetMotion::prescribed), road, "moved")
}

fn check_fixed(
    item: &Item,
    fixed: impl Iterator<Item = [bool; 3]>,
    road: Option<&Road>,
    how: &str,
) -> Result<()> {
    let Some(road) = road else { return Ok(()) };
    for (components, entry) in fixed.zip(item.entries()?) {
        for (d, name) in ["x", "y", "z"].into_iter().enumerate().filter(|(d, _)| components[*d]) {
            let Some(what) = road.acts_along(d) else { continue };
            let problem = format!("{what} along the {how} component {name}");
            return Err(entry.error(problem, "take another component, or hold these nodes with [rim]"));
        }
    }
    Ok(())
}

pub(super) fn road(item: &Item) -> Result<Road> {
    let table = item.table()?;
    type Read = fn(&Table) -> Result<Road>;
    let shapes: [(&str, Read); 2] = [("plane", plane), ("drum", drum)];
    let read = table.get("shape").map_or(Ok(shapes[0].1), |shape| shape.choice(&shapes, &LATER_ROADS))?;
    read(&table)
}

const LATER_KEYS: [Later; 1] = [("roughness", "remove the key: the road is smooth")];

fn plane(table: &Table) -> Result<Road> {
    table.only(&["shape", "point", "normal", "velocity"], &LATER_KEYS)?;
    let normal = direction(table, "normal", [0, 0, 1])?;
    let velocity = table.vector_or_zero("velocity", &VELOCITY)?;
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if dot(velocity, normal).abs() > IN_PLANE * dot(velocity, velocity).sqrt() {
        return Err(table.at("velocity").error(
            format!("the road would leave its plane at {} m/s", dot(velocity, normal)),
            "write a velocity perpendicular to the normal",
        ));
    }
    Ok(Plane { point: table.vector_or_zero("point", &LENGTH)?, normal, velocity }.into())
}

/// A plane bent about an axis: `point` and `normal` say where the surface is, `radius` and `side` how it is bent.
fn drum(table: &Table) -> Result<Road> {
    table.only(&["shape", "point", "normal", "axis", "radius", "side", "angular_velocity"], &LATER_KEYS)?;
    let normal = direction(table, "normal", [0, 0, 1])?;
    let axis = direction(table, "axis", [0, 1, 0])?;
    let along: f64 = (0..3).map(|d| axis[d] * normal[d]).sum();
    if along.abs() > IN_PLANE {
        return Err(table.at("axis").error(
            format!("the axis is not square to the normal: the cosine between them is {along}"),
            "write an axis that lies in the surface at the point",
        ));
    }
    let radius = table.quantity("radius", &LENGTH, Bound::Positive)?;
    let sides = [("outside", 1.0), ("inside", -1.0)];
    let side = table.get("side").map_or(Ok(1.0), |item| item.choice(&sides, &[]))?;
    let spin = table.quantity_or("angular_velocity", 0.0, &ANGULAR_VELOCITY, Bound::Any)?;
    let point = table.vector_or_zero("point", &LENGTH)?;
    Ok(Drum { point, normal, axis, curvature: side / radius, speed: spin * radius * side }.into())
}

/// A unit vector.
fn direction(table: &Table, key: &str, default: [i32; 3]) -> Result<[f64; 3]> {
    let Some(item) = table.get(key) else { return Ok(default.map(f64::from)) };
    let n = item.three("[0, 0, 1]", |entry| entry.number(Bound::Any))?;
    // Scaled first, so that no square overflows or vanishes.
    let largest = n.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if largest == 0.0 {
        return Err(item.error(format!("the {key} has no direction"), format!("write e.g. {default:?}")));
    }
    let n = n.map(|c| c / largest);
    let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
    Ok(n.map(|c| c / length))
}

/// `None` for mu = 0: a frictionless scene has no friction code.
pub(super) fn friction(item: &Item, has_road: bool) -> Result<Option<Friction>> {
    let table = item.table()?;
    let names: Vec<_> = Friction::KINDS.iter().map(|kind| (kind.name, kind)).collect();
    let kind = table.get("law").map_or(Ok(&Friction::KINDS[0]), |law| law.choice(&names, &LATER_FRICTION))?;
    let keys: Vec<_> = std::iter::once("law").chain(kind.parameters.iter().map(|p| p.key)).collect();
    table.only(&keys, &[])?;
    let values = parameters::read(&table, kind.parameters, &[])?;
    let law = (kind.from_values)(&values).map_err(|fault| parameters::error(&table, fault))?;
    if !has_road {
        return Err(item.error("friction without a road", "add a section [road], or remove [friction]"));
    }
    Ok(law)
}
