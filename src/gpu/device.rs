//! Adapters: which there are, which one to take, and a device with what it offers.

use super::program::Compiled;
use crate::error::{Error, Result};
use std::sync::{Arc, Mutex};

/// What wgpu sees, with the limits that matter here.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct AdapterReport {
    pub name: String,
    pub backend: String,
    pub driver: String,
    /// A processor pretending to be a GPU.
    pub software: bool,
    /// Largest storage binding and buffer [bytes].
    pub storage_binding: u64,
    pub buffer: u64,
    /// Storage buffers a compute stage may bind (passes bind up to 19, the kernel of small meshes 21).
    pub storage_buffers: u32,
    /// Work groups a dispatch may have in one dimension.
    pub workgroups: u32,
    /// Memory shared by a work group [bytes].
    pub shared_memory: u32,
    /// Whether timestamps inside passes can be read.
    pub timestamps: bool,
    /// Whether shaders may compute in double precision.
    pub doubles: bool,
    /// Whether this program can run on it, and if not, why not.
    pub unusable: Option<String>,
}

/// Storage buffers bound by the largest kernel of the passes.
pub const STORAGE_BUFFERS: u32 = 19;

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

fn all() -> Vec<wgpu::Adapter> {
    pollster::block_on(instance().enumerate_adapters(wgpu::Backends::all()))
}

fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
}

/// Discrete before integrated before others before software.
fn rank(info: &wgpu::AdapterInfo) -> u8 {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// Whether shaders may compute in double precision: on Vulkan. Direct3D offers doubles too, but the functions of HLSL (roots,
/// products of vectors) are single, so that results would be.
fn has_doubles(adapter: &wgpu::Adapter) -> bool {
    adapter.get_info().backend == wgpu::Backend::Vulkan
        && adapter.features().contains(wgpu::Features::SHADER_F64)
}

fn report(adapter: &wgpu::Adapter) -> AdapterReport {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    let buffers = limits.max_storage_buffers_per_shader_stage;
    let unusable =
        if !adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) {
            Some("it has no compute shaders".to_string())
        } else if buffers < STORAGE_BUFFERS {
            Some(format!("it binds {buffers} storage buffers a stage, {STORAGE_BUFFERS} are needed"))
        } else {
            None
        };
    AdapterReport {
        name: info.name.clone(),
        backend: info.backend.to_string(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_string(),
        software: is_software(&info),
        storage_binding: limits.max_storage_buffer_binding_size,
        buffer: limits.max_buffer_size,
        storage_buffers: buffers,
        workgroups: limits.max_compute_workgroups_per_dimension,
        shared_memory: limits.max_compute_workgroup_storage_size,
        timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY_INSIDE_PASSES),
        doubles: has_doubles(adapter),
        unusable,
    }
}

/// Every adapter, in the order in which they would be taken.
pub fn adapters() -> Vec<AdapterReport> {
    let mut all = all();
    all.sort_by_key(|a| rank(&a.get_info()));
    all.iter().map(report).collect()
}

/// A device ready for compute, with the adapter's own limits. Clones share the device and what is compiled for it.
#[derive(Debug, Clone)]
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// What the adapter offers: scenes are checked against it, and dispatches folded to its work groups.
    pub report: AdapterReport,
    /// Whether shaders check their indices and bound their loops, which costs a good part of a memory-bound kernel's time:
    /// debug builds (the tests) do. Counts for programs composed from now on.
    pub checked: bool,
    /// First error that wgpu reported since the last look.
    errors: Arc<Mutex<Option<String>>>,
    /// Programs compiled so far.
    pub(super) programs: Compiled,
}

impl Gpu {
    /// Opens the best usable adapter, or the first whose name contains `name` (any case).
    pub fn open(name: Option<&str>) -> Result<Gpu> {
        let mut candidates = all();
        candidates.sort_by_key(|a| rank(&a.get_info()));
        let wanted = |a: &&wgpu::Adapter| {
            name.is_none_or(|n| a.get_info().name.to_lowercase().contains(&n.to_lowercase()))
        };
        let adapter =
            candidates.iter().filter(wanted).find(|a| report(a).unusable.is_none()).ok_or_else(|| {
                let seen: Vec<String> = candidates
                    .iter()
                    .map(report)
                    .map(|r| {
                        format!("{} ({})", r.name, r.unusable.as_deref().unwrap_or("not the one asked for"))
                    })
                    .collect();
                let detail = if seen.is_empty() { "wgpu sees none".to_string() } else { seen.join(", ") };
                Error::NoAdapter { detail }
            })?;
        let report = report(adapter);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("hexroll"),
            required_features: adapter.features()
                & (wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SHADER_F64),
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| Error::Device { adapter: report.name.clone(), detail: e.to_string() })?;
        Ok(Gpu::from_parts(device, queue, report))
    }

    /// A device opened elsewhere. What wgpu would panic about is kept for [`Gpu::check`] from now on.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue, report: AdapterReport) -> Gpu {
        let errors = Arc::new(Mutex::new(None));
        let sink = errors.clone();
        device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| {
            sink.lock().expect("no one panics holding it").get_or_insert(e.to_string());
        }));
        Gpu { device, queue, report, checked: cfg!(debug_assertions), errors, programs: Compiled::default() }
    }

    /// The first error that wgpu reported since the last look.
    pub fn check(&self) -> Result<()> {
        match self.errors.lock().expect("no one panics holding it").take() {
            Some(detail) => Err(self.error(detail)),
            None => Ok(()),
        }
    }

    /// An error of this adapter.
    pub fn error(&self, detail: String) -> Error {
        Error::Device { adapter: self.report.name.clone(), detail }
    }

    /// Waits until everything submitted is done.
    pub fn wait(&self) -> Result<()> {
        let done = self.device.poll(wgpu::PollType::wait_indefinitely());
        done.map_err(|e| self.error(e.to_string()))?;
        self.check()
    }
}
