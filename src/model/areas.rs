//! Areas of surface nodes in a deformed shape.

use super::mesh::Mesh;
use crate::physics::tensor::{add, cross, dot, scale, sub};
use crate::scene::Road;

/// Tributary areas of the surface nodes [m2], shape `[surface_count]`: the quarters nearest to each node of its
/// deformed facets, projected on the road, of facets that face it. Without a road: empty.
pub fn contact_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<f64> {
    let Road::Plane { normal, .. } = road;
    let mut areas = vec![0.0; mesh.surface.len()];
    for facet in &mesh.facets {
        let p = facet.map(&x);
        let middle = |a: usize, b: usize| scale(add(p[a], p[b]), 0.5);
        let centre = scale(add(middle(0, 1), middle(2, 3)), 0.5);
        for a in 0..4 {
            let Ok(k) = mesh.surface.binary_search(&facet[a]) else { continue };
            let (before, after) = (middle((a + 3) % 4, a), middle(a, (a + 1) % 4));
            let doubled = cross(sub(centre, p[a]), sub(before, after));
            areas[k] += (-0.5 * dot(doubled, *normal)).max(0.0);
        }
    }
    areas
}

/// One over the areas of the surface nodes [1/m2], for laws that look at a node's pressure. A node whose facets have
/// turned away from the road, such as one at an edge that just touches, counts with a hundredth of the mean.
pub fn inverse_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<f64> {
    let areas = contact_areas(mesh, x, road);
    let touchable = areas.iter().filter(|a| **a > 0.0).count().max(1);
    let least = 0.01 * areas.iter().sum::<f64>() / touchable as f64;
    areas.iter().map(|a| 1.0 / a.max(least).max(f64::MIN_POSITIVE)).collect()
}
