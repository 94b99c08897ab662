//! Compute pipelines with what they bind, and those that a device has compiled.

use super::bindings::{Binding, BindingKind};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// Programs of a device by their text and constants: what two engines, two stages or two uses of one kernel share is
/// compiled once.
#[derive(Debug, Clone, Default)]
pub struct Compiled {
    pub(super) known: Arc<Mutex<HashMap<Key, Program>>>,
    /// Held while one is compiled: who wants the same waits for it.
    pub(super) compiling: Arc<Mutex<()>>,
}

/// Text, whether it is checked, and the bits of the constants it declares.
pub type Key = (String, bool, Vec<(String, u64)>);

/// A pipeline and what it binds; a clone is the same pipeline.
#[derive(Debug, Clone)]
pub struct Program {
    pub pipeline: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
    pub bindings: Vec<Binding>,
}

impl Program {
    /// Whether it reads the plan of steps.
    pub fn has_step(&self) -> bool {
        self.bindings.iter().any(|b| matches!(b.kind, BindingKind::Step(_)))
    }
}
