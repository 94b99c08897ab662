//! Writes a run's folder as the run goes.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::{Summary, contact, folder, history, pvd, snapshot};
use crate::model::mesh::Mesh;
use crate::record::{History, NewtonRow, Reaction, Sample, Snapshot};
use crate::scene::history::Format;
use crate::{Error, Result};

/// The open folder of a run. Everything given to it is on disk when the call returns.
pub struct RunWriter<'m> {
    dir: PathBuf,
    mesh: &'m Mesh,
    history: csv::Writer<File>,
    /// Made when the first implicit increment is.
    implicit: Option<csv::Writer<File>>,
    /// Made when the first reactions are.
    reactions: Option<csv::Writer<File>>,
    /// Times [s] and names of the snapshots so far.
    snapshots: Vec<(f64, String)>,
    /// Held, not used: the folder is locked while this lives.
    _lock: File,
}

impl<'m> RunWriter<'m> {
    /// Makes `dir` a run's folder, replacing a run that is there, and writes `scene_text` (the scene after
    /// `--set`), if given, to `scene.toml`.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Format`] if `dir` holds files but no run, or another run is writing to it.
    pub fn create(dir: &Path, mesh: &'m Mesh, scene_text: Option<&str>) -> Result<RunWriter<'m>> {
        let _lock = folder::claim(dir)?;
        if let Some(text) = scene_text {
            folder::write_whole(&dir.join(folder::SCENE), |out| out.write_all(text.as_bytes()))?;
        }
        let path = dir.join(folder::HISTORY);
        let file = File::create(&path).map_err(Error::io(&path, "write this file"))?;
        let mut history = csv::WriterBuilder::new().has_headers(false).from_writer(file);
        history.write_record(header()).map_err(csv_error(&path))?;
        history.flush().map_err(Error::io(&path, "write this file"))?;
        let writer = RunWriter {
            dir: dir.into(),
            mesh,
            history,
            implicit: None,
            reactions: None,
            snapshots: Vec::new(),
            _lock,
        };
        writer.write_pvd()?;
        Ok(writer)
    }

    /// Appends a row to `history.csv`.
    pub fn sample(&mut self, sample: &Sample) -> Result<()> {
        let path = self.dir.join(folder::HISTORY);
        self.history.serialize(sample).map_err(csv_error(&path))?;
        self.history.flush().map_err(Error::io(&path, "write this file"))
    }

    /// Appends the iterations of an implicit increment to `implicit.csv`.
    pub fn iterations(&mut self, rows: &[NewtonRow]) -> Result<()> {
        let path = self.dir.join(folder::IMPLICIT);
        if self.implicit.is_none() {
            let file = File::create(&path).map_err(Error::io(&path, "write this file"))?;
            self.implicit = Some(csv::Writer::from_writer(file));
        }
        let writer = self.implicit.as_mut().expect("just made");
        for row in rows {
            writer.serialize(row).map_err(csv_error(&path))?;
        }
        writer.flush().map_err(Error::io(&path, "write this file"))
    }

    /// Appends a row of what drives sets of nodes to `reactions.csv`.
    pub fn reactions(&mut self, sample: &Sample, sets: &[Reaction]) -> Result<()> {
        let path = self.dir.join(folder::REACTIONS);
        if self.reactions.is_none() {
            let file = File::create(&path).map_err(Error::io(&path, "write this file"))?;
            let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(file);
            writer.write_record(reaction_header(sets)).map_err(csv_error(&path))?;
            self.reactions = Some(writer);
        }
        let writer = self.reactions.as_mut().expect("just made");
        let numbers = sets.iter().flat_map(|set| set.components).flatten().flatten();
        let row = [sample.time_s.to_string(), sample.stage.clone()]
            .into_iter()
            .chain(numbers.map(|n| n.to_string()));
        writer.write_record(row).map_err(csv_error(&path))?;
        writer.flush().map_err(Error::io(&path, "write this file"))
    }

    /// Writes `snapshot_<k>.vtu`, `contact_<k>.csv` (with a road) and `run.pvd`; returns k, from 0.
    ///
    /// # Panics
    /// If the snapshot's fields do not have the mesh's sizes.
    pub fn snapshot(&mut self, snapshot: &Snapshot, stage: &str) -> Result<usize> {
        let k = self.snapshots.len();
        let name = folder::snapshot_name(k);
        folder::write_whole(&self.dir.join(&name), |out| snapshot::write(out, self.mesh, snapshot, stage))?;
        if !snapshot.contact.is_empty() {
            folder::write_whole(&self.dir.join(folder::contact_name(k)), |out| {
                contact::write(out, snapshot)
            })?;
        }
        self.snapshots.push((snapshot.time, name));
        self.write_pvd()?;
        Ok(k)
    }

    /// Writes `history_<name>.<format>` for every format of the history; returns the names.
    pub fn history(&self, history: &History) -> Result<Vec<String>> {
        let write = |format: &Format| {
            let name = folder::history_name(&history.name, format.ending());
            folder::write_whole(&self.dir.join(&name), |out| match format {
                Format::Npz => history::write_npz(out, history),
                Format::Uff => history::write_uff(out, history),
            })?;
            Ok(name)
        };
        history.formats.iter().map(write).collect()
    }

    /// Writes `summary.json`.
    pub fn finish(&mut self, summary: &Summary) -> Result<()> {
        folder::write_whole(&self.dir.join(folder::SUMMARY), |out| {
            serde_json::to_writer_pretty(&mut *out, summary)?;
            writeln!(out)
        })
    }

    fn write_pvd(&self) -> Result<()> {
        folder::write_whole(&self.dir.join(folder::PVD), |out| pvd::write(out, &self.snapshots))
    }
}

/// Names of the columns of `history.csv`: the fields of [`Sample`], in their order.
pub fn header() -> Vec<&'static str> {
    let mut names: Vec<_> = Sample::COLUMNS.iter().map(|(name, _)| *name).collect();
    names.insert(1, "stage");
    names
}

/// Names of the columns of `reactions.csv`; a set that is there again has a number behind its name.
fn reaction_header(sets: &[Reaction]) -> Vec<String> {
    let mut names = vec!["time_s".to_string(), "stage".into()];
    for (k, set) in sets.iter().enumerate() {
        let before = sets[..k].iter().filter(|other| other.set == set.set).count();
        let name = if before == 0 { set.set.clone() } else { format!("{}_{}", set.set, before + 1) };
        for (d, _) in ["x", "y", "z"].iter().zip(set.components).filter(|(_, c)| c.is_some()) {
            names.extend([format!("{name}_u{d}_m"), format!("{name}_f{d}_N")]);
        }
    }
    names
}

/// An error of the CSV writer: always the file's, since every row has the same fields.
fn csv_error(path: &Path) -> impl FnOnce(csv::Error) -> Error {
    move |error| Error::io(path, "write this file")(error.into())
}
