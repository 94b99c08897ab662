//! Signals: from uneven samples to an even grid without aliases ([`resample`]), power spectra ([`spectrum`]), one-third-octave
//! bands ([`bands`]).
//!
//! Numbers in, numbers out: nothing here knows bodies, runs or files.

pub mod bands;
pub mod resample;
pub mod spectrum;
