//! VTK's XML files of unstructured grids (`.vtu`): text, base64 or raw, compressed by zlib or not.
//!
//! Arrays of whole numbers become node sets: those of points directly, those of cells (regions) as the nodes of their cells. An
//! array of zeros and ones is a set under its own name, another one a set a value.
//!
//! Format: VTK User's Guide, "XML File Formats"; "VTK XML Formats" of VTK's documentation.

mod arrays;
mod decode;
mod sets;

use super::numbers::sane;
use super::raw::Raw;
use super::source::{Place, Source};
use crate::error::Result;
use crate::model::mesh::{Labels, Numbers};
use crate::scene::MeshFile;
use arrays::File;

/// VTK's numbers of cells.
const HEXAHEDRON: u64 = 12;
const VOXEL: u64 = 11;
/// Cells of three dimensions that are no hexahedra of eight nodes.
const OTHERS: [(u64, &str); 12] = [
    (10, "tetrahedron"),
    (13, "wedge"),
    (14, "pyramid"),
    (24, "quadratic tetrahedron"),
    (25, "quadratic hexahedron"),
    (26, "quadratic wedge"),
    (27, "quadratic pyramid"),
    (29, "triquadratic hexahedron"),
    (33, "biquadratic quadratic hexahedron"),
    (42, "polyhedron"),
    (71, "Lagrange tetrahedron"),
    (72, "Lagrange hexahedron"),
];

/// The mesh of a `.vtu` file.
pub fn read(file: &MeshFile) -> Result<Raw> {
    let place = Place { file: file.path.clone(), line: None };
    if file.revolve.is_some() {
        return Err(place.error(
            "body.mesh.revolve",
            "sections are not read from .vtu",
            "write the section as .inp or .msh",
        ));
    }
    let mut source = Source::open(&file.path)?;
    let bytes = source.whole()?;
    let grid = File::parse(&bytes, place.clone())?;
    let nodes = points(&grid)?;
    let cells = Cells::read(&grid, nodes.len())?;
    let Hexahedra { hexes, notes, cells: kept } = cells.hexahedra(&file.drop, &place)?;
    let sets = sets::of(&grid, nodes.len(), &cells)?;
    // Numbers from zero are what viewers of such files show.
    let labels = Labels {
        nodes: Numbers { of: (0..nodes.len() as u64).collect(), parts: Vec::new() },
        elements: Numbers { of: kept.iter().map(|&c| c as u64).collect(), parts: Vec::new() },
        hash: String::new(),
    };
    Ok(Raw { nodes, hexes, labels, sets, notes, format: "VTK grid".into(), ..Raw::default() })
}

fn points(file: &File) -> Result<Vec<[f64; 3]>> {
    let array = file.only("Points")?;
    let values = array.reals()?;
    if values.len() != 3 * file.points {
        let problem = format!("{} numbers are no {} points of three coordinates", values.len(), file.points);
        return Err(file.damaged("Points", problem));
    }
    if u32::try_from(file.points).is_err() {
        return Err(file.damaged("Points", format!("{} points are too many", file.points)));
    }
    for value in &values {
        sane(*value).map_err(|problem| file.damaged("Points", problem))?;
    }
    Ok(values.as_chunks().0.to_vec())
}

/// The cells of a grid.
pub struct Cells {
    connectivity: Vec<u64>,
    /// Ends of the cells in it.
    ends: Vec<u64>,
    kinds: Vec<u64>,
}

/// Hexahedra of a grid.
struct Hexahedra {
    hexes: Vec<[u32; 8]>,
    /// What is left out, in words.
    notes: Vec<String>,
    /// The cells that they are.
    cells: Vec<usize>,
}

impl Cells {
    fn read(file: &File, points: usize) -> Result<Cells> {
        let numbers = |name: &str| file.array("Cells", name)?.wholes();
        let cells = Cells {
            connectivity: numbers("connectivity")?,
            ends: numbers("offsets")?,
            kinds: numbers("types")?,
        };
        for (name, values) in [("offsets", &cells.ends), ("types", &cells.kinds)] {
            if values.len() != file.cells {
                let problem = format!("{} {name} where {} cells are announced", values.len(), file.cells);
                return Err(file.damaged("Cells", problem));
            }
        }
        let mut begin = 0;
        for (c, &end) in cells.ends.iter().enumerate() {
            if end < begin || end > cells.connectivity.len() as u64 {
                return Err(file.damaged(
                    "Cells",
                    format!("cell {c} ends at entry {end} of {}", cells.connectivity.len()),
                ));
            }
            begin = end;
        }
        match cells.connectivity.iter().find(|&&n| n >= points as u64) {
            Some(n) => {
                Err(file.damaged("Cells", format!("a cell has the point {n}, and there are {points}")))
            }
            None => Ok(cells),
        }
    }

    /// Points of a cell.
    pub fn nodes(&self, cell: usize) -> impl Iterator<Item = u32> + '_ {
        let begin = cell.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        self.connectivity[begin..self.ends[cell] as usize].iter().map(|&n| n as u32)
    }

    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// The hexahedra of the grid.
    fn hexahedra(&self, drop: &[String], place: &Place) -> Result<Hexahedra> {
        let (mut hexes, mut kept) = (Vec::new(), Vec::new());
        let mut others = std::collections::BTreeMap::<&str, usize>::new();
        for (cell, &kind) in self.kinds.iter().enumerate() {
            if kind != HEXAHEDRON && kind != VOXEL {
                if let Some((_, name)) = OTHERS.iter().find(|o| o.0 == kind) {
                    *others.entry(name).or_default() += 1;
                }
                continue;
            }
            let nodes: Vec<u32> = self.nodes(cell).collect();
            let Ok(corners) = <[u32; 8]>::try_from(nodes) else {
                let problem = format!("cell {cell} is a hexahedron of {} points", self.nodes(cell).count());
                return Err(place.error("Cells", problem, "the file is damaged: write it again"));
            };
            let [a, b, c, d, e, f, g, h] = corners;
            // A voxel's points are in the order of their coordinates.
            hexes.push(if kind == VOXEL { [a, b, d, c, e, f, h, g] } else { corners });
            kept.push(cell);
        }
        let (left_out, refused): (Vec<_>, Vec<_>) =
            others.iter().partition(|(name, _)| drop.iter().any(|d| d.eq_ignore_ascii_case(name)));
        if !refused.is_empty() {
            let list: Vec<String> = refused.iter().map(|(name, n)| format!("{n} of type {name:?}")).collect();
            let problem = format!("cells that are no hexahedra of eight points: {}", list.join(", "));
            return Err(place.error("Cells", problem, "mesh with hexahedra of eight nodes alone"));
        }
        if hexes.is_empty() {
            return Err(place.error(
                "Cells",
                "there are no hexahedra in this file",
                "write cells of type 12",
            ));
        }
        let notes = left_out
            .iter()
            .map(|(name, n)| format!("{n} cells of type {name:?} are left out (body.mesh.drop)"));
        Ok(Hexahedra { hexes, notes: notes.collect(), cells: kept })
    }
}
