//! Every buffer of a run, by the name the shaders use.

use super::Gpu;
use super::chains::{Chains, SHARED_CLASSES};
use super::layout::{self, MeanClass, PointClass, PointGeometry};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::element::{Class, hex8};
use crate::scene::Element;
use bytemuck::Pod;
use std::collections::HashMap;
use wgpu::util::DeviceExt;

/// Distance of two steps in the plan's uniform buffer: the largest offset alignment WebGPU allows.
pub const STEP_STRIDE: usize = 256;
/// Steps the plan holds at a time.
pub const PLAN: usize = 1024;

/// Buffers by name.
#[derive(Default)]
pub struct Buffers {
    map: HashMap<&'static str, wgpu::Buffer>,
}

impl Buffers {
    pub fn get(&self, name: &str) -> &wgpu::Buffer {
        self.map.get(name).unwrap_or_else(|| panic!("no buffer is called {name}"))
    }

    pub fn has(&self, name: &str) -> bool {
        self.map.contains_key(name)
    }

    /// Size of all of them [bytes].
    pub fn bytes(&self) -> u64 {
        self.map.values().map(wgpu::Buffer::size).sum()
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
        self.map.insert(name, buffer);
    }

    /// A zeroed buffer of `count` items of T.
    pub fn zeroed<T: Pod>(&mut self, gpu: &Gpu, name: &'static str, count: usize) {
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: (count.max(1) * size_of::<T>()).next_multiple_of(16) as u64,
            usage: usage(),
            mapped_at_creation: false,
        });
        self.map.insert(name, buffer);
    }

    /// A uniform buffer of `count` items of T that begins with `data`.
    pub fn filled_uniform<T: Pod>(&mut self, gpu: &Gpu, name: &'static str, data: &[T], count: usize) {
        self.uniform(gpu, name, count * size_of::<T>());
        gpu.queue.write_buffer(self.get(name), 0, bytemuck::cast_slice(data));
    }

    /// The plan's uniform buffer, and a small uniform.
    pub fn uniform(&mut self, gpu: &Gpu, name: &'static str, bytes: usize) {
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.map.insert(name, buffer);
    }
}

fn usage() -> wgpu::BufferUsages {
    wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC
}

/// What may not fit: name, bytes, and the limit it meets.
fn needs(gpu: &Gpu, model: &Model, chains: &Chains, road: bool) -> [(&'static str, u64, u64); 3] {
    let binding = gpu.report.storage_binding.min(gpu.report.buffer);
    let (slots, nodes) = (chains.slot_count() as u64, model.node_count() as u64);
    let surface = if road { model.mesh.surface.len() as u64 } else { 0 };
    let vector = size_of::<[f32; 4]>() as u64;
    let record = size_of::<layout::SurfaceRecord>() as u64;
    [
        ("corner forces [bytes]", vector * slots, binding),
        ("positions [bytes]", vector * nodes, binding),
        // Sums, positions and velocities of the surface come back through one buffer; the rest is small.
        ("a sample's surface [bytes]", (record + 2 * vector + 4) * surface + 65_536, gpu.report.buffer),
    ]
}

/// Refuses a scene that the adapter cannot hold, before anything starts.
pub fn check_limits(gpu: &Gpu, model: &Model, chains: &Chains, road: bool) -> Result<()> {
    for (what, need, limit) in needs(gpu, model, chains, road) {
        if need > limit {
            let fits = (limit as f64 / need as f64 * model.element_count() as f64) as u64;
            let adapter = gpu.report.name.clone();
            return Err(Error::TooLarge { what: what.into(), need, limit, adapter, fits });
        }
    }
    Ok(())
}

/// A position or direction, padded.
pub fn vec4(v: [f64; 3]) -> [f32; 4] {
    [v[0] as f32, v[1] as f32, v[2] as f32, 0.0]
}

/// Shape classes as the element's shader reads them.
pub fn upload_classes(buffers: &mut Buffers, gpu: &Gpu, model: &Model, shared: bool) {
    match model.element {
        Element::UniformGradient { .. } => {
            let classes: Vec<MeanClass> = model.classes.iter().map(mean_class).collect();
            put(buffers, gpu, &classes, shared);
        }
        Element::Q1p0 | Element::Full => {
            let classes: Vec<PointClass> = model.classes.iter().map(point_class).collect();
            put(buffers, gpu, &classes, shared);
        }
    }
}

fn put<T: Pod>(buffers: &mut Buffers, gpu: &Gpu, classes: &[T], shared: bool) {
    if shared {
        buffers.filled_uniform(gpu, "classes", classes, SHARED_CLASSES);
    } else {
        buffers.filled(gpu, "classes", classes);
    }
}

fn point_class(class: &Class<f64>) -> PointClass {
    let points = std::array::from_fn(|q| {
        // The shaders' element coordinates run from -1 to 1.
        let (m, unit) = (class.metric[q], hex8::TO_UNIT * hex8::TO_UNIT);
        PointGeometry {
            metric: [m.xx, m.yy, m.zz].map(|v| (v * unit) as f32),
            det_j0: class.det_j0[q] as f32,
            metric_off: [m.xy, m.xz, m.yz].map(|v| (v * unit) as f32),
            inverse_det_j0: (1.0 / class.det_j0[q]) as f32,
        }
    });
    PointClass {
        points,
        volume: class.volume as f32,
        inverse_volume: class.inverse_volume as f32,
        pad0: 0,
        pad1: 0,
    }
}

fn mean_class(class: &Class<f64>) -> MeanClass {
    MeanClass {
        gradient: class.gradient.map(vec4),
        gamma_x: class.gamma_x.map(vec4),
        volume: class.volume as f32,
        inverse_volume: class.inverse_volume as f32,
        hourglass_stiffness: class.hourglass_stiffness as f32,
        hourglass_viscosity: class.hourglass_viscosity as f32,
    }
}
