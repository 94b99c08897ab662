//! Gmsh's meshes (`.msh`), 2.2 and 4.1, as text and binary.
//!
//! Hexahedra are taken, elements of lower dimension only for the sets that they make: a physical group is a set of the nodes of its
//! elements.
//!
//! Format: Gmsh reference manual, "MSH file format" and "MSH file format version 2 (Legacy)".

mod groups;
mod stream;
mod version2;
mod version4;

use super::raw::Raw;
use super::source::Source;
use crate::error::Result;
use crate::scene::MeshFile;
use groups::Collected;
use stream::Stream;

/// The mesh of a `.msh` file.
pub fn read(file: &MeshFile) -> Result<Raw> {
    let mut source = Source::open(&file.path)?;
    let (version, binary) = header(&mut source)?;
    let mut stream = Stream::new(source, binary)?;
    let mut collected = Collected::new(&file.drop, file.revolve.is_some());
    while let Some(section) = stream.section()? {
        match (section.as_str(), version) {
            ("PhysicalNames", _) => groups::names(&mut stream, &mut collected)?,
            ("Entities", Version::Four) => version4::entities(&mut stream, &mut collected)?,
            ("Nodes", Version::Two) => version2::nodes(&mut stream, &mut collected)?,
            ("Nodes", Version::Four) => version4::nodes(&mut stream, &mut collected)?,
            ("Elements", Version::Two) => version2::elements(&mut stream, &mut collected)?,
            ("Elements", Version::Four) => version4::elements(&mut stream, &mut collected)?,
            _ => {
                stream.skip(&section)?;
                continue;
            }
        }
        stream.end(&section)?;
    }
    collected.into_raw(&stream.place(), version.name())
}

/// Versions that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    Two,
    Four,
}

impl Version {
    fn name(self) -> &'static str {
        match self {
            Version::Two => "Gmsh 2.2 mesh",
            Version::Four => "Gmsh 4.1 mesh",
        }
    }
}

/// `$MeshFormat`: version, and whether what follows is binary. The byte order of a binary file is what this machine has.
fn header(source: &mut Source) -> Result<(Version, bool)> {
    const KEY: &str = "$MeshFormat";
    let first = source.next_full_line()?.map(<[u8]>::to_vec);
    if first.as_deref() != Some(KEY.as_bytes()) {
        let problem = "the file does not begin with $MeshFormat";
        return Err(source.place().error(KEY, problem, "save the mesh with Gmsh as version 4.1 or 2.2"));
    }
    let line = source.next_line()?.map(<[u8]>::to_vec).unwrap_or_default();
    let words: Vec<&[u8]> = super::numbers::words(&line).collect();
    let remedy = "save the mesh with Gmsh as version 4.1 or 2.2 (Mesh.MshFileVersion)";
    let (version, binary) = match words[..] {
        [version, kind @ (b"0" | b"1"), b"8"] => (version, kind == b"1"),
        _ => {
            let problem =
                format!("{} is no line of version, type and size of numbers", super::numbers::shown(&line));
            return Err(source.place().error(KEY, problem, remedy));
        }
    };
    let version = match version {
        b"2.2" | b"2.1" | b"2" => Version::Two,
        b"4.1" => Version::Four,
        other => {
            let problem = format!("version {} is not read", super::numbers::shown(other));
            return Err(source.place().error(KEY, problem, remedy));
        }
    };
    if binary {
        let one = source.bytes(4, KEY)?;
        if one != 1_i32.to_ne_bytes() {
            let problem = "binary numbers in another byte order than this machine's";
            return Err(source.place().error(KEY, problem, "save the mesh as text"));
        }
        source.next_line()?;
    }
    match source.next_full_line()? {
        Some(b"$EndMeshFormat") => Ok((version, binary)),
        _ => Err(source.place().error(KEY, "$EndMeshFormat is missing", remedy)),
    }
}
