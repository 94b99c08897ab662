//! What the adapter can do at most, as a record keeps it.

use serde::{Deserialize, Serialize};

use super::cpu_limits::Copy;
use super::floor::Limits;
use hexroll::gpu::{Gpu, limits};
use hexroll::{Precision, Result};

/// Limits of an adapter; see [`hexroll::gpu::limits`] for how they are measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GpuLimits {
    /// Copies of several sizes: what an adapter's cache holds is faster than its memory.
    pub copy: Vec<Copy>,
    /// Multiply-adds in registers, single precision, two operations each [1/s].
    pub flops_per_s: f64,
    /// The same in double precision; `None` where the adapter has none.
    #[serde(default)]
    pub flops_double_per_s: Option<f64>,
    /// A dispatch that waits for the one before and does nothing [s].
    pub dispatch_s: f64,
    /// An empty submission that the host waits for [s].
    pub submit_s: f64,
}

impl GpuLimits {
    /// Measures them: some seconds on a software adapter.
    pub fn measure(gpu: &Gpu) -> Result<GpuLimits> {
        let all = limits::Limits::measure(gpu)?;
        let mut copy = Vec::new();
        for size in [8 << 20, 32 << 20] {
            if size < all.copied {
                let bytes_per_s = limits::copy_bandwidth(gpu, size)?;
                let bytes = 2 * size as usize;
                copy.push(Copy { bytes, holds_to: Some(bytes), bytes_per_s });
            }
        }
        copy.push(Copy { bytes: 2 * all.copied as usize, holds_to: None, bytes_per_s: all.copy_bandwidth });
        Ok(GpuLimits {
            copy,
            flops_per_s: all.flops,
            flops_double_per_s: all.flops_double,
            dispatch_s: all.dispatch,
            submit_s: all.submit,
        })
    }

    /// Those that hold for arrays of `bytes` in all, in double precision or single: the best of the copies that are at least as
    /// large.
    pub fn at(&self, bytes: f64, precision: Precision) -> Limits {
        let holds = |c: &&Copy| c.holds_to.is_none_or(|most| most as f64 >= bytes);
        let bandwidth = self.copy.iter().filter(holds).map(|c| c.bytes_per_s).fold(0.0, f64::max);
        let double = || self.flops_double_per_s.unwrap_or(f64::NAN);
        let flops = if precision.is_single() { self.flops_per_s } else { double() };
        Limits { bandwidth, flops, latency: self.dispatch_s }
    }
}
