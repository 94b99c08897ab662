//! Copies of buffers to the host, several in one submission.

use super::Gpu;
use super::buffers::Slice;
use crate::error::Result;

/// Buffers to be read together.
#[derive(Default)]
pub struct Readback<'b> {
    parts: Vec<(&'b Slice, u64, u64)>,
    bytes: u64,
}

/// Where a part lies in the data.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    start: usize,
    end: usize,
}

/// What came back.
pub struct Data(Vec<u8>);

impl Data {
    pub fn part(&self, part: Part) -> &[u8] {
        &self.0[part.start..part.end]
    }
}

impl<'b> Readback<'b> {
    pub fn add(&mut self, slice: &'b Slice) -> Part {
        self.add_first(slice, slice.size())
    }

    /// The first `bytes` of a buffer, a multiple of four.
    pub fn add_first(&mut self, slice: &'b Slice, bytes: u64) -> Part {
        let start = self.bytes;
        self.parts.push((slice, start, bytes));
        self.bytes += bytes.next_multiple_of(16);
        Part { start: start as usize, end: (start + bytes) as usize }
    }

    /// Runs `before` and the copies in one submission, and waits for it.
    pub fn run(self, gpu: &Gpu, before: impl FnOnce(&mut wgpu::CommandEncoder)) -> Result<Data> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        before(&mut encoder);
        self.copy(gpu, encoder)
    }

    /// Appends the copies to `encoder`, submits it and waits.
    pub fn copy(self, gpu: &Gpu, mut encoder: wgpu::CommandEncoder) -> Result<Data> {
        let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: self.bytes,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        for (slice, start, bytes) in &self.parts {
            slice.copy(&mut encoder, (&staging, *start), *bytes);
        }
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver lives until the answer is there.
            let _ = sender.send(result);
        });
        gpu.wait()?;
        let failed = |detail: String| gpu.error(detail);
        receiver.recv().map_err(|e| failed(e.to_string()))?.map_err(|e| failed(e.to_string()))?;
        let view = staging.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        Ok(Data(view.to_vec()))
    }
}
