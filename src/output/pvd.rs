//! `run.pvd`: the collection of snapshots that ParaView opens as one animation.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::{Error, Result};

/// Writes a collection of files and their times [s]; the names need no escaping.
pub fn write(out: &mut dyn Write, entries: &[(f64, String)]) -> std::io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>"
    )?;
    for (time, name) in entries {
        writeln!(out, "    <DataSet timestep=\"{time:e}\" group=\"\" part=\"0\" file=\"{name}\"/>")?;
    }
    writeln!(out, "  </Collection>\n</VTKFile>")
}

/// Reads a collection: times [s] and paths, in the file's order.
///
/// # Errors
/// [`Error::Io`], or [`Error::Format`] for anything but a collection of files with times.
pub fn read(path: &Path) -> Result<Vec<(f64, PathBuf)>> {
    let bad = |problem: String| Error::Format { path: path.into(), problem };
    let text = std::fs::read_to_string(path).map_err(Error::io(path, "read this file"))?;
    let document =
        roxmltree::Document::parse(&text).map_err(|e| bad(format!("not a complete XML file: {e}")))?;
    let entries = document.descendants().filter(|node| node.has_tag_name("DataSet"));
    let folder = path.parent().unwrap_or(Path::new(""));
    entries
        .map(|entry| {
            let time = entry.attribute("timestep").and_then(|t| t.parse().ok());
            let file = entry.attribute("file");
            let (Some(time), Some(file)) = (time, file) else {
                let line = document.text_pos_at(entry.range().start).row;
                return Err(bad(format!("line {line}: a DataSet needs a timestep (a number) and a file")));
            };
            Ok((time, folder.join(file)))
        })
        .collect()
}
