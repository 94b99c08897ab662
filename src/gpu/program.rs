//! Compute pipelines from composed modules, with their bindings as naga reflects them.

use super::Gpu;
use super::buffers::Slice;
use super::compose::{self, Choice, Composed, Kernel, capabilities};
use super::layout::{Real, Step, Wgsl};
use crate::error::Result;
use naga::valid::{GlobalUse, ValidationFlags, Validator};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A binding of a composed module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    pub name: String,
    pub index: u32,
    pub kind: BindingKind,
    /// What the code does with it, whatever its declaration allows.
    pub read: bool,
    pub written: bool,
}

impl Binding {
    /// Bytes bound at a time, where it is the plan's uniform.
    fn step_size(&self) -> Option<u64> {
        match self.kind {
            BindingKind::Step(real) => Some(Step::size(real) as u64),
            _ => None,
        }
    }

    /// Bytes that a pass moves through it if it reads, or writes, all of a buffer of `size` bytes once.
    pub fn touched(&self, size: u64) -> u64 {
        let size = self.step_size().unwrap_or(size);
        size * (u64::from(self.read) + u64::from(self.written))
    }
}

/// What is bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    Storage {
        writes: bool,
    },
    /// The plan's uniform, at a dynamic offset: one step after the other, in this precision.
    Step(Real),
    Uniform,
}

/// Bindings of a valid module with one entry point, by index.
pub fn bindings(module: &naga::Module) -> Vec<Binding> {
    let analysis = Validator::new(ValidationFlags::all(), capabilities())
        .validate(module)
        .expect("only valid modules are asked for their bindings");
    let entry = analysis.get_entry_point(0);
    let binding = |(handle, v): (naga::Handle<naga::GlobalVariable>, &naga::GlobalVariable)| {
        let kind = match v.space {
            naga::AddressSpace::Storage { access } => {
                BindingKind::Storage { writes: access.contains(naga::StorageAccess::STORE) }
            }
            naga::AddressSpace::Uniform if v.name.as_deref() == Some("step") => {
                BindingKind::Step(step_precision(module, v))
            }
            naga::AddressSpace::Uniform => BindingKind::Uniform,
            _ => return None,
        };
        let used = entry[handle];
        Some(Binding {
            name: v.name.clone()?,
            index: v.binding?.binding,
            kind,
            read: used.intersects(GlobalUse::READ | GlobalUse::ATOMIC),
            written: used.intersects(GlobalUse::WRITE | GlobalUse::ATOMIC),
        })
    };
    let mut all: Vec<Binding> = module.global_variables.iter().filter_map(binding).collect();
    all.sort_by_key(|b| b.index);
    all
}

/// The precision of a plan by the size of its entries.
fn step_precision(module: &naga::Module, step: &naga::GlobalVariable) -> Real {
    let size = module.types[step.ty].inner.size(module.to_ctx()) as usize;
    if size == Step::size(Real::Double) { Real::Double } else { Real::Single }
}

/// Programs of a device by their text and constants: what two engines, two stages or two uses of one kernel share is
/// compiled once.
#[derive(Debug, Clone, Default)]
pub struct Programs {
    known: Arc<Mutex<HashMap<Key, Program>>>,
    /// Held while one is compiled: who wants the same waits for it.
    compiling: Arc<Mutex<()>>,
}

/// Text, whether it is checked, and the bits of the constants it declares.
type Key = (String, bool, Vec<(String, u64)>);

/// A pipeline and what it binds; a clone is the same pipeline.
#[derive(Debug, Clone)]
pub struct Program {
    pub pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    pub bindings: Vec<Binding>,
}

impl Program {
    /// Composes and compiles a kernel, or takes it from those compiled before; of `constants` those the module
    /// declares are set.
    pub fn new(gpu: &Gpu, choice: &Choice, kernel: Kernel, constants: &[(&str, f64)]) -> Result<Program> {
        Program::of(gpu, choice.compose(kernel)?, kernel.name(), constants)
    }

    /// The program of an entry point that depends on no scene, such as `bench/copy`.
    pub fn plain(gpu: &Gpu, entry: &str, real: Real, constants: &[(&str, f64)]) -> Result<Program> {
        Program::of(gpu, compose::plain(entry, real)?, entry, constants)
    }

    fn of(gpu: &Gpu, composed: Composed, label: &str, constants: &[(&str, f64)]) -> Result<Program> {
        let Composed { text, module, .. } = composed;
        let declared = |name: &str| module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(name));
        let constants: Vec<(&str, f64)> = constants.iter().copied().filter(|(n, _)| declared(n)).collect();
        let bits = constants.iter().map(|(name, value)| (name.to_string(), value.to_bits())).collect();
        let key = (text, gpu.checked, bits);
        let known = || held(&gpu.programs.known).get(&key).cloned();
        if let Some(program) = known() {
            return Ok(program);
        }
        let _alone = held(&gpu.programs.compiling);
        if let Some(program) = known() {
            return Ok(program);
        }
        let program = Program::compile(gpu, module, label, &constants);
        gpu.check()?;
        held(&gpu.programs.known).insert(key, program.clone());
        Ok(program)
    }

    fn compile(gpu: &Gpu, module: naga::Module, label: &str, constants: &[(&str, f64)]) -> Program {
        let bindings = bindings(&module);
        let entries: Vec<wgpu::BindGroupLayoutEntry> = bindings.iter().map(layout_entry).collect();
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        });
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module)),
        };
        let checks = if gpu.checked {
            wgpu::ShaderRuntimeChecks::checked()
        } else {
            wgpu::ShaderRuntimeChecks::unchecked()
        };
        // SAFETY: every index a kernel uses comes from the model's own tables (connectivity, corners, roles), which
        // are built to the sizes of the buffers they index, or is compared with arrayLength; loops run over them.
        let shader = unsafe { gpu.device.create_shader_module_trusted(descriptor, checks) };
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(&pipeline_layout),
            module: &shader,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        Program { pipeline, layout, bindings }
    }

    /// A bind group with the buffer that `of` names for each binding.
    pub fn bind(&self, gpu: &Gpu, of: impl Fn(&str) -> Slice) -> wgpu::BindGroup {
        let slices: Vec<Slice> = self.bindings.iter().map(|b| of(&b.name)).collect();
        let entry = |(b, slice)| {
            let (b, slice): (&Binding, &Slice) = (b, slice);
            let resource = wgpu::BindingResource::Buffer(slice.binding(b.step_size()));
            wgpu::BindGroupEntry { binding: b.index, resource }
        };
        let entries: Vec<wgpu::BindGroupEntry> = self.bindings.iter().zip(&slices).map(entry).collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &entries,
        })
    }

    /// Whether it reads the plan of steps.
    pub fn has_step(&self) -> bool {
        self.bindings.iter().any(|b| matches!(b.kind, BindingKind::Step(_)))
    }
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn layout_entry(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let (ty, dynamic, size) = match binding.kind {
        BindingKind::Storage { writes } => {
            (wgpu::BufferBindingType::Storage { read_only: !writes }, false, None)
        }
        BindingKind::Step(_) => {
            (wgpu::BufferBindingType::Uniform, true, binding.step_size().and_then(wgpu::BufferSize::new))
        }
        BindingKind::Uniform => (wgpu::BufferBindingType::Uniform, false, None),
    };
    wgpu::BindGroupLayoutEntry {
        binding: binding.index,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: dynamic, min_binding_size: size },
        count: None,
    }
}
