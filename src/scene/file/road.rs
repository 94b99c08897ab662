//! `[road]`: shapes that are flat or round.

use super::rough;
use crate::error::Result;
use crate::physics::road::{Disk, Drum, Plane};
use crate::scene::Road;
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{ANGULAR_VELOCITY, LENGTH, VELOCITY};

/// A road may move in its plane only, up to this share of its speed (round-off of a tilted normal).
const IN_PLANE: f64 = 1e-9;

const LATER_ROADS: [Later; 4] = [
    ("cylinder", "use shape = \"drum\""),
    ("sphere", "use shape = \"plane\", or a height field of one"),
    ("rough", "use shape = \"height-field\""),
    ("heights", "use shape = \"height-field\""),
];

/// Roughness is a shape of its own.
const ROUGH: [Later; 1] = [("roughness", "use shape = \"height-field\" with generate = \"self-affine\"")];

pub(super) fn road(item: &Item) -> Result<Road> {
    let table = item.table()?;
    type Read = fn(&Table) -> Result<Road>;
    let shapes: [(&str, Read); 5] = [
        ("plane", plane),
        ("drum", drum),
        ("disk", disk),
        ("profile", rough::profile),
        ("height-field", rough::height_field),
    ];
    let read = table.get("shape").map_or(Ok(shapes[0].1), |shape| shape.choice(&shapes, &LATER_ROADS))?;
    read(&table)
}

fn plane(table: &Table) -> Result<Road> {
    table.only(&["shape", "point", "normal", "velocity"], &ROUGH)?;
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
    table.only(&["shape", "point", "normal", "axis", "radius", "side", "angular_velocity"], &ROUGH)?;
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

/// A plane that turns about its normal through `centre`. Its velocity is told from the point nearest to the origin, where a scene has
/// its body.
fn disk(table: &Table) -> Result<Road> {
    table.only(&["shape", "centre", "normal", "angular_velocity"], &ROUGH)?;
    let normal = direction(table, "normal", [0, 0, 1])?;
    let centre = table.need("centre", "[\"0 m\", \"165 mm\", \"0 m\"]")?.vector(&LENGTH, Bound::Any)?;
    let spin = table.quantity_or("angular_velocity", 0.0, &ANGULAR_VELOCITY, Bound::Any)?;
    Ok(Disk::about(centre, normal, spin, [0.0; 3]).into())
}

/// A unit vector.
pub(super) fn direction(table: &Table, key: &str, default: [i32; 3]) -> Result<[f64; 3]> {
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
