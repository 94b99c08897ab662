//! Generators: what a scene says of a mesh, made into one. A generator is a file here and an arm below.

mod block;
mod grading;
mod grid;
mod ring;
mod words;

pub(super) use grading::turn;

use super::Mesh;
use crate::scene::{Grading, MeshSpec};

impl Mesh {
    /// The mesh that a scene describes, of elements of equal size.
    pub fn generate(spec: &MeshSpec) -> Mesh {
        Mesh::graded(spec, &Grading::default())
    }

    /// The mesh that a scene describes, without its offset, rim and holds.
    ///
    /// # Panics
    /// Of a mesh from a file, which [`Mesh::imported`] reads.
    pub fn graded(spec: &MeshSpec, grading: &Grading) -> Mesh {
        match *spec {
            MeshSpec::Ring { outer_radius, inner_radius, width, elements } => {
                ring::mesh([outer_radius, inner_radius], width, elements, grading)
            }
            MeshSpec::Block { size, elements } => block::mesh(size, elements, grading),
            MeshSpec::File(_) => panic!("a file is no generator"),
        }
    }
}
