//! Arrays in NumPy's format (version 1.0 of NEP 1) in an archive: `.npz`.
//!
//! Own code: the one crate for it brings a parser of Python's literals and an archiver of another age, for a header of a
//! hundred bytes.

use std::io::{Result, Write};

use super::zip::Archive;
use crate::record::History;
use crate::signal::resample::{ATTENUATION, PASS, STOP};

/// An element type: its name in the header, its little-endian bytes.
trait Element: Copy {
    const DESCR: &'static str;
    fn put(self, out: &mut Vec<u8>);
}

macro_rules! element {
    ($($kind:ty => $descr:literal),*) => {
        $(impl Element for $kind {
            const DESCR: &'static str = $descr;
            fn put(self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
        })*
    };
}

element!(f64 => "<f8", f32 => "<f4", u32 => "<u4");

impl Element for bool {
    const DESCR: &'static str = "|b1";
    fn put(self, out: &mut Vec<u8>) {
        out.push(u8::from(self));
    }
}

/// A whole `.npy` file; the last index runs fastest.
fn array<T: Element>(shape: &[usize], values: &[T]) -> Vec<u8> {
    assert_eq!(shape.iter().product::<usize>(), values.len(), "the shape has another number of entries");
    // A tuple of one has a comma behind it.
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    let shape = format!("({}{})", sizes.join(", "), if shape.len() == 1 { "," } else { "" });
    let header = format!("{{'descr': '{}', 'fortran_order': False, 'shape': {shape}, }}", T::DESCR);
    // Magic, version and length take ten bytes; with the header and its newline they fill whole 64s.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    let mut file = Vec::with_capacity(length + 10 + size_of_val(values));
    file.extend_from_slice(b"\x93NUMPY\x01\x00");
    file.extend_from_slice(&(length as u16).to_le_bytes());
    file.extend_from_slice(header.as_bytes());
    file.resize(length + 9, b' ');
    file.push(b'\n');
    values.iter().for_each(|v| v.put(&mut file));
    file
}

/// Writes a history as `.npz`.
///
/// # Errors
/// Those of writing; an archive of 4 GiB or more, which this format's plain form does not have.
pub fn write(out: &mut dyn Write, history: &History) -> Result<()> {
    let (times, places) = (history.times.len(), history.nodes.len());
    let mut archive = Archive::new(out);
    archive.file("time.npy", &array(&[times], &history.times))?;
    archive.file("rate.npy", &array(&[], &[history.rate]))?;
    archive.file("filter.npy", &array(&[3], &[PASS, STOP, ATTENUATION]))?;
    archive.file("turning.npy", &array(&[], &[history.turning]))?;
    archive.file("node.npy", &array(&[places], &history.nodes))?;
    archive.file("reference_position.npy", &array(&[places, 3], history.positions.as_flattened()))?;
    archive.file("normal.npy", &array(&[places, 3], history.normals.as_flattened()))?;
    archive.file("area.npy", &array(&[places], &history.areas))?;
    archive.file("face.npy", &array(&[history.faces.len(), 4], history.faces.as_flattened()))?;
    for quantity in &history.values {
        let shape = [times, places, quantity.components];
        let shape = if quantity.components == 1 { &shape[..2] } else { &shape };
        archive.file(&format!("{}.npy", quantity.name.replace('-', "_")), &array(shape, &quantity.values))?;
    }
    if let Some(force) = &history.road_force {
        archive.file("road_force.npy", &array(&[times, 3], force))?;
    }
    archive.finish()
}
