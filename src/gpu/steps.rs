//! The step loop: plans and submissions.

use super::buffers::{step_stride, vec4};
use super::counts::GROUP;
use super::engine::GpuEngine;
use super::layout::{self, Wgsl};
use super::meeting::Job;
use super::readback::{Part, Readback};
use super::upload;
use super::verdict::{self, Taken, step_contact};
use crate::engine::Step;
use crate::error::Result;
use crate::physics::material::Pace;
use crate::physics::rim::{self, Coordinates};
use std::time::{Duration, Instant};

/// Aimed length of one submission: long enough to hide its cost, far from any driver's patience.
const SUBMIT: Duration = Duration::from_millis(50);

/// Buffers that say how steps went.
const REPORTS: [&str; 3] = ["contact_steps", "failure", "done"];

impl GpuEngine {
    /// A step as the shaders read it. `weights`: of the velocities before and after in works; of the viscous power. `keeps`: it is
    /// taken, not looked at.
    pub(super) fn plan_entry(
        &self,
        (index, slot): (u64, usize),
        step: &Step,
        before: &Coordinates,
        weights: [f64; 3],
        keeps: bool,
    ) -> layout::Step {
        let free = self.programs.has_free_rim();
        let local = |q: &Coordinates| vec4(std::array::from_fn(|d| q[d] - self.body.frame[d]));
        let (now, then) = (rim::rotation(before), rim::rotation(&step.rim));
        let columns = |m: glam::DMat3| m.to_cols_array_2d().map(vec4);
        let rotation = columns(if free { rim::frame(&step.rim) } else { then });
        let rate = columns((then - now) * (1.0 / step.dt));
        let speed = vec4(std::array::from_fn(|d| (step.rim[d] - before[d]) / step.dt));
        let moves = vec4(std::array::from_fn(|d| step.rim[d] - self.rim.q[d]));
        layout::Step {
            dt: step.dt,
            dtm: step.dtm(),
            weight_before: weights[0],
            weight_after: weights[1],
            index: index as u32,
            viscous_weight: weights[2],
            spin: step.rim[rim::SPIN] - self.rim.q[rim::SPIN],
            zero: 0,
            axle: if free { moves } else { local(&step.rim) },
            axle_velocity: speed,
            axle_before: local(before),
            rotation0: rotation[0],
            rotation1: rotation[1],
            rotation2: rotation[2],
            rate0: rate[0],
            rate1: rate[1],
            rate2: rate[2],
            load: [step.load[0], step.load[1], step.load[2], step.load[rim::SPIN]],
            slot: slot as u32,
            dt_before: step.dt_before,
            keeps: u32::from(keeps),
        }
    }

    pub(super) fn write_plan(&self, entries: &[layout::Step]) {
        let stride = step_stride(self.body.real());
        let mut bytes = Vec::with_capacity(entries.len() * stride);
        for entry in entries {
            entry.put(self.body.real(), &mut bytes);
            bytes.resize(bytes.len().next_multiple_of(stride), 0);
        }
        self.body.buffers.get("step").write(&self.body.gpu, &bytes);
    }

    /// Terms of the Prony series in the steps of a submission, or of the one that is looked at.
    pub(super) fn write_fading(&self, steps: &[Step]) {
        let Some(series) = &self.series else { return };
        let paced = |(n, step): (usize, &Step)| {
            let relaxed = self.programs.setup.relaxed || (n == 0 && series.rested);
            series.fading(step.dt_before, step.dt, if relaxed { Pace::Relaxed } else { Pace::Timed })
        };
        let all: Vec<[f64; 4]> = steps.iter().enumerate().flat_map(paced).collect();
        self.body.write("fading", &all);
    }

    /// Rounds of passes that a submission of `steps` needs: a resident kernel takes all steps in one.
    pub(super) fn rounds(&self, steps: usize) -> usize {
        if self.programs.is_resident() { 1 } else { steps }
    }

    /// Writes the plan of the steps of one submission.
    pub(super) fn write_steps(&self, steps: &[Step], starts: &[Coordinates]) {
        let entry = |(n, (step, before)): (usize, (&Step, &Coordinates))| {
            let w = 0.5 * step.dtm();
            self.plan_entry((self.pace.steps + n as u64, n), step, before, [w, w, step.dtm()], true)
        };
        self.write_fading(steps);
        let entries: Vec<layout::Step> = steps.iter().zip(starts).enumerate().map(entry).collect();
        if self.programs.is_resident() {
            self.body.write("plan", &entries);
            if self.seat.is_none() {
                self.write_member(steps.len());
            }
        } else {
            self.write_plan(&entries);
        }
    }

    /// What steps of a submission have to be told to a resident kernel.
    fn member(&self, steps: usize) -> layout::Member {
        upload::member(&self.body.counts, self.seat.as_ref().map_or(0, |seat| seat.seated.1), steps)
    }

    /// Tells the next dispatch of a resident kernel to take steps of this body alone.
    pub(super) fn write_member(&self, steps: usize) {
        if self.programs.is_resident() {
            self.body.write("members", &[self.member(steps)]);
        }
    }

    /// Submits `steps` in one go and waits.
    pub(super) fn submit(&mut self, steps: &[Step], starts: &[Coordinates]) -> Result<()> {
        self.write_steps(steps, starts);
        let taken = match (self.job(steps.len()), &self.seat) {
            (Some(job), Some(seat)) => seat.take(job)?,
            _ => {
                let mut encoder = self.body.gpu.device.create_command_encoder(&Default::default());
                let mut pass = encoder.begin_compute_pass(&Default::default());
                let passes = self.programs.passes(&self.body.counts);
                for slot in 0..self.rounds(steps.len()) {
                    passes.iter().for_each(|p| p.dispatch(&mut pass, slot));
                    let offset = (slot * step_stride(self.body.real())) as u32;
                    self.watch.iter().for_each(|watch| watch.dispatch(&mut pass, &self.body, offset));
                }
                drop(pass);
                self.take(encoder, steps.len())?
            }
        };
        self.took(steps, &taken);
        self.learn(steps.len(), &taken);
        Ok(())
    }

    /// Adapts the length of submissions to the time that one of `steps` steps took.
    pub(super) fn learn(&mut self, steps: usize, taken: &Taken) {
        if !self.pace.fixed {
            let most = SUBMIT.as_secs_f64() * steps as f64 / taken.seconds;
            self.pace.per_submit = (most as usize).clamp(1, self.body.counts.contact_slots());
        }
    }

    /// Steps that are written, to be taken together with those of others; `None` where no kernel can.
    pub(super) fn job(&self, steps: usize) -> Option<Job> {
        let program = self.programs.stage.as_ref()?.resident.clone()?;
        let seat = self.seat.as_ref()?;
        let [contact, failure, done] = REPORTS.map(|name| self.body.buffers.get(name).clone());
        Some(Job {
            seated: seat.seated,
            member: self.member(steps),
            program,
            contact: (contact, self.contact_bytes(steps)),
            flags: [failure, done],
        })
    }

    /// Work groups whose contact a step leaves behind.
    fn contact_groups(&self) -> usize {
        if self.programs.is_resident() {
            self.body.counts.surface.min(1)
        } else {
            self.body.counts.surface.div_ceil(GROUP)
        }
    }

    /// Bytes of the contact of `steps` steps.
    fn contact_bytes(&self, steps: usize) -> u64 {
        (steps * self.contact_groups() * <[f64; 4]>::size(self.body.real())) as u64
    }

    /// Submits `steps` steps that are encoded, waits, and reads what the device says of them.
    pub(super) fn take(&self, encoder: wgpu::CommandEncoder, steps: usize) -> Result<Taken> {
        let mut read = Readback::default();
        let [contact, failure, done] = REPORTS.map(|name| self.body.buffers.get(name));
        let parts = [read.add_first(contact, self.contact_bytes(steps)), read.add(failure), read.add(done)];
        let states = self.body.buffers.has("watched_states").then(|| self.body.buffers.get("watched_states"));
        let watched =
            self.watch.iter().zip(states).map(|(w, b)| read.add_first(b, w.bytes(&self.body, steps)));
        let watched: Vec<Part> = watched.collect();
        let begun = Instant::now();
        let data = read.copy(&self.body.gpu, encoder)?;
        let seconds = begun.elapsed().as_secs_f64();
        let taken = Taken::of(parts.map(|part| data.part(part)), self.body.real(), seconds);
        Ok(Taken { watched: watched.iter().flat_map(|part| data.part(*part)).copied().collect(), ..taken })
    }

    /// Books steps that the device has taken.
    pub(super) fn took(&mut self, steps: &[Step], taken: &Taken) {
        self.pace.steps += steps.len() as u64;
        self.series.iter_mut().for_each(|series| series.rested = false);
        self.pace.window_steps += steps.len() as u64;
        self.pace.flags = taken.flags;
        self.watch.iter_mut().for_each(|watch| watch.keep(&self.body, &taken.watched));
        if self.body.counts.surface > 0 {
            let each = taken.contact.chunks_exact(self.contact_groups());
            self.pace
                .step_contact
                .extend(steps.iter().zip(each).map(|(step, sums)| step_contact(step, sums)));
        }
    }

    /// Takes the steps by submissions, each made by `submit`.
    pub(super) fn in_submissions(
        &mut self,
        steps: &[Step],
        mut submit: impl FnMut(&mut Self, &[Step], &[Coordinates]) -> Result<()>,
    ) -> Result<()> {
        let (first, starts) = self.begin_steps(steps)?;
        let mut at = 0;
        while at < steps.len() {
            let most = self.watch.as_ref().map_or(usize::MAX, |watch| watch.steps);
            let end = (at + self.pace.per_submit.min(most)).min(steps.len());
            submit(self, &steps[at..end], &starts[at..end])?;
            at = end;
        }
        self.end_steps(steps, first)
    }

    /// What comes before steps are submitted: the number of the first, and where the rim is before each.
    pub(super) fn begin_steps(&mut self, steps: &[Step]) -> Result<(u64, Vec<Coordinates>)> {
        if !steps.is_empty() {
            self.body.restore()?;
            self.ready()?;
        }
        let before = std::iter::once(self.rim.q).chain(steps.iter().map(|s| s.rim));
        Ok((self.pace.steps, before.take(steps.len()).collect()))
    }

    /// What comes after: the rim is where they took it, unless the device knows; and the device's word on them.
    pub(super) fn end_steps(&mut self, steps: &[Step], first: u64) -> Result<()> {
        let Some(last) = steps.last() else { return Ok(()) };
        if !self.programs.has_free_rim() {
            let before = steps.len().checked_sub(2).map_or(self.rim.q, |k| steps[k].rim);
            self.rim.rate = std::array::from_fn(|c| (last.rim[c] - before[c]) / last.dt);
            self.rim.q = last.rim;
        }
        self.check_steps(steps, first)
    }

    /// Turns what the device reported into an error, and checks that the last pass ran.
    fn check_steps(&self, steps: &[Step], first: u64) -> Result<()> {
        verdict::failure(self.pace.flags.failure, steps, first, |e| self.body.element(e))?;
        verdict::sentinel(self.pace.flags.done, self.pace.steps).map_err(|detail| self.body.gpu.error(detail))
    }
}
