//! The least time a step can take on a machine whose limits were measured: every pass needs at least the time to move
//! its bytes, the time to do its arithmetic, and the time to be started.

use serde::{Deserialize, Serialize};

use super::work::Pass;

/// Limits that hold for one engine on one mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Copy bandwidth at the size of the engine's arrays, read and written bytes together [bytes/s].
    pub bandwidth: f64,
    /// Multiply-add rate, two operations each [flop/s].
    pub flops: f64,
    /// Shortest possible pass: an empty dispatch, or a meeting of the threads [s].
    pub latency: f64,
}

/// What a pass cannot be faster than.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bound {
    Bandwidth,
    Compute,
    Latency,
}

impl Bound {
    pub fn name(self) -> &'static str {
        match self {
            Bound::Bandwidth => "bandwidth",
            Bound::Compute => "compute",
            Bound::Latency => "latency",
        }
    }
}

/// The floor of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    pub seconds: f64,
    /// What most of it is.
    pub bound_by: Bound,
}

/// Passes follow each other, so their floors add up; within a pass the three overlap, so the longest counts.
pub fn floor(passes: &[Pass], limits: &Limits) -> Floor {
    let mut shares = [(Bound::Bandwidth, 0.0), (Bound::Compute, 0.0), (Bound::Latency, 0.0)];
    for pass in passes {
        let times = [pass.bytes / limits.bandwidth, pass.flops / limits.flops, limits.latency];
        let (longest, time) = largest(times.into_iter().enumerate());
        shares[longest].1 += time;
    }
    let (most, _) = largest(shares.iter().map(|s| s.1).enumerate());
    Floor { seconds: shares.iter().map(|s| s.1).sum(), bound_by: shares[most].0 }
}

fn largest(values: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    values.fold((0, f64::NEG_INFINITY), |most, v| if v.1 > most.1 { v } else { most })
}
