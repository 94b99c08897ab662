//! Steps: a team of threads goes through the tasks of a program, each through those of its own share.
//!
//! Every `unsafe` here is a member of a team that keeps to the contract of [`Shared`]; the comments name the phase.

use super::course::Course;
use super::plan::Task;
use super::program::Program;
use super::rim::{Reaction, RimState};
use super::sums::{contact_of, total};
use super::team::{self, SpinBarrier};
use super::watch::{Kept, Watch};
use crate::engine::{NodeState, Probe, Step, StepContact};
use crate::kernels::Line;
use crate::kernels::LineSums;
use crate::kernels::elements::{ElementStep, Failed};
use crate::kernels::{Arrays, Shared};
use crate::physics::lanes::WIDEST;
use crate::physics::material::Fading;
use crate::physics::scalar::Real;
use crate::physics::tensor::Vec3;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What the steps have done beside moving nodes.
#[derive(Debug, Clone)]
pub struct Taken {
    pub rim: RimState,
    /// Contact of every step; empty without a road.
    pub contact: Vec<StepContact>,
    /// Nodes that touch in the last step.
    pub touching: u32,
    /// States of the watched nodes, step after step.
    pub watched: Vec<NodeState>,
}

/// Where steps end: det F of an element is not positive at the start of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped {
    /// Its number among the steps to take.
    pub step: usize,
    /// The lowest such element.
    pub element: usize,
}

/// The lowest element that failed in a step, as all members learn when they meet.
struct Failure {
    element: AtomicUsize,
    step: AtomicUsize,
}

impl Failure {
    const NONE: usize = usize::MAX;

    fn none() -> Self {
        Failure { element: AtomicUsize::new(Self::NONE), step: AtomicUsize::new(Self::NONE) }
    }

    fn note(&self, step: usize, failed: Failed) {
        if let Some(element) = failed.0 {
            self.element.fetch_min(element, Ordering::Relaxed);
            self.step.store(step, Ordering::Relaxed);
        }
    }

    fn stopped(&self) -> Option<Stopped> {
        let element = self.element.load(Ordering::Relaxed);
        (element != Self::NONE).then(|| Stopped { step: self.step.load(Ordering::Relaxed), element })
    }
}

/// What elements need to know of a step that is taken.
fn taken<'a>(step: &Step, terms: &'a [Fading]) -> ElementStep<'a> {
    ElementStep { before: step.dt_before, weight: step.dtm(), terms, keeps: true }
}

impl<T: Real> Program<T> {
    /// Takes the steps of `course` with all threads; `touching`: nodes that touched in the step before. Where it stops,
    /// some nodes of the step that failed have moved already.
    pub fn take(
        &self,
        arrays: &mut Arrays<T>,
        course: &Course<T>,
        touching: u32,
        watch: &Watch,
    ) -> Result<Taken, Stopped> {
        let shared = arrays.shared();
        let failure = Failure::none();
        let mut states = vec![NodeState::default(); watch.len() * course.steps.len()];
        let kept = Kept::new(watch, &mut states);
        let mut taken = team::run(self.shares.len(), |member, meeting| {
            self.take_as(member, meeting, &shared, (course, touching), &failure, &kept)
        });
        taken.watched = states;
        failure.stopped().map_or(Ok(taken), Err)
    }

    /// The steps of one member.
    fn take_as(
        &self,
        member: usize,
        meeting: &SpinBarrier,
        shared: &Shared<T>,
        (course, touching): (&Course<T>, u32),
        failure: &Failure,
        kept: &Kept,
    ) -> Taken {
        let mut state = Taken { rim: course.rim, contact: Vec::new(), touching, watched: Vec::new() };
        for (n, step) in course.steps.iter().enumerate() {
            let c = course.early(n);
            // SAFETY: early, for a line of the share.
            let act = |line| unsafe { self.passes.nodes.step(&self.nodes, &c, line, shared, false) };
            // SAFETY: early.
            failure.note(n, unsafe { self.early(member, shared, taken(step, &course.terms(n)), act) });
            meeting.wait();
            if failure.stopped().is_some() {
                return state;
            }
            let c = course.late(n, &mut state.rim, |rim| {
                // SAFETY: between. The rim's lines move late, and nobody is late before all have read.
                let reaction =
                    unsafe { self.reaction(shared, course.world.gravity, course.world.local(&rim.q)) };
                meeting.wait();
                reaction
            });
            // SAFETY: late, for a line of the share.
            self.late(member, |line| unsafe { self.passes.nodes.step(&self.nodes, &c, line, shared, false) });
            meeting.wait();
            if member == 0 && course.world.road.is_some() {
                // SAFETY: after, by the first member.
                let lines = unsafe { shared.contacts(c.number) };
                state.contact.push(contact_of(lines, step.dtm(), &mut state.touching));
            }
            if kept.any() {
                // SAFETY: all members read, and nobody moves a node before they have met; each keeps a part of its own.
                unsafe { kept.keep(shared, n, [member, self.shares.len()]) };
                meeting.wait();
            }
        }
        state
    }

    /// The first step of `course`, not taken: nothing but forces and sums is written, and sums of before are kept.
    pub fn probe(&self, arrays: &mut Arrays<T>, course: &Course<T>) -> Probe {
        let window = std::mem::replace(&mut arrays.sums, vec![LineSums::default(); self.nodes.lines.len()]);
        let none = vec![0.0; self.elements.items.len() * WIDEST];
        let viscous = std::mem::replace(&mut arrays.viscous, none.clone());
        let loss = std::mem::replace(&mut arrays.loss, none);
        let shared = arrays.shared();
        let (world, number, step) = (course.world, course.first, &course.steps[0]);
        let terms = &course.terms(0);
        // What relaxation has done since the positions before counts whole: the steps have counted what was before that.
        let half = ElementStep { before: step.dt_before, weight: 0.5 * step.dt_before, terms, keeps: false };
        team::run(self.shares.len(), |member, meeting| {
            let held = &course.rim.q;
            let c = world.probed(number, step, held, held);
            // SAFETY: early, for a line of the share.
            let act = |line| unsafe { self.passes.nodes.step(&self.nodes, &c, line, &shared, true) };
            // SAFETY: early.
            unsafe { self.early(member, &shared, half, act) };
            meeting.wait();
            // SAFETY: between.
            let reaction = unsafe { self.reaction(&shared, world.gravity, world.local(held)) };
            let (q, _) = course.rim.advanced(course.setup, step, &reaction);
            let c = world.probed(number, step, held, &q);
            meeting.wait();
            // SAFETY: late, for a line of the share.
            self.late(member, |line| unsafe { self.passes.nodes.step(&self.nodes, &c, line, &shared, true) });
        });
        let totals = total(&std::mem::replace(&mut arrays.sums, window));
        arrays.loss = loss;
        let viscous = std::mem::replace(&mut arrays.viscous, viscous);
        let mut half_works = totals.works;
        half_works.viscous = -viscous.iter().sum::<f64>();
        half_works.internal -= half_works.viscous;
        Probe {
            mixed_kinetic: totals.mixed_kinetic,
            half_works,
            net_force: totals.net_force2.sqrt(),
            internal_force: totals.internal_force2.sqrt(),
        }
    }

    /// Puts the internal force on every node in the place of its position; `terms`: of the Prony series, which keeps nothing.
    pub fn internal_forces(&self, arrays: &mut Arrays<T>, terms: &[Fading]) {
        let shared = arrays.shared();
        let step = ElementStep { terms, ..ElementStep::default() };
        team::run(self.shares.len(), |member, meeting| {
            // SAFETY: early, for a line of the share; in place of a step.
            let act = |line| unsafe { self.gather_line(line, &shared) };
            // SAFETY: early.
            unsafe { self.early(member, &shared, step, act) };
            meeting.wait();
            // SAFETY: late, for a line of the share; in place of a step.
            self.late(member, |line| unsafe { self.gather_line(line, &shared) });
        });
    }

    /// A member's forces, and `act` on the lines that wait for no other member, each as soon as its forces are there;
    ///
    /// # Safety
    /// The caller is in the early phase of [`Shared`]'s contract.
    unsafe fn early(
        &self,
        member: usize,
        shared: &Shared<T>,
        step: ElementStep,
        act: impl Fn(usize),
    ) -> Failed {
        let mut failed = Failed(None);
        for task in &self.shares[member].early {
            match *task {
                Task::Forces(item) => {
                    let item = item as usize;
                    // SAFETY: early, for an item of the share.
                    let bad = unsafe { self.passes.elements.forces(&self.elements, item, shared, step) };
                    failed.0 = [failed.0, bad.0].into_iter().flatten().min();
                }
                Task::Move(line) => act(line as usize),
            }
        }
        failed
    }

    /// `act` on the lines of a member that wait for all forces.
    fn late(&self, member: usize, act: impl Fn(usize)) {
        self.shares[member].late.iter().for_each(|line| act(*line as usize));
    }

    /// Internal force on node `i` of a line: its slots, first to last.
    ///
    /// # Safety
    /// The caller may read the line's slots by the contract of [`Shared`].
    unsafe fn gather(&self, line: usize, i: usize, shared: &Shared<T>) -> Vec3<T> {
        let mut f = [T::zero(); 3];
        for (k, &slot) in self.nodes.lines[line].slots.iter().enumerate() {
            for d in 0..3 {
                // SAFETY: the caller's promise; `i` is within the line.
                let part = unsafe { *shared.f[d].add(slot + i) };
                f[d] = if k == 0 { part } else { f[d] + part };
            }
        }
        f
    }

    /// Puts the internal forces on a line's nodes in the place of their positions.
    ///
    /// # Safety
    /// The caller may step the line by the contract of [`Shared`].
    unsafe fn gather_line(&self, line: usize, shared: &Shared<T>) {
        let Line { start, ref nodes, .. } = self.nodes.lines[line];
        for i in 0..nodes.len() {
            // SAFETY: the caller's promise.
            unsafe {
                let f = self.gather(line, i, shared);
                (0..3).for_each(|d| *shared.x[d].add(start + i) = f[d]);
            }
        }
    }

    /// Sums the reaction of the rubber (and of body forces on the rim nodes), node by node in order.
    ///
    /// # Safety
    /// The caller is between the early and the late phase of [`Shared`]'s contract.
    unsafe fn reaction(&self, shared: &Shared<T>, gravity: Vec3<T>, axle: [f64; 3]) -> Reaction {
        let mut sum = Reaction::default();
        for &(line, i) in &self.rim_nodes {
            let n = self.nodes.lines[line].start + i;
            // SAFETY: the rim's lines move late.
            let (f_int, x) = unsafe { (self.gather(line, i, shared), shared.x.map(|x| *x.add(n))) };
            let weight = |i: usize| (self.nodes.mass.slice()[n] * gravity[i]).to_f64();
            let f: [f64; 3] = std::array::from_fn(|i| weight(i) - f_int[i].to_f64());
            let arm: [f64; 3] = std::array::from_fn(|i| x[i].to_f64() - axle[i]);
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sum.force[i] += f[i];
                sum.moment[i] += arm[j] * f[k] - arm[k] * f[j];
            }
        }
        sum
    }
}
