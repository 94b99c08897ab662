//! How two runs of one mesh differ: settings, histories, fields.
//!
//! Rows and snapshots are matched by stage and by time since the start of that stage, because a stage that
//! settles by a criterion may end at another moment in another run.

mod display;
mod fields;
mod history;

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Summary, read};
use crate::record::Sample;
use crate::{Error, Result};

pub use fields::{FieldError, SnapshotError};
pub use history::{ColumnError, HistoryError};

/// Two runs side by side; A is the reference.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    pub a: PathBuf,
    pub b: PathBuf,
    /// What the reader of the numbers has to know: rows without a partner, other windows, missing files.
    pub notes: Vec<String>,
    /// Entries of the summaries that differ.
    pub settings: Vec<Setting>,
    pub history: HistoryError,
    pub snapshots: Vec<SnapshotError>,
}

/// An entry of the summaries that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Setting {
    pub name: String,
    pub a: serde_json::Value,
    pub b: serde_json::Value,
}

/// Entries of a summary that say how the run was made.
const SETTINGS: [&str; 15] = [
    "title",
    "scene_hash",
    "engine",
    "adapter",
    "driver",
    "precision",
    "threads",
    "elements",
    "nodes",
    "steps",
    "time_s",
    "dt_min_s",
    "dt_max_s",
    "critical_dt_s",
    "versions",
];

/// One of the two runs.
struct Run<'a> {
    dir: &'a Path,
    history: Vec<Sample>,
    snapshots: Vec<read::SnapshotFile>,
    summary: Option<Summary>,
}

impl Run<'_> {
    fn read(dir: &Path) -> Result<Run<'_>> {
        Ok(Run {
            dir,
            history: read::history(dir)?,
            snapshots: read::snapshots(dir)?,
            summary: read::summary(dir)?,
        })
    }

    /// How far apart two times may be to be the same one [s]: 5 % of a window. Engines that choose their
    /// own steps end their windows within a step of each other.
    fn tolerance(&self) -> f64 {
        self.history.last().map_or(0.0, |last| 0.05 * last.time_s / self.history.len() as f64)
    }
}

/// Compares the runs in two folders, finished or killed.
///
/// # Errors
/// [`Error::Io`] and [`Error::Format`] from reading; [`Error::Format`] about `b` if its mesh is another one.
pub fn compare(a: &Path, b: &Path) -> Result<Comparison> {
    let (a, b) = (Run::read(a)?, Run::read(b)?);
    let mut notes = Vec::new();
    for run in [&a, &b].iter().filter(|run| run.summary.is_none()) {
        notes.push(format!("{} has no summary.json: that run did not finish", run.dir.display()));
    }
    let settings = settings(&a, &b)?;
    let history = history::compare(&a, &b, &mut notes);
    let snapshots = fields::compare(&a, &b, &mut notes)?;
    Ok(Comparison { a: a.dir.into(), b: b.dir.into(), notes, settings, history, snapshots })
}

fn settings(a: &Run, b: &Run) -> Result<Vec<Setting>> {
    let (Some(one), Some(other)) = (&a.summary, &b.summary) else { return Ok(Vec::new()) };
    let sizes = |s: &Summary| (s.elements, s.nodes);
    if sizes(one) != sizes(other) {
        return Err(other_mesh(a, b, format!("{:?} elements and nodes, not {:?}", sizes(other), sizes(one))));
    }
    let value = |summary| serde_json::to_value(summary).unwrap_or_default();
    let (one, other) = (value(one), value(other));
    let differing = SETTINGS.iter().filter(|&&name| one[name] != other[name]);
    Ok(differing
        .map(|&name| Setting { name: name.into(), a: one[name].clone(), b: other[name].clone() })
        .collect())
}

fn other_mesh(a: &Run, b: &Run, detail: String) -> Error {
    let problem =
        format!("its mesh is not the one of {}: {detail}; only runs of one mesh compare", a.dir.display());
    Error::Format { path: b.dir.into(), problem }
}

/// Norm of the difference over the norm of `a`; none if only `a` is all zero. NaN (0/0 included) if any
/// value is.
fn relative_l2(pairs: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (mut difference, mut norm) = (0.0, 0.0);
    for (a, b) in pairs {
        difference += (b - a) * (b - a);
        norm += a * a;
    }
    match (difference, norm) {
        (0.0, _) => Some(0.0),
        (d, 0.0) if !f64::is_nan(d) => None,
        _ => Some((difference / norm).sqrt()),
    }
}
