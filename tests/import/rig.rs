//! Files in a folder of their own, read as meshes.

use std::path::Path;

use hexroll::model::mesh::Mesh;
use hexroll::scene::{Axis, Gaps, LengthUnit, MeshFile};
use hexroll::{Error, Result};
use tempfile::TempDir;

/// A file in metres, its axle along y, nothing said of the rest.
pub fn metres(path: &Path) -> MeshFile {
    MeshFile {
        path: path.into(),
        unit: LengthUnit { name: "m".into(), metres: 1.0 },
        axis: Axis::Y,
        axle: None,
        merge: None,
        revolve: None,
        gaps: Gaps::Refuse,
        drop: Vec::new(),
    }
}

/// The mesh of a text, as if it stood in a file of that name; `change`: how the scene takes it.
pub fn read_with(name: &str, text: impl AsRef<[u8]>, change: impl FnOnce(&mut MeshFile)) -> Result<Mesh> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    let mut file = metres(&path);
    change(&mut file);
    Mesh::imported(&file, None)
}

pub fn read(name: &str, text: impl AsRef<[u8]>) -> Result<Mesh> {
    read_with(name, text, |_| {})
}

/// Line, problem and remedy of the error that a file must be answered with.
pub fn refused(name: &str, text: impl AsRef<[u8]>) -> (Option<usize>, String, String) {
    parts(read(name, text).map(|mesh| mesh.description))
}

pub fn parts<T: std::fmt::Debug>(result: Result<T>) -> (Option<usize>, String, String) {
    match result {
        Err(Error::Scene { line, problem, remedy, .. }) => {
            assert!(!problem.is_empty() && !remedy.is_empty());
            (line, problem, remedy)
        }
        other => panic!("{other:?}"),
    }
}

/// A deck of a unit cube with the corners 1 to 8, and what comes behind.
pub fn cube(behind: &str) -> String {
    format!(
        "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n\
         8, 0., 1., 1.\n*ELEMENT, TYPE=C3D8, ELSET=ALL_OF_IT\n1, 1, 2, 3, 4, 5, 6, 7, 8\n{behind}"
    )
}

/// Nodes of a set by the numbers of the file.
pub fn numbers(mesh: &Mesh, set: &str) -> Vec<String> {
    let nodes = mesh.set(set).unwrap_or_else(|e| panic!("{e:?}"));
    nodes.iter().map(|&n| mesh.labels.as_ref().unwrap().nodes.text(n as usize)).collect()
}
