//! Numbers of arrays: base64 or raw, whole or in compressed blocks.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use roxmltree::Node;

use super::super::numbers::shown;

/// How binary arrays of a file are written.
#[derive(Debug, Clone, Copy)]
pub struct Coding {
    /// Whether appended data is raw; else base64.
    pub raw: bool,
    big_endian: bool,
    /// Bytes of a number of a header.
    header: usize,
    zlib: bool,
}

/// A number of an array.
#[derive(Debug, Clone, Copy)]
pub enum Scalar {
    Real(f64),
    Whole(i128),
}

impl Coding {
    pub fn of(root: Node, raw: bool) -> Result<Coding, String> {
        let header = match root.attribute("header_type") {
            None | Some("UInt32") => 4,
            Some("UInt64") => 8,
            Some(other) => return Err(format!("header_type {other:?} is not known")),
        };
        let zlib = match root.attribute("compressor") {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                return Err(format!("compressor {other:?} is not read: write it with zlib, or without"));
            }
        };
        Ok(Coding { raw, big_endian: root.attribute("byte_order") == Some("BigEndian"), header, zlib })
    }

    /// Numbers of a type.
    pub fn numbers<T>(
        &self,
        bytes: &[u8],
        kind: &str,
        take: impl Fn(Scalar) -> Option<T>,
    ) -> Result<Vec<T>, String> {
        let size = match kind {
            "Int8" | "UInt8" => 1,
            "Int16" | "UInt16" => 2,
            "Int32" | "UInt32" | "Float32" => 4,
            "Int64" | "UInt64" | "Float64" => 8,
            other => return Err(format!("numbers of type {other:?} are not known")),
        };
        if !bytes.len().is_multiple_of(size) {
            return Err(format!("{} bytes are no whole {kind}", bytes.len()));
        }
        let wrong = || format!("a number of type {kind} cannot stand here");
        let number = |chunk: &[u8]| take(self.number(chunk, kind)).ok_or_else(wrong);
        bytes.chunks_exact(size).map(number).collect()
    }

    fn number(&self, chunk: &[u8], kind: &str) -> Scalar {
        let mut eight = [0; 8];
        let size = chunk.len();
        eight[..size].copy_from_slice(chunk);
        if self.big_endian {
            eight[..size].reverse();
        }
        let bits = u64::from_le_bytes(eight);
        match kind {
            "Float64" => Scalar::Real(f64::from_bits(bits)),
            "Float32" => Scalar::Real(f64::from(f32::from_bits(bits as u32))),
            _ if kind.starts_with('U') => Scalar::Whole(i128::from(bits)),
            // The sign is the highest bit of as many as there are.
            _ => Scalar::Whole(i128::from((bits << (64 - 8 * size)) as i64 >> (64 - 8 * size))),
        }
    }

    fn header_number(&self, bytes: &[u8]) -> u64 {
        let kind = if self.header == 4 { "UInt32" } else { "UInt64" };
        match self.number(bytes, kind) {
            Scalar::Whole(v) => v as u64,
            Scalar::Real(_) => 0,
        }
    }
}

/// The bytes of an array that begins at `source`. `length`: of the file, which bounds what may come out.
pub fn decode(source: &[u8], base64: bool, coding: &Coding, length: usize) -> Result<Vec<u8>, String> {
    let cut = || "its data is cut off".to_string();
    let head = if coding.zlib { 3 } else { 1 };
    let (bytes, used) = take(source, base64, head * coding.header)?;
    let number = |i: usize| coding.header_number(&bytes[i * coding.header..(i + 1) * coding.header]);
    if !coding.zlib {
        let count = usize::try_from(number(0)).map_err(|_| cut())?;
        if !base64 {
            return source.get(used..).and_then(|s| s.get(..count)).map(<[u8]>::to_vec).ok_or_else(cut);
        }
        // Header and data are one run of base64.
        let total = count.checked_add(coding.header).ok_or_else(cut)?;
        return Ok(take(source, true, total)?.0.split_off(coding.header));
    }
    blocks(source, base64, coding, [number(0), number(1), number(2)], length)
}

/// Compressed blocks: their count, size, that of the last, then compressed sizes; then, as a run of its own, the data.
fn blocks(
    source: &[u8],
    base64: bool,
    coding: &Coding,
    [count, size, last]: [u64; 3],
    length: usize,
) -> Result<Vec<u8>, String> {
    /// Zlib makes a block of equal numbers a thousand times smaller; a mesh is not all equal numbers.
    const MOST: u64 = 64;
    let bound = MOST * length as u64 + (1 << 20);
    let total = count.saturating_sub(u64::from(last > 0)).saturating_mul(size).saturating_add(last);
    if total > bound || count > length as u64 {
        return Err(format!("it says that it holds {total} bytes in {count} blocks, of a file of {length}"));
    }
    let header = (3 + count as usize) * coding.header;
    let (sizes, used) = take(source, base64, header)?;
    let size_of =
        |i: usize| coding.header_number(&sizes[(3 + i) * coding.header..(4 + i) * coding.header]) as usize;
    let compressed = (0..count as usize).try_fold(0_usize, |sum, i| sum.checked_add(size_of(i)));
    let compressed = compressed.ok_or("its blocks are too large")?;
    let (data, _) = take(source.get(used..).unwrap_or_default(), base64, compressed)?;
    let (mut all, mut at) = (Vec::with_capacity(total as usize), 0);
    for i in 0..count as usize {
        let block = &data[at..at + size_of(i)];
        let whole = if i + 1 == count as usize && last > 0 { last } else { size };
        let bytes = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(block, whole as usize);
        let bytes = bytes.map_err(|_| format!("block {i} does not decompress"))?;
        if bytes.len() as u64 != whole {
            return Err(format!("block {i} has {} bytes, not {whole}", bytes.len()));
        }
        all.extend(bytes);
        at += size_of(i);
    }
    Ok(all)
}

/// The first `count` bytes, and how much of the source they take.
fn take(source: &[u8], base64: bool, count: usize) -> Result<(Vec<u8>, usize), String> {
    let cut = || "its data is cut off".to_string();
    if !base64 {
        return Ok((source.get(..count).ok_or_else(cut)?.to_vec(), count));
    }
    let run = count.div_ceil(3).checked_mul(4).ok_or_else(cut)?;
    let text = source.get(..run).ok_or_else(cut)?;
    let mut bytes = STANDARD.decode(text).map_err(|e| format!("its base64 is damaged: {e}"))?;
    bytes.truncate(count);
    match bytes.len() == count {
        true => Ok((bytes, run)),
        false => Err(cut()),
    }
}

/// Numbers of an array that is text.
pub fn text<T>(text: &str, kind: &str, take: impl Fn(Scalar) -> Option<T>) -> Result<Vec<T>, String> {
    let is_real = kind.starts_with("Float");
    let number = |word: &str| {
        let wrong = || format!("{} is no number of type {kind}", shown(word.as_bytes()));
        let scalar = match is_real {
            true => Scalar::Real(word.parse().map_err(|_| wrong())?),
            false => Scalar::Whole(word.parse().map_err(|_| wrong())?),
        };
        take(scalar).ok_or_else(wrong)
    };
    text.split_ascii_whitespace().map(number).collect()
}
