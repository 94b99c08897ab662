//! What the adapter can do at best, measured: the yardsticks a pass is held against.

use super::Gpu;
use super::bound::Bound;
use super::buffers::{Buffers, Slice};
use super::layout::{Real, encode};
use super::program::Program;
use crate::error::Result;
use std::time::Instant;

/// Threads of a work group of the kernels in shaders/bench.
const GROUP: usize = 64;
/// Scalar multiply-adds a thread does in one turn of shaders/bench/multiply_add.wgsl.
const MULTIPLY_ADDS: usize = 64;
/// Times each measurement is repeated: the best counts.
const REPEATS: usize = 5;
/// What one submission should take at least, so that its own cost is small beside it [s].
const LONG: f64 = 0.02;

/// Limits of an adapter.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Limits {
    /// Bytes read plus bytes written a second, copying a buffer of [`Limits::copied`] bytes.
    pub copy_bandwidth: f64,
    /// Size of that buffer: 256 MiB, or the largest binding. [bytes]
    pub copied: u64,
    /// Single-precision operations a second, a multiply-add being two, in registers only.
    pub flops: f64,
    /// The same in double precision, where the adapter has it.
    pub flops_double: Option<f64>,
    /// What a dispatch costs that waits for the one before and does nothing [s].
    pub dispatch: f64,
    /// What an empty submission costs that the host waits for [s].
    pub submit: f64,
}

impl Limits {
    /// Measures all of them; takes some seconds on a software adapter.
    ///
    /// # Errors
    /// The adapter refuses a buffer or a kernel, or is lost.
    pub fn measure(gpu: &Gpu) -> Result<Limits> {
        let copied = gpu.report.storage_binding.min(gpu.report.buffer).min(1 << 28) / 16 * 16;
        Ok(Limits {
            copy_bandwidth: copy_bandwidth(gpu, copied)?,
            copied,
            flops: multiply_add_rate(gpu, Real::Single)?,
            flops_double: match gpu.report.doubles {
                true => Some(multiply_add_rate(gpu, Real::Double)?),
                false => None,
            },
            dispatch: dispatch_latency(gpu)?,
            submit: submit_latency(gpu)?,
        })
    }
}

/// Bytes read plus bytes written a second, copying `bytes` from one buffer to another.
pub fn copy_bandwidth(gpu: &Gpu, bytes: u64) -> Result<f64> {
    let kernel = Loop::new(gpu, "bench/copy", Real::Single, bytes as usize, &[])?;
    let groups = (bytes as usize / 16).div_ceil(GROUP) as u32;
    let rows = groups.div_ceil(gpu.report.workgroups);
    Ok(2.0 * bytes as f64 / kernel.seconds(gpu, [groups.div_ceil(rows), rows, 1])?)
}

/// Operations a second in registers, a multiply-add being two.
pub fn multiply_add_rate(gpu: &Gpu, real: Real) -> Result<f64> {
    // Enough threads for 256 processors of 2,048 threads; a software adapter has few.
    let (groups, turns) = if gpu.report.software { (64, 512) } else { (8192, 256) };
    let threads = groups * GROUP;
    let bytes = 4 * real.bytes() * threads;
    let kernel = Loop::new(gpu, "bench/multiply_add", real, bytes, &[("turns", turns as f64)])?;
    // The factor and the summand.
    kernel.from.write(gpu, &encode(real, &[[0.5; 4], [1.0; 4]]));
    let operations = 2 * MULTIPLY_ADDS * turns * threads;
    Ok(operations as f64 / kernel.seconds(gpu, [groups as u32, 1, 1])?)
}

/// Seconds a dispatch costs that waits for the one before and does nothing.
pub fn dispatch_latency(gpu: &Gpu) -> Result<f64> {
    let kernel = Loop::new(gpu, "bench/empty", Real::Single, 1024, &[])?;
    kernel.seconds(gpu, [1, 1, 1])
}

/// Seconds an empty submission costs that the host waits for.
pub fn submit_latency(gpu: &Gpu) -> Result<f64> {
    let mut best = f64::INFINITY;
    for _ in 0..20 {
        let encoder = gpu.device.create_command_encoder(&Default::default());
        let begun = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        best = best.min(begun.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// A kernel that can be dispatched any number of times.
struct Loop {
    kernel: Bound,
    from: Slice,
}

impl Loop {
    fn new(gpu: &Gpu, entry: &str, real: Real, bytes: usize, constants: &[(&str, f64)]) -> Result<Loop> {
        let mut buffers = Buffers::default();
        buffers.zeroed(gpu, "from_buffer", 1, bytes);
        buffers.zeroed(gpu, "to_buffer", 1, bytes);
        let program = Program::plain(gpu, entry, real, constants)?;
        gpu.check()?;
        let from = buffers.get("from_buffer").clone();
        Ok(Loop { kernel: Bound::new(gpu, program, |name| buffers.get(name)), from })
    }

    /// Seconds of one submission of `count` dispatches.
    fn submit(&self, gpu: &Gpu, groups: [u32; 3], count: usize) -> Result<f64> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for _ in 0..count {
                self.kernel.dispatch(&mut pass, groups, 0);
            }
        }
        let begun = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        Ok(begun.elapsed().as_secs_f64())
    }

    /// Seconds of one dispatch: what twice as many cost more, so that the cost of submitting drops out.
    fn seconds(&self, gpu: &Gpu, groups: [u32; 3]) -> Result<f64> {
        self.submit(gpu, groups, 1)?;
        let mut count = 1;
        while count < 4096 && self.submit(gpu, groups, count)? < LONG {
            count *= 2;
        }
        let (mut once, mut twice) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..REPEATS {
            once = once.min(self.submit(gpu, groups, count)?);
            twice = twice.min(self.submit(gpu, groups, 2 * count)?);
        }
        Ok((twice - once).max(0.01 * twice) / count as f64)
    }
}
