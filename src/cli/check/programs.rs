//! The GPU programs a scene is composed of, as naga sees them: parts, bindings, memory.

use std::collections::BTreeMap;
use std::path::Path;

use naga::{AddressSpace, Module, StorageAccess, TypeInner};
use serde::Serialize;

use hexroll::engine::StageSetup;
use hexroll::gpu::chains::{self, Chains};
use hexroll::gpu::compose::{Choice, Composed, Kernel, RimKind};
use hexroll::gpu::{Counts, Precision, Shape, choice, order};
use hexroll::model::Model;
use hexroll::scene::{Drive, Scene};
use hexroll::{Error, Result};

/// Threads and memory [bytes] of a work group that every GPU of a desktop has at least.
const THREADS: usize = 1024;
const MEMORY: usize = 32 << 10;

/// Programs and buffers of the single-precision GPU engine.
#[derive(Debug, Serialize)]
pub struct GpuPlan {
    pub programs: Vec<Program>,
    /// Buffers that grow with the mesh or that programs share.
    pub buffers: Vec<Buffer>,
    /// Their sum; small sums and what is read back come on top.
    pub bytes: u64,
}

/// A composed program.
#[derive(Debug, Serialize)]
pub struct Program {
    pub kernel: String,
    /// Stages that dispatch it; empty: all.
    pub stages: Vec<String>,
    /// When it is dispatched.
    pub runs: &'static str,
    /// Files it is composed of.
    pub parts: Vec<String>,
    pub functions: usize,
    pub bindings: Vec<Binding>,
    /// WGSL, as the parts are joined.
    #[serde(skip)]
    pub source: String,
}

/// A buffer as a program binds it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Binding {
    pub binding: u32,
    pub name: String,
    pub access: &'static str,
    /// Size of one entry, or of all of a binding without a length of its own [bytes].
    pub stride: u32,
    /// Whether it is an array as long as the mesh asks.
    pub array: bool,
}

/// A buffer on the device.
#[derive(Debug, Serialize)]
pub struct Buffer {
    pub name: String,
    pub entries: u64,
    pub bytes: u64,
}

impl GpuPlan {
    /// Writes every program's WGSL to a folder: `<kernel>.wgsl`, numbered where stages have different ones, which the first line
    /// says.
    ///
    /// # Errors
    /// [`Error::Io`](hexroll::Error::Io).
    pub fn write_sources(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder).map_err(Error::io(folder, "make the folder"))?;
        let mut met: BTreeMap<&str, usize> = BTreeMap::new();
        for program in &self.programs {
            let number = met.entry(&program.kernel).and_modify(|n| *n += 1).or_insert(1);
            let number = if *number == 1 { String::new() } else { format!("-{number}") };
            let file = folder.join(format!("{}{number}.wgsl", program.kernel));
            let stages =
                if program.stages.is_empty() { "all".into() } else { format!("{:?}", program.stages) };
            let text = format!("// Stages: {stages}.\n{}", program.source);
            std::fs::write(&file, text).map_err(Error::io(&file, "write"))?;
        }
        Ok(())
    }

    /// # Errors
    /// [`Error::Device`](hexroll::Error::Device) if a program cannot be composed.
    pub fn of(scene: &Scene, model: &Model) -> Result<GpuPlan> {
        let ordered = order::ordered(model);
        let model = &*ordered.model;
        let mut programs: Vec<Program> = Vec::new();
        let chains = Chains::new(model, chains::longest(false, model.element_count()), true);
        let scene_choice = choice(model, scene, &chains, Precision::F32);
        for (kernel, runs) in scene_kernels(scene) {
            programs.push(program(&scene_choice, kernel, runs)?);
        }
        for stage in &scene.stages {
            let free = stage.rim.drives().map(|d| match d {
                Drive::Free { mass, .. } => Some(mass),
                _ => None,
            });
            let choice = scene_choice.for_stage(&StageSetup {
                mass_damping: stage.mass_damping,
                free,
                relaxed: stage.is_quasi_static(),
            });
            let small = Shape::within(THREADS, MEMORY, &chains, model.node_count()).is_some();
            for (kernel, runs) in stage_kernels(&choice, small) {
                let new = program(&choice, kernel, runs)?;
                match programs.iter_mut().find(|p| p.kernel == new.kernel && p.source == new.source) {
                    Some(known) => known.stages.push(stage.name.clone()),
                    None => programs.push(Program { stages: vec![stage.name.clone()], ..new }),
                }
            }
        }
        let buffers = buffers(&programs, model, &chains);
        Ok(GpuPlan { bytes: buffers.iter().map(|b| b.bytes).sum(), programs, buffers })
    }
}

/// Programs that are the same in every stage.
fn scene_kernels(scene: &Scene) -> Vec<(Kernel, &'static str)> {
    let mut kernels = vec![
        (Kernel::ElementForce, "every step"),
        (Kernel::ElementEnergy, "every window"),
        (Kernel::Gather, "for the critical step"),
        (Kernel::Reduce, "every window"),
    ];
    kernels.extend(scene.road.as_ref().map(|_| (Kernel::SurfaceState, "every window")));
    let watched = !scene.output.histories.is_empty();
    kernels.extend(watched.then_some((Kernel::Watch, "every step of stages with histories")));
    kernels.extend(scene.rim.as_ref().map(|_| (Kernel::Rebase, "when the wheel has rolled a grain further")));
    kernels
}

/// Programs that depend on the stage's damping and rim.
fn stage_kernels(choice: &Choice, small: bool) -> Vec<(Kernel, &'static str)> {
    let mut kernels = vec![(Kernel::Node, "every step"), (Kernel::NodeProbe, "every window")];
    if choice.road.is_some() || choice.rim != RimKind::None {
        kernels.insert(1, (Kernel::Boundary, "every step"));
    }
    if choice.rim == RimKind::Free {
        kernels.insert(0, (Kernel::Rim, "every step"));
    } else if small {
        kernels.push((
            Kernel::Resident,
            "many steps at once, in place of their passes, on a GPU with 32 KiB a work group",
        ));
    }
    kernels
}

fn program(choice: &Choice, kernel: Kernel, runs: &'static str) -> Result<Program> {
    let Composed { parts, text, module } = choice.compose(kernel)?;
    Ok(Program {
        kernel: kernel.name().into(),
        stages: Vec::new(),
        runs,
        functions: module.functions.len(),
        bindings: bindings(&module),
        parts,
        source: text,
    })
}

/// Bindings of a module, in their order.
fn bindings(module: &Module) -> Vec<Binding> {
    let mut found = Vec::new();
    for (_, variable) in module.global_variables.iter() {
        let Some(resource) = &variable.binding else { continue };
        let access = match variable.space {
            AddressSpace::Uniform => "uniform",
            AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => "read, write",
            _ => "read",
        };
        let (stride, array) = match module.types[variable.ty].inner {
            TypeInner::Array { stride, size: naga::ArraySize::Dynamic, .. } => (stride, true),
            ref inner => (inner.size(module.to_ctx()), false),
        };
        let name = variable.name.clone().unwrap_or_default();
        found.push(Binding { binding: resource.binding, name, access, stride, array });
    }
    found.sort_by_key(|b| b.binding);
    found
}

/// Buffers behind the bindings.
fn buffers(programs: &[Program], model: &Model, chains: &Chains) -> Vec<Buffer> {
    let mut by_name: BTreeMap<&str, Buffer> = BTreeMap::new();
    for binding in programs.iter().flat_map(|p| &p.bindings) {
        let name = binding.name.as_str();
        let entries = if binding.array { entries(name, model, chains) } else { Some(1) };
        if let Some(entries) = entries {
            let bytes = entries * u64::from(binding.stride);
            by_name.entry(name).or_insert(Buffer { name: name.into(), entries, bytes });
        }
    }
    let mut buffers: Vec<Buffer> = by_name.into_values().collect();
    buffers.sort_by_key(|b| std::cmp::Reverse(b.bytes));
    buffers
}

/// Entries of an array on this mesh; `None`: it is bound to other arrays, or does not grow with the mesh.
fn entries(name: &str, model: &Model, chains: &Chains) -> Option<u64> {
    let mesh = &model.mesh;
    let counts = || Counts::of(model, chains, true, u32::MAX);
    let count = match name {
        "chain_groups" => chains.groups.len(),
        "chain_nodes" => chains.nodes.len(),
        "slots" => chains.slot_count(),
        "chain_classes" => chains.classes.len(),
        "chain_elements" => chains.elements.len(),
        "energies" | "viscous_work" => chains::LANES * chains.groups.len(),
        "corners" => chains.slots.len(),
        "classes" if chains.shared_classes => chains::SHARED_CLASSES,
        "classes" => model.classes.len(),
        "corner_start" => model.node_count() + 1,
        "roles" | "positions" | "positions_lo" | "velocities" | "works" | "held" => model.node_count(),
        "boundary_bits" => model.node_count().div_ceil(32),
        "boundary" => mesh.surface.len() + mesh.rim.len(),
        "rim_nodes" | "rim_arms" | "rim_sums" => mesh.rim.len(),
        "surface_nodes" | "surface_sums" | "contact_states" | "inverse_areas" => mesh.surface.len(),
        "surface_states" => 2 * mesh.surface.len(),
        "contact_steps" => counts().contact_records(),
        "probes" => counts().probe_records(),
        _ => return None,
    };
    Some(count as u64)
}
