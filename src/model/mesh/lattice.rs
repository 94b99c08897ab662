//! Meshes whose numbers are those of a lattice: what tables would say follows from the numbers.

use super::SIGNS;

/// Node (i, j, k) is number (k rows + j) row + i, elements likewise, and xi, eta, zeta of an element are along i, j, k.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lattice {
    /// Elements along i, j, k.
    pub elements: [usize; 3],
    /// Whether rows along i close on themselves.
    pub closed: bool,
}

impl Lattice {
    /// The lattice that these elements are numbered by, if there is one that has all of them and `nodes` nodes.
    pub fn of(hexes: &[[u32; 8]], nodes: usize) -> Option<Lattice> {
        // The first element's corners say how many nodes there are along i, and in a layer.
        let first = hexes.first()?;
        let (row, layer) = (first[3] as usize, first[4] as usize);
        if row == 0 || layer == 0 || !layer.is_multiple_of(row) {
            return None;
        }
        let closed = hexes.get(row - 1).is_some_and(|h| h[0] as usize == row - 1);
        let along = if closed { row } else { row - 1 };
        let across = layer / row - 1;
        let per_layer = along * across;
        if per_layer == 0 || !hexes.len().is_multiple_of(per_layer) {
            return None;
        }
        let lattice = Lattice { elements: [along, across, hexes.len() / per_layer], closed };
        let all = hexes.iter().enumerate().all(|(e, hex)| lattice.hex(e) == *hex);
        (lattice.node_count() == nodes && all).then_some(lattice)
    }

    /// Nodes along i.
    pub fn row(&self) -> usize {
        self.elements[0] + usize::from(!self.closed)
    }

    pub fn node_count(&self) -> usize {
        self.row() * (self.elements[1] + 1) * (self.elements[2] + 1)
    }

    /// Number of a node; i may be one beyond the end of a closed row.
    pub fn node(&self, [i, j, k]: [usize; 3]) -> u32 {
        ((k * (self.elements[1] + 1) + j) * self.row() + i % self.row()) as u32
    }

    /// Corners of element `e`.
    pub fn hex(&self, e: usize) -> [u32; 8] {
        let [along, across, _] = self.elements;
        let at = [e % along, e / along % across, e / along / across];
        SIGNS.map(|s| self.node(std::array::from_fn(|d| at[d] + usize::from(s[d] > 0.0))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::Mesh;
    use crate::scene::MeshSpec;

    fn meshes() -> Vec<(Mesh, Lattice)> {
        let ring = |[around, through, across]: [usize; 3]| {
            let elements = [around, through, across];
            let spec = MeshSpec::Ring { outer_radius: 2.0, inner_radius: 1.0, width: 0.5, elements };
            (Mesh::generate(&spec), Lattice { elements: [around, across, through], closed: true })
        };
        let block = |elements| {
            let mesh = Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements });
            (mesh, Lattice { elements, closed: false })
        };
        vec![
            ring([3, 1, 1]),
            ring([44, 4, 5]),
            ring([7, 1, 3]),
            block([1, 1, 1]),
            block([1, 4, 1]),
            block([5, 1, 2]),
            block([2, 3, 4]),
        ]
    }

    #[test]
    fn generated_meshes_are_lattices() {
        for (mesh, lattice) in meshes() {
            assert_eq!(mesh.lattice(), Some(lattice));
        }
    }

    #[test]
    fn other_numbers_and_missing_elements_are_none() {
        for (mesh, lattice) in meshes() {
            let swap = |n: u32| if n < 2 { 1 - n } else { n };
            let renumbered: Vec<_> = mesh.hexes.iter().map(|hex| hex.map(swap)).collect();
            assert_eq!(Lattice::of(&renumbered, mesh.nodes.len()), None, "{lattice:?}");
            assert_eq!(Lattice::of(&mesh.hexes, mesh.nodes.len() + 1), None, "{lattice:?}");
            // What is left of a closed row may be an open one.
            let fewer = &mesh.hexes[..mesh.hexes.len() - 1];
            assert_ne!(Lattice::of(fewer, mesh.nodes.len()), Some(lattice));
        }
    }
}
