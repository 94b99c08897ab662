//! Where a body begins: never inside the road. From there a step would lift it out, and what it was lifted by would be its speed.

use super::mesh::Mesh;
use crate::error::{Error, Result};
use crate::physics::road::Road;
use crate::physics::tensor::dot;
use crate::scene::Scene;

/// Depth that rounding may leave, over the body's size: a step lifts a node out of it with a speed that nothing notices.
const ROUNDING: f64 = 1e-9;

/// The mesh where the scene wants it.
///
/// # Errors
/// [`Error::Scene`] for a body that begins inside the road, or that finds no place on it.
pub fn placed(mesh: Mesh, scene: &Scene) -> Result<Mesh> {
    let Some(road) = &scene.road else { return Ok(mesh) };
    if scene.body.on_road {
        let shift = shift_onto(&mesh, road).ok_or_else(|| no_place(scene))?;
        return over_road(mesh.moved(shift), road, scene);
    }
    match inside(&mesh, road) {
        Some(inside) => Err(begins_inside(scene, &mesh, &inside, shift_onto(&mesh, road))),
        None => over_road(mesh, road, scene),
    }
}

/// The mesh, if the road has heights wherever a node is low enough to meet them.
fn over_road(mesh: Mesh, road: &Road, scene: &Scene) -> Result<Mesh> {
    match mesh.surface.iter().map(|&n| mesh.nodes[n as usize]).find(|x| road.gap(*x).is_nan()) {
        None => Ok(mesh),
        Some([x, y, z]) => {
            let problem = format!("there is no road below the body at ({x:.6}, {y:.6}, {z:.6}) m");
            let remedy = "write another road.point or road.border, or a larger map without holes there";
            Err(error(scene, "body.offset", problem, remedy.into()))
        }
    }
}

/// Nodes that could touch a road and are inside it.
struct Inside {
    count: usize,
    deepest: [f64; 3],
    /// Of the deepest [m].
    depth: f64,
}

fn inside(mesh: &Mesh, road: &Road) -> Option<Inside> {
    let allowed = ROUNDING * size(mesh);
    let (gap, deepest) = lowest(mesh, road, [0.0; 3])?;
    let count = mesh.surface.iter().filter(|&&n| road.gap(mesh.nodes[n as usize]) < -allowed).count();
    (count > 0).then_some(Inside { count, deepest, depth: -gap })
}

/// Longest edge of the box round a mesh [m].
fn size(mesh: &Mesh) -> f64 {
    let extent = |d: usize| {
        let of = |pick: fn(f64, f64) -> f64, start| mesh.nodes.iter().fold(start, |m, x| pick(m, x[d]));
        of(f64::max, f64::NEG_INFINITY) - of(f64::min, f64::INFINITY)
    };
    (0..3).map(extent).fold(0.0, f64::max)
}

/// Smallest gap of the nodes that can touch the road, all moved by `shift`, and where that node is.
fn lowest(mesh: &Mesh, road: &Road, shift: [f64; 3]) -> Option<(f64, [f64; 3])> {
    let moved = |&n: &u32| -> [f64; 3] { std::array::from_fn(|d| mesh.nodes[n as usize][d] + shift[d]) };
    let gaps = mesh.surface.iter().map(moved).map(|x| (road.gap(x), x));
    gaps.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The way along the road's normal, under the middle of the body, that makes the body touch it: Newton's method on the
/// smallest gap, which on a plane takes a step. `None` where there is none, as for a wheel larger than the drum it is in.
fn shift_onto(mesh: &Mesh, road: &Road) -> Option<[f64; 3]> {
    /// The slope of the smallest gap is known at every step: an error is squared, or a node less is in question.
    const MOST: usize = 50;
    let middle =
        std::array::from_fn(|d| mesh.nodes.iter().map(|x| x[d]).sum::<f64>() / mesh.nodes.len() as f64);
    let direction: [f64; 3] = road.normal(middle);
    let mut along = 0.0;
    for _ in 0..MOST {
        let shift = direction.map(|d| along * d);
        let (gap, x) = lowest(mesh, road, shift)?;
        let slope: f64 = dot(road.normal(x), direction);
        if gap.abs() <= 1e-3 * ROUNDING * size(mesh) {
            return Some(shift);
        }
        along -= gap / slope;
        if !along.is_finite() {
            return None;
        }
    }
    None
}

fn error(scene: &Scene, key: &str, problem: String, remedy: String) -> Error {
    let file = scene.file.display().to_string();
    Error::Scene { file, line: None, key: key.into(), problem, remedy }
}

fn begins_inside(scene: &Scene, mesh: &Mesh, inside: &Inside, shift: Option<[f64; 3]>) -> Error {
    let Inside { count, deepest: [x, y, z], depth } = inside;
    let problem = format!(
        "the body begins inside the road: {count} of {} surface nodes, the deepest by {:.6} mm at ({x:.6}, {y:.6}, {z:.6}) m",
        mesh.surface.len(),
        1e3 * depth
    );
    let offset = shift.map(|shift| {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|d| 1e3 * (scene.body.offset[d] + shift[d]));
        format!(", or offset = [\"{x:.9} mm\", \"{y:.9} mm\", \"{z:.9} mm\"]")
    });
    let remedy = format!("write place = \"on-road\"{}", offset.unwrap_or_default());
    error(scene, "body.offset", problem, remedy)
}

fn no_place(scene: &Scene) -> Error {
    let problem = "no way along the road's normal makes the body touch the road without going into it".into();
    error(scene, "body.place", problem, "write an offset from which there is one, or a larger drum".into())
}
