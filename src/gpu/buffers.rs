//! Every buffer of a run, by the name the shaders use.

use super::Gpu;
use super::chains::{Chains, SHARED_CLASSES};
use super::layout::{self, MeanClass, PointClass, PointGeometry, Real, Step, Wgsl, encode};
use super::series;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::element::Class;
use crate::scene::Element;
use bytemuck::Pod;
use std::collections::HashMap;
use wgpu::util::DeviceExt;

/// Distance of two steps in the plan's uniform buffer [bytes]: a multiple of the largest offset alignment WebGPU allows.
pub fn step_stride(real: Real) -> usize {
    Step::size(real).next_multiple_of(256)
}
/// Steps the plan holds at a time.
pub const PLAN: usize = 1024;

/// A buffer, or one body's part of one.
#[derive(Debug, Clone)]
pub struct Slice {
    buffer: wgpu::Buffer,
    offset: u64,
    size: u64,
    /// Share of its bytes that a pass over all of it reads or writes.
    share: f64,
}

impl Slice {
    /// All of a buffer.
    pub fn whole(buffer: wgpu::Buffer) -> Slice {
        let size = buffer.size();
        Slice { buffer, offset: 0, size, share: 1.0 }
    }

    /// Bytes that a pass over all of it reads or writes.
    pub fn used(&self) -> u64 {
        (self.share * self.size as f64) as u64
    }

    /// Bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    pub fn write(&self, gpu: &Gpu, bytes: &[u8]) {
        assert!(bytes.len() as u64 <= self.size, "{} bytes for a part of {}", bytes.len(), self.size);
        gpu.queue.write_buffer(&self.buffer, self.offset, bytes);
    }

    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.buffer, self.offset, Some(self.size));
    }

    /// Copies the first `bytes` to a place in another buffer.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, (to, at): (&wgpu::Buffer, u64), bytes: u64) {
        encoder.copy_buffer_to_buffer(&self.buffer, self.offset, to, at, bytes);
    }

    /// Copies all of it to another one.
    pub fn copy_to(&self, encoder: &mut wgpu::CommandEncoder, to: &Slice) {
        self.copy(encoder, (&to.buffer, to.offset), self.size);
    }

    /// As a shader sees it: `size` bytes, or all.
    pub fn binding(&self, size: Option<u64>) -> wgpu::BufferBinding<'_> {
        let size = wgpu::BufferSize::new(size.unwrap_or(self.size));
        wgpu::BufferBinding { buffer: &self.buffer, offset: self.offset, size }
    }

    /// The buffer it is a part of.
    pub fn all(&self) -> Slice {
        Slice::whole(self.buffer.clone())
    }
}

/// Buffers by name.
#[derive(Default)]
pub struct Buffers {
    map: HashMap<&'static str, Slice>,
    /// From one body's part to the next [bytes], in arrays that have parts.
    strides: HashMap<&'static str, u64>,
}

impl Buffers {
    pub fn get(&self, name: &str) -> &Slice {
        self.map.get(name).unwrap_or_else(|| panic!("no buffer is called {name}"))
    }

    pub fn has(&self, name: &str) -> bool {
        self.map.contains_key(name)
    }

    /// Size of all of them [bytes].
    pub fn bytes(&self) -> u64 {
        self.map.values().map(Slice::size).sum()
    }

    /// Says that passes leave all but a share of an array alone.
    pub fn use_share(&mut self, name: &'static str, share: f64) {
        self.map.get_mut(name).unwrap_or_else(|| panic!("no buffer is called {name}")).share = share;
    }

    /// The same with the parts of the body number `body` of those that share them.
    pub fn of_body(&self, body: usize) -> Buffers {
        let part = |(name, slice): (&&'static str, &Slice)| {
            let offset = self.strides.get(name).map_or(0, |stride| stride * body as u64);
            (*name, Slice { offset, ..slice.clone() })
        };
        Buffers { map: self.map.iter().map(part).collect(), strides: self.strides.clone() }
    }

    /// A buffer with content.
    pub fn filled<T: Pod>(&mut self, gpu: &Gpu, name: &'static str, data: &[T]) {
        let contents: &[u8] = bytemuck::cast_slice(data);
        // Buffers cannot be empty; kernels that would read an empty one are not composed.
        let contents = if contents.is_empty() { &[0u8; 16] } else { contents };
        let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(name),
            contents,
            usage: usage(),
        });
        self.map.insert(name, Slice::whole(buffer));
    }

    /// A zeroed buffer of `count` items of `each` bytes.
    pub fn zeroed(&mut self, gpu: &Gpu, name: &'static str, each: usize, count: usize) {
        self.parts(gpu, name, each, count, 1);
    }

    /// A zeroed buffer with a part of `count` items of `each` bytes for each of several bodies: the first one's part.
    pub fn parts(&mut self, gpu: &Gpu, name: &'static str, each: usize, count: usize, bodies: usize) {
        let size = (count.max(1) * each).next_multiple_of(16) as u64;
        let stride = (part_stride(count) * each) as u64;
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: stride * (bodies as u64 - 1) + size,
            usage: usage(),
            mapped_at_creation: false,
        });
        self.map.insert(name, Slice { buffer, offset: 0, size, share: 1.0 });
        self.strides.insert(name, stride);
    }

    /// A uniform buffer of `bytes`, zeroed.
    pub fn uniform(&mut self, gpu: &Gpu, name: &'static str, bytes: usize) {
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.map.insert(name, Slice::whole(buffer));
    }
}

/// Entries from one body's part of an array to the next: whatever an entry's size, a part then begins at the largest offset
/// alignment WebGPU allows.
pub fn part_stride(count: usize) -> usize {
    count.max(1).next_multiple_of(256)
}

fn usage() -> wgpu::BufferUsages {
    wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC
}

/// What may not fit: name, bytes, and the limit it meets.
fn needs(gpu: &Gpu, model: &Model, chains: &Chains, road: bool, real: Real) -> [(&'static str, u64, u64); 4] {
    let binding = gpu.report.storage_binding.min(gpu.report.buffer);
    let (slots, nodes) = (chains.slot_count() as u64, model.node_count() as u64);
    let surface = if road { model.mesh.surface.len() as u64 } else { 0 };
    let vector = <[f64; 4]>::size(real) as u64;
    let record = layout::SurfaceRecord::size(real) as u64;
    [
        ("corner forces [bytes]", vector * slots, binding),
        ("positions [bytes]", vector * nodes, binding),
        ("what relaxing points remember [bytes]", (real.bytes() * series::remembered(model)) as u64, binding),
        // Sums, positions and velocities of the surface come back through one buffer; the rest is small.
        ("a sample's surface [bytes]", (record + 2 * vector + 4) * surface + 65_536, gpu.report.buffer),
    ]
}

/// Refuses a scene that the adapter cannot hold, before anything starts.
pub fn check_limits(gpu: &Gpu, model: &Model, chains: &Chains, road: bool, real: Real) -> Result<()> {
    for (what, need, limit) in needs(gpu, model, chains, road, real) {
        if need > limit {
            let fits = (limit as f64 / need as f64 * model.element_count() as f64) as u64;
            let adapter = gpu.report.name.clone();
            return Err(Error::TooLarge { what: what.into(), need, limit, adapter, fits });
        }
    }
    Ok(())
}

/// A position or direction, padded.
pub fn vec4(v: [f64; 3]) -> [f64; 4] {
    [v[0], v[1], v[2], 0.0]
}

/// Shape classes as the element's shader reads them.
pub fn classes(model: &Model, real: Real) -> Vec<u8> {
    match model.element {
        Element::UniformGradient { .. } => bytes_of(&model.classes, mean_class, real),
        Element::Q1p0 | Element::Full => bytes_of(&model.classes, point_class, real),
    }
}

fn bytes_of<T: Wgsl>(classes: &[Class<f64>], shared: fn(&Class<f64>) -> T, real: Real) -> Vec<u8> {
    encode(real, &classes.iter().map(shared).collect::<Vec<T>>())
}

/// Bytes of the uniform buffer of shape classes that are shared.
pub fn shared_classes_size(element: Element, real: Real) -> usize {
    SHARED_CLASSES
        * match element {
            Element::UniformGradient { .. } => MeanClass::stride(real),
            Element::Q1p0 | Element::Full => PointClass::stride(real),
        }
}

fn point_class(class: &Class<f64>) -> PointClass {
    let points = std::array::from_fn(|q| {
        let m = class.metric[q];
        PointGeometry {
            metric: [m.xx, m.yy, m.zz],
            volume: class.det_j0[q],
            metric_off: [m.xy, m.xz, m.yz],
            inverse_det_j0: class.inverse_det_j0[q],
        }
    });
    PointClass { points, volume: class.volume, inverse_volume: class.inverse_volume }
}

fn mean_class(class: &Class<f64>) -> MeanClass {
    let e = class.extruded;
    MeanClass {
        gradient: class.gradient.map(vec4),
        gamma_x: class.gamma_x.map(vec4),
        in_plane: [e[0], e[1], e[2], e[3]],
        along: [e[4], e[5], e[6], 0.0],
        bend: [e[7], e[8], 0.0, 0.0],
        volume: class.volume,
        inverse_volume: class.inverse_volume,
        hourglass_stiffness: class.hourglass_stiffness,
        hourglass_viscosity: class.hourglass_viscosity,
    }
}
