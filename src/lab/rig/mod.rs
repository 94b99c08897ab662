//! The test rig: bodies built in code, runs of them, and what other programs say of the paper's wheel. Tests, `report`
//! and `bench` use the same one. SI units.

mod bodies;
mod book;
pub mod given;
pub mod implicit;
mod numbers;
pub mod references;
mod runs;

pub use bodies::{
    ELEMENTS, EQ4, HELD, RUBBER, TWO_CONSTANTS, at_once, block, body, down, elastic_constants, explicit,
    hold, laws, laws_of, press, ring, rolling, scene, shipped, wheel,
};
pub use book::{book, by_the_book};
pub use given::{BULK_MODULUS as KAPPA, DENSITY, SHEAR_MODULUS as G};
pub use hexroll::scene::GROUND;
pub use numbers::{Random, close, distort, largest, order, relative, times};
pub use references::{Reference, reference};
pub use runs::{Driver, Outcome, Recorder, column, run, simulate, simulate_on, simulate_with};
