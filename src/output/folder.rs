//! The names in a run's folder, and who may write there.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::{Error, Result};

pub const MARKER: &str = ".hexroll";
pub const HISTORY: &str = "history.csv";
pub const IMPLICIT: &str = "implicit.csv";
pub const REACTIONS: &str = "reactions.csv";
pub const SCENE: &str = "scene.toml";
pub const PVD: &str = "run.pvd";
pub const SUMMARY: &str = "summary.json";
pub const REPORT: &str = "report.html";

/// Ending of a file that is not complete yet.
const PART: &str = ".part";

pub fn snapshot_name(k: usize) -> String {
    format!("snapshot_{k}.vtu")
}

/// A history at a high rate; `format`: `npz` or `uff`.
pub fn history_name(name: &str, format: &str) -> String {
    format!("history_{name}.{format}")
}

pub fn contact_name(k: usize) -> String {
    format!("contact_{k}.csv")
}

/// Makes `dir` an empty run's folder and locks it for as long as the returned file lives.
///
/// A run that is already there is removed, with its pictures; other files stay.
///
/// # Errors
/// [`Error::Format`] if the folder holds files but no run, or if another process is writing a run there.
pub fn claim(dir: &Path) -> Result<File> {
    fs::create_dir_all(dir).map_err(Error::io(dir, "create this folder"))?;
    let marker = dir.join(MARKER);
    let names = names(dir)?;
    if !names.is_empty() && !marker.exists() {
        let problem = "this folder holds files that no run wrote, so it is left alone; \
                       choose another folder, or empty this one";
        return Err(Error::Format { path: dir.into(), problem: problem.into() });
    }
    let mut options = OpenOptions::new();
    let mut lock = options
        .create(true)
        .write(true)
        .truncate(false)
        .open(&marker)
        .map_err(Error::io(&marker, "write this file"))?;
    // A file system without locks is no reason not to run.
    if let Err(TryLockError::WouldBlock) = lock.try_lock() {
        let problem = "another run is writing to this folder".into();
        return Err(Error::Format { path: dir.into(), problem });
    }
    for name in names.iter().filter(|name| is_ours(name)) {
        let path = dir.join(name);
        fs::remove_file(&path).map_err(Error::io(&path, "remove this file of an older run"))?;
    }
    lock.set_len(0)
        .and_then(|()| writeln!(lock, "hexroll {}", env!("CARGO_PKG_VERSION")))
        .map_err(Error::io(&marker, "write this file"))?;
    Ok(lock)
}

/// Whether `dir` is a run's folder, and whether a run is writing to it now.
pub fn is_run(dir: &Path) -> bool {
    dir.join(MARKER).exists()
}

pub fn is_being_written(dir: &Path) -> bool {
    let marker = File::open(dir.join(MARKER));
    marker.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

fn names(dir: &Path) -> Result<Vec<String>> {
    let entries = fs::read_dir(dir).map_err(Error::io(dir, "list this folder"))?;
    entries
        .map(|entry| Ok(entry.map_err(Error::io(dir, "list this folder"))?.file_name()))
        .map(|name: Result<_>| Ok(name?.to_string_lossy().into_owned()))
        .collect()
}

/// Whether a run writes a file of this name (the marker stays where it is).
fn is_ours(name: &str) -> bool {
    let name = name.strip_suffix(PART).unwrap_or(name);
    let numbered = |prefix, suffix| {
        let middle = name.strip_prefix(prefix).and_then(|rest: &str| rest.strip_suffix(suffix));
        middle.is_some_and(|k| !k.is_empty() && k.bytes().all(|b| b.is_ascii_digit()))
    };
    let picture = || ["body", "footprint"].iter().any(|p| name.starts_with(p)) && name.ends_with(".png");
    let any = |prefixes: &[&str], endings: &[&str]| {
        prefixes.iter().any(|p| name.starts_with(p)) && endings.iter().any(|e| name.ends_with(e))
    };
    let histories = any(&["history_"], &[".npz", ".uff"]) || any(&["spectrum_", "bands_"], &[".csv", ".png"]);
    [HISTORY, IMPLICIT, REACTIONS, SCENE, PVD, SUMMARY, REPORT].contains(&name)
        || numbered("snapshot_", ".vtu")
        || numbered("contact_", ".csv")
        || picture()
        || histories
}

/// Names of the histories that a folder has as `.npz`.
///
/// # Errors
/// [`Error::Io`].
pub fn histories(dir: &Path) -> Result<Vec<String>> {
    let name = |file: String| Some(file.strip_prefix("history_")?.strip_suffix(".npz")?.to_string());
    let mut found: Vec<String> = names(dir)?.into_iter().filter_map(name).collect();
    found.sort();
    Ok(found)
}

/// A picture of a snapshot in a run's folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PictureFile {
    /// Without number and ending: `body_pressure`.
    pub name: String,
    pub snapshot: usize,
    pub path: PathBuf,
}

/// Pictures of snapshots in a folder, by name and number.
///
/// # Errors
/// [`Error::Io`].
pub fn pictures(dir: &Path) -> Result<Vec<PictureFile>> {
    let picture = |file: String| {
        let (name, number) = file.strip_suffix(".png").filter(|_| is_ours(&file))?.rsplit_once('_')?;
        Some(PictureFile { name: name.into(), snapshot: number.parse().ok()?, path: dir.join(&file) })
    };
    let mut found: Vec<PictureFile> = names(dir)?.into_iter().filter_map(picture).collect();
    found.sort_by(|a, b| (&a.name, a.snapshot).cmp(&(&b.name, b.snapshot)));
    Ok(found)
}

/// Writes a file so that it appears under its name only when it is complete; what a failure leaves is removed.
pub fn write_whole(path: &Path, fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<()> {
    let part = PathBuf::from(format!("{}{PART}", path.display()));
    let write = || {
        let mut file = BufWriter::new(File::create(&part)?);
        fill(&mut file)?;
        file.flush()?;
        fs::rename(&part, path)
    };
    write().map_err(|error| {
        // Nothing to remove where not even this file could be made; the first failure is the one to tell.
        _ = fs::remove_file(&part);
        Error::io(path, "write this file")(error)
    })
}
