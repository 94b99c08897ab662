//! The outer faces of a mesh, found from its elements alone.

use std::collections::HashMap;

use super::FACES;

/// Faces that belong to one element only, counter-clockwise seen from outside, in the order of the elements.
pub fn boundary(hexes: &[[u32; 8]]) -> Vec<[u32; 4]> {
    let key = |mut face: [u32; 4]| {
        face.sort_unstable();
        face
    };
    let faces = || hexes.iter().flat_map(|hex| FACES.map(|face| face.map(|c| hex[c])));
    let mut count = HashMap::new();
    faces().for_each(|face| *count.entry(key(face)).or_insert(0_u32) += 1);
    faces().filter(|&face| count[&key(face)] == 1).collect()
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
