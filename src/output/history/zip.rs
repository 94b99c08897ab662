//! An archive of stored files, as NumPy's `.npz` is one: APPNOTE.TXT of PKWARE, without compression.

use std::io::{Error, Result, Write};

/// Versions needed: 2.0. Times: 1980-01-01, since the same run gives the same bytes.
const VERSION: u16 = 20;
const DATE: u16 = 0x21;

/// An archive that is being written.
pub struct Archive<'w> {
    out: &'w mut dyn Write,
    at: u64,
    directory: Vec<u8>,
    files: u16,
}

impl<'w> Archive<'w> {
    pub fn new(out: &'w mut dyn Write) -> Archive<'w> {
        Archive { out, at: 0, directory: Vec::new(), files: 0 }
    }

    /// Appends a file.
    pub fn file(&mut self, name: &str, content: &[u8]) -> Result<()> {
        let sums = [crc32fast::hash(content), small(content.len() as u64)?, small(content.len() as u64)?];
        let offset = small(self.at)?;
        // Needed, flags, method (stored), time, date; sums; length of name, of extra fields.
        let mut common = Vec::new();
        [VERSION, 0, 0, 0, DATE].iter().for_each(|w| common.extend(w.to_le_bytes()));
        sums.iter().for_each(|w| common.extend(w.to_le_bytes()));
        [name.len() as u16, 0].iter().for_each(|w| common.extend(w.to_le_bytes()));
        self.put(b"PK\x03\x04")?;
        self.put(&common)?;
        self.put(name.as_bytes())?;
        self.put(content)?;
        self.directory.extend(b"PK\x01\x02");
        self.directory.extend(VERSION.to_le_bytes());
        self.directory.extend(&common);
        // Comment's length, disk, inner attributes; outer attributes; where it is.
        [0u16; 3].iter().for_each(|w| self.directory.extend(w.to_le_bytes()));
        [0, offset].iter().for_each(|w: &u32| self.directory.extend(w.to_le_bytes()));
        self.directory.extend(name.as_bytes());
        self.files += 1;
        Ok(())
    }

    /// Writes the directory.
    pub fn finish(mut self) -> Result<()> {
        let (start, directory) = (small(self.at)?, std::mem::take(&mut self.directory));
        self.put(&directory)?;
        let mut end = b"PK\x05\x06".to_vec();
        [0, 0, self.files, self.files].iter().for_each(|w: &u16| end.extend(w.to_le_bytes()));
        [directory.len() as u32, start].iter().for_each(|w| end.extend(w.to_le_bytes()));
        end.extend(0u16.to_le_bytes());
        self.put(&end)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.at += bytes.len() as u64;
        self.out.write_all(bytes)
    }
}

/// A number that the plain form has room for.
fn small(size: u64) -> Result<u32> {
    u32::try_from(size).map_err(|_| {
        Error::other(
            "a history of 4 GiB or more; ask for fewer nodes or quantities, a lower rate or fewer stages",
        )
    })
}
