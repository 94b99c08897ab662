//! From a composed module to a pipeline.

use super::Gpu;
use super::bindings::{Binding, BindingKind, bindings};
use super::compose::{self, Choice, Composed, Kernel};
use super::layout::Real;
use super::program::Program;
use crate::error::Result;
use std::sync::{Mutex, MutexGuard, PoisonError};

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
