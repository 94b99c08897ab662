//! The GPU engine: the explicit loop as WGSL compute shaders.

mod buffers;
pub mod chains;
mod check;
pub mod compose;
mod device;
mod engine;
mod ensemble;
mod lattice;
pub mod layout;
pub mod limits;
pub mod order;
mod precision;
mod prepared;
pub mod program;
mod readback;
mod resident;
mod rim;
mod sample;
mod stage;
mod steps;
mod timing;
mod trial;
mod upload;
mod verdict;

pub use device::{AdapterReport, Gpu, STORAGE_BUFFERS, adapters};
pub use engine::{Counts, GpuEngine};
pub use ensemble::{advance_together, ensemble};
pub use precision::Precision;
pub use resident::{RESIDENT_STORAGE_BUFFERS, Shape};
pub use timing::{PassTime, PassTimes};
