//! Areas of surface nodes in a deformed shape, and the directions that a footprint is measured along.

use super::mesh::Mesh;
use crate::physics::rim;
use crate::physics::tensor::{add, cross, dot, scale, sub};
use crate::scene::Road;

/// Tributary areas of the surface nodes [m2], shape `[surface_count]`: the quarters nearest to each node of its
/// deformed facets, projected on the road, of facets that face it. Nodes that are not `wanted`, by their index in the
/// surface, have none.
pub fn contact_areas(
    mesh: &Mesh,
    x: impl Fn(u32) -> [f64; 3],
    road: &Road,
    wanted: impl Fn(usize) -> bool,
) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.surface.len()];
    quarters(mesh, x, road, wanted, |k, area, _| areas[k] += area);
    areas
}

/// Extents of the quarters of some nodes, `touches` by their index in the surface, along the unit directions [m].
pub fn extents(
    mesh: &Mesh,
    x: impl Fn(u32) -> [f64; 3],
    road: &Road,
    touches: impl Fn(usize) -> bool,
    directions: [[f64; 3]; 2],
) -> [f64; 2] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    quarters(mesh, x, road, touches, |_, _, corners| {
        for (bound, direction) in bounds.iter_mut().zip(&directions) {
            for corner in corners {
                let at = dot(*corner, *direction);
                *bound = [bound[0].min(at), bound[1].max(at)];
            }
        }
    });
    bounds.map(|[low, high]| (high - low).max(0.0))
}

/// Calls `visit` with every quarter of a facet that faces the road and belongs to a wanted node: index in the surface of
/// the node, projected area, corners.
fn quarters(
    mesh: &Mesh,
    x: impl Fn(u32) -> [f64; 3],
    road: &Road,
    wanted: impl Fn(usize) -> bool,
    mut visit: impl FnMut(usize, f64, &[[f64; 3]; 4]),
) {
    // By node, its index in the surface if it is wanted: most facets of a wheel are passed over.
    const NOT: u32 = u32::MAX;
    let mut of_node = vec![NOT; mesh.nodes.len()];
    for (k, &n) in mesh.surface.iter().enumerate().filter(|(k, _)| wanted(*k)) {
        of_node[n as usize] = k as u32;
    }
    for facet in &mesh.facets {
        let on_surface = facet.map(|n| of_node[n as usize]);
        if on_surface == [NOT; 4] {
            continue;
        }
        let p = facet.map(&x);
        let middle = |a: usize, b: usize| scale(add(p[a], p[b]), 0.5);
        let centre = scale(add(middle(0, 1), middle(2, 3)), 0.5);
        let normal = road.normal(centre);
        for a in (0..4).filter(|a| on_surface[*a] != NOT) {
            let (before, after) = (middle((a + 3) % 4, a), middle(a, (a + 1) % 4));
            let doubled = cross(sub(centre, p[a]), sub(before, after));
            let area = -0.5 * dot(doubled, normal);
            if area > 0.0 {
                visit(on_surface[a] as usize, area, &[p[a], after, centre, before]);
            }
        }
    }
}

/// One over the areas of the surface nodes [1/m2], for laws that look at a node's pressure. A node whose facets have
/// turned away from the road, such as one at an edge that just touches, counts with a hundredth of the mean.
pub fn inverse_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<f64> {
    let areas = contact_areas(mesh, x, road, |_| true);
    let touchable = areas.iter().filter(|a| **a > 0.0).count().max(1);
    let least = 0.01 * areas.iter().sum::<f64>() / touchable as f64;
    areas.iter().map(|a| 1.0 / a.max(least).max(f64::MIN_POSITIVE)).collect()
}

/// Unit vectors along the road below the axle: along the wheel's heading, and to its left.
pub fn road_axes(road: &Road, rim: &rim::Coordinates) -> [[f64; 3]; 2] {
    road.axes(rim::axle(rim).into(), rim::axle_direction(rim).into())
}
