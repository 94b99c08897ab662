//! Several bodies on one device that take their steps together: a work group a body, all of them in one submission.
//!
//! Every body has an engine of its own, driven by a thread of its own, with its own stages, windows and steps. When each of
//! them waits for steps to be taken, one thread submits those of all. Bodies with the same kernels and tables are *alike*:
//! their arrays are parts of the same buffers, and one dispatch takes the steps of all that wait and are in the same kind of
//! stage. Others have dispatches of their own in the same pass, with nothing between them to wait for. A body alone is
//! dispatched by the same kernel, so that its results do not depend on who else is there, to the bit.

use super::Gpu;
use super::buffers::Slice;
use super::engine::GpuEngine;
use super::layout::{Member, Real, encode};
use super::precision::Precision;
use super::prepared::Prepared;
use super::readback::Readback;
use super::stage::Bound;
use super::steps::Taken;
use super::upload::MEMBERS;
use crate::engine::Step;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::rim::Coordinates;
use crate::scene::Scene;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Engines in plain f32 for bodies that each fit into one work group's memory. Each is to be driven by a thread of its own
/// and dropped when it has nothing more to do: a body that takes no steps keeps the others waiting.
///
/// # Errors
/// [`Error::Unsupported`] for a mesh that does not fit; those of [`GpuEngine::new`].
pub fn ensemble(gpu: &Gpu, bodies: &[(&Model, &Scene)]) -> Result<Vec<GpuEngine>> {
    let prepared = bodies.iter().map(|(model, scene)| {
        let prepared = Prepared::new(gpu, model, scene, Precision::F32)?;
        if prepared.shape.is_none() {
            return Err(Error::Unsupported {
                what: format!("an ensemble of meshes of {} elements on {}", prepared.counts.elements, gpu.report.name),
                instead: "mesh them so that positions and forces fit into one work group's memory (1,320 nodes need \
                          32 KiB), or run them one by one"
                    .into(),
            });
        }
        Ok(prepared)
    });
    let prepared = prepared.collect::<Result<Vec<Prepared>>>()?;
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (k, body) in prepared.iter().enumerate() {
        let most = body.most_bodies(gpu).min(MEMBERS);
        let alike = |group: &&mut Vec<usize>| group.len() < most && prepared[group[0]].is_alike(body);
        match groups.iter_mut().find(alike) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    let buffers: Vec<_> = groups.iter().map(|g| prepared[g[0]].buffers(gpu, g.len())).collect();
    gpu.check()?;
    let mut places: Vec<Seated> = vec![(0, 0); prepared.len()];
    for (g, group) in groups.iter().enumerate() {
        group.iter().enumerate().for_each(|(body, &k)| places[k] = (g, body));
    }
    let together = Arc::new(Together {
        gpu: gpu.clone(),
        groups: buffers
            .iter()
            .map(|b| Group { members: b.get("members").clone(), programs: Mutex::default() })
            .collect(),
        meeting: Mutex::new(Meeting { present: prepared.len(), ..Meeting::default() }),
        changed: Condvar::new(),
    });
    let engine = |(prepared, seated): (Prepared, Seated)| {
        let seat = Seat { together: together.clone(), seated };
        GpuEngine::of_prepared(gpu, prepared, buffers[seated.0].of_body(seated.1), Some(seat))
    };
    prepared.into_iter().zip(places).map(engine).collect()
}

/// Takes the same steps with every engine of an ensemble, from one thread: no one waits for anyone. To the bit what
/// [`Engine::advance`](crate::engine::Engine::advance) does with each.
///
/// # Errors
/// Those of `advance`, the first one's; [`Error::Unsupported`] where a stage's rim moves freely, which no engine of small
/// meshes has.
pub fn advance_together(engines: &mut [GpuEngine], steps: &[Step]) -> Result<()> {
    let begun = engines.iter_mut().map(|e| e.begin_steps(steps)).collect::<Result<Vec<_>>>()?;
    let Some(together) = engines.iter().find_map(|e| e.seat.as_ref()).map(|seat| seat.together.clone())
    else {
        return Ok(());
    };
    let mut at = 0;
    while at < steps.len() {
        let end = engines.iter().map(|e| at + e.steps_per_submit).fold(steps.len(), usize::min);
        let job = |(engine, (_, starts)): (&GpuEngine, &(u64, Vec<Coordinates>))| {
            engine.write_steps(&steps[at..end], &starts[at..end]);
            engine.job(end - at).ok_or_else(|| Error::Unsupported {
                what: "an ensemble whose rims move freely".into(),
                instead: "prescribe the rims' motion, or advance each engine by itself".into(),
            })
        };
        let jobs = engines.iter().zip(&begun).map(job).collect::<Result<Vec<Job>>>()?;
        let taken = together.try_submit(&jobs)?;
        for (engine, taken) in engines.iter_mut().zip(&taken) {
            engine.took(&steps[at..end], taken);
            engine.learn(end - at, taken);
        }
        at = end;
    }
    engines.iter_mut().zip(&begun).try_for_each(|(engine, (first, _))| engine.end_steps(steps, *first))
}

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
type Seated = (usize, usize);

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
    together: Arc<Together>,
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

    fn try_submit(&self, jobs: &[Job]) -> Result<Vec<Taken>> {
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
