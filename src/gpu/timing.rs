//! Where the time of a step goes: every pass between two timestamps.

use super::Gpu;
use super::buffers::Slice;
use super::engine::GpuEngine;
use super::programs::Pass;
use super::readback::Readback;
use crate::engine::Step;
use crate::error::Result;
use crate::physics::rim::Coordinates;
use std::time::Instant;

/// Steps timed a submission: two timestamps a pass and four passes a step stay within wgpu's 4,096 a query set.
const STEPS: usize = 512;

/// One pass of a step, over all timed steps.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassTime {
    /// Name of the kernel: `element_force`, `rim`, `node` (interior), `boundary` (road and rim);
    /// or `resident`, which is all of them.
    pub kernel: String,
    /// Seconds on the device, all timed steps together; `None` where the adapter has no timestamps.
    pub seconds: Option<f64>,
    /// Bytes a step moves if every buffer it reads or writes is read or written once.
    pub bytes: u64,
}

/// What timed steps took.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassTimes {
    pub passes: Vec<PassTime>,
    pub steps: u64,
    /// Seconds the host waited, plans and timestamps included: more than the same steps take in
    /// [`advance`](crate::engine::Engine::advance), whose passes are not taken apart.
    pub wall: f64,
    /// Steps that one submission of `advance` holds at present.
    pub steps_per_submit: usize,
}

impl GpuEngine {
    /// Takes the steps as [`advance`](crate::engine::Engine::advance) does, to the bit, and times every pass.
    ///
    /// # Errors
    /// Those of `advance`.
    pub fn timed_advance(&mut self, steps: &[Step]) -> Result<PassTimes> {
        let begun = Instant::now();
        let stamps = self.body.gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let mut seconds: Vec<f64> = Vec::new();
        self.in_submissions(steps, |engine, steps, starts| {
            for (steps, starts) in steps.chunks(STEPS).zip(starts.chunks(STEPS)) {
                let each = engine.submit_timed(steps, starts, stamps)?;
                seconds.resize(each.len(), 0.0);
                seconds.iter_mut().zip(each).for_each(|(sum, s)| *sum += s);
            }
            Ok(())
        })?;
        let wall = begun.elapsed().as_secs_f64();
        let time = |(k, pass): (usize, Pass)| PassTime {
            kernel: pass.name.to_string(),
            seconds: if stamps { seconds.get(k).copied() } else { None },
            bytes: pass.program.bytes(pass.share),
        };
        let passes = if steps.is_empty() {
            Vec::new()
        } else {
            self.programs.passes(&self.body.counts).into_iter().enumerate().map(time).collect()
        };
        Ok(PassTimes { passes, steps: steps.len() as u64, wall, steps_per_submit: self.pace.per_submit })
    }

    /// Submits the steps with every dispatch in a pass of its own; seconds by pass.
    fn submit_timed(&mut self, steps: &[Step], starts: &[Coordinates], stamps: bool) -> Result<Vec<f64>> {
        self.write_steps(steps, starts);
        self.write_member(steps.len());
        let passes = self.programs.passes(&self.body.counts);
        let rounds = self.rounds(steps.len());
        let clock = Clock::new(&self.body.gpu, passes.len() * rounds);
        let mut encoder = self.body.gpu.device.create_command_encoder(&Default::default());
        for slot in 0..rounds {
            for (k, pass) in passes.iter().enumerate() {
                let timestamp_writes = stamps.then(|| clock.writes(slot * passes.len() + k));
                let descriptor = wgpu::ComputePassDescriptor { label: Some(pass.name), timestamp_writes };
                pass.dispatch(&mut encoder.begin_compute_pass(&descriptor), slot);
            }
        }
        let each = clock.read(&self.body.gpu, encoder)?;
        let sum = |k: usize| each.iter().skip(k).step_by(passes.len()).sum();
        let seconds = (0..passes.len()).map(sum).collect();
        let taken =
            self.take(self.body.gpu.device.create_command_encoder(&Default::default()), steps.len())?;
        self.took(steps, &taken);
        Ok(seconds)
    }
}

/// Timestamps before and after each of a number of passes.
struct Clock {
    queries: Option<wgpu::QuerySet>,
    resolved: wgpu::Buffer,
    passes: usize,
}

impl Clock {
    fn new(gpu: &Gpu, passes: usize) -> Clock {
        let stamps = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let queries = stamps.then(|| {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * passes as u32,
            })
        });
        let resolved = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timestamps"),
            size: 16 * passes as u64,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Clock { queries, resolved, passes }
    }

    fn writes(&self, pass: usize) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: self.queries.as_ref().expect("only asked for with timestamps"),
            beginning_of_pass_write_index: Some(2 * pass as u32),
            end_of_pass_write_index: Some(2 * pass as u32 + 1),
        }
    }

    /// Submits, waits; seconds of each pass (zeros without timestamps).
    fn read(&self, gpu: &Gpu, mut encoder: wgpu::CommandEncoder) -> Result<Vec<f64>> {
        if let Some(queries) = &self.queries {
            encoder.resolve_query_set(queries, 0..2 * self.passes as u32, &self.resolved, 0);
        }
        let mut read = Readback::default();
        let resolved = Slice::whole(self.resolved.clone());
        let part = read.add(&resolved);
        let data = read.copy(gpu, encoder)?;
        let ticks: &[u64] = bytemuck::cast_slice(data.part(part));
        let period = 1e-9 * f64::from(gpu.queue.get_timestamp_period());
        Ok(ticks.chunks_exact(2).map(|t| t[1].saturating_sub(t[0]) as f64 * period).collect())
    }
}
