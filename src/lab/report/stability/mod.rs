//! Hard cases: does a run stay stable at the default settings, up to which safety factor, with what energy error; and
//! where it fails, does it say what failed.

mod limits;
mod scales;
mod sizes;
mod sliding;
mod steps;

pub use limits::{HARD, Hard, Limit, find};

use super::Case;

/// Cases with claims of their own; [`HARD`] are those whose limit is searched.
pub const CASES: &[Case] = &[
    steps::SHARP,
    steps::REFUSED,
    scales::SIMILAR,
    scales::FAR,
    sizes::SIZES,
    sliding::CASE,
    scales::CHATTER,
    scales::LONG,
];
