//! Bytes of a body, from its element counts.

use crate::memory::{Counts, Part};
use crate::physics::element::Class;
use crate::scene::Scene;

/// The mesh and the model of a scene. Every term is a count times the bytes of what is stored; what is smaller than a per cent is
/// left out.
pub fn body(scene: &Scene) -> Part {
    let counts = Counts::of(scene);
    let of = |count: u64, bytes: usize| count * bytes as u64;
    let corners = size_of::<[u32; 8]>();
    // Corners of an element, the list of who gathers them, and its shape.
    let elements = of(counts.elements, 2 * corners + size_of::<u32>());
    // Position, mass, where its corners begin.
    let held = usize::from(!scene.holds.is_empty());
    let nodes = of(counts.nodes, size_of::<[f64; 3]>() + size_of::<f64>() + size_of::<u32>() + held);
    // Facets in an array that grew by doubling, and what the surface was sorted in.
    let facets = of(counts.facets.next_power_of_two() + counts.facets, size_of::<[u32; 4]>());
    // Shapes are met one after the other: when their array last doubles, the half of it is held beside the whole.
    let room = counts.shapes.next_power_of_two();
    let shapes = of(room + room / 2, size_of::<Class<f64>>());
    let bytes = elements + nodes + facets + shapes;
    Part { name: "body", bytes }
}
