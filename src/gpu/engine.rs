//! The engine on the device: what it is made of, and what it answers.

use super::Gpu;
use super::buffers::{Buffers, PLAN, vec4};
use super::chains::Chains;
use super::compose::{Choice, Kernel, RimKind};
use super::ensemble::Seat;
use super::layout::{Real, Wgsl, decode, encode};
use super::order::Order;
use super::precision::Precision;
use super::prepared::Prepared;
use super::program::Program;
use super::readback::Readback;
use super::resident::Shape;
use super::rim::FreeRim;
use super::sample::Reductions;
use super::stage::{Bound, StagePrograms};
use super::steps::{Flags, NO_FLAGS};
use super::upload;
use crate::engine::{Engine, EngineInfo, StageSetup, State, Step, StepContact, Window};
use crate::error::Result;
use crate::model::mesh::Mesh;
use crate::model::{Model, frame};
use crate::physics::rim::Coordinates;
use crate::scene::{Road, Scene};

/// Threads of a work group, as written in every kernel.
pub const GROUP: usize = 64;
/// Partial sums of a reduction.
pub const PARTIALS: usize = 64;

/// The GPU engine.
pub struct GpuEngine {
    pub(super) gpu: Gpu,
    pub(super) choice: Choice,
    constants: Vec<(&'static str, f64)>,
    pub(super) buffers: Buffers,
    pub(super) force: Bound,
    pub(super) gather: Bound,
    pub(super) energy: Bound,
    pub(super) surface_state: Option<Bound>,
    rebase: Option<Bound>,
    pub(super) reductions: Reductions,
    /// Composed when the first stage begins.
    pub(super) stage: Option<StagePrograms>,
    setup: StageSetup,
    pub(super) rim: FreeRim,
    pub(super) road: Option<Road>,
    /// For the areas of surface nodes, where friction looks at pressure.
    pub(super) mesh: Option<Mesh>,
    /// The model's numbers by the device's, where they differ.
    pub(super) order: Option<Order>,
    pub(super) frame: [f64; 3],
    grain: f64,
    pub(super) counts: Counts,
    pub(super) steps: u64,
    pub(super) window_steps: u64,
    pub(super) step_contact: Vec<StepContact>,
    pub(super) steps_per_submit: usize,
    pub(super) fixed_submits: bool,
    pub(super) surface_nodes: Vec<u32>,
    /// As the device has them, with the sign of [`upload::masses`].
    pub(super) masses: Vec<f64>,
    /// How the mesh fits into one work group, if it does and may.
    shape: Option<Shape>,
    fits: Option<Shape>,
    /// Its place among bodies that take their steps together.
    pub(super) seat: Option<Seat>,
    /// What the device said last: of failures, and which step came last.
    pub(super) flags: Flags,
    /// The state, while the device's buffers serve for forces elsewhere.
    pub(super) lent: Option<Vec<(&'static str, Vec<u8>)>>,
}

/// Sizes of dispatches.
#[derive(Debug, Clone, Copy)]
pub struct Counts {
    pub elements: usize,
    pub nodes: usize,
    pub surface: usize,
    pub rim: usize,
    /// Work groups of chains.
    pub chain_groups: usize,
    /// Corner slots, and those that the element pass fills.
    pub slots: usize,
    pub stored_slots: usize,
    /// Work groups a dispatch may have in one dimension.
    pub most_groups: u32,
}

impl Counts {
    /// Of a model in these chains; `road`: surface nodes can touch, `most_groups`: of an adapter.
    pub fn of(model: &Model, chains: &Chains, road: bool, most_groups: u32) -> Counts {
        Counts {
            elements: model.element_count(),
            nodes: model.node_count(),
            surface: if road { model.mesh.surface.len() } else { 0 },
            rim: model.mesh.rim.len(),
            chain_groups: chains.groups.len(),
            slots: chains.slot_count(),
            stored_slots: chains.stored_slots(),
            most_groups,
        }
    }

    /// Records of a sample's probe.
    pub fn probe_records(&self) -> usize {
        4 * self.nodes.div_ceil(GROUP)
    }

    /// Work groups for `items` threads, folded into two dimensions where one is too short.
    pub fn groups(&self, items: usize) -> [u32; 3] {
        let groups = items.div_ceil(GROUP) as u32;
        if groups <= self.most_groups {
            return [groups, 1, 1];
        }
        let rows = groups.div_ceil(self.most_groups);
        [groups.div_ceil(rows), rows, 1]
    }

    /// Most steps a submission may hold: those whose contact the device can keep, in 2 bytes an element or 1 MiB.
    pub fn contact_slots(&self) -> usize {
        match self.surface.div_ceil(GROUP) {
            0 => PLAN,
            groups => ((2 * self.elements).max(1 << 20) / (16 * groups)).clamp(64, PLAN),
        }
    }

    /// Records of the contact of those steps.
    pub fn contact_records(&self) -> usize {
        self.contact_slots() * self.surface.div_ceil(GROUP)
    }
}

impl GpuEngine {
    /// An engine at rest in the reference shape.
    ///
    /// # Errors
    /// The scene does not fit the adapter's limits, the adapter does not have the precision, or (`f32+`) its arithmetic spoils
    /// compensated sums.
    pub fn new(gpu: &Gpu, model: &Model, scene: &Scene, precision: Precision) -> Result<Self> {
        let prepared = Prepared::new(gpu, model, scene, precision)?;
        let buffers = prepared.buffers(gpu, 1);
        GpuEngine::of_prepared(gpu, prepared, buffers, None)
    }

    /// The engine of a prepared body with these buffers, alone or in its place among others.
    pub(super) fn of_prepared(
        gpu: &Gpu,
        prepared: Prepared,
        mut buffers: Buffers,
        seat: Option<Seat>,
    ) -> Result<Self> {
        let Prepared { model, order, mesh, choice, counts, constants, shape, scene, grain, frame, .. } =
            prepared;
        upload::fill(gpu, &mut buffers, &model, &choice, frame, scene.road.as_ref());
        let program = |kernel| Program::new(gpu, &choice, kernel, &constants);
        let bound = |p: Program| Bound::new(gpu, p, |name| buffers.get(name));
        let force = bound(program(Kernel::ElementForce)?);
        let surface_state = match counts.surface {
            0 => None,
            _ => Some(bound(program(Kernel::SurfaceState)?)),
        };
        // Double precision has digits enough for any road.
        let rebase = match (counts.rim, choice.precision.real()) {
            (0, _) | (_, Real::Double) => None,
            _ => Some(bound(program(Kernel::Rebase)?)),
        };
        let reductions = Reductions::new(gpu, &choice, &buffers, counts.rim > 0)?;
        let engine = GpuEngine {
            gather: Bound::new(gpu, program(Kernel::Gather)?, |name| {
                // Forces are read back through the velocities' buffer, which the state does not need while it is on the host.
                buffers.get(if name == "forces" { "velocities" } else { name })
            }),
            energy: bound(program(Kernel::ElementEnergy)?),
            rim: FreeRim::new(&model),
            gpu: gpu.clone(),
            road: scene.road,
            mesh,
            order,
            setup: StageSetup::default(),
            steps: 0,
            window_steps: 0,
            step_contact: Vec::new(),
            flags: NO_FLAGS,
            lent: None,
            // A software adapter gives a work group one of its processors, and the passes all of them.
            shape: shape.filter(|_| seat.is_some() || !gpu.report.software),
            fits: shape,
            seat,
            steps_per_submit: 8,
            fixed_submits: false,
            surface_nodes: if choice.road.is_some() { model.mesh.surface.clone() } else { Vec::new() },
            masses: upload::masses(&model, choice.road.is_some()),
            choice,
            constants,
            buffers,
            force,
            surface_state,
            rebase,
            reductions,
            stage: None,
            frame,
            grain,
            counts,
        };
        gpu.check()?;
        if choice.precision.has_pairs() {
            super::check::compensated_sums(gpu, &engine.choice)?;
        }
        Ok(engine)
    }

    /// Fixes how many steps one submission holds (at most the plan's length), or (`None`) lets the time a submission
    /// takes decide, as it does at first. Results do not depend on it.
    pub fn set_steps_per_submit(&mut self, steps: Option<usize>) {
        self.fixed_submits = steps.is_some();
        self.steps_per_submit = steps.unwrap_or(8).clamp(1, self.counts.contact_slots());
    }

    /// Whether small meshes are kept in one work group's memory. At first they are, where they fit, but on software
    /// adapters. Results agree to rounding: forces are summed in another order.
    ///
    /// # Errors
    /// The stage's programs cannot be composed again.
    pub fn set_resident(&mut self, allowed: bool) -> Result<()> {
        self.shape = if allowed { self.fits } else { None };
        if self.stage.is_some() { self.compose_stage() } else { Ok(()) }
    }

    /// Whether the present stage's steps are taken in one work group.
    pub fn is_resident(&self) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.resident.is_some())
    }

    /// Whether both are of one ensemble and alike, so that one dispatch takes the steps of both.
    pub fn shares_dispatches(&self, other: &GpuEngine) -> bool {
        matches!((&self.seat, &other.seat), (Some(own), Some(other)) if own.is_beside(other))
    }

    /// Device memory of all buffers, over the number of elements [bytes].
    pub fn bytes_per_element(&self) -> f64 {
        self.buffers.bytes() as f64 / self.counts.elements as f64
    }

    /// What numbers are on the device.
    pub(super) fn real(&self) -> Real {
        self.choice.precision.real()
    }

    pub(super) fn element_groups(&self) -> [u32; 3] {
        self.counts.groups(GROUP * self.counts.chain_groups)
    }

    /// Composes the stage's programs, if no stage has begun yet.
    pub(super) fn ready(&mut self) -> Result<()> {
        if self.stage.is_none() { self.compose_stage() } else { Ok(()) }
    }

    fn compose_stage(&mut self) -> Result<()> {
        if self.choice.for_stage(&self.setup).other_works() && !self.buffers.has("works") {
            let each = <[f64; 2]>::size(self.real());
            self.buffers.zeroed(&self.gpu, "works", each, self.counts.nodes);
        }
        let Self { gpu, choice, constants, buffers, setup, rim, shape, seat, .. } = self;
        let resident = shape.map(|shape| (shape, seat.as_ref()));
        self.stage = Some(StagePrograms::new(gpu, choice, constants, buffers, setup, rim, resident)?);
        self.gpu.check()
    }

    pub(super) fn has_free_rim(&self) -> bool {
        self.choice.for_stage(&self.setup).rim == RimKind::Free
    }

    /// Lets the frame follow the axle.
    pub(super) fn follow(&mut self) -> Result<()> {
        let Some(rebase) = &self.rebase else { return Ok(()) };
        let axle = [self.rim.q[0], self.rim.q[1], self.rim.q[2]];
        let shift = frame::shift(self.grain, axle, self.frame, self.road.as_ref());
        if shift == [0.0; 3] {
            return Ok(());
        }
        self.buffers.get("shift").write(&self.gpu, &encode(self.real(), &[vec4(shift)]));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        rebase.dispatch(&mut pass, self.counts.groups(self.counts.nodes), 0);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        self.frame.iter_mut().zip(shift).for_each(|(frame, shift)| *frame += shift);
        self.gpu.wait()
    }

    pub(super) fn write_rim(&self) {
        if self.has_free_rim() {
            let state = self.rim.upload(self.frame);
            self.buffers.get("rim_state").write(&self.gpu, &encode(self.real(), &[state]));
        }
    }

    /// What stands by the device's nodes, by the model's.
    pub(super) fn by_model<T: Copy + Default>(&self, values: Vec<T>) -> Vec<T> {
        match &self.order {
            Some(order) => order.to_model(&values),
            None => values,
        }
    }

    /// The reverse.
    pub(super) fn by_device<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.order.as_ref().map_or(values.to_vec(), |order| order.to_device(values))
    }

    /// Absolute positions; `lo`: what is beside them in pairs.
    pub(super) fn absolute(&self, hi: &[[f64; 4]], lo: Option<&[[f64; 4]]>) -> Vec<[f64; 3]> {
        let at = |n: usize, d: usize| hi[n][d] + lo.map_or(0.0, |lo| lo[n][d]) + self.frame[d];
        self.by_model((0..hi.len()).map(|n| std::array::from_fn(|d| at(n, d))).collect())
    }
}

impl Engine for GpuEngine {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            engine: "gpu".into(),
            precision: self.choice.precision.name().into(),
            device: self.gpu.report.name.clone(),
            driver: self.gpu.report.driver.clone(),
            threads: 0,
        }
    }

    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        if *setup != self.setup || self.stage.is_none() {
            self.setup = *setup;
            self.compose_stage()?;
        }
        self.write_rim();
        Ok(())
    }

    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        self.in_submissions(steps, Self::submit)
    }

    fn sample(&mut self, next: &Step) -> Result<Window> {
        self.take_sample(next)
    }

    fn state(&mut self) -> Result<State> {
        self.restore()?;
        let mut read = Readback::default();
        let (x, v) = (read.add(self.buffers.get("positions")), read.add(self.buffers.get("velocities")));
        let lo = self.choice.precision.has_pairs().then(|| read.add(self.buffers.get("positions_lo")));
        let data = read.run(&self.gpu, |_| {})?;
        let vectors = |part| -> Vec<[f64; 4]> { decode(self.real(), data.part(part)) };
        let v = vectors(v).into_iter().map(|[x, y, z, _]| [x, y, z]).collect();
        Ok(State { x: self.absolute(&vectors(x), lo.map(vectors).as_deref()), v: self.by_model(v) })
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.restore()?;
        let mut v: Vec<[f64; 4]> = self.by_device(v).into_iter().map(vec4).collect();
        if self.window_steps > 0 {
            // The window's works stand beside the velocities.
            let mut read = Readback::default();
            let part = read.add(self.buffers.get("velocities"));
            let data = read.run(&self.gpu, |_| {})?;
            let old: Vec<[f64; 4]> = decode(self.real(), data.part(part));
            v.iter_mut().zip(&old).for_each(|(v, old)| v[3] = old[3]);
        }
        self.buffers.get("velocities").write(&self.gpu, &encode(self.real(), &v));
        self.rim.set_rate(&self.setup, rim_rate);
        self.write_rim();
        self.gpu.check()
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        self.restore()?;
        self.write_positions(&state.x);
        self.rim.q = *rim;
        self.follow()?;
        self.set_velocity(&state.v, rim_rate)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        self.trial_force(x, v)
    }
}
