//! A mesh of another program: where it is, and what such files do not say themselves.

use std::path::PathBuf;

/// A file with a mesh, and how to take it.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    /// As it can be opened: what a scene writes is relative to the scene's folder.
    pub path: PathBuf,
    /// Unit of the file's coordinates.
    pub unit: LengthUnit,
    /// The file's axis that becomes y, which wheels turn about.
    pub axis: Axis,
    /// A point of the wheel's axle, along the file's x, y, z [m]; `None`: found from the mesh.
    pub axle: Option<[f64; 3]>,
    /// Nodes of different elements that are no farther apart than this become one [m]; `None`: none do.
    pub merge: Option<f64>,
    pub gaps: Gaps,
    /// How a section in a plane becomes a wheel; `None`: the file has a solid.
    pub revolve: Option<Revolve>,
    /// Element types that are left out, as the file names them.
    pub drop: Vec<String>,
}

/// A section turned about the axle, with as many elements round the circumference as there are sectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Revolve {
    /// At least 3.
    pub sectors: usize,
    /// Element size at the top over that at the bottom, as in [`Grading`](super::Grading).
    pub grading: f64,
    /// Elements within this arc about the bottom are equal [rad].
    pub fine_arc: f64,
}

/// A unit of length.
#[derive(Debug, Clone, PartialEq)]
pub struct LengthUnit {
    pub name: String,
    /// One of it [m].
    pub metres: f64,
}

impl LengthUnit {
    /// So many of the unit [m], correctly rounded where a metre has a whole number of them: 39 mm are 0.039 m to the last digit.
    pub fn to_metres(&self, value: f64) -> f64 {
        let in_a_metre = (1.0 / self.metres).round();
        if (in_a_metre * self.metres - 1.0).abs() < 1e-12 { value / in_a_metre } else { value * self.metres }
    }
}

/// An axis of a file's coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    /// A vector of the file, turned so that this axis is along y. The other two follow in cyclic order, which mirrors nothing.
    pub fn to_y(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Axis::X => [z, x, y],
            Axis::Y => [x, y, z],
            Axis::Z => [y, z, x],
        }
    }
}

/// What to do with surfaces that lie on each other without common nodes, and with parts that hang together by nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gaps {
    /// An error that names them.
    Refuse,
    /// They are meant: a warning.
    Keep,
}
