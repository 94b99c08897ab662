//! Where single-precision engines put their origin.
//!
//! Positions are kept relative to a frame that follows the axle in whole grains, a power of two of about half the
//! body's size, so that a wheel that has rolled far has the digits of one that has not moved, and so that moving the
//! frame itself rounds nothing that matters.

use crate::model::mesh::Mesh;
use crate::scene::Road;

/// Grain of a body [m].
pub fn grain(mesh: &Mesh) -> f64 {
    let reach =
        mesh.nodes.iter().flat_map(|x| (0..3).map(|d| (x[d] - mesh.axle[d]).abs())).fold(0.0, f64::max);
    2.0f64.powi(reach.log2().floor() as i32)
}

/// How far the frame at `frame` should move so that `axle` is within a grain of it [m]. Only along directions in
/// which the road does not change: its offset must stay what it is, to the last digit.
pub fn shift(grain: f64, axle: [f64; 3], frame: [f64; 3], road: Option<&Road>) -> [f64; 3] {
    let along = road.map_or([true; 3], |road| road.invariant());
    std::array::from_fn(|d| {
        let away = axle[d] - frame[d];
        if along[d] && away.abs() > grain { (away / grain).round() * grain } else { 0.0 }
    })
}
