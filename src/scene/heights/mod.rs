//! Heights of a road on a regular grid, from files and from seeds.

pub mod crg;
pub mod generate;
pub mod grid;
pub mod picture;
mod transform;

use crate::physics::road::Border;

/// Heights as a file or a generator gives them. NaN: missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Samples along u, and along v.
    pub size: [usize; 2],
    /// Distance of neighbours [m].
    pub spacing: [f64; 2],
    /// u and v of the first sample [m].
    pub origin: [f64; 2],
    /// Rows of u, the first at the smallest v [m].
    pub heights: Vec<f64>,
    /// What the file says of beyond its samples, if it says something.
    pub border: Option<Border>,
}

/// What is wrong with a file, and what helps.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// From 1, of a file of lines.
    pub line: Option<usize>,
    pub problem: String,
    pub remedy: String,
}

impl Fault {
    fn at(line: usize, problem: impl Into<String>, remedy: impl Into<String>) -> Fault {
        Fault { line: Some(line), problem: problem.into(), remedy: remedy.into() }
    }

    fn of_file(problem: impl Into<String>, remedy: impl Into<String>) -> Fault {
        Fault { line: None, problem: problem.into(), remedy: remedy.into() }
    }
}

/// A map that a road can be made of: at least two samples each way, one of them there.
fn checked(map: Map) -> Result<Map, Fault> {
    let [columns, rows] = map.size;
    if columns < 2 || rows < 2 {
        let problem = format!("{columns} x {rows} samples are no field");
        return Err(Fault::of_file(
            problem,
            "give at least two along both directions, or use shape = \"profile\"",
        ));
    }
    if map.heights.iter().all(|h| h.is_nan()) {
        return Err(Fault::of_file("every sample is missing", "give a file with heights"));
    }
    if let Some(k) = map.heights.iter().position(|h| h.is_infinite()) {
        let problem = format!("the height number {} is not finite", k + 1);
        return Err(Fault::of_file(problem, "give a number, or mark it as missing"));
    }
    Ok(map)
}
