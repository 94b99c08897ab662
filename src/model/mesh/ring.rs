//! Rows of nodes round the axle: what rolls over the road one after the other.

use std::f64::consts::{PI, TAU};

use super::Mesh;

/// A body that is closed round its axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Elements round the circumference: rows of outermost nodes.
    pub around: usize,
    /// Distance of the outermost nodes from the axle [m].
    pub radius: f64,
}

/// Nodes within this share of the largest radius are outermost: coordinates of a file have few digits.
const OUTERMOST: f64 = 1e-3;
/// Nodes within this angle stand in one row [rad]: no mesh has 60,000 elements round its circumference.
const ROW: f64 = 1e-4;
/// Fewest rows without a lattice. A block turns on its corners, which are four rows, and is no ring.
const FEWEST: usize = 8;

impl Ring {
    pub(super) fn of(mesh: &Mesh) -> Option<Ring> {
        let radius = mesh.nodes.iter().map(|x| polar(mesh, x)[0]).fold(0.0, f64::max);
        let around = rows_of_lattice(mesh).or_else(|| rows_of_nodes(mesh, radius))?;
        Some(Ring { around, radius })
    }
}

/// Distance from the axle, and angle about it.
fn polar(mesh: &Mesh, x: &[f64; 3]) -> [f64; 2] {
    let [dx, dz] = [x[0] - mesh.axle[0], x[2] - mesh.axle[2]];
    [dx.hypot(dz), dx.atan2(dz)]
}

/// Elements along the closed rows of a lattice, if its first row goes round the axle once.
fn rows_of_lattice(mesh: &Mesh) -> Option<usize> {
    let around = mesh.lattice().filter(|lattice| lattice.closed)?.elements[0];
    let angle = |i: usize| polar(mesh, &mesh.nodes[i % around])[1];
    let turn = |i: usize| {
        let step = angle(i + 1) - angle(i);
        step - TAU * (step / TAU).round()
    };
    let turned: f64 = (0..around).map(turn).sum();
    (turned.abs() > PI).then_some(around)
}

/// Rows that the outermost nodes stand in, if they leave no gap in which further ones would be missing.
fn rows_of_nodes(mesh: &Mesh, radius: f64) -> Option<usize> {
    let outermost = mesh.nodes.iter().map(|x| polar(mesh, x)).filter(|p| p[0] >= (1.0 - OUTERMOST) * radius);
    let mut angles: Vec<f64> = outermost.map(|p| p[1]).collect();
    angles.sort_unstable_by(f64::total_cmp);
    let first = *angles.first()?;
    let next = angles.iter().skip(1).copied().chain([first + TAU]);
    let gaps: Vec<f64> = angles.iter().zip(next).map(|(a, b)| b - a).collect();
    let rows = gaps.iter().filter(|gap| **gap > ROW).count();
    let widest = gaps.iter().copied().fold(0.0, f64::max);
    // With slack for round-off in equal gaps.
    (rows >= FEWEST && widest <= 1.01 * TAU / FEWEST as f64).then_some(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Grading, MeshSpec};

    fn wheel(around: usize, grading: &Grading) -> Mesh {
        let elements = [around, 2, 3];
        let spec = MeshSpec::Ring { outer_radius: 0.04, inner_radius: 0.02, width: 0.02, elements };
        Mesh::graded(&spec, grading).moved([0.3, -0.1, 0.02])
    }

    /// The mesh with its nodes and elements the other way round: no lattice any more.
    fn reversed(mesh: &Mesh) -> Mesh {
        let last = mesh.nodes.len() as u32 - 1;
        let mut mesh = mesh.clone();
        mesh.nodes.reverse();
        mesh.hexes.reverse();
        mesh.hexes.iter_mut().flatten().for_each(|n| *n = last - *n);
        assert_eq!(mesh.lattice(), None);
        mesh
    }

    #[test]
    fn a_ring_knows_its_rows_under_any_numbers() {
        for around in [8, 44, 352] {
            let mesh = wheel(around, &Grading::default());
            for mesh in [mesh.clone(), reversed(&mesh)] {
                let ring = mesh.ring().unwrap();
                assert_eq!(ring.around, around);
                assert!((ring.radius - 0.04).abs() < 1e-15);
            }
        }
        // Coarse rings and strongly graded ones are known by their lattice.
        let grading = Grading { ratio: [1e3, 1.0, 1.0], fine_arc: 0.2 };
        assert_eq!(wheel(30, &grading).ring().unwrap().around, 30);
        assert_eq!(wheel(3, &Grading::default()).ring().unwrap().around, 3);
    }

    #[test]
    fn a_rounded_tread_has_rows_too() {
        let mut mesh = reversed(&wheel(44, &Grading::default()));
        let [cx, _, cz] = mesh.axle;
        for x in &mut mesh.nodes {
            // The edges stand back by 10 %.
            let edge = (x[1] + 0.1).abs() / 0.01;
            let by = 1.0 - 0.1 * edge * edge;
            (x[0], x[2]) = (cx + by * (x[0] - cx), cz + by * (x[2] - cz));
        }
        assert_eq!(mesh.ring().unwrap().around, 44);
    }

    #[test]
    fn blocks_and_rings_about_another_axis_are_none() {
        for elements in [[1, 1, 1], [20, 3, 20], [60, 1, 1]] {
            let mesh = Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements });
            assert_eq!(mesh.ring(), None, "{elements:?}");
        }
        let mut mesh = wheel(44, &Grading::default());
        mesh.nodes.iter_mut().for_each(|x| x.swap(0, 1));
        mesh.axle.swap(0, 1);
        assert!(mesh.lattice().unwrap().closed);
        assert_eq!(mesh.ring(), None);
    }
}
