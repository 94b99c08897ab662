//! Meshes whose numbering is a generator's: what tables would say follows from the numbers.

use crate::model::mesh::Mesh;

/// Chains side by side in a work group.
pub const LANES: usize = 64;

/// Node (i, j, k) is number (k rows + j) row + i; elements likewise; corners 4 to 7 of an element are one k above
/// corners 0 to 3. Rows are open, or close on themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lattice {
    /// Nodes along i, and along j.
    pub row: usize,
    pub rows: usize,
    /// Elements along i, j, k.
    pub elements: [usize; 3],
}

impl Lattice {
    /// The lattice that all of a mesh is numbered by, if there is one.
    pub fn of(mesh: &Mesh) -> Option<Lattice> {
        let lattice = mesh.lattice()?;
        let elements = lattice.elements;
        Some(Lattice { row: lattice.row(), rows: elements[1] + 1, elements })
    }

    /// Columns of elements.
    pub fn columns(&self) -> usize {
        self.elements[0] * self.elements[1]
    }

    /// Rows that a group of `columns` columns, one after the other, may touch: so many ends of rows, or of itself, it
    /// may have.
    pub fn row_ends(&self, columns: usize) -> usize {
        // The worst group begins at the last column of a row.
        ((columns - 1).div_ceil(self.elements[0]) + 1).min(self.elements[1])
    }

    /// Elements of a chain, and of one of the last layer, if none may have more than `longest`.
    pub fn lengths(&self, longest: usize) -> [usize; 2] {
        let tall = self.elements[2];
        let length = tall.div_ceil(tall.div_ceil(longest));
        [length, tall - (tall.div_ceil(length) - 1) * length]
    }

    /// Values of the constants that shaders compute with.
    pub fn constants(&self, longest: usize) -> [(&'static str, f64); 7] {
        let [length, last] = self.lengths(longest);
        [
            ("lattice_row", self.row),
            ("lattice_rows", self.rows),
            ("lattice_columns", self.elements[0]),
            ("lattice_groups", self.columns().div_ceil(LANES)),
            ("lattice_length", length),
            ("lattice_layers", self.elements[2].div_ceil(length)),
            ("lattice_last", last),
        ]
        .map(|(name, value)| (name, value as f64))
    }

    /// Chains of at most `longest` elements, layer by layer.
    pub fn chains(&self, longest: usize) -> Vec<Vec<Vec<u32>>> {
        let ([length, _], columns, tall) = (self.lengths(longest), self.columns(), self.elements[2]);
        let chain = |column: usize, k: usize| {
            (k..(k + length).min(tall)).map(|k| (k * columns + column) as u32).collect()
        };
        (0..tall).step_by(length).map(|k| (0..columns).map(|column| chain(column, k)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mesh::Mesh;
    use crate::scene::MeshSpec;

    fn ring(elements: [usize; 3]) -> Mesh {
        let spec = MeshSpec::Ring { outer_radius: 2.0, inner_radius: 1.0, width: 0.5, elements };
        Mesh::generate(&spec)
    }

    /// Rings are closed, blocks are open, however flat.
    #[test]
    fn generated_meshes_are_lattices() {
        for [around, through, across] in [[7, 3, 2], [8, 1, 1], [3, 2, 1]] {
            let lattice = Lattice::of(&ring([around, through, across])).unwrap();
            assert_eq!(
                lattice,
                Lattice { row: around, rows: across + 1, elements: [around, across, through] }
            );
        }
        for elements in [[7, 3, 2], [1, 1, 1], [2, 1, 5], [1, 4, 1]] {
            let mesh = Mesh::generate(&MeshSpec::Block { size: [1.0; 3], elements });
            let [i, j, _] = elements;
            assert_eq!(Lattice::of(&mesh), Some(Lattice { row: i + 1, rows: j + 1, elements }));
        }
    }

    /// One element that is numbered otherwise, or one node that none has, and the mesh needs its tables.
    #[test]
    fn other_numberings_are_no_lattices() {
        let mut turned = ring([6, 3, 2]);
        turned.hexes[17].rotate_left(4);
        assert_eq!(Lattice::of(&turned), None);
        let mut swapped = ring([6, 3, 2]);
        swapped.hexes.swap(4, 5);
        assert_eq!(Lattice::of(&swapped), None);
        let mut more = ring([6, 3, 2]);
        more.nodes.push([0.0; 3]);
        assert_eq!(Lattice::of(&more), None);
    }

    /// Counted group by group: never more, and reached by some row length that has a group begin at a row's last column.
    #[test]
    fn a_group_has_no_more_ends_than_rows_it_touches() {
        for (row, rows) in (1..150).flat_map(|row| [(row, 100), (row, 4)]) {
            let lattice = Lattice { row, rows, elements: [row, rows - 1, 1] };
            let touched = |first: usize| (first + 63).min(lattice.columns() - 1) / row - first / row + 1;
            let most = (0..lattice.columns()).step_by(64).map(touched).max().unwrap();
            assert!(most <= lattice.row_ends(64), "rows of {row}");
            assert!(row % 2 == 0 || rows < 100 || most == lattice.row_ends(64), "rows of {row}");
        }
    }

    #[test]
    fn chains_of_a_column_are_about_equal() {
        let lattice = Lattice::of(&ring([4, 20, 2])).unwrap();
        assert_eq!(lattice.lengths(32), [20, 20]);
        assert_eq!(lattice.lengths(16), [10, 10]);
        assert_eq!(lattice.lengths(8), [7, 6]);
        assert_eq!(lattice.lengths(1), [1, 1]);
    }
}
