//! The loop on the device: dispatches without host traffic between samples.

use super::Gpu;
use super::buffers::{self, Buffers, PLAN, STEP_STRIDE, vec4};
use super::compose::{Choice, FEW_CLASSES, Kernel, RimKind};
use super::layout::{self, Node, RimSum, SurfaceRecord};
use super::program::Program;
use super::readback::Readback;
use super::rim::FreeRim;
use super::stage::{Bound, StagePrograms};
use super::verdict;
use crate::engine::{Engine, EngineInfo, Probe, StageSetup, State, Step, SurfaceSum, Window, Works};
use crate::error::Result;
use crate::model::mesh::Mesh;
use crate::model::{Model, areas, frame};
use crate::physics::rim::{self, Coordinates};
use crate::scene::{Friction, Road, Scene};
use std::time::{Duration, Instant};

/// Threads of a work group, as written in every kernel.
const GROUP: usize = 64;
/// Partial sums of a reduction.
pub const PARTIALS: usize = 64;
/// Aimed length of one submission: long enough to hide its cost, far from any driver's patience.
const SUBMIT: Duration = Duration::from_millis(50);
/// Node roles, as in shaders/lib/nodes.wgsl.
const INTERIOR: u32 = 0xffff_ffff;
const RIM: u32 = 0x8000_0000;

/// The GPU engine.
pub struct GpuEngine {
    pub(super) gpu: Gpu,
    choice: Choice,
    constants: Vec<(&'static str, f64)>,
    buffers: Buffers,
    force: Bound,
    trial_force: Bound,
    gather: Bound,
    energy: Bound,
    surface_state: Option<Bound>,
    rebase: Option<Bound>,
    reductions: Reductions,
    /// Composed when the first stage begins.
    stage: Option<StagePrograms>,
    setup: StageSetup,
    rim: FreeRim,
    road: Option<Road>,
    /// For the areas of surface nodes, where friction looks at pressure.
    mesh: Option<Mesh>,
    frame: [f64; 3],
    grain: f64,
    counts: Counts,
    steps: u64,
    window_steps: u64,
    pub(super) steps_per_submit: usize,
    fixed_submits: bool,
    surface_nodes: Vec<u32>,
}

/// Sizes of dispatches.
#[derive(Debug, Clone, Copy)]
pub struct Counts {
    pub elements: usize,
    pub nodes: usize,
    pub surface: usize,
    pub rim: usize,
    /// Work groups a dispatch may have in one dimension.
    pub most_groups: u32,
}

impl Counts {
    /// Work groups for `items` threads, folded into two dimensions where one is too short.
    pub fn groups(&self, items: usize) -> [u32; 3] {
        let groups = items.div_ceil(GROUP) as u32;
        if groups <= self.most_groups {
            return [groups, 1, 1];
        }
        let rows = groups.div_ceil(self.most_groups);
        [groups.div_ceil(rows), rows, 1]
    }
}

/// One dispatch of a step.
pub(super) struct Pass<'e> {
    pub name: &'static str,
    pub program: &'e Bound,
    pub groups: [u32; 3],
}

impl Pass<'_> {
    /// Records it for the step whose plan entry is `slot`.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, slot: usize) {
        self.program.dispatch(pass, self.groups, (slot * STEP_STRIDE) as u32);
    }
}

/// Sums of records.
struct Reductions {
    works: Bound,
    rim: Option<Bound>,
    viscous: Option<Bound>,
    probes: Bound,
    energies: Bound,
}

impl GpuEngine {
    /// An engine at rest in the reference shape. `plus`: positions as hi + lo pairs (`f32+`).
    ///
    /// # Errors
    /// The scene does not fit the adapter's limits, or (`plus`) the adapter's arithmetic spoils compensated sums.
    pub fn new(gpu: &Gpu, model: &Model, scene: &Scene, plus: bool) -> Result<Self> {
        buffers::check_limits(gpu, model, scene.road.is_some())?;
        let choice = Choice {
            element: model.element,
            law: model.law,
            viscous: model.viscosity.is_some(),
            road: scene.road.is_some(),
            friction: scene.friction,
            held: !model.mesh.held.is_empty(),
            gravity: scene.gravity != [0.0; 3],
            damping: false,
            rim: if model.mesh.rim.is_empty() { RimKind::None } else { RimKind::Prescribed },
            plus,
            few_classes: model.classes.len() <= FEW_CLASSES,
        };
        let grain = frame::grain(&model.mesh);
        let frame = frame::shift(grain, model.mesh.axle, [0.0; 3], scene.road.as_ref());
        let counts = Counts {
            elements: model.element_count(),
            nodes: model.node_count(),
            surface: if choice.road { model.mesh.surface.len() } else { 0 },
            rim: model.mesh.rim.len(),
            most_groups: gpu.report.workgroups,
        };
        let constants = constants(model, scene);
        let buffers = upload(gpu, model, &choice, &counts, frame, scene.road.as_ref());
        let program = |kernel| Program::new(gpu, &choice, kernel, &constants);
        let bound = |p: Program| Bound::new(gpu, p, |name| buffers.get(canonical(name)));
        let element_force = program(Kernel::ElementForce)?;
        let force = bound(element_force.clone());
        let trial_force = Bound::new(gpu, element_force, |name| buffers.get(trial(canonical(name))));
        let surface_state = match counts.surface {
            0 => None,
            _ => Some(bound(program(Kernel::SurfaceState)?)),
        };
        let rebase = match counts.rim {
            0 => None,
            _ => Some(bound(program(Kernel::Rebase)?)),
        };
        let reductions = Reductions::new(gpu, &choice, &buffers, counts.rim > 0)?;
        let engine = GpuEngine {
            gather: bound(program(Kernel::Gather)?),
            energy: bound(program(Kernel::ElementEnergy)?),
            rim: FreeRim::new(model),
            gpu: gpu.clone(),
            road: scene.road,
            mesh: scene.friction.filter(Friction::needs_area).map(|_| model.mesh.clone()),
            setup: StageSetup::default(),
            steps: 0,
            window_steps: 0,
            steps_per_submit: 8,
            fixed_submits: false,
            surface_nodes: if choice.road { model.mesh.surface.clone() } else { Vec::new() },
            choice,
            constants,
            buffers,
            force,
            trial_force,
            surface_state,
            rebase,
            reductions,
            stage: None,
            frame,
            grain,
            counts,
        };
        gpu.check()?;
        if plus {
            super::check::compensated_sums(gpu, &engine.choice)?;
        }
        Ok(engine)
    }

    /// Fixes how many steps one submission holds (at most the plan's length), or (`None`) lets the time a submission
    /// takes decide, as it does at first. Results do not depend on it.
    pub fn set_steps_per_submit(&mut self, steps: Option<usize>) {
        self.fixed_submits = steps.is_some();
        self.steps_per_submit = steps.unwrap_or(8).clamp(1, PLAN);
    }

    /// Composes the stage's programs, if no stage has begun yet.
    fn ready(&mut self) -> Result<()> {
        if self.stage.is_none() { self.compose_stage() } else { Ok(()) }
    }

    fn compose_stage(&mut self) -> Result<()> {
        let Self { gpu, choice, constants, buffers, setup, rim, .. } = self;
        self.stage = Some(StagePrograms::new(gpu, choice, constants, buffers, setup, rim)?);
        self.gpu.check()
    }

    fn has_free_rim(&self) -> bool {
        self.choice.for_stage(&self.setup).rim == RimKind::Free
    }

    /// A step as the shaders read it. `weights`: of the velocities before and after in works; of the viscous power.
    fn plan_entry(&self, index: u64, step: &Step, before: &Coordinates, weights: [f64; 3]) -> layout::Step {
        let free = self.has_free_rim();
        let local = |q: &Coordinates| vec4(std::array::from_fn(|d| q[d] - self.frame[d]));
        let (now, then) = (rim::rotation(before), rim::rotation(&step.rim));
        let columns = |m: glam::DMat3| m.to_cols_array_2d().map(vec4);
        let rotation = columns(if free { rim::frame(&step.rim) } else { then });
        let rate = columns((then - now) * (1.0 / step.dt));
        let speed = vec4(std::array::from_fn(|d| (step.rim[d] - before[d]) / step.dt));
        let moves = vec4(std::array::from_fn(|d| step.rim[d] - self.rim.q[d]));
        layout::Step {
            dt: step.dt as f32,
            dtm: step.dtm() as f32,
            weight_before: weights[0] as f32,
            weight_after: weights[1] as f32,
            index: index as u32,
            viscous_weight: weights[2] as f32,
            spin: (step.rim[rim::SPIN] - self.rim.q[rim::SPIN]) as f32,
            pad: 0,
            axle: if free { moves } else { local(&step.rim) },
            axle_velocity: speed,
            axle_before: local(before),
            rotation0: rotation[0],
            rotation1: rotation[1],
            rotation2: rotation[2],
            rate0: rate[0],
            rate1: rate[1],
            rate2: rate[2],
            load: [step.load[0], step.load[1], step.load[2], step.load[rim::SPIN]].map(|l| l as f32),
        }
    }

    fn write_plan(&self, entries: &[layout::Step]) {
        let mut bytes = vec![0u8; entries.len() * STEP_STRIDE];
        for (slot, entry) in bytes.chunks_exact_mut(STEP_STRIDE).zip(entries) {
            slot[..size_of::<layout::Step>()].copy_from_slice(bytemuck::bytes_of(entry));
        }
        self.gpu.queue.write_buffer(self.buffers.get("step"), 0, &bytes);
    }

    /// The passes of one step, in order.
    pub(super) fn passes(&self) -> Vec<Pass<'_>> {
        let stage = self.stage.as_ref().expect("a stage is composed before its passes are asked for");
        let mut passes = vec![Pass {
            name: "element_force",
            program: &self.force,
            groups: self.counts.groups(self.counts.elements),
        }];
        passes.extend(stage.rim.as_ref().map(|program| Pass { name: "rim", program, groups: [1, 1, 1] }));
        passes.push(Pass {
            name: "node",
            program: &stage.node,
            groups: self.counts.groups(self.counts.nodes),
        });
        passes
    }

    /// Writes the plan of the steps of one submission.
    pub(super) fn write_steps(&self, steps: &[Step], starts: &[Coordinates]) {
        let entry = |(n, (step, before)): (usize, (&Step, &Coordinates))| {
            let w = 0.5 * step.dtm();
            self.plan_entry(self.steps + n as u64, step, before, [w, w, step.dtm()])
        };
        let entries: Vec<layout::Step> = steps.iter().zip(starts).enumerate().map(entry).collect();
        self.write_plan(&entries);
    }

    /// Submits `steps` in one go and waits.
    fn submit(&mut self, steps: &[Step], starts: &[Coordinates]) -> Result<()> {
        self.ready()?;
        self.write_steps(steps, starts);
        let passes = self.passes();
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for slot in 0..steps.len() {
                passes.iter().for_each(|p| p.dispatch(&mut pass, slot));
            }
        }
        let begun = Instant::now();
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait()?;
        let each = begun.elapsed().as_secs_f64() / steps.len() as f64;
        if !self.fixed_submits {
            self.steps_per_submit = ((SUBMIT.as_secs_f64() / each) as usize).clamp(1, PLAN);
        }
        self.took(steps.len());
        Ok(())
    }

    pub(super) fn took(&mut self, steps: usize) {
        self.steps += steps as u64;
        self.window_steps += steps as u64;
    }

    /// Takes the steps by submissions, each made by `submit`.
    pub(super) fn in_submissions(
        &mut self,
        steps: &[Step],
        mut submit: impl FnMut(&mut Self, &[Step], &[Coordinates]) -> Result<()>,
    ) -> Result<()> {
        if steps.is_empty() {
            return Ok(());
        }
        self.ready()?;
        let first = self.steps;
        let starts: Vec<Coordinates> =
            std::iter::once(self.rim.q).chain(steps.iter().map(|s| s.rim)).take(steps.len()).collect();
        let mut at = 0;
        while at < steps.len() {
            let end = (at + self.steps_per_submit).min(steps.len());
            submit(self, &steps[at..end], &starts[at..end])?;
            at = end;
        }
        if let (false, Some(last), Some(before)) = (self.has_free_rim(), steps.last(), starts.last()) {
            self.rim.rate = std::array::from_fn(|c| (last.rim[c] - before[c]) / last.dt);
            self.rim.q = last.rim;
        }
        self.check_steps(steps, first)
    }

    /// Turns what the device reported into an error, and checks that the last pass ran.
    fn check_steps(&mut self, steps: &[Step], first: u64) -> Result<()> {
        let mut read = Readback::default();
        let failure = read.add(self.buffers.get("failure"));
        let done = read.add(self.buffers.get("done"));
        let data = read.run(&self.gpu, |_| {})?;
        let flag = |part| -> &[u32] { bytemuck::cast_slice(data.part(part)) };
        let (failure, done) = (flag(failure), flag(done)[0]);
        verdict::failure([failure[0], failure[1]], steps, first)?;
        verdict::sentinel(done, self.steps).map_err(|detail| self.gpu.error(detail))
    }

    /// Lets the frame follow the axle.
    fn follow(&mut self) -> Result<()> {
        let Some(rebase) = &self.rebase else { return Ok(()) };
        let axle = [self.rim.q[0], self.rim.q[1], self.rim.q[2]];
        let shift = frame::shift(self.grain, axle, self.frame, self.road.as_ref());
        if shift == [0.0; 3] {
            return Ok(());
        }
        self.gpu.queue.write_buffer(self.buffers.get("shift"), 0, bytemuck::bytes_of(&vec4(shift)));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        rebase.dispatch(&mut pass, self.counts.groups(self.counts.nodes), 0);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        self.frame.iter_mut().zip(shift).for_each(|(frame, shift)| *frame += shift);
        self.gpu.wait()
    }

    /// Encodes everything a sample needs before it is copied out.
    fn encode_sample(&self, stage: &StagePrograms, encoder: &mut wgpu::CommandEncoder) {
        let counts = &self.counts;
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.energy.dispatch(&mut pass, counts.groups(counts.elements), 0);
            self.reductions.energies.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
            self.reductions.works.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
            if let Some(rim) = &self.reductions.rim {
                rim.dispatch(&mut pass, [PARTIALS as u32, 2, 1], 0);
            }
            if let Some(viscous) = &self.reductions.viscous {
                viscous.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
            }
        }
        if self.reductions.viscous.is_some() {
            let (from, to) = (self.buffers.get("partials_viscous"), self.buffers.get("kept_viscous"));
            encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
            encoder.clear_buffer(self.buffers.get("viscous_work"), 0, None);
        }
        if self.has_free_rim() {
            let (from, to) = (self.buffers.get("rim_state"), self.buffers.get("rim_state_probe"));
            encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.force.dispatch(&mut pass, counts.groups(counts.elements), 0);
        if let Some(rim) = &stage.probe_rim {
            rim.dispatch(&mut pass, [1, 1, 1], 0);
        }
        stage.probe.dispatch(&mut pass, counts.groups(counts.nodes), 0);
        self.reductions.probes.dispatch(&mut pass, [PARTIALS as u32, 3, 1], 0);
        if let Some(viscous) = &self.reductions.viscous {
            viscous.dispatch(&mut pass, [PARTIALS as u32, 1, 1], 0);
        }
        if let Some(surface) = &self.surface_state {
            surface.dispatch(&mut pass, counts.groups(counts.surface), 0);
        }
    }

    fn clear_sums(&self) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        for name in ["works", "rim_sums", "surface_sums", "viscous_work"] {
            encoder.clear_buffer(self.buffers.get(name), 0, None);
        }
        // The probe may have met the failure that the next step will report.
        self.gpu.queue.submit([encoder.finish()]);
        self.reset_failure();
    }

    fn reset_failure(&self) {
        self.gpu.queue.write_buffer(self.buffers.get("failure"), 0, bytemuck::cast_slice(&[u32::MAX; 4]));
    }

    fn write_rim(&self) {
        if self.has_free_rim() {
            let state = self.rim.upload(self.frame);
            self.gpu.queue.write_buffer(self.buffers.get("rim_state"), 0, bytemuck::bytes_of(&state));
        }
    }

    /// Absolute positions of f32 or f32+ data.
    fn absolute(&self, hi: &[f32], lo: Option<&[f32]>) -> Vec<[f64; 3]> {
        let at = |n: usize, d: usize| {
            let low = lo.map_or(0.0, |lo| f64::from(lo[4 * n + d]));
            f64::from(hi[4 * n + d]) + low + self.frame[d]
        };
        (0..hi.len() / 4).map(|n| std::array::from_fn(|d| at(n, d))).collect()
    }
}

impl Reductions {
    fn new(gpu: &Gpu, choice: &Choice, buffers: &Buffers, rim: bool) -> Result<Self> {
        let make = |records: &'static str, partials: &'static str, width: f64, least: f64| -> Result<Bound> {
            let constants = [("width", width), ("least_w", least)];
            let program = Program::new(gpu, choice, Kernel::Reduce, &constants)?;
            Ok(Bound::new(gpu, program, |name| {
                buffers.get(if name == "records" { records } else { partials })
            }))
        };
        Ok(Reductions {
            works: make("works", "partials_works", 1.0, 0.0)?,
            rim: if rim { Some(make("rim_sums", "partials_rim", 2.0, 0.0)?) } else { None },
            viscous: if choice.viscous {
                Some(make("viscous_work", "partials_viscous", 1.0, 0.0)?)
            } else {
                None
            },
            probes: make("probes", "partials_probes", 3.0, 0.0)?,
            energies: make("energies", "partials_energies", 1.0, 1.0)?,
        })
    }
}

/// The buffer behind a shader's name for it.
pub fn canonical(name: &str) -> &str {
    match name {
        "positions_in" => "positions",
        "positions_lo_in" => "positions_lo",
        "velocities_in" | "velocities_now" => "velocities",
        other => other,
    }
}

/// The buffer of a trial state, which the state itself never sees.
fn trial(name: &str) -> &str {
    match name {
        "positions" => "trial_positions",
        "positions_lo" => "trial_positions_lo",
        "velocities" => "trial_velocities",
        "failure" => "trial_failure",
        "viscous_work" => "trial_viscous",
        other => other,
    }
}

/// Values of every constant a kernel may declare.
fn constants(model: &Model, scene: &Scene) -> Vec<(&'static str, f64)> {
    use crate::scene::Law::*;
    let [g0, g1, g2] = match model.law {
        NeoHookean { g0, g1 } => [g0, g1, 0.0],
        MooneyRivlin { g0, g1, g2 } | MooneyRivlinEq4 { g0, g1, g2 } => [g0, g1, g2],
    };
    let mut all = vec![("g0", g0), ("g1", g1), ("g2", g2), ("eta", model.viscosity.unwrap_or(0.0))];
    all.extend(["gravity_x", "gravity_y", "gravity_z"].into_iter().zip(scene.gravity));
    all.extend(scene.friction.iter().flat_map(friction_constants));
    if let Some(Road::Plane { point, normal, velocity }) = scene.road {
        all.extend(["normal_x", "normal_y", "normal_z"].into_iter().zip(normal));
        all.extend(["road_velocity_x", "road_velocity_y", "road_velocity_z"].into_iter().zip(velocity));
        // Seen from the frame: it moves only along the road.
        all.push(("road_offset", (0..3).map(|d| normal[d] * point[d]).sum()));
    }
    all
}

fn friction_constants(law: &Friction) -> Vec<(&'static str, f64)> {
    match *law {
        Friction::Coulomb { mu } => vec![("mu", mu)],
        Friction::Viscous { slope } => vec![("friction_slope", slope)],
        Friction::Stribeck { still, kinetic, speed, slope } => vec![
            ("friction_still", still),
            ("friction_kinetic", kinetic),
            ("friction_inverse_speed", 1.0 / speed),
            ("friction_slope", slope),
        ],
        Friction::PressureVelocity { a, b, pressure, c, speed } => vec![
            ("friction_a", a),
            ("friction_b", b),
            ("friction_inverse_pressure", 1.0 / pressure),
            ("friction_c", c),
            ("friction_inverse_speed", 1.0 / speed),
        ],
    }
}

fn inverse_areas(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<f32> {
    areas::inverse_areas(mesh, x, road).into_iter().map(|a| a as f32).collect()
}

fn upload(
    gpu: &Gpu,
    model: &Model,
    choice: &Choice,
    counts: &Counts,
    frame: [f64; 3],
    road: Option<&Road>,
) -> Buffers {
    let mut b = Buffers::default();
    let mesh = &model.mesh;
    b.filled(gpu, "hexes", mesh.hexes.as_flattened());
    b.filled(gpu, "class_of", &model.class_of);
    buffers::upload_classes(&mut b, gpu, model);
    b.filled(gpu, "corner_start", &model.corner_start);
    b.filled(gpu, "corners", &model.corners);
    b.filled(gpu, "nodes", &nodes(model, choice.road));
    b.filled(gpu, "rim_nodes", &mesh.rim);
    let arm = |&n: &u32| vec4(std::array::from_fn(|d| mesh.nodes[n as usize][d] - mesh.axle[d]));
    b.filled(gpu, "rim_arms", &mesh.rim.iter().map(arm).collect::<Vec<_>>());
    b.filled(gpu, "surface_nodes", &mesh.surface);
    if choice.held {
        b.filled(gpu, "held", &mesh.held.iter().map(|&bits| u32::from(bits)).collect::<Vec<u32>>());
    }
    if let (Some(road), true) = (road, choice.friction.is_some_and(|law| law.needs_area())) {
        b.filled(gpu, "inverse_areas", &inverse_areas(mesh, |n| mesh.nodes[n as usize], road));
    }
    let (hi, lo) = split(&mesh.nodes, frame);
    for (name, data) in [("positions", &hi), ("trial_positions", &hi)] {
        b.filled(gpu, name, data);
    }
    if choice.plus {
        b.filled(gpu, "positions_lo", &lo);
        b.filled(gpu, "trial_positions_lo", &lo);
    }
    for name in ["velocities", "trial_velocities", "forces", "works"] {
        b.zeroed::<[f32; 4]>(gpu, name, counts.nodes);
    }
    b.zeroed::<[f32; 4]>(gpu, "slots", 8 * counts.elements);
    b.zeroed::<[f32; 4]>(gpu, "energies", counts.elements);
    for name in ["viscous_work", "trial_viscous"] {
        b.zeroed::<f32>(gpu, name, if choice.viscous { counts.elements } else { 1 });
    }
    b.zeroed::<RimSum>(gpu, "rim_sums", counts.rim);
    b.zeroed::<SurfaceRecord>(gpu, "surface_sums", counts.surface);
    b.zeroed::<[f32; 4]>(gpu, "surface_states", 2 * counts.surface);
    b.zeroed::<layout::ProbeRecord>(gpu, "probes", counts.nodes);
    b.zeroed::<layout::RimState>(gpu, "rim_state", 1);
    b.zeroed::<layout::RimState>(gpu, "rim_state_probe", 1);
    for (name, width) in [
        ("partials_works", 1),
        ("partials_rim", 2),
        ("partials_viscous", 1),
        ("kept_viscous", 1),
        ("partials_probes", 3),
        ("partials_energies", 1),
    ] {
        b.zeroed::<[f32; 4]>(gpu, name, width * PARTIALS);
    }
    b.filled(gpu, "failure", &[u32::MAX; 4]);
    b.filled(gpu, "trial_failure", &[u32::MAX; 4]);
    // No step has this index: a submission that does nothing is noticed, the first one too.
    b.filled(gpu, "done", &[u32::MAX; 4]);
    b.uniform(gpu, "step", PLAN * STEP_STRIDE);
    b.uniform(gpu, "shift", 16);
    b
}

/// Positions relative to the frame, as single-precision hi and lo parts.
fn split(x: &[[f64; 3]], frame: [f64; 3]) -> (Vec<[f32; 4]>, Vec<[f32; 4]>) {
    let local = |x: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|d| x[d] - frame[d]) };
    let low = |v: f64| f64::from(v as f32 - 0.0) - v;
    x.iter().map(local).map(|x| (vec4(x), vec4(x.map(|v| -low(v))))).unzip()
}

fn nodes(model: &Model, road: bool) -> Vec<Node> {
    let mut nodes: Vec<Node> = model.mass.iter().map(|&m| Node { mass: m as f32, role: INTERIOR }).collect();
    if road {
        for (k, &n) in model.mesh.surface.iter().enumerate() {
            nodes[n as usize].role = k as u32;
        }
    }
    for (k, &n) in model.mesh.rim.iter().enumerate() {
        nodes[n as usize].role = RIM | k as u32;
    }
    nodes
}

impl Engine for GpuEngine {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            engine: "gpu".into(),
            precision: if self.choice.plus { "f32+" } else { "f32" }.into(),
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
        self.ready()?;
        let stage = self.stage.as_ref().expect("it is ready");
        let half = 0.5 * next.dt_before;
        let entry = self.plan_entry(self.steps, next, &self.rim.q, [half, 0.0, half]);
        self.write_plan(&[entry]);
        let mut read = Readback::default();
        let names = [
            "partials_works",
            "partials_rim",
            "kept_viscous",
            "partials_viscous",
            "partials_probes",
            "partials_energies",
            "surface_sums",
            "surface_states",
            "rim_state",
        ];
        let parts = names.map(|n| read.add(self.buffers.get(n)));
        let data = read.run(&self.gpu, |encoder| self.encode_sample(stage, encoder))?;
        let [works, rim, viscous, half_viscous, probes, energies, sums, states, rim_state] =
            parts.map(|p| data.part(p));
        if self.has_free_rim() {
            self.rim.download(bytemuck::from_bytes(rim_state));
        }
        let mut window = Window {
            steps: std::mem::take(&mut self.window_steps),
            rim: self.rim.q,
            rim_rate: self.rim.rate,
            ..Window::default()
        };
        let sum = |bytes: &[u8], column: usize| column_sum(bytes, column);
        let (e, least) = (sum(energies, 0), least_w(energies));
        (window.strain, window.hourglass, window.min_jacobian) = (e[0], e[1], least);
        let (w, r0, r1) = (sum(works, 0), sum(rim, 0), sum(rim, 1));
        let total = |bytes: &[u8]| if self.choice.viscous { sum(bytes, 0).iter().sum() } else { 0.0 };
        window.rim_impulse = [r0[0], r0[1], r0[2]];
        window.rim_moment_impulse = [r1[0], r1[1], r1[2]];
        window.works = Works {
            internal: w[0],
            viscous: total(viscous),
            damping: w[2],
            body_force: w[1],
            rim: r0[3],
            ..Works::default()
        };
        let (p, h, c) = (sum(probes, 0), sum(probes, 1), sum(probes, 2));
        window.kinetic = p[1];
        window.probe = Probe {
            mixed_kinetic: p[0],
            half_works: Works {
                internal: h[0],
                viscous: total(half_viscous),
                damping: h[2],
                body_force: h[1],
                rim: h[3],
                normal: c[0],
                friction: c[1],
            },
            net_force: p[2].sqrt(),
            internal_force: p[3].sqrt(),
        };
        window.works.internal -= window.works.viscous;
        window.probe.half_works.internal -= window.probe.half_works.viscous;
        if self.counts.surface > 0 {
            self.read_surface(&mut window, sums, states);
            self.refresh_areas(&window);
        }
        self.clear_sums();
        self.follow()?;
        self.write_rim();
        Ok(window)
    }

    fn state(&mut self) -> Result<State> {
        let mut read = Readback::default();
        let (x, v) = (read.add(self.buffers.get("positions")), read.add(self.buffers.get("velocities")));
        let lo = self.choice.plus.then(|| read.add(self.buffers.get("positions_lo")));
        let data = read.run(&self.gpu, |_| {})?;
        let floats = |part| -> &[f32] { bytemuck::cast_slice(data.part(part)) };
        let v = floats(v).chunks_exact(4).map(|v| [v[0], v[1], v[2]].map(f64::from)).collect();
        Ok(State { x: self.absolute(floats(x), lo.map(floats)), v })
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        let v: Vec<[f32; 4]> = v.iter().map(|&v| vec4(v)).collect();
        self.gpu.queue.write_buffer(self.buffers.get("velocities"), 0, bytemuck::cast_slice(&v));
        self.rim.set_rate(&self.setup, rim_rate);
        self.write_rim();
        self.gpu.check()
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        let (hi, lo) = split(&state.x, self.frame);
        let write = |name, data: &[[f32; 4]]| {
            self.gpu.queue.write_buffer(self.buffers.get(name), 0, bytemuck::cast_slice(data));
        };
        write("positions", &hi);
        if self.choice.plus {
            write("positions_lo", &lo);
        }
        self.rim.q = *rim;
        self.follow()?;
        self.set_velocity(&state.v, rim_rate)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        let (hi, lo) = split(x, self.frame);
        let v: Vec<[f32; 4]> = v.iter().map(|&v| vec4(v)).collect();
        let write = |name, data: &[[f32; 4]]| {
            self.gpu.queue.write_buffer(self.buffers.get(name), 0, bytemuck::cast_slice(data));
        };
        write("trial_positions", &hi);
        write("trial_velocities", &v);
        if self.choice.plus {
            write("trial_positions_lo", &lo);
        }
        let mut read = Readback::default();
        let forces = read.add(self.buffers.get("forces"));
        let data = read.run(&self.gpu, |encoder| {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.trial_force.dispatch(&mut pass, self.counts.groups(self.counts.elements), 0);
            self.gather.dispatch(&mut pass, self.counts.groups(self.counts.nodes), 0);
        })?;
        let forces: &[f32] = bytemuck::cast_slice(data.part(forces));
        Ok(forces.chunks_exact(4).map(|f| [f[0], f[1], f[2]].map(f64::from)).collect())
    }
}

impl GpuEngine {
    /// Areas of the surface nodes at the end of a window, where friction looks at pressure.
    fn refresh_areas(&self, window: &Window) {
        let (Some(mesh), Some(road)) = (&self.mesh, &self.road) else { return };
        let at = |n: u32| match mesh.surface.binary_search(&n) {
            Ok(k) => window.surface[k].x,
            // A rim node beside the surface: its facet faces no road.
            Err(_) => mesh.nodes[n as usize],
        };
        let areas = inverse_areas(mesh, at, road);
        self.gpu.queue.write_buffer(self.buffers.get("inverse_areas"), 0, bytemuck::cast_slice(&areas));
    }

    fn read_surface(&self, window: &mut Window, sums: &[u8], states: &[u8]) {
        let sums: &[SurfaceRecord] = bytemuck::cast_slice(sums);
        let states: &[[f32; 4]] = bytemuck::cast_slice(states);
        for (k, record) in sums.iter().take(self.surface_nodes.len()).enumerate() {
            let [x, v] = [states[2 * k], states[2 * k + 1]];
            window.works.normal += f64::from(record.normal_work);
            window.works.friction += f64::from(record.friction_work);
            window.surface.push(SurfaceSum {
                x: std::array::from_fn(|d| f64::from(x[d]) + self.frame[d]),
                v: [v[0], v[1], v[2]].map(f64::from),
                impulse: [0, 1, 2].map(|d| f64::from(record.impulse[d])),
                friction_work: f64::from(record.friction_work),
                touching: record.touching,
                sticking: record.sticking,
                touches: record.state != 0,
                sticks: record.state == 2,
            });
        }
    }
}

/// Sum of one column's partials, first to last, in double precision.
fn column_sum(bytes: &[u8], column: usize) -> [f64; 4] {
    let partials: &[[f32; 4]] = bytemuck::cast_slice(bytes);
    let mut sum = [0.0; 4];
    for partial in &partials[column * PARTIALS..(column + 1) * PARTIALS] {
        for (s, p) in sum.iter_mut().zip(partial) {
            *s += f64::from(*p);
        }
    }
    sum
}

fn least_w(bytes: &[u8]) -> f64 {
    let partials: &[[f32; 4]] = bytemuck::cast_slice(bytes);
    partials.iter().map(|p| f64::from(p[3])).fold(f64::INFINITY, f64::min)
}
