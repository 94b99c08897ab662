//! Signals: from uneven samples to an even grid without aliases ([`resample`]).
//!
//! Numbers in, numbers out: nothing here knows bodies, runs or files.

pub mod resample;
