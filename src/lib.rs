//! hexroll: explicit dynamics of rubber wheels on rigid roads, on the GPU and on the CPU.
//!
//! Everything flows one way; see `ARCHITECTURE.md`.
#![allow(non_snake_case)] // F, J, W, N: the field's own symbols

pub mod error;
pub mod model;
pub mod output;
pub mod record;
pub mod scene;

pub use error::{Error, Result};
