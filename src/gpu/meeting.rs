//! Where bodies that take their steps together meet: each waits until all have steps, then one thread submits those of all.

use super::Gpu;
use super::bound::Bound;
use super::buffers::Slice;
use super::layout::{Member, Real, encode};
use super::readback::Readback;
use super::verdict::Taken;
use crate::error::{Error, Result};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Where bodies meet.
pub struct Together {
    gpu: Gpu,
    groups: Vec<Group>,
    meeting: Mutex<Meeting>,
    changed: Condvar,
}

/// Bodies that are alike.
struct Group {
    members: Slice,
    /// Their kernels so far, one for each kind of stage.
    programs: Mutex<Vec<Arc<Bound>>>,
}

#[derive(Default)]
struct Meeting {
    /// Bodies that have not left.
    present: usize,
    waiting: Vec<Job>,
    answers: Vec<(Seated, Result<Taken>)>,
    /// Whether somebody submits at the moment.
    busy: bool,
}

/// A body: its group, and its place in it.
pub type Seated = (usize, usize);

/// Steps of a body that waits; they are in its plan.
pub struct Job {
    pub seated: Seated,
    pub member: Member,
    pub program: Arc<Bound>,
    /// What its engine asks to see: contact of the steps (so many bytes), failure and sentinel.
    pub contact: (Slice, u64),
    pub flags: [Slice; 2],
}

/// A body's place among the others, until it is dropped.
pub struct Seat {
    pub together: Arc<Together>,
    pub seated: Seated,
}

impl Seat {
    /// Whether both are in the same group.
    pub fn is_beside(&self, other: &Seat) -> bool {
        Arc::ptr_eq(&self.together, &other.together) && self.seated.0 == other.seated.0
    }

    /// The group's kernel with this pipeline: `made`, unless another body has it already.
    pub fn program(&self, made: Bound) -> Arc<Bound> {
        let mut programs = held(&self.together.groups[self.seated.0].programs);
        if let Some(known) = programs.iter().find(|p| p.is_same(&made)) {
            return known.clone();
        }
        programs.push(Arc::new(made));
        programs[programs.len() - 1].clone()
    }

    /// Waits until every other body has steps to take or has left, and takes them all.
    pub fn take(&self, job: Job) -> Result<Taken> {
        self.together.take(job)
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        held(&self.together.meeting).present -= 1;
        self.together.changed.notify_all();
    }
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Together {
    /// For bodies whose groups have these lists of members; `bodies`: how many.
    pub fn new(gpu: &Gpu, members: impl Iterator<Item = Slice>, bodies: usize) -> Together {
        Together {
            gpu: gpu.clone(),
            groups: members.map(|members| Group { members, programs: Mutex::default() }).collect(),
            meeting: Mutex::new(Meeting { present: bodies, ..Meeting::default() }),
            changed: Condvar::new(),
        }
    }

    fn take(&self, job: Job) -> Result<Taken> {
        let own = job.seated;
        let mut meeting = held(&self.meeting);
        meeting.waiting.push(job);
        loop {
            if let Some(at) = meeting.answers.iter().position(|(seated, _)| *seated == own) {
                return meeting.answers.swap_remove(at).1;
            }
            if !meeting.busy && meeting.waiting.len() == meeting.present {
                let jobs = std::mem::take(&mut meeting.waiting);
                meeting.busy = true;
                drop(meeting);
                let answers = self.submit(&jobs);
                meeting = held(&self.meeting);
                meeting.busy = false;
                meeting.answers.extend(jobs.iter().map(|job| job.seated).zip(answers));
                self.changed.notify_all();
            } else {
                meeting = self.changed.wait(meeting).unwrap_or_else(PoisonError::into_inner);
            }
        }
    }

    /// Takes the steps of all jobs; what each has to be told. Whatever goes wrong, nobody is left waiting.
    fn submit(&self, jobs: &[Job]) -> Vec<Result<Taken>> {
        let failed = |detail: String| jobs.iter().map(|_| Err(self.gpu.error(detail.clone()))).collect();
        match catch_unwind(AssertUnwindSafe(|| self.try_submit(jobs))) {
            Ok(Ok(taken)) => taken.into_iter().map(Ok).collect(),
            Ok(Err(Error::Device { detail, .. })) => failed(detail),
            Ok(Err(error)) => failed(error.to_string()),
            Err(_) => failed("a submission of several bodies panicked".into()),
        }
    }

    /// Takes the steps of all jobs, in one submission or a few; by job, what the device says of them.
    pub fn try_submit(&self, jobs: &[Job]) -> Result<Vec<Taken>> {
        let begun = Instant::now();
        let mut read = Readback::default();
        let parts: Vec<_> = jobs
            .iter()
            .map(|job| {
                let (contact, bytes) = &job.contact;
                [read.add_first(contact, *bytes), read.add(&job.flags[0]), read.add(&job.flags[1])]
            })
            .collect();
        let mut rounds = self.rounds(jobs);
        let last = rounds.pop().unwrap_or_default();
        for round in &rounds {
            let encoder = self.encode(round);
            self.gpu.queue.submit([encoder.finish()]);
        }
        let data = read.copy(&self.gpu, self.encode(&last))?;
        let seconds = begun.elapsed().as_secs_f64();
        Ok(parts
            .into_iter()
            .map(|parts| Taken::of(parts.map(|part| data.part(part)), Real::Single, seconds))
            .collect())
    }

    /// Dispatches by rounds: in a round each group has one, since its bodies' parts are listed in one place.
    fn rounds<'j>(&self, jobs: &'j [Job]) -> Vec<Vec<Vec<&'j Job>>> {
        let mut rounds: Vec<Vec<Vec<&Job>>> = Vec::new();
        for group in 0..self.groups.len() {
            let mut dispatches: Vec<Vec<&Job>> = Vec::new();
            for job in jobs.iter().filter(|job| job.seated.0 == group) {
                match dispatches.iter_mut().find(|d| Arc::ptr_eq(&d[0].program, &job.program)) {
                    Some(dispatch) => dispatch.push(job),
                    None => dispatches.push(vec![job]),
                }
            }
            for (round, dispatch) in dispatches.into_iter().enumerate() {
                if round == rounds.len() {
                    rounds.push(Vec::new());
                }
                rounds[round].push(dispatch);
            }
        }
        rounds
    }

    fn encode(&self, round: &[Vec<&Job>]) -> wgpu::CommandEncoder {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        for dispatch in round {
            let members: Vec<Member> = dispatch.iter().map(|job| job.member).collect();
            self.groups[dispatch[0].seated.0].members.write(&self.gpu, &encode(Real::Single, &members));
            dispatch[0].program.dispatch(&mut pass, [members.len() as u32, 1, 1], 0);
        }
        drop(pass);
        encoder
    }
}
