//! Snapshots as vtkio reads them, which shares nothing with our reader.

use std::path::Path;

use hexroll::output::RunWriter;
use hexroll::record::Snapshot;
use vtkio::model::{Attribute, Attributes, CellType, DataSet, Piece, UnstructuredGridPiece, Vtk};

use crate::fixtures::*;

fn open(path: &Path) -> UnstructuredGridPiece {
    match Vtk::import(path).unwrap().data {
        DataSet::UnstructuredGrid { pieces, .. } => match pieces.into_iter().next().unwrap() {
            Piece::Inline(piece) => *piece,
            _ => panic!("not inline"),
        },
        _ => panic!("not an unstructured grid"),
    }
}

fn array(attributes: &[Attribute], name: &str) -> Vec<f64> {
    let found = attributes.iter().find_map(|a| match a {
        Attribute::DataArray(array) if array.name == name => array.data.cast_into::<f64>(),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("no array {name}"))
}

#[test]
fn finds_every_value_of_a_snapshot() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let written = snapshot(&mesh, 0.25);
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&written, "roll").unwrap();
    let piece = open(&dir.join("snapshot_0.vtu"));
    let Attributes { point, cell } = &piece.data;

    assert_eq!(piece.points.cast_into::<f64>().unwrap(), written.x.as_flattened());
    assert_eq!(array(point, "velocity"), written.v.as_flattened());
    let displacement = array(point, "displacement");
    for (u, (x, X)) in displacement.as_chunks().0.iter().zip(written.x.iter().zip(&mesh.nodes)) {
        assert_eq!(*u, [x[0] - X[0], x[1] - X[1], x[2] - X[2]]);
    }
    let [force, pressure, state] =
        ["contact_force", "contact_pressure", "contact_state"].map(|name| array(point, name));
    for c in &written.contact {
        let n = c.node as usize;
        assert_eq!((&force[3 * n..3 * n + 3], pressure[n]), (&c.force[..], c.pressure));
        assert_eq!(state[n], f64::from(c.state as u8));
    }
    for &n in &mesh.rim {
        assert_eq!((force[3 * n as usize], pressure[n as usize]), (0.0, 0.0));
    }
    let [J, p, q] = [&written.volume_ratio, &written.pressure, &written.von_mises];
    for (name, field) in [("J", J), ("pressure", p), ("von_mises", q)] {
        assert_eq!(&array(cell, name), field, "{name}");
    }
}

/// VTK's hexahedron: corners 0-3 around the bottom, 4-7 above them, so that (0->1, 0->3, 0->4) is
/// right-handed and 6 is opposite 0 (VTK User's Guide, figure of the linear cells).
#[test]
fn finds_hexahedra_with_vtks_corners() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let written = Snapshot { x: mesh.nodes.clone(), ..snapshot(&mesh, 0.0) };
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&written, "roll").unwrap();
    let piece = open(&dir.join("snapshot_0.vtu"));
    assert_eq!(piece.cells.types, vec![CellType::Hexahedron; mesh.hexes.len()]);
    let points = piece.points.cast_into::<f64>().unwrap();
    let (corners, ends) = piece.cells.cell_verts.into_xml();
    assert!(ends.into_iter().eq((1..=mesh.hexes.len() as u64).map(|e| 8 * e)));
    for hex in corners.as_chunks::<8>().0 {
        let p = hex.map(|n| glam::DVec3::from_slice(&points[3 * n as usize..]));
        assert!((p[1] - p[0]).cross(p[3] - p[0]).dot(p[4] - p[0]) > 0.0);
        // Each of VTK's twelve edges is shorter than each of the diagonals 0-6, 1-7, 2-4, 3-5.
        let length = |(a, b): (usize, usize)| p[a].distance(p[b]);
        let shortest = [(0, 6), (1, 7), (2, 4), (3, 5)].map(length).into_iter().fold(f64::INFINITY, f64::min);
        let rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)];
        let uprights = (0..4).map(|a| (a, a + 4));
        assert!(rings.into_iter().chain(uprights).all(|edge| length(edge) < shortest));
    }
}
