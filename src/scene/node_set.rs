//! Sets of nodes by name. A scene knows no mesh: whether there is such a set is found when the mesh is there.

use super::reader::{Item, one_of};
use crate::error::{Error, Result};

/// A set of nodes by its name, with the place where a scene names it, for errors.
#[derive(Debug, Clone, Eq)]
pub struct NodeSet {
    pub name: String,
    written: Written,
}

/// Where a name was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Written {
    /// A line of the scene's file.
    Line(usize),
    CommandLine,
    /// Not in a scene's text.
    Program,
}

impl From<&str> for NodeSet {
    fn from(name: &str) -> NodeSet {
        NodeSet { name: name.into(), written: Written::Program }
    }
}

/// Sets are the same if their names are, wherever they are named.
impl PartialEq for NodeSet {
    fn eq(&self, other: &NodeSet) -> bool {
        self.name == other.name
    }
}

impl NodeSet {
    pub(super) fn read(item: &Item) -> Result<NodeSet> {
        let written = item.node.line.map_or(Written::CommandLine, Written::Line);
        Ok(NodeSet { name: item.text()?.into(), written })
    }

    /// The error where a mesh has no such set but only those `known`; `key` is where the scene `file` names it.
    pub fn unknown(&self, file: &str, key: &str, known: &[String]) -> Error {
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        let problem = format!("the mesh has no node set {:?}", self.name);
        self.error(file, key, problem, one_of(&self.name, &names))
    }

    /// An error at the name.
    pub fn error(&self, file: &str, key: &str, problem: String, remedy: String) -> Error {
        let (line, from) = match self.written {
            Written::Line(line) => (Some(line), ""),
            Written::CommandLine => (None, " (from --set)"),
            Written::Program => (None, ""),
        };
        Error::Scene { file: file.into(), line, key: key.into(), problem: problem + from, remedy }
    }
}
