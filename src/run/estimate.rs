//! What a run knows of its own errors without a second run: the class of what its step and its precision do to forces and
//! deformation. Upper estimates, of the right power of ten; `hexroll report accuracy` measures the errors themselves, and
//! tests hold the estimates against runs with other steps and in other precisions.
//!
//! *Time step.* The larger of two. The stored-energy balance is the error of central differences that a run can see: exact
//! for a linear body, of second order in the step otherwise. And a node lands, sticks or is let go at the end of a step: half a
//! step late in the mean, of the steps that it stays in a state, which is half the share of touching nodes that change
//! theirs in a step. A run that chatters has a large one, as it should.
//!
//! *Rounding.* A step rounds each coordinate by up to half a unit u in the last place, relative to the frame that follows the
//! axle, one way or the other: after n steps sqrt(n) u, against a deformation of e s, e the root mean square stretch of the
//! element edges and s the body's smallest extent; and single precision knows a strain to a unit of one.
//!
//! *Residual.* Of a stage that relaxes, the net force on free nodes over the largest internal force when it was taken as
//! settled: an equilibrium has no error of the step.

use crate::model::Model;
use crate::model::mesh::SIGNS;
use crate::precision::Precision;

/// Half a unit in the last place of positions [m] and the unit of strains; `reach` is the largest coordinate from the axle
/// [m]. Pairs of singles have finer positions, but strains come from single differences of them.
pub fn units(precision: Precision, reach: f64) -> [f64; 2] {
    [0.5 * precision.position_epsilon() * reach, precision.epsilon()]
}

/// Class of the rounding error after `steps` steps to the positions `x`; none of a body that is not deformed.
pub fn rounding(model: &Model, precision: Precision, x: &[[f64; 3]], steps: u64) -> Option<f64> {
    let nodes = &model.mesh.nodes;
    let reach = |x: &[f64; 3]| (0..3).map(|d| (x[d] - model.mesh.axle[d]).abs()).fold(0.0, f64::max);
    let [half_unit, strain_unit] = units(precision, nodes.iter().map(reach).fold(0.0, f64::max));
    let extent = |d: usize| {
        let along = || nodes.iter().map(|x| x[d]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let smallest = (0..3).map(extent).fold(f64::INFINITY, f64::min);
    let stretch = edge_stretch(model, x);
    let lost = half_unit * (steps as f64).sqrt() / smallest + strain_unit;
    (stretch > 0.0 && stretch.is_finite()).then(|| lost / stretch)
}

/// Pairs of an element's corners that an edge joins: they differ in one coordinate.
fn edges() -> Vec<[usize; 2]> {
    let differ = |a: usize, b: usize| (0..3).filter(|&d| SIGNS[a][d] != SIGNS[b][d]).count();
    (0..8).flat_map(|a| (0..a).map(move |b| [a, b])).filter(|&[a, b]| differ(a, b) == 1).collect()
}

fn length(x: &[[f64; 3]], a: u32, b: u32) -> f64 {
    let [a, b] = [a, b].map(|n| x[n as usize]);
    (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt()
}

/// Of all elements, in the reference shape [m].
pub fn shortest_edge(model: &Model) -> f64 {
    let edges = edges();
    let of = |hex: &[u32; 8]| {
        edges.iter().map(|&[a, b]| length(&model.mesh.nodes, hex[a], hex[b])).fold(f64::INFINITY, f64::min)
    };
    model.mesh.hexes.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// Root mean square of the relative change of length over the elements' edges: blind to rigid motion.
fn edge_stretch(model: &Model, x: &[[f64; 3]]) -> f64 {
    let edges = edges();
    let mut sum = 0.0;
    for hex in &model.mesh.hexes {
        for [a, b] in edges.iter().map(|edge| edge.map(|k| hex[k])) {
            sum += (length(x, a, b) / length(&model.mesh.nodes, a, b) - 1.0).powi(2);
        }
    }
    (sum / (edges.len() * model.mesh.hexes.len()) as f64).sqrt()
}

/// Class of the time step's error: `stored` is the stored-energy balance's error over the largest energy, `changing` the share
/// of touching nodes that change their state in a step (0 without contact).
pub fn time_step(stored: f64, changing: f64) -> f64 {
    stored.max(0.5 * changing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    fn block(size: &str, elements: &str) -> Model {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/spinning_block.toml");
        let sets = [format!("body.mesh.size={size}"), format!("body.mesh.elements={elements}")];
        Model::new(&Scene::load(&file, &sets).unwrap()).unwrap()
    }

    #[test]
    fn edges_feel_a_stretch_and_no_rotation() {
        let model = block(r#"["20 mm", "10 mm", "30 mm"]"#, "[2, 3, 4]");
        let turned: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|x| [1.0 - x[1], 2.0 + x[0], x[2]]).collect();
        // Lengths of coordinates near one: 1e-16 over edges of 3 mm.
        assert!(edge_stretch(&model, &turned) < 1e-12);
        // A third of the edges are 1 % longer.
        let pulled: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|x| [x[0], x[1], 1.01 * x[2]]).collect();
        assert!((edge_stretch(&model, &pulled) / (0.01 / 3f64.sqrt()) - 1.0).abs() < 1e-9);
        assert_eq!(rounding(&model, Precision::F32, &model.mesh.nodes, 100), None);
    }

    #[test]
    fn precision_decides_the_class_of_rounding() {
        let model = block(r#"["20 mm", "20 mm", "20 mm"]"#, "[2, 2, 2]");
        let pulled: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|x| [x[0], x[1], 1.03 * x[2]]).collect();
        let of = |precision| rounding(&model, precision, &pulled, 10_000).unwrap();
        // u = 6e-8 of 20 mm or less, a hundred of them over 20 mm, against 3 % / sqrt(3).
        assert!((1e-4..1e-3).contains(&of(Precision::F32)), "{}", of(Precision::F32));
        assert!((1e-6..1e-5).contains(&of(Precision::F32Plus)), "{}", of(Precision::F32Plus));
        assert!(of(Precision::F64) < 1e-11, "{}", of(Precision::F64));
    }
}
