//! A section turned into a solid: quadrilaterals in a plane through the axle, swept round it.

use std::f64::consts::TAU;

use super::super::raw::Raw;
use super::fault::Fault;
use crate::error::Result;
use crate::model::mesh::Numbers;
use crate::model::mesh::generate::turn;
use crate::scene::Revolve;

/// Turns the section of `raw` (x: distance from the axle, y: along it [m]) into the wheel that it is a section of: the axle along
/// y, the lowest row of nodes at z = 0, as the ring generator has it. Quadrilaterals become hexahedra, sets the rings of their nodes.
///
/// # Errors
/// A node on the axle, or beyond it: no hexahedron closes there.
pub fn revolve(raw: &mut Raw, how: &Revolve, fault: &Fault) -> Result<()> {
    let inside: Vec<u32> = (0..raw.nodes.len() as u32).filter(|&n| raw.nodes[n as usize][0] <= 0.0).collect();
    if !inside.is_empty() {
        let problem = format!(
            "{} nodes of the section are on the axle or beyond it: {}",
            inside.len(),
            fault.nodes(&inside)
        );
        return Err(fault.error(
            problem,
            "x is the distance from the axle, y runs along it: leave a hole, or turn the section",
        ));
    }
    let n = how.sectors;
    let outer = raw.nodes.iter().map(|x| x[0]).fold(0.0, f64::max);
    // Node 0 at the bottom, then towards -x: a turn about +y.
    let angles: Vec<(f64, f64)> =
        (0..n).map(|i| (TAU * turn(i, n, how.grading, how.fine_arc)).sin_cos()).collect();
    let around = |&[radius, y, _]: &[f64; 3]| {
        angles.iter().map(move |(sin, cos)| [-radius * sin, y, outer - radius * cos]).collect::<Vec<_>>()
    };
    raw.hexes = raw.quads.iter().flat_map(|quad| swept(in_order(*quad, &raw.nodes), n)).collect();
    raw.nodes = raw.nodes.iter().flat_map(around).collect();
    for set in &mut raw.sets {
        set.nodes = set.nodes.iter().flat_map(|&s| (0..n as u32).map(move |i| s * n as u32 + i)).collect();
    }
    // A node and an element have the number of the one in the section that they were swept from.
    let repeated = |numbers: &Numbers| Numbers {
        of: numbers.of.iter().flat_map(|&id| std::iter::repeat_n(id, n)).collect(),
        parts: numbers.parts.iter().map(|(first, name)| (first * n as u32, name.clone())).collect(),
    };
    // As the ring generator's: in the middle of the width, and above the lowest row of nodes by the largest radius.
    let ends = |pick: fn(f64, f64) -> f64, from: f64| raw.nodes.iter().fold(from, |m, x| pick(m, x[1]));
    raw.axle = Some([0.0, 0.5 * (ends(f64::min, f64::INFINITY) + ends(f64::max, f64::NEG_INFINITY)), outer]);
    (raw.labels.nodes, raw.labels.elements) = (repeated(&raw.labels.nodes), repeated(&raw.labels.elements));
    raw.quads.clear();
    Ok(())
}

/// The quadrilateral counter-clockwise in the plane of (along the axle, away from it): sections are drawn either way.
fn in_order([a, b, c, d]: [u32; 4], nodes: &[[f64; 3]]) -> [u32; 4] {
    let at = |n: u32| [nodes[n as usize][1], nodes[n as usize][0]];
    let cross = |p: u32, q: u32| at(p)[0] * at(q)[1] - at(p)[1] * at(q)[0];
    let twice_the_area = cross(a, b) + cross(b, c) + cross(c, d) + cross(d, a);
    if twice_the_area >= 0.0 { [a, b, c, d] } else { [a, d, c, b] }
}

/// Hexahedra of a quadrilateral round the axle: xi runs round, eta from its first to its second corner.
fn swept([a, b, c, d]: [u32; 4], n: usize) -> impl Iterator<Item = [u32; 8]> {
    (0..n).map(move |i| {
        let at = |s: u32, i: usize| s * n as u32 + (i % n) as u32;
        [at(a, i), at(a, i + 1), at(b, i + 1), at(b, i), at(d, i), at(d, i + 1), at(c, i + 1), at(c, i)]
    })
}
