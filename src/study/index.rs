//! `study.json` and `sweep.json`: what a command set out to run and where, written before the first run, so that its
//! folder says what is there and what is missing.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::report::{Run, Study};
use super::sweep::{Point, Sweep};
use crate::output::folder::write_whole;
use crate::output::{Summary, read};
use crate::{Error, Result};

pub const STUDY: &str = "study.json";
pub const SWEEP: &str = "sweep.json";

/// Everything that a command was to run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Index {
    /// The command as it was typed, and the version of the program.
    pub command: String,
    pub version: String,
    /// One a scene.
    pub scenes: Vec<Planned>,
}

/// The runs of a scene.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Planned {
    pub name: String,
    pub title: String,
    /// What is varied, with units.
    pub axes: Vec<String>,
    pub runs: Vec<Place>,
}

/// A run: where it is, and where it stands in tables and plots.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Place {
    /// Below the folder of the index.
    pub folder: String,
    /// What tables call it (studies).
    pub label: String,
    /// Values of the axes as they were written, and the first one's number or place (sweeps).
    pub values: Vec<String>,
    pub x: f64,
    /// Relative size of mesh or step (studies).
    pub size: Option<f64>,
}

impl Index {
    /// Writes the index under `name` into `dir`, which is made if it is missing.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, dir: &Path, name: &str) -> Result<()> {
        std::fs::create_dir_all(dir).map_err(Error::io(dir, "create this folder"))?;
        write_whole(&dir.join(name), |out| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            writeln!(out)
        })
    }

    /// Reads the index `name` of `dir`.
    ///
    /// # Errors
    /// [`Error::Format`] without one, or if it is damaged.
    pub fn read(dir: &Path, name: &str) -> Result<Index> {
        let path = dir.join(name);
        let command = name.trim_end_matches(".json");
        let bad = |problem: String| Error::Format { path: path.clone(), problem };
        let text = match std::fs::read_to_string(&path) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                return Err(Error::Format {
                    path: dir.into(),
                    problem: format!(
                        "this folder has no {name}, so it is not the folder of a {command}; one of an older version gets \
                         it from the same command again (finished runs are kept)"
                    ),
                });
            }
            text => text.map_err(Error::io(&path, "read this file"))?,
        };
        serde_json::from_str(&text).map_err(|e| bad(format!("not an index of runs: {e}")))
    }
}

impl Planned {
    /// The finished runs with their summaries, and what the others are called.
    fn split(&self, dir: &Path) -> (Vec<(&Place, Summary)>, Vec<String>) {
        let (mut there, mut missing) = (Vec::new(), Vec::new());
        for place in &self.runs {
            match read::summary(&dir.join(&place.folder)) {
                Ok(Some(summary)) if summary.finished => there.push((place, summary)),
                Ok(Some(_)) => missing.push(format!("{} ended early", place.folder)),
                Ok(None) => missing.push(format!("{} has not finished, or not begun", place.folder)),
                Err(error) => missing.push(error.to_string()),
            }
        }
        (there, missing)
    }

    /// The scene's study as far as it has come; `dir`: the folder of the index.
    pub fn study(&self, dir: &Path) -> (Study, Vec<String>) {
        let (there, missing) = self.split(dir);
        let run = |(place, summary): (&Place, Summary)| Run {
            label: place.label.clone(),
            size: place.size,
            summary,
        };
        let runs = there.into_iter().map(run).collect();
        let axis = self.axes.first().cloned().unwrap_or_default();
        (Study { name: self.name.clone(), title: self.title.clone(), axis, runs }, missing)
    }

    /// The scene's sweep as far as it has come; `dir`: the folder of the index.
    pub fn sweep(&self, dir: &Path) -> (Sweep, Vec<String>) {
        let (there, missing) = self.split(dir);
        let point =
            |(place, summary): (&Place, Summary)| Point { values: place.values.clone(), x: place.x, summary };
        let points = there.into_iter().map(point).collect();
        (
            Sweep { name: self.name.clone(), title: self.title.clone(), axes: self.axes.clone(), points },
            missing,
        )
    }
}
