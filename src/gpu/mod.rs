//! The GPU engine: the explicit loop as WGSL compute shaders.
//!
//! Files import along these arrows, never against them:
//!
//! ```text
//! layout, bindings, verdict            what host and device say to each other
//!   -> program -> device               pipelines; adapters and devices
//!   -> precision -> compose -> compile WGSL from parts; a pipeline from WGSL
//!   -> chains, lattice, order          elements in chains, nodes in the device's numbers
//!   -> buffers, counts, resident       what is bound; how many; small meshes in one work group
//!   -> upload -> prepared              what a body becomes on the device
//!   -> bound, readback -> meeting      programs with their buffers; bodies that step together
//!   -> check, limits, rim              what an adapter can do; the rim on the host
//!   -> stage -> programs, body, watch  everything there is to dispatch; a body's state; states kept after every step
//!   -> engine                          body, programs, pace
//!   -> steps -> sample, trial, timing  what it does
//!   -> explicit, ensemble              what it answers; several of them
//! ```

pub mod bindings;
mod body;
mod bound;
mod buffers;
pub mod chains;
mod check;
mod compile;
pub mod compose;
mod counts;
mod device;
mod engine;
mod ensemble;
mod explicit;
mod lattice;
pub mod layout;
pub mod limits;
mod meeting;
pub mod order;
mod precision;
mod prepared;
mod program;
mod programs;
mod readback;
mod resident;
mod rim;
mod sample;
mod series;
mod stage;
mod steps;
mod timing;
mod trial;
mod upload;
mod verdict;
mod watch;

pub use counts::Counts;
pub use device::{AdapterReport, Gpu, STORAGE_BUFFERS, adapters};
pub use engine::GpuEngine;
pub use ensemble::{advance_together, ensemble};
pub use precision::Precision;
pub use prepared::choice;
pub use resident::{RESIDENT_STORAGE_BUFFERS, Shape};
pub use timing::{PassTime, PassTimes};
