//! The body's boundary as triangles and edges.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::camera::Camera;
use super::gpu::{Segment, Vertex};
use crate::model::mesh::{FACES, Mesh};

/// Element behind every facet of the mesh, shape `[facet_count]`.
pub fn facet_elements(mesh: &Mesh) -> Vec<u32> {
    let sorted = |mut nodes: [u32; 4]| {
        nodes.sort_unstable();
        nodes
    };
    let mut places: HashMap<[u32; 4], usize> = HashMap::with_capacity(mesh.facets.len());
    for (at, &facet) in mesh.facets.iter().enumerate() {
        places.insert(sorted(facet), at);
    }
    let mut elements = vec![0; mesh.facets.len()];
    for (element, hex) in mesh.hexes.iter().enumerate() {
        for face in FACES {
            if let Some(&at) = places.get(&sorted(face.map(|c| hex[c]))) {
                elements[at] = element as u32;
            }
        }
    }
    elements
}

/// Every edge of the facets once, as (lower node, higher node), in the order of first meeting.
pub fn edges(facets: &[[u32; 4]]) -> Vec<[u32; 2]> {
    let mut seen = HashSet::with_capacity(2 * facets.len());
    let mut edges = Vec::with_capacity(2 * facets.len());
    for facet in facets {
        for c in 0..4 {
            let (a, b) = (facet[c], facet[(c + 1) % 4]);
            let edge = [a.min(b), a.max(b)];
            if seen.insert(edge) {
                edges.push(edge);
            }
        }
    }
    edges
}

/// Median length of `edges` in the deformed shape [m]; 0 without edges.
pub fn median_length(edges: &[[u32; 2]], x: &[[f64; 3]]) -> f64 {
    let at = |n: u32| DVec3::from(x[n as usize]);
    let mut lengths: Vec<f64> = edges.iter().map(|&[a, b]| at(a).distance(at(b))).collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() { 0.0 } else { *lengths.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Four triangles about the middle of a quadrilateral: its diagonals must not show in a coloured field.
/// `corners` [m] counter-clockwise seen from outside, `paint` at each of them.
pub fn quad(into: &mut Vec<Vertex>, camera: &Camera, corners: [DVec3; 4], paint: [[f32; 3]; 4]) {
    let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero();
    let normal = normal.as_vec3().to_array();
    let middle = corners.iter().sum::<DVec3>() / 4.0;
    let mean = std::array::from_fn(|d| paint.iter().map(|p| p[d]).sum::<f32>() / 4.0);
    let vertex = |point, paint| Vertex { position: camera.local(point), normal, paint };
    for c in 0..4 {
        let next = (c + 1) % 4;
        into.push(vertex(corners[c], paint[c]));
        into.push(vertex(corners[next], paint[next]));
        into.push(vertex(middle, mean));
    }
}

/// How strongly element edges show when they are `pixels` apart: (width [pixels], opacity).
/// Fine meshes fade instead of turning black.
pub fn edge_style(pixels: f64, unit: f64) -> (f64, f64) {
    let room = pixels / unit;
    ((0.05 * room).clamp(0.8, 1.3) * unit, (room / 20.0).clamp(0.0, 1.0) * 0.75)
}

/// Edges as segments.
pub fn lines(
    camera: &Camera,
    edges: &[[u32; 2]],
    x: &[[f64; 3]],
    colour: [f32; 4],
    width: f64,
) -> Vec<Segment> {
    let at = |n: u32| camera.local(DVec3::from(x[n as usize]));
    let segment = |&[a, b]: &[u32; 2]| Segment { from: at(a), to: at(b), colour, width: width as f32 };
    edges.iter().map(segment).collect()
}
