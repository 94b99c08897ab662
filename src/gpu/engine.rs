//! The engine on the device: a body's state there, the programs that move it, and how far its steps have come.

use super::Gpu;
use super::body::Body;
use super::buffers::{Buffers, vec4};
use super::meeting::Seat;
use super::precision::Precision;
use super::prepared::Prepared;
use super::programs::Programs;
use super::rim::FreeRim;
use super::series::Series;
use super::upload;
use super::verdict::{Flags, NO_FLAGS};
use super::watch::Watch;
use crate::engine::StepContact;
use crate::error::Result;
use crate::model::mesh::Mesh;
use crate::model::{Model, frame};
use crate::scene::{Road, Scene};

/// The GPU engine.
pub struct GpuEngine {
    pub(super) body: Body,
    pub(super) programs: Programs,
    pub(super) pace: Pace,
    pub(super) rim: FreeRim,
    pub(super) road: Option<Road>,
    pub(super) series: Option<Series>,
    /// For the areas of surface nodes, where friction looks at pressure.
    pub(super) mesh: Option<Mesh>,
    /// Powers of two in which the frame follows the axle [m].
    grain: f64,
    /// Nodes whose state is kept after every step.
    pub(super) watch: Option<Watch>,
    /// Its place among bodies that take their steps together.
    pub(super) seat: Option<Seat>,
}

/// How far the steps have come, and how many a submission takes.
pub struct Pace {
    pub steps: u64,
    /// Since the last sample.
    pub window_steps: u64,
    pub step_contact: Vec<StepContact>,
    /// What the device said last: of failures, and which step came last.
    pub flags: Flags,
    pub per_submit: usize,
    /// Whether `per_submit` is as it was set, whatever the time a submission takes.
    pub fixed: bool,
}

/// Steps of the first submissions, before their time is known.
const FIRST: usize = 8;

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
        let Prepared {
            model,
            order,
            mesh,
            choice,
            counts,
            series,
            constants,
            shape,
            scene,
            grain,
            frame,
            ..
        } = prepared;
        upload::fill(gpu, &mut buffers, &model, &choice, frame, scene.road.as_ref());
        let mut programs = Programs::new(gpu, choice, constants, &buffers, &counts, shape)?;
        // A software adapter gives a work group one of its processors, and the passes all of them.
        programs.resident_allowed = seat.is_some() || !gpu.report.software;
        gpu.check()?;
        if choice.precision.has_pairs() {
            super::check::compensated_sums(gpu, &choice)?;
        }
        Ok(GpuEngine {
            body: Body {
                gpu: gpu.clone(),
                buffers,
                counts,
                precision: choice.precision,
                order,
                masses: model.mass.clone(),
                frame,
                lent: None,
            },
            programs,
            pace: Pace {
                steps: 0,
                window_steps: 0,
                step_contact: Vec::new(),
                flags: NO_FLAGS,
                per_submit: FIRST,
                fixed: false,
            },
            rim: FreeRim::new(&model),
            road: scene.road.clone(),
            series,
            mesh,
            grain,
            watch: None,
            seat,
        })
    }

    /// Fixes how many steps one submission holds (at most the plan's length), or (`None`) lets the time a submission
    /// takes decide, as it does at first. Results do not depend on it.
    pub fn set_steps_per_submit(&mut self, steps: Option<usize>) {
        self.pace.fixed = steps.is_some();
        self.pace.per_submit = steps.unwrap_or(FIRST).clamp(1, self.body.counts.contact_slots());
    }

    /// Whether small meshes are kept in one work group's memory. At first they are, where they fit, but on software
    /// adapters. Results agree to rounding: forces are summed in another order.
    ///
    /// # Errors
    /// The stage's programs cannot be composed again.
    pub fn set_resident(&mut self, allowed: bool) -> Result<()> {
        self.programs.resident_allowed = allowed;
        if self.programs.stage.is_some() { self.compose_stage() } else { Ok(()) }
    }

    /// Whether the present stage's steps are taken in one work group.
    pub fn is_resident(&self) -> bool {
        self.programs.is_resident()
    }

    /// Whether both are of one ensemble and alike, so that one dispatch takes the steps of both.
    pub fn shares_dispatches(&self, other: &GpuEngine) -> bool {
        matches!((&self.seat, &other.seat), (Some(own), Some(other)) if own.is_beside(other))
    }

    /// Device memory of all buffers, over the number of elements [bytes].
    pub fn bytes_per_element(&self) -> f64 {
        self.body.buffers.bytes() as f64 / self.body.counts.elements as f64
    }

    /// Composes the stage's programs, if no stage has begun yet.
    pub(super) fn ready(&mut self) -> Result<()> {
        if self.programs.stage.is_none() { self.compose_stage() } else { Ok(()) }
    }

    pub(super) fn compose_stage(&mut self) -> Result<()> {
        let Body { gpu, buffers, counts, .. } = &mut self.body;
        self.programs.compose_stage(gpu, buffers, counts, &self.rim, self.seat.as_ref())
    }

    /// Lets the frame follow the axle.
    pub(super) fn follow(&mut self) -> Result<()> {
        let Some(rebase) = &self.programs.rebase else { return Ok(()) };
        let body = &mut self.body;
        let axle = [self.rim.q[0], self.rim.q[1], self.rim.q[2]];
        let shift = frame::shift(self.grain, axle, body.frame, self.road.as_ref());
        if shift == [0.0; 3] {
            return Ok(());
        }
        body.write("shift", &[vec4(shift)]);
        let mut encoder = body.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        rebase.dispatch(&mut pass, body.counts.groups(body.counts.nodes), 0);
        drop(pass);
        body.gpu.queue.submit([encoder.finish()]);
        body.frame.iter_mut().zip(shift).for_each(|(frame, shift)| *frame += shift);
        body.gpu.wait()
    }

    /// Tells the device where a rim with free components is.
    pub(super) fn write_rim(&self) {
        if self.programs.has_free_rim() {
            self.body.write("rim_state", &[self.rim.upload(self.body.frame)]);
        }
    }
}
