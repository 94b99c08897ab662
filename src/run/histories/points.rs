//! The place of the outer surface that is nearest to a point.

use crate::model::mesh::Mesh;
use crate::physics::tensor::{add, cross, dot, scale, sub};

/// A place on a face.
#[derive(Debug, Clone, Copy)]
pub struct Found {
    pub nodes: [u32; 4],
    pub weights: [f64; 4],
    pub position: [f64; 3],
    /// Unit, outwards.
    pub normal: [f64; 3],
    /// From the point to it [m].
    pub distance: f64,
}

/// Iterations of Newton's method on a face: two are enough for plane ones.
const ITERATIONS: usize = 12;

/// Over all outer faces.
pub fn nearest(mesh: &Mesh, point: [f64; 3]) -> Found {
    let on = |facet: &[u32; 4]| on_face(*facet, facet.map(|n| mesh.nodes[n as usize]), point);
    let all = mesh.facets.iter().map(on);
    all.min_by(|a, b| a.distance.total_cmp(&b.distance)).expect("a mesh has outer faces")
}

/// On one face, by Gauss-Newton steps in its own coordinates (0..1), kept within it.
fn on_face(nodes: [u32; 4], p: [[f64; 3]; 4], point: [f64; 3]) -> Found {
    let weights = |[s, t]: [f64; 2]| [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
    let at = |w: [f64; 4]| (0..4).fold([0.0; 3], |sum, k| add(sum, scale(p[k], w[k])));
    let mut place = [0.5, 0.5];
    let mut slopes = [[0.0; 3]; 2];
    for _ in 0..ITERATIONS {
        let [s, t] = place;
        slopes = [
            add(scale(sub(p[1], p[0]), 1.0 - t), scale(sub(p[2], p[3]), t)),
            add(scale(sub(p[3], p[0]), 1.0 - s), scale(sub(p[2], p[1]), s)),
        ];
        let left = sub(point, at(weights(place)));
        let [aa, ab, bb] = [dot(slopes[0], slopes[0]), dot(slopes[0], slopes[1]), dot(slopes[1], slopes[1])];
        let [ra, rb] = slopes.map(|slope| dot(slope, left));
        let determinant = aa * bb - ab * ab;
        place[0] = (s + (ra * bb - rb * ab) / determinant).clamp(0.0, 1.0);
        place[1] = (t + (rb * aa - ra * ab) / determinant).clamp(0.0, 1.0);
    }
    let weights = weights(place);
    let (position, normal) = (at(weights), cross(slopes[0], slopes[1]));
    let away = sub(point, position);
    let normal = scale(normal, 1.0 / dot(normal, normal).sqrt());
    Found { nodes, weights, position, normal, distance: dot(away, away).sqrt() }
}
