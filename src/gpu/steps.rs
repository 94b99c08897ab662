//! The step loop: plans, passes, submissions.

use super::buffers::{step_stride, vec4};
use super::engine::{GROUP, GpuEngine};
use super::ensemble::Job;
use super::layout::{self, Real, Wgsl, decode, encode};
use super::readback::Readback;
use super::stage::Bound;
use super::{upload, verdict};
use crate::engine::{Step, StepContact};
use crate::error::Result;
use crate::physics::rim::{self, Coordinates};
use std::time::{Duration, Instant};

/// Aimed length of one submission: long enough to hide its cost, far from any driver's patience.
const SUBMIT: Duration = Duration::from_millis(50);

/// Buffers that say how steps went.
const REPORTS: [&str; 3] = ["contact_steps", "failure", "done"];

/// First failing step with its element, and the last step taken, as the device has them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flags {
    failure: [u32; 2],
    done: u32,
}

/// Before any step.
pub(super) const NO_FLAGS: Flags = Flags { failure: [u32::MAX; 2], done: u32::MAX };

/// What the device says of the steps of a submission.
pub struct Taken {
    /// Contact by step and work group.
    contact: Vec<[f64; 4]>,
    flags: Flags,
    /// How long it took [s].
    seconds: f64,
}

impl Taken {
    /// From the bytes of contact, failure and sentinel.
    pub fn of([contact, failure, done]: [&[u8]; 3], real: Real, seconds: f64) -> Taken {
        let word = |bytes: &[u8], k: usize| bytemuck::cast_slice::<u8, u32>(bytes)[k];
        let flags = Flags { failure: [word(failure, 0), word(failure, 1)], done: word(done, 0) };
        Taken { contact: decode(real, contact), flags, seconds }
    }
}

/// One dispatch of a step.
pub(super) struct Pass<'e> {
    pub name: &'static str,
    pub program: &'e Bound,
    pub groups: [u32; 3],
    /// Share of the nodes that it moves; 1 where it is about elements.
    pub share: f64,
    /// Of the plan.
    pub real: Real,
}

impl Pass<'_> {
    /// Records it for the step whose plan entry is `slot`.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, slot: usize) {
        self.program.dispatch(pass, self.groups, (slot * step_stride(self.real)) as u32);
    }
}

/// Contact over the body in one step from its sums by work groups, as shaders/contact/book.wgsl packs them.
fn step_contact(step: &Step, sums: &[[f64; 4]]) -> StepContact {
    let mut all = StepContact { dtm: step.dtm(), ..StepContact::default() };
    for sum in sums {
        all.force.iter_mut().zip(sum).for_each(|(f, s)| *f += s);
        let counts = sum[3] as u32;
        all.touching += counts % 4096;
        all.changes += counts / 4096;
    }
    all
}

impl GpuEngine {
    /// A step as the shaders read it. `weights`: of the velocities before and after in works; of the viscous power.
    pub(super) fn plan_entry(
        &self,
        (index, slot): (u64, usize),
        step: &Step,
        before: &Coordinates,
        weights: [f64; 3],
    ) -> layout::Step {
        let free = self.has_free_rim();
        let local = |q: &Coordinates| vec4(std::array::from_fn(|d| q[d] - self.frame[d]));
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
        }
    }

    pub(super) fn write_plan(&self, entries: &[layout::Step]) {
        let stride = step_stride(self.real());
        let mut bytes = Vec::with_capacity(entries.len() * stride);
        for entry in entries {
            entry.put(self.real(), &mut bytes);
            bytes.resize(bytes.len().next_multiple_of(stride), 0);
        }
        self.buffers.get("step").write(&self.gpu, &bytes);
    }

    /// Rounds of passes that a submission of `steps` needs: a resident kernel takes all steps in one.
    pub(super) fn rounds(&self, steps: usize) -> usize {
        if self.is_resident() { 1 } else { steps }
    }

    /// The passes of one step, in order.
    pub(super) fn passes(&self) -> Vec<Pass<'_>> {
        let stage = self.stage.as_ref().expect("a stage is composed before its passes are asked for");
        let real = self.real();
        if let Some(program) = &stage.resident {
            return vec![Pass { name: "resident", program, groups: [1, 1, 1], share: 1.0, real }];
        }
        let share = |count: usize| count as f64 / self.counts.nodes as f64;
        let (rim, boundary) = (share(self.counts.rim), share(self.counts.surface + self.counts.rim));
        let mut passes = vec![Pass {
            name: "element_force",
            program: &self.force,
            groups: self.element_groups(),
            share: 1.0,
            real,
        }];
        passes.extend(stage.rim.as_ref().map(|program| Pass {
            name: "rim",
            program,
            groups: [1, 1, 1],
            share: rim,
            real,
        }));
        passes.push(Pass {
            name: "node",
            program: &stage.node,
            groups: self.counts.groups(self.counts.nodes),
            share: 1.0 - boundary,
            real,
        });
        let groups = self.counts.groups(self.counts.surface + self.counts.rim);
        passes.extend(stage.boundary.as_ref().map(|program| Pass {
            name: "boundary",
            program,
            groups,
            share: boundary,
            real,
        }));
        passes
    }

    /// Writes the plan of the steps of one submission.
    pub(super) fn write_steps(&self, steps: &[Step], starts: &[Coordinates]) {
        let entry = |(n, (step, before)): (usize, (&Step, &Coordinates))| {
            let w = 0.5 * step.dtm();
            self.plan_entry((self.steps + n as u64, n), step, before, [w, w, step.dtm()])
        };
        let entries: Vec<layout::Step> = steps.iter().zip(starts).enumerate().map(entry).collect();
        if self.is_resident() {
            self.buffers.get("plan").write(&self.gpu, &encode(self.real(), &entries));
            if self.seat.is_none() {
                self.write_member(steps.len());
            }
        } else {
            self.write_plan(&entries);
        }
    }

    /// What steps of a submission have to be told to a resident kernel.
    fn member(&self, steps: usize) -> layout::Member {
        upload::member(&self.counts, self.seat.as_ref().map_or(0, |seat| seat.seated.1), steps)
    }

    /// Tells the next dispatch of a resident kernel to take steps of this body alone.
    pub(super) fn write_member(&self, steps: usize) {
        if self.is_resident() {
            self.buffers.get("members").write(&self.gpu, &encode(self.real(), &[self.member(steps)]));
        }
    }

    /// Submits `steps` in one go and waits.
    pub(super) fn submit(&mut self, steps: &[Step], starts: &[Coordinates]) -> Result<()> {
        self.write_steps(steps, starts);
        let taken = match (self.job(steps.len()), &self.seat) {
            (Some(job), Some(seat)) => seat.take(job)?,
            _ => {
                let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
                let mut pass = encoder.begin_compute_pass(&Default::default());
                let passes = self.passes();
                for slot in 0..self.rounds(steps.len()) {
                    passes.iter().for_each(|p| p.dispatch(&mut pass, slot));
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
        if !self.fixed_submits {
            let most = SUBMIT.as_secs_f64() * steps as f64 / taken.seconds;
            self.steps_per_submit = (most as usize).clamp(1, self.counts.contact_slots());
        }
    }

    /// Steps that are written, to be taken together with those of others; `None` where no kernel can.
    pub(super) fn job(&self, steps: usize) -> Option<Job> {
        let program = self.stage.as_ref()?.resident.clone()?;
        let seat = self.seat.as_ref()?;
        let [contact, failure, done] = REPORTS.map(|name| self.buffers.get(name).clone());
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
        if self.is_resident() { self.counts.surface.min(1) } else { self.counts.surface.div_ceil(GROUP) }
    }

    /// Bytes of the contact of `steps` steps.
    fn contact_bytes(&self, steps: usize) -> u64 {
        (steps * self.contact_groups() * <[f64; 4]>::size(self.real())) as u64
    }

    /// Submits `steps` steps that are encoded, waits, and reads what the device says of them.
    pub(super) fn take(&self, encoder: wgpu::CommandEncoder, steps: usize) -> Result<Taken> {
        let mut read = Readback::default();
        let [contact, failure, done] = REPORTS.map(|name| self.buffers.get(name));
        let parts = [read.add_first(contact, self.contact_bytes(steps)), read.add(failure), read.add(done)];
        let begun = Instant::now();
        let data = read.copy(&self.gpu, encoder)?;
        let seconds = begun.elapsed().as_secs_f64();
        Ok(Taken::of(parts.map(|part| data.part(part)), self.real(), seconds))
    }

    /// Books steps that the device has taken.
    pub(super) fn took(&mut self, steps: &[Step], taken: &Taken) {
        self.steps += steps.len() as u64;
        self.window_steps += steps.len() as u64;
        self.flags = taken.flags;
        if self.counts.surface > 0 {
            let each = taken.contact.chunks_exact(self.contact_groups());
            self.step_contact.extend(steps.iter().zip(each).map(|(step, sums)| step_contact(step, sums)));
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
            let end = (at + self.steps_per_submit).min(steps.len());
            submit(self, &steps[at..end], &starts[at..end])?;
            at = end;
        }
        self.end_steps(steps, first)
    }

    /// What comes before steps are submitted: the number of the first, and where the rim is before each.
    pub(super) fn begin_steps(&mut self, steps: &[Step]) -> Result<(u64, Vec<Coordinates>)> {
        if !steps.is_empty() {
            self.restore()?;
            self.ready()?;
        }
        let before = std::iter::once(self.rim.q).chain(steps.iter().map(|s| s.rim));
        Ok((self.steps, before.take(steps.len()).collect()))
    }

    /// What comes after: the rim is where they took it, unless the device knows; and the device's word on them.
    pub(super) fn end_steps(&mut self, steps: &[Step], first: u64) -> Result<()> {
        let Some(last) = steps.last() else { return Ok(()) };
        if !self.has_free_rim() {
            let before = steps.len().checked_sub(2).map_or(self.rim.q, |k| steps[k].rim);
            self.rim.rate = std::array::from_fn(|c| (last.rim[c] - before[c]) / last.dt);
            self.rim.q = last.rim;
        }
        self.check_steps(steps, first)
    }

    /// Turns what the device reported into an error, and checks that the last pass ran.
    fn check_steps(&self, steps: &[Step], first: u64) -> Result<()> {
        let element = |e: usize| self.order.as_ref().map_or(e, |order| order.elements[e] as usize);
        verdict::failure(self.flags.failure, steps, first, element)?;
        verdict::sentinel(self.flags.done, self.steps).map_err(|detail| self.gpu.error(detail))
    }
}
