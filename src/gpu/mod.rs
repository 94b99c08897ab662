//! The GPU engine: the explicit loop as WGSL compute shaders.

mod buffers;
mod check;
pub mod compose;
mod device;
mod engine;
pub mod layout;
pub mod limits;
pub mod program;
mod readback;
mod rim;
mod stage;
mod timing;
mod verdict;

pub use device::{AdapterReport, Gpu, STORAGE_BUFFERS, adapters};
pub use engine::{Counts, GpuEngine};
pub use timing::{PassTime, PassTimes};
