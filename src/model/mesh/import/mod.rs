//! Meshes of other programs: a reader a format, which hands on what the file says, and what makes a mesh of it (`build/`).
//!
//! Readers are streams with bounds: no line, count or nesting that a file claims takes more memory than a small multiple of the
//! file itself. Every error names file, line where there are lines, and a remedy.

mod build;
mod gmsh;
mod ids;
mod keywords;
mod numbers;
mod raw;
mod source;
mod vtu;

use super::Mesh;
use crate::error::Result;
use crate::scene::{MeshFile, NodeSet};
use keywords::Dialect;
use source::{Place, Source};

/// Formats by their files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Keywords(Dialect),
    Gmsh,
    Vtu,
}

impl Mesh {
    /// The mesh of a file in SI units, its axle along y. `rim`: the set that the axle is found from where the file's scene does not
    /// say where it is.
    ///
    /// # Errors
    /// [`Error::Io`](crate::Error::Io), or [`Error::Scene`](crate::Error::Scene) with the file, its line where it has lines, what is
    /// wrong, and a remedy.
    pub fn imported(file: &MeshFile, rim: Option<&NodeSet>) -> Result<Mesh> {
        let raw = match format(file)? {
            Format::Keywords(dialect) => keywords::read(file, dialect)?,
            Format::Gmsh => gmsh::read(file)?,
            Format::Vtu => vtu::read(file)?,
        };
        build::mesh(raw, file, rim.map(|set| set.name.as_str()))
    }
}

/// What a deck says of materials, as lines of a scene; none of a file that says nothing, or is of a format that has none.
///
/// # Errors
/// As [`Mesh::imported`].
pub fn materials(file: &MeshFile) -> Result<Vec<String>> {
    match format(file)? {
        Format::Keywords(dialect) => keywords::materials(&file.path, dialect, &file.unit, &file.drop),
        Format::Gmsh | Format::Vtu => Ok(Vec::new()),
    }
}

/// The format by the file's ending; two programs write `.msh`, and begin it differently.
fn format(file: &MeshFile) -> Result<Format> {
    let ending = file.path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match ending.as_str() {
        "inp" => Ok(Format::Keywords(Dialect::Abaqus)),
        "vtu" => Ok(Format::Vtu),
        "msh" => {
            let mut source = Source::open(&file.path)?;
            let first = source.beginning()?.trim_ascii_start().first().copied();
            let keywords = matches!(first, Some(b'!' | b'#'));
            Ok(if keywords { Format::Keywords(Dialect::FrontIstr) } else { Format::Gmsh })
        }
        other => {
            let place = Place { file: file.path.clone(), line: None };
            let problem = format!("files that end in {other:?} are not read");
            let remedy = "write the mesh as .inp (Abaqus), .msh (Gmsh 2.2 or 4.1, FrontISTR) or .vtu (VTK); geometry (.step, .stl) has to \
                          be meshed first, with hexahedra, in Gmsh or another mesher";
            Err(place.error("body.mesh.file", problem, remedy))
        }
    }
}
