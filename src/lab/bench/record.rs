//! The folder of a record: JSON, the page, the picture.

use std::path::{Path, PathBuf};

use super::report::Report;
use super::{chart, markdown};
use hexroll::{Error, Result};

/// A folder that no other record has.
#[derive(Debug)]
pub struct Record {
    pub folder: PathBuf,
}

impl Record {
    /// Makes `<out>/<date>-<adapter or cpu>`; with a number after it where that is taken.
    pub fn create(out: &Path, report: &Report) -> Result<Record> {
        let machine = &report.machine;
        let device = machine.adapter.as_deref().map_or("cpu".into(), slug);
        let name = format!("{}-{device}", machine.date);
        std::fs::create_dir_all(out).map_err(Error::io(out, "create the folder"))?;
        let numbered = (2..).map(|n| format!("{name}-{n}"));
        for name in std::iter::once(name.clone()).chain(numbered) {
            let folder = out.join(name);
            match std::fs::create_dir(&folder) {
                Ok(()) => return Ok(Record { folder }),
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(e) => return Err(Error::io(folder, "create the folder")(e)),
            }
        }
        unreachable!("numbers do not end")
    }

    /// Writes what there is so far.
    pub fn write(&self, report: &Report) -> Result<()> {
        write_json(&self.folder.join("bench.json"), report)?;
        let page = self.folder.join("bench.md");
        std::fs::write(&page, markdown::page(report)).map_err(Error::io(&page, "write the record"))?;
        if let Some(picture) = chart::scaling(&report.rows)? {
            let path = self.folder.join("scaling.png");
            picture.save(&path).map_err(|e| Error::Picture { problem: e.to_string() })?;
        }
        Ok(())
    }
}

/// Writes a report as JSON, whole or not at all.
pub fn write_json(path: &Path, report: &Report) -> Result<()> {
    let text = serde_json::to_string_pretty(report).expect("a report has no keys that JSON cannot have");
    let part = path.with_extension("json.part");
    std::fs::write(&part, text + "\n").map_err(Error::io(&part, "write the record"))?;
    std::fs::rename(&part, path).map_err(Error::io(path, "write the record"))
}

/// `NVIDIA H100 PCIe` -> `nvidia-h100-pcie`.
fn slug(name: &str) -> String {
    let name = name.split('(').next().unwrap_or(name).to_lowercase();
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|w| !w.is_empty());
    words.collect::<Vec<_>>().join("-")
}
