//! VTK's XML format for unstructured grids (`.vtu`), binary appended: arrays of numbers in, arrays out.
//!
//! The appended block is base64: raw bytes are smaller, but they are not XML, and readers built on strict
//! parsers (newer expat, vtkio) refuse them. Each array is one base64 run of a `u64` byte count and the
//! values, in the host's byte order; its `offset` counts characters from the underscore.
//!
//! Format: VTK User's Guide, "XML File Formats".

mod read;
mod write;

pub use read::Grid;
pub use write::{Array, write};

const BYTE_ORDER: &str = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };

/// Numbers an array can hold, with VTK's name for them.
pub trait Scalar: bytemuck::Pod {
    const VTK: &'static str;
}
impl Scalar for f64 {
    const VTK: &'static str = "Float64";
}
impl Scalar for i32 {
    const VTK: &'static str = "Int32";
}
impl Scalar for u8 {
    const VTK: &'static str = "UInt8";
}
impl Scalar for u64 {
    const VTK: &'static str = "UInt64";
}

/// The parts of a grid that hold arrays, in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Section {
    FieldData,
    Points,
    Cells,
    PointData,
    CellData,
}

impl Section {
    const ALL: [Section; 5] =
        [Section::FieldData, Section::Points, Section::Cells, Section::PointData, Section::CellData];
}
