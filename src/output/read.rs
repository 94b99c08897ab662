//! Reads a run's folder, finished or killed.

use std::path::{Path, PathBuf};

use super::{Summary, folder, pvd, snapshot, writer};
use crate::record::Sample;
use crate::{Error, Result};

pub use super::snapshot::Stored;

/// A snapshot's file and its time.
#[derive(Debug, Clone, PartialEq)]
pub struct SnapshotFile {
    /// [s]
    pub time: f64,
    pub path: PathBuf,
}

/// Rows of `history.csv`; a last row that a kill cut off is skipped.
///
/// # Errors
/// [`Error::Io`]; [`Error::Format`] with the line for other columns than a [`Sample`]'s or a bad value.
pub fn history(dir: &Path) -> Result<Vec<Sample>> {
    let path = dir.join(folder::HISTORY);
    let bad = |problem: String| Error::Format { path: path.clone(), problem };
    let bytes = std::fs::read(&path).map_err(Error::io(&path, "read this file"))?;
    let complete = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
    let mut reader = csv::Reader::from_reader(&bytes[..complete]);
    let names = reader.headers().map_err(|e| bad(e.to_string()))?;
    let expected = writer::header();
    if let Some(i) = (0..expected.len().max(names.len())).find(|&i| names.get(i) != expected.get(i).copied())
    {
        let found = names.get(i).map_or("missing".into(), |name| format!("{name:?}"));
        let right = expected.get(i).map_or("no further column".into(), |name| format!("{name:?}"));
        return Err(bad(format!("column {} is {found}; {right} is expected", i + 1)));
    }
    reader.deserialize().map(|row| row.map_err(|e| bad(e.to_string()))).collect()
}

/// Times and paths of the snapshots, as `run.pvd` lists them.
///
/// # Errors
/// [`Error::Io`]; [`Error::Format`] if it is not a complete collection.
pub fn snapshots(dir: &Path) -> Result<Vec<SnapshotFile>> {
    let entries = pvd::read(&dir.join(folder::PVD))?;
    Ok(entries.into_iter().map(|(time, path)| SnapshotFile { time, path }).collect())
}

/// A snapshot with its stage and its mesh (facets are found anew, reference positions are exact to
/// round-off).
///
/// # Errors
/// [`Error::Io`]; [`Error::Format`] if the file is not a complete snapshot.
pub fn snapshot(path: &Path) -> Result<Stored> {
    snapshot::read(path)
}

/// The summary; `None` if the run never finished.
///
/// # Errors
/// [`Error::Io`]; [`Error::Format`] if it is not a [`Summary`].
pub fn summary(dir: &Path) -> Result<Option<Summary>> {
    let path = dir.join(folder::SUMMARY);
    let bytes = match std::fs::read(&path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        result => result.map_err(Error::io(&path, "read this file"))?,
    };
    let parsed = serde_json::from_slice(&bytes);
    parsed.map(Some).map_err(|e| Error::Format { path, problem: format!("not a run's summary: {e}") })
}

/// The scene's effective text, if the run kept it.
///
/// # Errors
/// [`Error::Io`].
pub fn scene_text(dir: &Path) -> Result<Option<String>> {
    let path = dir.join(folder::SCENE);
    match std::fs::read_to_string(&path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        result => result.map(Some).map_err(Error::io(&path, "read this file")),
    }
}
