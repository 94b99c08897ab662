//! Reads `history_<name>.npz` back, as far as spectra need it.

use std::collections::HashMap;
use std::path::Path;

use crate::{Error, Result};

/// Arrays of a history that this program has written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stored {
    /// [s]
    pub times: Vec<f64>,
    /// [Hz]
    pub rate: f64,
    /// Whether places go with the material.
    pub turning: bool,
    pub normals: Vec<[f64; 3]>,
    /// [m2]
    pub areas: Vec<f64>,
    /// Shape `[times, places, 3]` [m/s], and `[times, 3]` [N].
    pub velocity: Option<Vec<f32>>,
    pub road_force: Option<Vec<f32>>,
}

/// Reads the file.
///
/// # Errors
/// [`Error::Io`]; [`Error::Format`] if it is not what [`write_npz`](super::write_npz) writes.
pub fn read(path: &Path) -> Result<Stored> {
    let bytes = std::fs::read(path).map_err(Error::io(path, "read this file"))?;
    let bad =
        |problem: &str| Error::Format { path: path.into(), problem: format!("not a history: {problem}") };
    let arrays = arrays(&bytes).ok_or_else(|| bad("not an archive of stored arrays"))?;
    let doubles = |name: &str| -> Result<Vec<f64>> {
        let content = arrays.get(name).ok_or_else(|| bad(&format!("no array {name}")))?;
        Ok(content.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
    };
    let singles = |name: &str| -> Option<Vec<f32>> {
        let content = arrays.get(name)?;
        Some(content.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect())
    };
    let stored = Stored {
        times: doubles("time")?,
        rate: *doubles("rate")?.first().ok_or_else(|| bad("no rate"))?,
        turning: arrays.get("turning").is_some_and(|b| b.first() == Some(&1)),
        normals: doubles("normal")?.as_chunks().0.to_vec(),
        areas: doubles("area")?,
        velocity: singles("velocity"),
        road_force: singles("road_force"),
    };
    let fits = |values: &Option<Vec<f32>>, width: usize| {
        values.as_ref().is_none_or(|v| v.len() == width * stored.times.len())
    };
    match fits(&stored.velocity, 3 * stored.areas.len()) && fits(&stored.road_force, 3) {
        true => Ok(stored),
        false => Err(bad("an array has another length than its times and places")),
    }
}

/// Contents of the arrays of an archive by name, without their headers; `None`: it is cut off, or compressed.
fn arrays(bytes: &[u8]) -> Option<HashMap<&str, &[u8]>> {
    let mut arrays = HashMap::new();
    let mut at = 0;
    while bytes.get(at..at + 4)? == b"PK\x03\x04" {
        let word = |i: usize| Some(u16::from_le_bytes(bytes.get(at + i..at + i + 2)?.try_into().ok()?));
        let size = u32::from_le_bytes(bytes.get(at + 18..at + 22)?.try_into().ok()?) as usize;
        if word(8)? != 0 {
            return None;
        }
        let name_end = at + 30 + usize::from(word(26)?);
        let start = name_end + usize::from(word(28)?);
        let name = std::str::from_utf8(bytes.get(at + 30..name_end)?).ok()?;
        let file = bytes.get(start..start + size)?;
        let header = usize::from(u16::from_le_bytes(file.get(8..10)?.try_into().ok()?));
        arrays.insert(name.strip_suffix(".npy")?, file.get(10 + header..)?);
        at = start + size;
    }
    Some(arrays)
}
