//! VTK's grid of a mesh, with an array of zeros and ones for each node set.

use std::io::{Result, Write};

use crate::model::mesh::Mesh;
use crate::output::vtu::{Array, Section::*, write as write_arrays};

/// VTK's number for an eight-node hexahedron, whose corners are numbered as ours.
const HEXAHEDRON: u8 = 12;

/// Writes nodes [m], hexahedra and node sets.
pub fn write(out: &mut dyn Write, mesh: &Mesh) -> Result<()> {
    let connectivity: Vec<i32> = mesh.hexes.as_flattened().iter().map(|&n| n as i32).collect();
    let ends: Vec<i32> = (1..=mesh.hexes.len()).map(|e| 8 * e as i32).collect();
    let mut arrays = vec![
        Array::new(Points, "points", 3, mesh.nodes.as_flattened()),
        Array::new(Cells, "connectivity", 1, connectivity),
        Array::new(Cells, "offsets", 1, ends),
        Array::new(Cells, "types", 1, vec![HEXAHEDRON; mesh.hexes.len()]),
    ];
    for set in mesh.sets.iter() {
        let mut members = vec![0_u8; mesh.nodes.len()];
        set.nodes.iter().for_each(|&n| members[n as usize] = 1);
        arrays.push(Array::new(PointData, set.name.clone(), 1, members));
    }
    write_arrays(out, mesh.nodes.len(), mesh.hexes.len(), &arrays)
}
