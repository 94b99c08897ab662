//! `hexroll bench`: how fast every engine is, against what the machine can do, with the error of the run that was
//! timed.
//!
//! ```text
//! wheel (any refinement) -> engine, timed -> cpu-f64 after the same steps -> error
//! counting scalar, arrays -> flops, bytes -> measured limits -> floor, fraction
//! ```

pub mod chart;
mod clock;
pub mod counting;
pub mod cpu_limits;
pub mod critical;
mod fleet;
pub mod floor;
pub mod gpu_limits;
pub mod kind;
pub mod machine;
pub mod markdown;
pub mod record;
pub mod report;
pub mod rows;
pub mod straight;
pub mod wheel;
pub mod work;
