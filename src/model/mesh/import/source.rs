//! A file that is read from front to back, with the line for messages, and no line or block longer than is sane.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Longest line of text [bytes]. Formats that are made of lines have at most some hundred characters in one.
const LONGEST: u64 = 1 << 16;

/// Bytes that are read at a time.
const BUFFER: usize = 1 << 20;

/// Where something stands in a file: for messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    pub file: PathBuf,
    /// From 1; none in a binary part.
    pub line: Option<usize>,
}

impl Place {
    /// An error here; `key`: the section or keyword that it is about.
    pub fn error(&self, key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::Scene {
            file: self.file.display().to_string(),
            line: self.line,
            key: key.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }
}

/// A file as lines and blocks of bytes.
#[derive(Debug)]
pub struct Source {
    path: PathBuf,
    reader: BufReader<File>,
    line: Vec<u8>,
    /// Number of the line read last, from 1.
    number: usize,
    /// Bytes that the file has.
    length: u64,
}

impl Source {
    pub fn open(path: &Path) -> Result<Source> {
        let action = "read this mesh";
        let file = File::open(path).map_err(Error::io(path, action))?;
        let about = file.metadata().map_err(Error::io(path, action))?;
        if !about.is_file() {
            let place = Place { file: path.into(), line: None };
            return Err(place.error("file", "this is no plain file", "name the file of a mesh"));
        }
        let reader = BufReader::with_capacity(BUFFER, file);
        Ok(Source { path: path.into(), reader, line: Vec::new(), number: 0, length: about.len() })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where the line that was read last stands.
    pub fn place(&self) -> Place {
        Place { file: self.path.clone(), line: Some(self.number).filter(|&n| n > 0) }
    }

    /// Number of the line that was read last.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The next line without its end, blanks at both ends left out; none at the end of the file.
    pub fn next_line(&mut self) -> Result<Option<&[u8]>> {
        self.line.clear();
        let read = (&mut self.reader).take(LONGEST + 1).read_until(b'\n', &mut self.line);
        let read = read.map_err(Error::io(&self.path, "read this mesh"))?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        if read as u64 > LONGEST {
            let problem = format!("a line of more than {LONGEST} characters");
            return Err(self.place().error(
                "line",
                problem,
                "no mesh program writes such lines: is this the right file?",
            ));
        }
        // Editors of Windows mark UTF-8 by three bytes before the text.
        let line: &[u8] = match self.number {
            1 => self.line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&self.line),
            _ => &self.line,
        };
        Ok(Some(line.trim_ascii()))
    }

    /// The next line with anything on it.
    pub fn next_full_line(&mut self) -> Result<Option<&[u8]>> {
        loop {
            match self.next_line()? {
                None => return Ok(None),
                Some([]) => {}
                Some(_) => return Ok(Some(self.line.trim_ascii())),
            }
        }
    }

    /// The next `count` bytes; no more than the file has are ever asked for.
    pub fn bytes(&mut self, count: usize, key: &str) -> Result<Vec<u8>> {
        let mut bytes = Vec::with_capacity(count.min(self.length as usize));
        let read = (&mut self.reader).take(count as u64).read_to_end(&mut bytes);
        read.map_err(Error::io(&self.path, "read this mesh"))?;
        if bytes.len() < count {
            let problem = format!("{count} bytes should follow, but the file ends after {}", bytes.len());
            return Err(self.place().error(key, problem, "the file is cut off: write or copy it again"));
        }
        Ok(bytes)
    }

    /// All of the file.
    pub fn whole(&mut self) -> Result<Vec<u8>> {
        let mut bytes = Vec::with_capacity(self.length as usize);
        self.reader.read_to_end(&mut bytes).map_err(Error::io(&self.path, "read this mesh"))?;
        Ok(bytes)
    }

    /// The beginning of the file, before anything of it is read.
    pub fn beginning(&mut self) -> Result<&[u8]> {
        self.reader.fill_buf().map_err(Error::io(&self.path, "read this mesh"))
    }

    /// How many items of `bytes` each the file can hold at most: room for `count` of them is not made on a file's word alone.
    pub fn room(&self, count: usize, bytes: u64) -> usize {
        count.min((self.length / bytes) as usize)
    }

    /// Skips lines until one begins with `end`; false if there is none.
    pub fn skip_to(&mut self, end: &[u8]) -> Result<bool> {
        loop {
            self.line.clear();
            // Binary data may be a line of any length, which is skipped in pieces.
            let read = (&mut self.reader).take(LONGEST).read_until(b'\n', &mut self.line);
            if read.map_err(Error::io(&self.path, "read this mesh"))? == 0 {
                return Ok(false);
            }
            self.number += usize::from(self.line.ends_with(b"\n"));
            if self.line.starts_with(end) {
                return Ok(true);
            }
        }
    }
}
