//! Meshes of generators whose nodes stand in a logical grid.

use crate::model::mesh::{FACES, Lattice, Mesh, NodeSets};

/// A logically rectangular grid of nodes.
pub struct Grid {
    pub lattice: Lattice,
    /// Positions by number [m].
    pub nodes: Vec<[f64; 3]>,
}

/// A face of the grid that is a node set.
pub struct Face {
    pub name: &'static str,
    pub meaning: &'static str,
    /// Logical direction that it is square to, and whether it is at its far end.
    pub direction: usize,
    pub far: bool,
}

impl Grid {
    pub fn into_mesh(self, faces: &[Face], axle: [f64; 3], description: String) -> Mesh {
        let lattice = &self.lattice;
        let hexes: Vec<[u32; 8]> = (0..lattice.elements.iter().product()).map(|e| lattice.hex(e)).collect();
        let facets = self.facets(&hexes);
        let mut sets = NodeSets::default();
        faces.iter().for_each(|face| sets.insert(face.name, face.meaning, self.nodes_of(face)));
        let surface = Mesh::boundary_nodes(&facets);
        Mesh { nodes: self.nodes, hexes, facets, sets, axle, description, surface, ..Mesh::default() }
    }

    /// Faces of elements at the ends of the directions, in the order of the elements.
    fn facets(&self, hexes: &[[u32; 8]]) -> Vec<[u32; 4]> {
        let [ni, nj, nk] = self.lattice.elements;
        let mut facets = Vec::new();
        for (e, hex) in hexes.iter().enumerate() {
            let ends = |at: usize, n: usize| [at == 0, at + 1 == n];
            let [i0, i1] = if self.lattice.closed { [false; 2] } else { ends(e % ni, ni) };
            let ([j0, j1], [k0, k1]) = (ends(e / ni % nj, nj), ends(e / ni / nj, nk));
            for (face, outside) in FACES.iter().zip([i0, i1, j0, j1, k0, k1]) {
                if outside {
                    facets.push(face.map(|c| hex[c]));
                }
            }
        }
        facets
    }

    /// Nodes of a face, ascending.
    fn nodes_of(&self, face: &Face) -> Vec<u32> {
        let [_, nj, nk] = self.lattice.elements;
        let end = if face.far { self.lattice.elements[face.direction] } else { 0 };
        let mut nodes = Vec::new();
        for k in 0..=nk {
            for j in 0..=nj {
                for i in 0..self.lattice.row() {
                    if [i, j, k][face.direction] == end {
                        nodes.push(self.lattice.node([i, j, k]));
                    }
                }
            }
        }
        nodes
    }
}
