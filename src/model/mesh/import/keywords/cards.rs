//! Keyword files as cards and data lines: comments, continued and included lines are dealt with here.
//!
//! Two dialects are alike: Abaqus' input files, whose keyword lines begin with `*`, and FrontISTR's meshes (HEC-MW), where
//! they begin with `!`.

use std::path::{Path, PathBuf};

use super::super::numbers::fields;
use super::super::source::{Place, Source};
use crate::error::Result;

/// What a keyword line begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    Abaqus,
    FrontIstr,
}

/// Deepest nesting of included files, and most of them: a file that includes another twice, which includes a third twice, ...
/// is a few bytes and without end.
const DEEPEST: usize = 16;
const MOST_FILES: usize = 1000;

/// A keyword line with its parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Card {
    /// In capitals, single blanks: `SOLID SECTION`.
    pub name: String,
    /// Names in capitals, values as written.
    parameters: Vec<(String, String)>,
    pub place: Place,
}

/// What a file consists of.
#[derive(Debug)]
pub enum Event {
    Card(Card),
    /// A line of data is ready: [`Cards::data`].
    Data,
    End,
}

/// The cards and data lines of a file and of those that it includes.
#[derive(Debug)]
pub struct Cards {
    dialect: Dialect,
    open: Vec<Source>,
    files: usize,
    data: Vec<u8>,
}

impl Card {
    /// A parameter's value; empty where it is a mere word. Names may be cut short to three letters, as decks do.
    pub fn get(&self, name: &str) -> Option<&str> {
        let exact = self.parameters.iter().find(|p| p.0 == name);
        let cut = |given: &str| given.len() >= 3 && name.starts_with(given);
        exact.or_else(|| self.parameters.iter().find(|p| cut(&p.0))).map(|p| p.1.as_str())
    }

    /// A parameter that must have a value.
    pub fn need(&self, name: &str) -> Result<&str> {
        let value = self.get(name).filter(|v| !v.is_empty());
        value.ok_or_else(|| {
            self.error(format!("{name}= is missing"), format!("write *{}, {name}=...", self.name))
        })
    }

    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    pub fn error(&self, problem: impl Into<String>, remedy: impl Into<String>) -> crate::Error {
        self.place.error(&format!("*{}", self.name), problem, remedy)
    }

    fn parse(text: &[u8], place: Place) -> Card {
        let mut parts = fields(text).map(|f| String::from_utf8_lossy(f).into_owned());
        let capitals = |t: &str| t.split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase();
        let name = capitals(&parts.next().unwrap_or_default());
        let parameter = |text: String| match text.split_once('=') {
            Some((key, value)) => (capitals(key), unquoted(value.trim())),
            None => (capitals(&text), String::new()),
        };
        Card { name, parameters: parts.filter(|p| !p.is_empty()).map(parameter).collect(), place }
    }
}

fn unquoted(text: &str) -> String {
    let inside = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
    inside.unwrap_or(text).into()
}

impl Cards {
    pub fn open(path: &Path, dialect: Dialect) -> Result<Cards> {
        Ok(Cards { dialect, open: vec![Source::open(path)?], files: 1, data: Vec::new() })
    }

    /// The line of data that was announced last.
    pub fn data(&self) -> &[u8] {
        &self.data
    }

    /// Where the last card or line of data stands.
    pub fn place(&self) -> Place {
        self.source().place()
    }

    /// File and line of it.
    pub fn file(&self) -> (&Path, usize) {
        (self.source().path(), self.source().number())
    }

    fn source(&self) -> &Source {
        self.open.last().expect("the first file stays open")
    }

    pub fn next(&mut self) -> Result<Event> {
        loop {
            let dialect = self.dialect;
            let source = self.open.last_mut().expect("the first file stays open");
            let Some(line) = source.next_line()? else {
                // The first file stays, for messages.
                if self.open.len() == 1 {
                    return Ok(Event::End);
                }
                self.open.pop();
                continue;
            };
            if line.is_empty() || dialect.is_comment(line) {
                continue;
            }
            let Some(rest) = dialect.keyword(line) else {
                self.data.clear();
                self.data.extend_from_slice(line);
                return Ok(Event::Data);
            };
            let (text, place) = (rest.to_vec(), source.place());
            let card = Card::parse(&self.continued(text)?, place);
            if let Some(file) = self.included(&card) {
                self.include(&file, &card)?;
                if card.name == "INCLUDE" {
                    continue;
                }
            }
            return Ok(Event::Card(card));
        }
    }

    /// The data line after this one, where one goes on; none at a keyword or the end, which stay to be read.
    ///
    /// A keyword line cannot be given back: whoever asks knows that the line before ended with a comma.
    pub fn next_data(&mut self) -> Result<bool> {
        loop {
            let dialect = self.dialect;
            let source = self.open.last_mut().expect("the first file stays open");
            match source.next_line()? {
                None => return Ok(false),
                Some(line) if line.is_empty() || dialect.is_comment(line) => {}
                Some(line) if dialect.keyword(line).is_some() => {
                    return Err(source.place().error(
                        "data",
                        "a keyword in the middle of a data line",
                        "finish the line above",
                    ));
                }
                Some(line) => {
                    self.data.clear();
                    self.data.extend_from_slice(line);
                    return Ok(true);
                }
            }
        }
    }

    /// A keyword line with those that it is continued on: it ends with a comma.
    fn continued(&mut self, mut text: Vec<u8>) -> Result<Vec<u8>> {
        /// Parameters of a keyword do not fill a page.
        const LONGEST: usize = 1 << 14;
        while text.ends_with(b",") {
            let dialect = self.dialect;
            let source = self.open.last_mut().expect("the first file stays open");
            let Some(line) = source.next_line()? else { break };
            if dialect.is_comment(line) {
                continue;
            }
            if dialect.keyword(line).is_some() || text.len() > LONGEST {
                let problem = "a keyword line that does not end: its last character is a comma";
                return Err(source.place().error(
                    "keyword",
                    problem,
                    "remove the comma, or write the parameter that it announces",
                ));
            }
            text.extend_from_slice(line);
        }
        Ok(text)
    }

    /// The file that a card says its data is in, or that stands in its place.
    fn included(&self, card: &Card) -> Option<String> {
        let takes_file = ["INCLUDE", "NODE", "ELEMENT", "NSET", "ELSET"].contains(&card.name.as_str());
        takes_file.then(|| card.get("INPUT")).flatten().filter(|f| !f.is_empty()).map(Into::into)
    }

    fn include(&mut self, file: &str, card: &Card) -> Result<()> {
        let folder = self.source().path().parent().unwrap_or(Path::new("")).to_path_buf();
        let path = folder.join(file.replace('\\', "/"));
        let same = |path: &Path| -> Option<PathBuf> { std::fs::canonicalize(path).ok() };
        let Some(canonical) = same(&path) else {
            let problem = format!("there is no file {}", path.display());
            return Err(
                card.error(problem, "names are relative to the file that includes; put it there, or name it")
            );
        };
        if self.open.iter().any(|s| same(s.path()).as_ref() == Some(&canonical)) {
            return Err(
                card.error(format!("{file:?} includes itself"), "remove the *INCLUDE that closes the circle")
            );
        }
        self.files += 1;
        if self.open.len() > DEEPEST || self.files > MOST_FILES {
            let problem = format!(
                "more than {DEEPEST} included files in one another, or more than {MOST_FILES} in all"
            );
            return Err(card.error(problem, "put what belongs together into one file"));
        }
        self.open.push(Source::open(&path)?);
        Ok(())
    }
}

impl Dialect {
    fn is_comment(self, line: &[u8]) -> bool {
        match self {
            Dialect::Abaqus => line.starts_with(b"**"),
            Dialect::FrontIstr => line.starts_with(b"!!") || line.starts_with(b"#"),
        }
    }

    fn keyword(self, line: &[u8]) -> Option<&[u8]> {
        match self {
            Dialect::Abaqus => line.strip_prefix(b"*"),
            Dialect::FrontIstr => line.strip_prefix(b"!"),
        }
    }
}
