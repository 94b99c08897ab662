//! Arrays of whole numbers as node sets.

use std::collections::BTreeMap;

use super::super::raw::RawSet;
use super::Cells;
use super::arrays::{Array, File};
use crate::error::Result;

/// Values of an array that names regions; one with more is a number of something.
const MOST: usize = 64;

/// Sets of a file's arrays. Cells need not be hexahedra: quadrilaterals name surfaces.
pub fn of(file: &File, points: usize, cells: &Cells) -> Result<Vec<RawSet>> {
    let mut sets = Vec::new();
    let single =
        |a: &&Array| a.is_whole() && a.components == 1 && !a.name.starts_with("vtk") && !a.name.is_empty();
    for array in file.of("PointData").filter(single) {
        let values = array.integers()?;
        if values.len() != points {
            return Err(file.damaged(
                "PointData",
                format!("{} values of {:?} for {points} points", values.len(), array.name),
            ));
        }
        add(&array.name, "nodes with", values.iter().enumerate().map(|(n, &v)| (v, [n as u32])), &mut sets);
    }
    for array in file.of("CellData").filter(single) {
        let values = array.integers()?;
        if values.len() != cells.count() {
            let problem = format!("{} values of {:?} for {} cells", values.len(), array.name, cells.count());
            return Err(file.damaged("CellData", problem));
        }
        let of_cells = values.iter().enumerate().map(|(c, &v)| (v, cells.nodes(c)));
        add(&array.name, "nodes of cells with", of_cells, &mut sets);
    }
    Ok(sets)
}

/// Adds the sets of an array: under its own name where its values are 0 and 1, else one a value but zero.
fn add<I: IntoIterator<Item = u32>>(
    name: &str,
    what: &str,
    values: impl Iterator<Item = (i64, I)>,
    sets: &mut Vec<RawSet>,
) {
    let mut by_value = BTreeMap::<i64, Vec<u32>>::new();
    for (value, nodes) in values.filter(|(v, _)| *v != 0) {
        if by_value.len() == MOST && !by_value.contains_key(&value) {
            return;
        }
        by_value.entry(value).or_default().extend(nodes);
    }
    let flag = by_value.keys().all(|&v| v == 1);
    for (value, mut nodes) in by_value {
        nodes.sort_unstable();
        nodes.dedup();
        let mut name = if flag { name.to_string() } else { format!("{name}={value}") };
        if sets.iter().any(|s| s.name == name) {
            name += ".cells";
        }
        sets.push(RawSet { meaning: format!("{what} {name}"), name, nodes });
    }
}
