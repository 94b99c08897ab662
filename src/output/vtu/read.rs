//! A `.vtu` file to arrays.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{BYTE_ORDER, Scalar, Section};
use crate::{Error, Result};

/// A grid that was read: its arrays, still encoded.
pub struct Grid {
    path: PathBuf,
    /// Number of points and of cells.
    pub points: usize,
    pub cells: usize,
    headers: HashMap<(Section, String), Header>,
    appended: String,
}

struct Header {
    kind: String,
    components: usize,
    offset: usize,
}

impl Grid {
    /// Reads a file as [`write`](super::write) leaves it.
    ///
    /// # Errors
    /// [`Error::Io`], or [`Error::Format`] with what is wrong: not XML (a truncated file), another kind of
    /// VTK file, another byte order, arrays that are not appended.
    pub fn read(path: &Path) -> Result<Grid> {
        let bad = |problem: String| Error::Format { path: path.into(), problem };
        let bytes = std::fs::read(path).map_err(Error::io(path, "read this file"))?;
        let text = String::from_utf8(bytes).map_err(|_| bad("not a text file".into()))?;
        let document = roxmltree::Document::parse(&text)
            .map_err(|e| bad(format!("not a complete XML file (cut off, or damaged): {e}")))?;
        let root = document.root_element();
        let expected = [("type", "UnstructuredGrid"), ("byte_order", BYTE_ORDER), ("header_type", "UInt64")];
        for (key, value) in expected {
            if root.attribute(key) != Some(value) {
                let found = root.attribute(key).unwrap_or("nothing");
                return Err(bad(format!("<VTKFile> has {found} as {key}; {value} is expected")));
            }
        }
        let find = |name: &str| {
            let node = document.descendants().find(|n| n.has_tag_name(name));
            node.ok_or_else(|| bad(format!("there is no <{name}>")))
        };
        let piece = find("Piece")?;
        let mut headers = HashMap::new();
        for section in Section::ALL {
            for node in find(&format!("{section:?}"))?.children().filter(|n| n.is_element()) {
                let name = node.attribute("Name").unwrap_or_default().to_owned();
                let kind = node.attribute("type").unwrap_or_default().to_owned();
                let single = !node.has_attribute("NumberOfComponents");
                let components = if single { 1 } else { number(&bad, node, "NumberOfComponents")? };
                let offset = number(&bad, node, "offset")?;
                headers.insert((section, name), Header { kind, components, offset });
            }
        }
        let appended = find("AppendedData")?.text().unwrap_or_default().trim();
        let appended =
            appended.strip_prefix('_').ok_or_else(|| bad("the appended data has no start".into()))?;
        Ok(Grid {
            path: path.into(),
            points: number(&bad, piece, "NumberOfPoints")?,
            cells: number(&bad, piece, "NumberOfCells")?,
            headers,
            appended: appended.to_owned(),
        })
    }

    /// Whether there is such an array.
    pub fn has(&self, section: Section, name: &str) -> bool {
        self.headers.contains_key(&(section, name.to_owned()))
    }

    /// An array, flat, shape `[tuples, components]`; field data may have any number of `tuples` (`None`).
    ///
    /// # Errors
    /// [`Error::Format`] if it is missing, of another type or shape, or if its data ends early.
    pub fn get<T: Scalar>(
        &self,
        section: Section,
        name: &str,
        components: usize,
        tuples: Option<usize>,
    ) -> Result<Vec<T>> {
        let bad = |problem: String| self.bad(format!("{section:?} array {name:?}: {problem}"));
        let header =
            self.headers.get(&(section, name.to_owned())).ok_or_else(|| bad("there is none".into()))?;
        if header.kind != T::VTK || header.components != components {
            let found = format!("{} x {}", header.components, header.kind);
            return Err(bad(format!("it holds {found}; {components} x {} is expected", T::VTK)));
        }
        let bytes = self.decode(header.offset).ok_or_else(|| bad("its data is cut off or damaged".into()))?;
        let expected = tuples.map(|n| n * components * size_of::<T>());
        if !bytes.len().is_multiple_of(components * size_of::<T>())
            || expected.is_some_and(|n| n != bytes.len())
        {
            return Err(bad(format!("{} bytes do not make the tuples it should have", bytes.len())));
        }
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// The bytes of the array whose run of base64 starts at `offset`.
    fn decode(&self, offset: usize) -> Option<Vec<u8>> {
        // 12 characters hold the 8 bytes of the count, and one more.
        let run = self.appended.get(offset..)?;
        let start = STANDARD.decode(run.get(..12)?).ok()?;
        let count = u64::from_ne_bytes(start.get(..8)?.try_into().ok()?);
        let total = usize::try_from(count).ok()?.checked_add(size_of::<u64>())?;
        let mut bytes = STANDARD.decode(run.get(..total.div_ceil(3).checked_mul(4)?)?).ok()?;
        (bytes.len() == total).then(|| bytes.split_off(size_of::<u64>()))
    }

    /// An error about this file.
    pub fn bad(&self, problem: String) -> Error {
        Error::Format { path: self.path.clone(), problem }
    }
}

/// A whole number in an attribute.
fn number(bad: &dyn Fn(String) -> Error, node: roxmltree::Node, key: &str) -> Result<usize> {
    let text = node.attribute(key).unwrap_or_default();
    text.parse()
        .map_err(|_| bad(format!("<{}> has {text:?} as {key}: not a whole number", node.tag_name().name())))
}
