//! What the nodes of each line are: held by the rim, near the road, held in a component.

use super::lines::{Lines, NodeLine};
use crate::kernels::{DrivenPart, NodeBatch};
use crate::model::mesh::{Driven, Mesh};

/// Bits of a node; those of held components follow.
const RIM: u8 = 1;
const SURFACE: u8 = 2;
const HELD: u8 = 4;

/// Roles of the nodes of a line.
#[derive(Debug, Clone)]
pub struct LineRoles {
    pub batches: Vec<NodeBatch>,
    pub has_rim: bool,
    pub driven: bool,
    /// Whether all of its nodes are free of rim and holds.
    pub plain: bool,
    /// Its number among the lines that can touch the road.
    pub surface: Option<usize>,
}

/// Roles by line.
#[derive(Debug, Clone)]
pub struct Roles {
    pub of_lines: Vec<LineRoles>,
    /// Lines that can touch the road.
    pub surface_lines: usize,
    /// Lanes of batches with rim or surface nodes.
    pub boundary: usize,
    /// Batches with driven nodes: their parts.
    pub driven: Vec<Vec<DrivenPart>>,
}

impl Roles {
    /// Roles of a mesh's nodes in batches of `width`; `road`: its surface nodes can touch.
    pub fn new(lines: &Lines, mesh: &Mesh, road: bool, width: usize) -> Roles {
        let of_nodes = bits(mesh, road);
        let sets: Vec<Vec<bool>> =
            mesh.driven.iter().map(|set| members(&set.nodes, mesh.nodes.len())).collect();
        let (mut surface_lines, mut boundary, mut driven) = (0, 0, Vec::new());
        let mut of_line = |line: &NodeLine| {
            let batches: Vec<NodeBatch> = line
                .nodes
                .chunks(width)
                .map(|nodes| {
                    let mut batch = batch(nodes, &of_nodes, boundary);
                    let parts = parts(nodes, mesh, &sets);
                    if !parts.is_empty() {
                        driven.push(parts);
                        batch.driven = driven.len() as u32;
                    }
                    boundary += if batch.rim | batch.surface != 0 { width } else { 0 };
                    batch
                })
                .collect();
            let surface = batches.iter().any(|b| b.surface != 0).then_some(surface_lines);
            surface_lines += usize::from(surface.is_some());
            LineRoles {
                has_rim: batches.iter().any(|b| b.rim != 0),
                driven: batches.iter().any(|b| b.driven != 0),
                plain: batches.iter().all(|b| b.rim == 0 && b.held == [0; 3]),
                surface,
                batches,
            }
        };
        let of_lines = lines.lines.iter().map(&mut of_line).collect();
        Roles { of_lines, surface_lines, boundary, driven }
    }
}

/// Roles by node.
fn bits(mesh: &Mesh, road: bool) -> Vec<u8> {
    let mut bits = vec![0; mesh.nodes.len()];
    mesh.rim.iter().for_each(|n| bits[*n as usize] |= RIM);
    if road {
        mesh.surface.iter().for_each(|n| bits[*n as usize] |= SURFACE);
    }
    for (bits, held) in bits.iter_mut().zip(&mesh.held) {
        *bits |= (held & 0b111) * HELD;
    }
    bits
}

fn batch(nodes: &[u32], of_nodes: &[u8], boundary: usize) -> NodeBatch {
    let lanes = |bit: u8| {
        let with = nodes.iter().enumerate().filter(|(_, n)| of_nodes[**n as usize] & bit != 0);
        with.fold(0, |mask, (lane, _)| mask | 1 << lane)
    };
    NodeBatch {
        rim: lanes(RIM),
        surface: lanes(SURFACE),
        held: [0, 1, 2].map(|d| lanes(HELD << d)),
        boundary: boundary as u32,
        driven: 0,
    }
}

/// Whether each of `count` nodes is one of a set's.
fn members(nodes: &[u32], count: usize) -> Vec<bool> {
    let mut is_one = vec![false; count];
    nodes.iter().for_each(|&n| is_one[n as usize] = true);
    is_one
}

/// What the driven sets have of a batch.
fn parts(nodes: &[u32], mesh: &Mesh, sets: &[Vec<bool>]) -> Vec<DrivenPart> {
    let part = |(number, (set, driven)): (usize, (&Vec<bool>, &Driven))| {
        let of_set = nodes.iter().enumerate().filter(|(_, n)| set[**n as usize]);
        let lanes = of_set.fold(0, |mask, (lane, _)| mask | 1 << lane);
        let lanes = driven.components.map(|prescribed| if prescribed { lanes } else { 0 });
        (lanes != [0; 3]).then_some(DrivenPart { set: number as u32, lanes })
    };
    sets.iter().zip(&mesh.driven).enumerate().filter_map(part).collect()
}
