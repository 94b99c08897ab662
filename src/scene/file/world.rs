//! `[rim]`, `[road]`, `[friction]`.

use crate::error::Result;
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{LENGTH, VELOCITY};
use crate::scene::{Friction, MeshSpec, NodeSet, Rim, Road};

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

const COULOMB_INSTEAD: &str = "use law = \"coulomb\" with a constant coefficient";

const LATER_FRICTION: [Later; 4] = [
    ("viscous", COULOMB_INSTEAD),
    ("stribeck", COULOMB_INSTEAD),
    ("pressure-velocity", COULOMB_INSTEAD),
    ("table", COULOMB_INSTEAD),
];

pub(super) fn rim(item: &Item, mesh: &MeshSpec) -> Result<Rim> {
    let table = item.table()?;
    table.only(&["nodes"], &[])?;
    let faces = [
        ("x-min", NodeSet::XMin),
        ("x-max", NodeSet::XMax),
        ("y-min", NodeSet::YMin),
        ("y-max", NodeSet::YMax),
        ("z-min", NodeSet::ZMin),
        ("z-max", NodeSet::ZMax),
    ];
    let inner = [("inner", NodeSet::Inner)];
    let sets: &[_] = if matches!(mesh, MeshSpec::Ring { .. }) { &inner } else { &faces };
    Ok(Rim { nodes: table.need("nodes", &format!("\"{}\"", sets[0].0))?.choice(sets, &[])? })
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
    if let Some(law) = table.get("law") {
        law.choice(&[("coulomb", ())], &LATER_FRICTION)?;
    }
    table.only(&["law", "coefficient"], &[])?;
    let mu = table.need("coefficient", "1.0")?.number(Bound::NotNegative)?;
    if !has_road {
        return Err(item.error("friction without a road", "add a section [road], or remove [friction]"));
    }
    Ok((mu > 0.0).then_some(Friction::Coulomb { mu }))
}
