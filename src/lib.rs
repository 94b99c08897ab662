//! hexroll: explicit dynamics of rubber wheels on rigid roads, on the GPU and on the CPU.
//!
//! Everything flows one way; see `ARCHITECTURE.md`.
#![allow(non_snake_case)] // F, J, W, N: the field's own symbols
#![allow(rustdoc::broken_intra_doc_links)] // units are written [m], [N s]

pub mod cpu;
pub mod engine;
pub mod error;
pub mod gpu;
pub mod implicit;
pub mod instructions;
pub mod memory;
pub mod model;
pub mod output;
pub mod plot;
pub mod precision;
pub mod record;
pub mod render;
pub mod run;
pub mod scene;
pub mod signal;
pub mod study;

pub use error::{Error, Result};
pub use hexroll_kernels as kernels;
pub use hexroll_physics as physics;
pub use precision::Precision;
