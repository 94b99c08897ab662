//! Programs with the buffers that they read and write.

use super::Gpu;
use super::bindings::Binding;
use super::buffers::Slice;
use super::program::Program;

/// Arrays by node, and the slots and lists by which nodes gather.
const BY_NODE: [&str; 9] =
    ["positions", "positions_lo", "velocities", "works", "held", "roles", "slots", "corner_start", "corners"];

/// Arrays of which a step touches an entry or none: its own place among the steps, the names of elements that fail.
const SELDOM: [&str; 3] = ["contact_steps", "plan", "chain_elements"];

/// A program with its buffers.
pub struct Bound {
    program: Program,
    group: wgpu::BindGroup,
    /// Bytes of the bindings it reads, plus those it writes: of arrays by node or slot, and of all others.
    touched: [u64; 2],
}

impl Bound {
    pub fn new<'b>(gpu: &Gpu, program: Program, of: impl Fn(&str) -> &'b Slice) -> Bound {
        let group = bind(gpu, &program, |name| of(name).clone());
        Bound::with(program, group, of)
    }

    /// With the whole buffers of those given, where they are parts: of all bodies.
    pub fn of_all<'b>(gpu: &Gpu, program: Program, of: impl Fn(&str) -> &'b Slice) -> Bound {
        let group = bind(gpu, &program, |name| of(name).all());
        Bound::with(program, group, of)
    }

    fn with<'b>(program: Program, group: wgpu::BindGroup, of: impl Fn(&str) -> &'b Slice) -> Bound {
        let mut touched = [0; 2];
        for b in program.bindings.iter().filter(|b| !SELDOM.contains(&&*b.name)) {
            touched[usize::from(!BY_NODE.contains(&&*b.name))] += b.touched(of(&b.name).used());
        }
        Bound { program, group, touched }
    }

    /// Whether it is the same pipeline.
    pub fn is_same(&self, other: &Bound) -> bool {
        self.program.pipeline == other.program.pipeline
    }

    /// Bytes that a pass moves which meets `share` of all nodes, every entry of an array once.
    pub fn bytes(&self, share: f64) -> u64 {
        (share * self.touched[0] as f64) as u64 + self.touched[1]
    }

    /// Records one dispatch; `offset` into the plan is not read by programs without a step.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, groups: [u32; 3], offset: u32) {
        pass.set_pipeline(&self.program.pipeline);
        let offsets: &[u32] = if self.program.has_step() { &[offset] } else { &[] };
        pass.set_bind_group(0, &self.group, offsets);
        pass.dispatch_workgroups(groups[0], groups[1], groups[2]);
    }
}

/// A bind group with the buffer that `of` names for each binding.
fn bind(gpu: &Gpu, program: &Program, of: impl Fn(&str) -> Slice) -> wgpu::BindGroup {
    let slices: Vec<Slice> = program.bindings.iter().map(|b| of(&b.name)).collect();
    let entry = |(b, slice)| {
        let (b, slice): (&Binding, &Slice) = (b, slice);
        let resource = wgpu::BindingResource::Buffer(slice.binding(b.step_size()));
        wgpu::BindGroupEntry { binding: b.index, resource }
    };
    let entries: Vec<wgpu::BindGroupEntry> = program.bindings.iter().zip(&slices).map(entry).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &program.layout,
        entries: &entries,
    })
}
