//! Cases against closed forms and other codes, one page a file.

mod bar_impact;
mod bonded_strip;
mod brush;
mod carter;
mod cattaneo;
mod constitutive;
mod coupons;
mod cylinder;
mod hertz_drum;
mod hertz_line;
mod hertz_point;
mod paper;
mod relaxation;
mod rotation;
mod slider;
mod slope;
mod vibration;
mod waves;

use super::Case;

/// Every case, in the order of the page that `hexroll report verification` writes.
pub const CASES: &[Case] = &[
    constitutive::CASE,
    coupons::CASE,
    waves::CASE,
    vibration::CASE,
    relaxation::CASE,
    rotation::CASE,
    bonded_strip::CASE,
    bar_impact::CASE,
    hertz_line::CASE,
    hertz_drum::CASE,
    hertz_point::CASE,
    cattaneo::CASE,
    carter::CASE,
    slider::CASE,
    slope::CASE,
    brush::CASE,
    paper::STATIC,
    paper::ROLLING,
    paper::ORDER,
];
