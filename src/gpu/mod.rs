//! The GPU engine: the explicit loop as WGSL compute shaders.

pub mod compose;
mod device;
mod engine;
pub mod layout;

pub use device::{AdapterReport, Gpu, adapters};
pub use engine::GpuEngine;
