//! What a composed module binds, as naga reflects it.

use super::layout::{Real, Step, Wgsl};
use naga::valid::{Capabilities, GlobalUse, ValidationFlags, Validator};

/// What a shader may use: what every adapter has, and doubles.
pub fn capabilities() -> Capabilities {
    Capabilities::default() | Capabilities::FLOAT64
}

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
    pub(super) fn step_size(&self) -> Option<u64> {
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
