//! Roads with a shape of their own: nearest points, files, generators, and wheels that roll over them.

mod files;
mod generated;
mod geometry;
mod rolling;

use std::path::{Path, PathBuf};

/// Asserts that a value is within `most` of what is expected.
#[track_caller]
fn near(what: &str, value: f64, expected: f64, most: f64) {
    assert!((value - expected).abs() <= most, "{what}: {value:e}, expected {expected:e} within {most:e}");
}

/// A file of the test's folder.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/roads/data").join(name)
}
