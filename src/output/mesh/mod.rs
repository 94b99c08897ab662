//! Meshes for other programs: nodes, hexahedra and node sets, in metres, with every digit, so that what is read back is the same.

mod inp;
mod msh;
mod vtu;

pub use inp::write as write_inp;
pub use msh::{Msh, write as write_msh};
pub use vtu::write as write_vtu;

use crate::model::mesh::{Mesh, Numbers};

/// Numbers of nodes or elements: those of the file that the mesh is from, where a number is one thing, else from one on.
fn numbers(labels: Option<&Numbers>, count: usize) -> Vec<u64> {
    let each_once = |numbers: &[u64]| {
        let mut sorted = numbers.to_vec();
        sorted.sort_unstable();
        sorted.first() != Some(&0) && sorted.windows(2).all(|pair| pair[0] != pair[1])
    };
    let own = labels.filter(|l| l.of.len() == count && l.parts.len() <= 1 && each_once(&l.of));
    own.map_or_else(|| (1..=count as u64).collect(), |l| l.of.clone())
}

fn node_numbers(mesh: &Mesh) -> Vec<u64> {
    numbers(mesh.labels.as_ref().map(|l| &l.nodes), mesh.nodes.len())
}

fn element_numbers(mesh: &Mesh) -> Vec<u64> {
    numbers(mesh.labels.as_ref().map(|l| &l.elements), mesh.hexes.len())
}
