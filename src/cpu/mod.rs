//! The reference engine: the same passes in the same order as the GPU's, in f64 or f32, on any number of threads
//! with the same bits.

mod elements;
mod engine;
mod nodes;
mod reduce;
mod rim;
mod team;

pub use elements::element_forces;
pub use engine::CpuEngine;
