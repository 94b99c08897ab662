//! What the program can be believed: claims against sources that nobody here wrote, limits of stability, and speed
//! against error. Tests and the command `hexroll report` read the same cases.

pub mod accuracy;
pub mod claim;
pub mod page;
pub mod parity;
pub mod stability;
pub mod verification;

pub use claim::{Claim, Tolerance};

/// A page of the textbook: what is claimed, of which body, by whose formula.
pub struct Case {
    /// Name on the command line.
    pub name: &'static str,
    /// What it shows, as the name of its test.
    pub theorem: &'static str,
    pub title: &'static str,
    /// Where the expected numbers come from.
    pub source: &'static str,
    /// Body, mesh, loads.
    pub setup: &'static str,
    /// Whether it belongs to the everyday suite; otherwise its test is ignored and `make verify` runs it.
    pub everyday: bool,
    pub run: fn() -> hexroll::Result<Vec<Claim>>,
}
