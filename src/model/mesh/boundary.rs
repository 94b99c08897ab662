//! The outer faces of a mesh, found from its elements alone.

use super::faces::{Faces, nodes_of};

/// Faces that belong to one element only, counter-clockwise seen from outside, in the order of the elements.
pub fn boundary(hexes: &[[u32; 8]]) -> Vec<[u32; 4]> {
    Faces::of(hexes).outer().map(|face| nodes_of(hexes, face)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::Mesh;
    use crate::scene::MeshSpec;

    /// Generators know their outer faces; the elements alone give the same ones in the same order.
    #[test]
    fn generators_and_elements_agree_on_the_boundary() {
        let ring = MeshSpec::Ring { outer_radius: 2.0, inner_radius: 1.0, width: 0.5, elements: [9, 2, 3] };
        for spec in [ring, MeshSpec::Block { size: [1.0; 3], elements: [2, 3, 4] }] {
            let mesh = Mesh::generate(&spec);
            assert_eq!(boundary(&mesh.hexes), mesh.facets);
        }
    }
}
