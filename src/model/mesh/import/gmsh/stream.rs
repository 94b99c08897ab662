//! Numbers of a section, whether text or binary.

use super::super::numbers::{real, sane, shown, whole};
use super::super::source::{Place, Source};
use crate::error::{Error, Result};

/// Binary blocks are read in pieces of so many items: a count that lies asks for no more memory than the file has.
const PIECE: usize = 1 << 14;

/// A file after its header.
pub struct Stream {
    source: Source,
    binary: bool,
    section: String,
    /// Line of text that is being read, and how much of it is.
    line: Vec<u8>,
    at: usize,
}

/// What a reader of binary numbers takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// `int`.
    Four,
    /// `size_t`.
    Eight,
}

impl Stream {
    pub fn new(source: Source, binary: bool) -> Result<Stream> {
        Ok(Stream { source, binary, section: String::new(), line: Vec::new(), at: 0 })
    }

    pub fn binary(&self) -> bool {
        self.binary
    }

    pub fn place(&self) -> Place {
        let place = self.source.place();
        // Lines mean nothing between binary numbers.
        if self.binary { Place { line: None, ..place } } else { place }
    }

    pub fn error(&self, problem: impl Into<String>, remedy: &str) -> Error {
        self.place().error(&format!("${}", self.section), problem, remedy)
    }

    /// An error of what cannot be right in a whole file.
    pub fn damaged(&self, problem: impl Into<String>) -> Error {
        self.error(problem, "the file is damaged or cut off: write or copy it again")
    }

    /// The name of the next section, without its dollar; none at the end of the file.
    pub fn section(&mut self) -> Result<Option<String>> {
        (self.line, self.at) = (Vec::new(), 0);
        let Some(line) = self.source.next_full_line()? else { return Ok(None) };
        match line.strip_prefix(b"$") {
            Some(name) => {
                self.section = String::from_utf8_lossy(name).into_owned();
                Ok(Some(self.section.clone()))
            }
            None => {
                let problem = format!("{} stands between sections", shown(line));
                Err(self.damaged(problem))
            }
        }
    }

    /// Skips a section that is of no use.
    pub fn skip(&mut self, section: &str) -> Result<()> {
        match self.source.skip_to(format!("$End{section}").as_bytes())? {
            true => Ok(()),
            false => Err(self.damaged(format!("$End{section} is missing"))),
        }
    }

    /// Reads the end of a section.
    pub fn end(&mut self, section: &str) -> Result<()> {
        let rest = self.line[self.at.min(self.line.len())..].trim_ascii();
        if !rest.is_empty() {
            let problem = format!("{} stands before $End{section}", shown(rest));
            return Err(self.damaged(problem));
        }
        let expected = format!("$End{section}");
        match self.source.next_full_line()? {
            Some(line) if line == expected.as_bytes() => Ok(()),
            Some(line) => {
                let problem = format!(
                    "{} stands where {expected} should: the counts of the section are not right",
                    shown(line)
                );
                Err(self.damaged(problem))
            }
            None => Err(self.damaged(format!("{expected} is missing"))),
        }
    }

    /// The next line as text, in text files and binary ones.
    pub fn text_line(&mut self) -> Result<String> {
        let line = self.source.next_full_line()?.map(|l| String::from_utf8_lossy(l).into_owned());
        line.ok_or_else(|| self.damaged("the file ends in the section"))
    }

    /// Room for `count` items of at least two bytes each.
    pub fn room(&self, count: usize) -> usize {
        self.source.room(count, 2)
    }

    /// The next word of a text file.
    fn word(&mut self) -> Result<&[u8]> {
        loop {
            let rest = &self.line[self.at.min(self.line.len())..];
            if let Some(begin) = rest.iter().position(|b| !b.is_ascii_whitespace()) {
                let length =
                    rest[begin..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - begin);
                let from = self.at + begin;
                self.at = from + length;
                return Ok(&self.line[from..from + length]);
            }
            self.line.clear();
            self.at = 0;
            match self.source.next_line()? {
                Some(line) if line.starts_with(b"$") => {
                    let problem = format!(
                        "{} stands where numbers should: the counts of the section are not right",
                        shown(line)
                    );
                    return Err(self.damaged(problem));
                }
                Some(line) => self.line.extend_from_slice(line),
                None => return Err(self.damaged("the file ends in the section")),
            }
        }
    }

    /// A whole number that is not negative.
    pub fn whole(&mut self, width: Width) -> Result<u64> {
        Ok(self.wholes(1, width)?[0])
    }

    /// A whole number of either sign: tags of entities.
    pub fn integer(&mut self) -> Result<i64> {
        if self.binary {
            let bytes = self.bytes(4)?;
            return Ok(i64::from(i32::from_ne_bytes(bytes[..4].try_into().expect("four bytes"))));
        }
        let word = self.word()?;
        let value = std::str::from_utf8(word).ok().and_then(|w| w.parse::<i32>().ok());
        let problem = format!("{} is not a whole number", shown(word));
        value.map(i64::from).ok_or_else(|| self.damaged(problem))
    }

    /// So many whole numbers.
    pub fn wholes(&mut self, count: usize, width: Width) -> Result<Vec<u64>> {
        let mut all = Vec::with_capacity(self.room(count));
        if !self.binary {
            for _ in 0..count {
                let number = whole(self.word()?);
                all.push(number.map_err(|problem| self.damaged(problem))?);
            }
            return Ok(all);
        }
        let size = if width == Width::Four { 4 } else { 8 };
        while all.len() < count {
            let bytes = self.bytes(size * PIECE.min(count - all.len()))?;
            for chunk in bytes.chunks_exact(size) {
                let number = match width {
                    Width::Four => i64::from(i32::from_ne_bytes(chunk.try_into().expect("four bytes"))),
                    Width::Eight => i64::from_ne_bytes(chunk.try_into().expect("eight bytes")),
                };
                let number = u64::try_from(number);
                all.push(
                    number.map_err(|_| self.damaged("a negative number where a count or a tag should be"))?,
                );
            }
        }
        Ok(all)
    }

    /// So many real numbers.
    pub fn reals(&mut self, count: usize) -> Result<Vec<f64>> {
        let mut all = Vec::with_capacity(self.room(count));
        if !self.binary {
            for _ in 0..count {
                let number = real(self.word()?);
                all.push(number.map_err(|problem| self.damaged(problem))?);
            }
            return Ok(all);
        }
        while all.len() < count {
            let bytes = self.bytes(8 * PIECE.min(count - all.len()))?;
            for chunk in bytes.chunks_exact(8) {
                let number = sane(f64::from_ne_bytes(chunk.try_into().expect("eight bytes")));
                all.push(number.map_err(|problem| self.damaged(problem))?);
            }
        }
        Ok(all)
    }

    fn bytes(&mut self, count: usize) -> Result<Vec<u8>> {
        let key = format!("${}", self.section);
        self.source.bytes(count, &key)
    }
}
