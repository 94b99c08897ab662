//! The file as a tree of arrays.

use roxmltree::{Document, Node};

use super::super::source::Place;
use super::decode::{Coding, Scalar, decode};
use crate::error::{Error, Result};

/// A file whose arrays can be asked for.
pub struct File<'a> {
    arrays: Vec<Array<'a>>,
    /// Points and cells that the file announces.
    pub points: usize,
    pub cells: usize,
    place: Place,
}

/// An array that is not decoded yet.
pub struct Array<'a> {
    section: String,
    pub name: String,
    kind: String,
    pub components: usize,
    text: String,
    format: String,
    offset: Option<usize>,
    appended: Option<&'a [u8]>,
    coding: Coding,
    length: usize,
    place: Place,
}

const SECTIONS: [&str; 4] = ["Points", "Cells", "PointData", "CellData"];

impl<'a> File<'a> {
    pub fn parse(bytes: &'a [u8], place: Place) -> Result<File<'a>> {
        let bad =
            |problem: String| place.error("VTKFile", problem, "write the grid again, as a .vtu of one piece");
        if !bytes.trim_ascii_end().ends_with(b"</VTKFile>") {
            return Err(bad(
                "not a complete XML file (cut off, or damaged): it does not end with </VTKFile>".into(),
            ));
        }
        let (head, appended) = split(bytes);
        let text = std::str::from_utf8(&head)
            .map_err(|_| bad("the part before <AppendedData> is not text".into()))?;
        let document = Document::parse(text)
            .map_err(|e| bad(format!("not a complete XML file (cut off, or damaged): {e}")))?;
        let root = document.root_element();
        if !root.has_tag_name("VTKFile") || root.attribute("type") != Some("UnstructuredGrid") {
            return Err(bad("this is no <VTKFile type=\"UnstructuredGrid\">".into()));
        }
        let pieces: Vec<Node> = document.descendants().filter(|n| n.has_tag_name("Piece")).collect();
        let [piece] = pieces[..] else { return Err(bad(format!("{} pieces; one is read", pieces.len()))) };
        let raw = appended.is_some() && encoding(bytes) == Some("raw");
        let coding = Coding::of(root, raw).map_err(bad)?;
        let number = |key: &str| {
            let text = piece.attribute(key).unwrap_or_default();
            text.trim()
                .parse::<usize>()
                .map_err(|_| bad(format!("<Piece> has {text:?} as {key}: not a whole number")))
        };
        let (points, cells) = (number("NumberOfPoints")?, number("NumberOfCells")?);
        let mut arrays = Vec::new();
        for section in piece.children().filter(|n| SECTIONS.contains(&n.tag_name().name())) {
            for node in section.children().filter(|n| n.has_tag_name("DataArray")) {
                arrays.push(Array {
                    section: section.tag_name().name().into(),
                    name: node.attribute("Name").unwrap_or_default().into(),
                    kind: node.attribute("type").unwrap_or_default().into(),
                    components: node
                        .attribute("NumberOfComponents")
                        .and_then(|n| n.parse().ok())
                        .unwrap_or(1),
                    text: node.text().unwrap_or_default().into(),
                    format: node.attribute("format").unwrap_or("ascii").into(),
                    offset: node.attribute("offset").and_then(|n| n.parse().ok()),
                    appended,
                    coding,
                    length: bytes.len(),
                    place: place.clone(),
                });
            }
        }
        Ok(File { arrays, points, cells, place })
    }

    /// The array `name` of a section.
    pub fn array(&self, section: &'static str, name: &str) -> Result<&Array<'a>> {
        let found = self.of(section).find(|a| a.name == name);
        found.ok_or_else(|| self.damaged(section, format!("there is no array {name:?}")))
    }

    /// The only array of a section.
    pub fn only(&self, section: &'static str) -> Result<&Array<'a>> {
        self.of(section).next().ok_or_else(|| self.damaged(section, "there is no array".into()))
    }

    pub fn of<'b>(&'b self, section: &'static str) -> impl Iterator<Item = &'b Array<'a>> + 'b {
        self.arrays.iter().filter(move |a| a.section == section)
    }

    pub fn damaged(&self, section: &str, problem: String) -> Error {
        self.place.error(section, problem, "the file is damaged or cut off: write or copy it again")
    }
}

impl Array<'_> {
    pub fn is_whole(&self) -> bool {
        !self.kind.starts_with("Float")
    }

    pub fn reals(&self) -> Result<Vec<f64>> {
        self.values(|s| match s {
            Scalar::Real(v) => Some(v),
            Scalar::Whole(v) => Some(v as f64),
        })
    }

    /// Whole numbers that are not negative.
    pub fn wholes(&self) -> Result<Vec<u64>> {
        self.values(|s| match s {
            Scalar::Whole(v) => u64::try_from(v).ok(),
            Scalar::Real(_) => None,
        })
    }

    /// Whole numbers of either sign.
    pub fn integers(&self) -> Result<Vec<i64>> {
        self.values(|s| match s {
            Scalar::Whole(v) => i64::try_from(v).ok(),
            Scalar::Real(_) => None,
        })
    }

    fn values<T>(&self, take: impl Fn(Scalar) -> Option<T>) -> Result<Vec<T>> {
        let bad = |problem: String| {
            let key = format!("{} array {:?}", self.section, self.name);
            self.place.error(&key, problem, "the file is damaged or cut off: write or copy it again")
        };
        let source = match self.format.as_str() {
            "ascii" => return super::decode::text(&self.text, &self.kind, take).map_err(bad),
            "binary" => self.text.trim().as_bytes(),
            "appended" => {
                let at = self.offset.ok_or_else(|| bad("it has no offset".into()))?;
                self.appended
                    .and_then(|a| a.get(at..))
                    .ok_or_else(|| bad(format!("its offset {at} is behind the end")))?
            }
            other => return Err(bad(format!("format {other:?} is not known"))),
        };
        let base64 = self.format == "binary" || !self.coding.raw;
        let bytes = decode(source, base64, &self.coding, self.length).map_err(bad)?;
        self.coding.numbers(&bytes, &self.kind, take).map_err(bad)
    }
}

/// What is XML, closed, and the appended data behind its underscore, which may be raw.
fn split(bytes: &[u8]) -> (Vec<u8>, Option<&[u8]>) {
    let Some(at) = find(bytes, b"<AppendedData") else { return (bytes.to_vec(), None) };
    let mut head = bytes[..at].to_vec();
    head.extend_from_slice(b"</VTKFile>");
    let data = bytes[at..].iter().position(|&b| b == b'>').map(|end| &bytes[at + end + 1..]);
    let data = data.and_then(|d| d.iter().position(|&b| b == b'_').map(|u| &d[u + 1..]));
    (head, data)
}

/// Encoding of the appended data.
fn encoding(bytes: &[u8]) -> Option<&str> {
    let tag = &bytes[find(bytes, b"<AppendedData")?..];
    let tag = std::str::from_utf8(&tag[..tag.iter().position(|&b| b == b'>')?]).ok()?;
    let (_, rest) = tag.split_once("encoding")?;
    rest.split(['"', '\'']).nth(1)
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|w| w == what)
}
