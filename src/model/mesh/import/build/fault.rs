//! Errors that name nodes and elements as their file does.

use super::super::source::Place;
use crate::error::Error;
use crate::model::mesh::Labels;
use crate::scene::MeshFile;

/// Errors of a mesh file, with its numbers.
pub struct Fault<'a> {
    file: &'a MeshFile,
    labels: Labels,
}

impl<'a> Fault<'a> {
    pub fn new(file: &'a MeshFile, labels: Labels) -> Fault<'a> {
        Fault { file, labels }
    }

    pub fn error(&self, problem: String, remedy: impl Into<String>) -> Error {
        Place { file: self.file.path.clone(), line: None }.error("mesh", problem, remedy)
    }

    pub fn file(&self) -> &MeshFile {
        self.file
    }

    pub fn nodes(&self, places: &[u32]) -> String {
        self.labels.nodes.list(places)
    }

    pub fn elements(&self, places: &[u32]) -> String {
        self.labels.elements.list(places)
    }
}
