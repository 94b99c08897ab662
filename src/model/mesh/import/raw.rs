//! What every reader hands on: the mesh of a file before anything of it is judged.

use crate::model::mesh::Labels;

/// Nodes, hexahedra and sets of a file, by place.
#[derive(Debug, Default)]
pub struct Raw {
    /// Coordinates in the file's unit and axes, shape `[node_count]`.
    pub nodes: Vec<[f64; 3]>,
    /// Corners, numbered as here and in most formats, shape `[element_count]`.
    pub hexes: Vec<[u32; 8]>,
    /// Corners of the quadrilaterals of a section that is to be revolved; then there are no hexahedra yet.
    pub quads: Vec<[u32; 4]>,
    /// The axle, where the reader knows it [m].
    pub axle: Option<[f64; 3]>,
    /// Numbers that the file gives them.
    pub labels: Labels,
    /// In the order in which people should see them.
    pub sets: Vec<RawSet>,
    /// What a user must know of the file: dropped, not taken over, unknown.
    pub notes: Vec<String>,
    /// Program or format that wrote it, for people.
    pub format: String,
}

/// Nodes under a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawSet {
    pub name: String,
    pub meaning: String,
    pub nodes: Vec<u32>,
}
