//! `snapshot_<k>.vtu`: a mesh and a [`Snapshot`] as one VTK grid, complete enough to read both back.
//!
//! | section | array | content |
//! |---|---|---|
//! | points | `points` | current positions x [m] |
//! | cells | `connectivity`, `offsets`, `types` | hexahedra (VTK type 12, whose corners are numbered as ours) |
//! | point | `displacement` | x - X [m]; X comes back to round-off |
//! | point | `velocity` | half a step before the file's time [m/s] (at it after implicit stages) |
//! | point | `node_set` | 0 inside, 1 surface (can touch the road), 2 rim |
//! | point | `contact_force` | mean over the last window, road on node [N]: half a window older than the points |
//! | point | `contact_pressure`, `contact_area`, `slip_speed` | mean normal force over area [Pa], [m2], [m/s]; zero off the surface |
//! | point | `friction_energy` | dissipated by friction at the node since the start [J]; zero off the surface |
//! | point | `contact_state` | 0 free or off the surface, 1 sticks, 2 slips |
//! | cell | `J`, `pressure`, `von_mises` | mean volume ratio [-], mean -tr(sigma)/3 [Pa], mean stress [Pa] |
//! | field | `TimeValue`, `step` | time [s], step |
//! | field | `force_time` | length of the window that the contact forces are means over [s] |
//! | field | `stage` | name of the stage, UTF-8 bytes |
//! | field | `axle_reference` | the mesh's axle point before the start [m] |
//! | field | `axle`, `rim_rotation` | axle's position [m], rotation of the rim (rows); only with a rim |
//!
//! Forces of a window and points of its end do not belong together where the body moves: a node was
//! at about x - v `force_time` / 2 when it had its mean force, and so was the axle (as in `contact_<k>.csv`).
//!
//! Without a road the contact arrays are missing. Numbers are `f64`: comparing runs needs every digit.

use std::path::Path;

use super::vtu::{Array, Grid, Section::*};
use crate::Result;
use crate::model::mesh::{Mesh, boundary};
use crate::record::{ContactNode, ContactState, Snapshot};

/// VTK's number for an eight-node hexahedron.
const VTK_HEXAHEDRON: u8 = 12;

/// Values of `node_set`.
const SURFACE: u8 = 1;
const RIM: u8 = 2;

const STATES: [ContactState; 3] = [ContactState::Free, ContactState::Stick, ContactState::Slip];

/// What a snapshot file holds.
#[derive(Debug, Clone)]
pub struct Stored {
    /// Name of the stage.
    pub stage: String,
    pub mesh: Mesh,
    pub snapshot: Snapshot,
}

/// Writes a snapshot of `mesh`.
///
/// # Panics
/// If the snapshot's fields do not have the mesh's sizes.
pub fn write(
    out: &mut dyn std::io::Write,
    mesh: &Mesh,
    snapshot: &Snapshot,
    stage: &str,
) -> std::io::Result<()> {
    let (nodes, cells) = (mesh.nodes.len(), mesh.hexes.len());
    assert_eq!([snapshot.x.len(), snapshot.v.len()], [nodes; 2], "node fields of another mesh");
    let fields = [&snapshot.volume_ratio, &snapshot.pressure, &snapshot.von_mises];
    assert_eq!(fields.map(Vec::len), [cells; 3], "element fields of another mesh");

    let mut arrays = field_data(mesh, snapshot, stage);
    arrays.extend(grid(mesh, snapshot));
    arrays.extend(point_data(mesh, snapshot));
    let names = ["J", "pressure", "von_mises"];
    arrays.extend(names.into_iter().zip(fields).map(|(name, f)| Array::new(CellData, name, 1, f)));
    super::vtu::write(out, nodes, cells, &arrays)
}

fn field_data<'a>(mesh: &'a Mesh, snapshot: &'a Snapshot, stage: &'a str) -> Vec<Array<'a>> {
    let mut arrays = vec![
        Array::new(FieldData, "TimeValue", 1, vec![snapshot.time]),
        Array::new(FieldData, "step", 1, vec![snapshot.step]),
        Array::new(FieldData, "force_time", 1, vec![snapshot.force_time]),
        Array::new(FieldData, "stage", 1, stage.as_bytes()),
        Array::new(FieldData, "axle_reference", 3, &mesh.axle[..]),
    ];
    if let Some((axle, rotation)) = &snapshot.axle {
        arrays.push(Array::new(FieldData, "axle", 3, &axle[..]));
        arrays.push(Array::new(FieldData, "rim_rotation", 9, rotation.as_flattened()));
    }
    arrays
}

fn grid<'a>(mesh: &Mesh, snapshot: &'a Snapshot) -> [Array<'a>; 4] {
    let connectivity: Vec<i32> = mesh.hexes.as_flattened().iter().map(|&n| n as i32).collect();
    let ends: Vec<i32> = (1..=mesh.hexes.len()).map(|e| 8 * e as i32).collect();
    [
        Array::new(Points, "points", 3, snapshot.x.as_flattened()),
        Array::new(Cells, "connectivity", 1, connectivity),
        Array::new(Cells, "offsets", 1, ends),
        Array::new(Cells, "types", 1, vec![VTK_HEXAHEDRON; mesh.hexes.len()]),
    ]
}

fn point_data<'a>(mesh: &Mesh, snapshot: &'a Snapshot) -> Vec<Array<'a>> {
    let moved = snapshot.x.iter().zip(&mesh.nodes).map(|(x, X)| std::array::from_fn(|d| x[d] - X[d]));
    let displacement: Vec<[f64; 3]> = moved.collect();
    let mut sets = vec![0; mesh.nodes.len()];
    mesh.surface.iter().for_each(|&n| sets[n as usize] = SURFACE);
    mesh.rim.iter().for_each(|&n| sets[n as usize] = RIM);
    let mut arrays = vec![
        Array::new(PointData, "displacement", 3, displacement.as_flattened().to_vec()),
        Array::new(PointData, "velocity", 3, snapshot.v.as_flattened()),
        Array::new(PointData, "node_set", 1, sets),
    ];
    if !snapshot.contact.is_empty() {
        let forces = scatter(mesh, snapshot, |c| c.force).as_flattened().to_vec();
        arrays.extend([
            Array::new(PointData, "contact_force", 3, forces),
            Array::new(PointData, "contact_pressure", 1, scatter(mesh, snapshot, |c| c.pressure)),
            Array::new(PointData, "contact_area", 1, scatter(mesh, snapshot, |c| c.area)),
            Array::new(PointData, "slip_speed", 1, scatter(mesh, snapshot, |c| c.slip_speed)),
            Array::new(PointData, "friction_energy", 1, scatter(mesh, snapshot, |c| c.friction_energy)),
            Array::new(PointData, "contact_state", 1, scatter(mesh, snapshot, |c| c.state as u8)),
        ]);
    }
    arrays
}

/// A contact value at every node of the mesh, zero off the surface.
fn scatter<T: Default + Clone>(
    mesh: &Mesh,
    snapshot: &Snapshot,
    value: impl Fn(&ContactNode) -> T,
) -> Vec<T> {
    let mut all = vec![T::default(); mesh.nodes.len()];
    snapshot.contact.iter().for_each(|c| all[c.node as usize] = value(c));
    all
}

/// Reads a snapshot and its mesh.
///
/// # Errors
/// [`Error::Io`](crate::Error::Io), or [`Error::Format`](crate::Error::Format) with the path and what is
/// wrong: a truncated file, a missing array, cells that are not hexahedra, nodes that do not exist.
pub fn read(path: &Path) -> Result<Stored> {
    let grid = Grid::read(path)?;
    let scalar = |section, name| grid.get::<f64>(section, name, 1, Some(grid.cells));
    let x = vectors(&grid, Points, "points", grid.points)?;
    let displacement = vectors(&grid, PointData, "displacement", grid.points)?;
    let nodes = x.iter().zip(&displacement).map(|(x, u)| std::array::from_fn(|d| x[d] - u[d])).collect();
    let mesh = mesh(&grid, nodes)?;
    let axle = if grid.has(FieldData, "axle") {
        let rows = vectors(&grid, FieldData, "axle", 1)?;
        let rotation = grid.get::<f64>(FieldData, "rim_rotation", 9, Some(1))?;
        Some((rows[0], std::array::from_fn(|i| std::array::from_fn(|j| rotation[3 * i + j]))))
    } else {
        None
    };
    // Files of older versions do not say: their forces are taken as those of the end.
    let force_time = match grid.has(FieldData, "force_time") {
        true => grid.get(FieldData, "force_time", 1, Some(1))?[0],
        false => 0.0,
    };
    let snapshot = Snapshot {
        force_time,
        time: grid.get(FieldData, "TimeValue", 1, Some(1))?[0],
        step: grid.get(FieldData, "step", 1, Some(1))?[0],
        v: vectors(&grid, PointData, "velocity", grid.points)?,
        contact: contact(&grid, &mesh)?,
        volume_ratio: scalar(CellData, "J")?,
        pressure: scalar(CellData, "pressure")?,
        von_mises: scalar(CellData, "von_mises")?,
        axle,
        x,
    };
    let stage = String::from_utf8(grid.get(FieldData, "stage", 1, None)?)
        .map_err(|_| grid.bad("the stage's name is not UTF-8".into()))?;
    Ok(Stored { stage, mesh, snapshot })
}

fn vectors(grid: &Grid, section: super::vtu::Section, name: &str, count: usize) -> Result<Vec<[f64; 3]>> {
    Ok(grid.get::<f64>(section, name, 3, Some(count))?.as_chunks().0.to_vec())
}

fn mesh(grid: &Grid, nodes: Vec<[f64; 3]>) -> Result<Mesh> {
    let types = grid.get::<u8>(Cells, "types", 1, Some(grid.cells))?;
    if let Some(e) = types.iter().position(|&t| t != VTK_HEXAHEDRON) {
        return Err(grid.bad(format!("cell {e} is not a hexahedron (VTK type {})", types[e])));
    }
    let corners = grid.get::<i32>(Cells, "connectivity", 1, Some(8 * grid.cells))?;
    if let Some(n) = corners.iter().find(|&&n| usize::try_from(n).is_ok_and(|n| n < nodes.len()).eq(&false)) {
        return Err(grid.bad(format!("a cell has node {n}; nodes are 0 to {}", nodes.len() as i64 - 1)));
    }
    let hexes: Vec<[u32; 8]> = corners.as_chunks::<8>().0.iter().map(|hex| hex.map(|n| n as u32)).collect();
    let sets = grid.get::<u8>(PointData, "node_set", 1, Some(grid.points))?;
    let members = |set| (0..).zip(&sets).filter(|&(_, &s)| s == set).map(|(n, _)| n).collect();
    let axle = vectors(grid, FieldData, "axle_reference", 1)?[0];
    let facets = boundary(&hexes);
    Ok(Mesh { nodes, facets, hexes, rim: members(RIM), axle, surface: members(SURFACE), ..Mesh::default() })
}

fn contact(grid: &Grid, mesh: &Mesh) -> Result<Vec<ContactNode>> {
    if !grid.has(PointData, "contact_force") {
        return Ok(Vec::new());
    }
    let scalar = |name| grid.get::<f64>(PointData, name, 1, Some(grid.points));
    let force = vectors(grid, PointData, "contact_force", grid.points)?;
    let (pressure, area, slip_speed) =
        (scalar("contact_pressure")?, scalar("contact_area")?, scalar("slip_speed")?);
    let friction_energy = scalar("friction_energy")?;
    let states = grid.get::<u8>(PointData, "contact_state", 1, Some(grid.points))?;
    let node = |&node: &u32| {
        let n = node as usize;
        let state = *STATES
            .get(states[n] as usize)
            .ok_or_else(|| grid.bad(format!("node {n} has contact state {}; 0 to 2 exist", states[n])))?;
        let (force, area, pressure, slip_speed) = (force[n], area[n], pressure[n], slip_speed[n]);
        let friction_energy = friction_energy[n];
        Ok(ContactNode { node, force, area, pressure, slip_speed, friction_energy, state })
    };
    mesh.surface.iter().map(node).collect()
}
