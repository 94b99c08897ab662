//! Arrays to a `.vtu` file.

use std::borrow::Cow;
use std::io::Write;

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;

use super::{BYTE_ORDER, Scalar, Section};

/// A named array of tuples.
pub struct Array<'a> {
    section: Section,
    name: Cow<'a, str>,
    kind: &'static str,
    components: usize,
    tuples: usize,
    bytes: Cow<'a, [u8]>,
}

impl<'a> Array<'a> {
    /// One tuple of `components` numbers for each item of `values`, shape `[tuples, components]` flat.
    pub fn new<T: Scalar>(
        section: Section,
        name: impl Into<Cow<'a, str>>,
        components: usize,
        values: impl Into<Cow<'a, [T]>>,
    ) -> Self {
        let values = values.into();
        let tuples = values.len() / components;
        let bytes = match values {
            Cow::Borrowed(v) => Cow::Borrowed(bytemuck::cast_slice(v)),
            Cow::Owned(v) => Cow::Owned(bytemuck::cast_slice(&v).to_vec()),
        };
        Array { section, name: name.into(), kind: T::VTK, components, tuples, bytes }
    }

    /// Characters that the array takes in the appended block.
    fn encoded_len(&self) -> usize {
        (size_of::<u64>() + self.bytes.len()).div_ceil(3) * 4
    }

    fn header(&self, offset: usize) -> String {
        let Array { name, kind, components, tuples, .. } = self;
        let name = escaped(name);
        let mut shape = String::new();
        // Readers make a list of single numbers of what says nothing, a matrix of what says 1.
        if *components > 1 {
            shape += &format!(" NumberOfComponents=\"{components}\"");
        }
        // Field data has no count of its own; elsewhere the piece gives the tuples.
        if self.section == Section::FieldData {
            shape += &format!(" NumberOfTuples=\"{tuples}\"");
        }
        format!("<DataArray type=\"{kind}\" Name=\"{name}\"{shape} format=\"appended\" offset=\"{offset}\"/>")
    }
}

/// A text as it may stand in an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Writes a grid of `points` points and `cells` cells with its arrays.
pub fn write(out: &mut dyn Write, points: usize, cells: usize, arrays: &[Array]) -> std::io::Result<()> {
    let offsets: Vec<usize> =
        arrays.iter().scan(0, |end, a| Some(std::mem::replace(end, *end + a.encoded_len()))).collect();
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{BYTE_ORDER}\" header_type=\"UInt64\">"
    )?;
    writeln!(out, "  <UnstructuredGrid>")?;
    for section in Section::ALL {
        if section == Section::Points {
            writeln!(out, "  <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">")?;
        }
        writeln!(out, "    <{section:?}>")?;
        for (array, &offset) in arrays.iter().zip(&offsets).filter(|(a, _)| a.section == section) {
            writeln!(out, "      {}", array.header(offset))?;
        }
        writeln!(out, "    </{section:?}>")?;
    }
    write!(out, "  </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"base64\">\n_")?;
    for array in arrays {
        let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
        encoder.write_all(&(array.bytes.len() as u64).to_ne_bytes())?;
        encoder.write_all(&array.bytes)?;
        encoder.finish()?;
    }
    writeln!(out, "\n  </AppendedData>\n</VTKFile>")
}
