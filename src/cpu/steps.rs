//! Steps: forces and nodes by threads that meet, and the step that is only looked at.

use super::elements::{Failed, Power};
use super::engine::CpuEngine;
use super::layout::Line;
use super::nodes::{Books, Conditions, LineContact, LineSums, node_pass};
use super::reduce::total;
use super::rim::{Reaction, RimState};
use super::schedule::Task;
use super::state::View;
use super::team::SpinBarrier;
use crate::engine::{Probe, Step, StepContact};
use crate::physics::lanes::WIDEST;
use crate::physics::node::{Loads, Prediction, StepSize};
use crate::physics::rim::{self, Coordinates};
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, vec3};
use std::sync::atomic::{AtomicUsize, Ordering};

impl<T: Real> CpuEngine<T> {
    /// Conditions of step number `number`, which takes the rim from coordinates `before` to `q`. `probe`: works over
    /// the half step before.
    pub(super) fn conditions(
        &self,
        number: u64,
        step: &Step,
        before: &Coordinates,
        q: &Coordinates,
        probe: bool,
    ) -> Conditions<T> {
        let s = T::from_f64;
        let (start, end) = (rim::rotation(before), rim::rotation(q));
        let weights = if probe { [0.5 * step.dt_before, 0.0] } else { [0.5 * step.dtm(); 2] };
        let size = StepSize { dt: s(step.dt), dtm: s(step.dtm()) };
        let loads = Loads { gravity: self.gravity, alpha: s(self.setup.mass_damping) };
        Conditions {
            step: size,
            loads,
            prediction: Prediction::new(&loads, size),
            road: self.road.map(|road| road.seen_from(self.frame)),
            road_moves: self.road.is_some_and(|road| road.moves()),
            friction: self.friction,
            axle: vec3(self.local(q)),
            axle_velocity: vec3(std::array::from_fn(|d| (q[d] - before[d]) / step.dt)),
            rotation: end.to_cols_array_2d().map(vec3),
            rotation_rate: ((end - start) * (1.0 / step.dt)).to_cols_array_2d().map(vec3),
            axle_before: vec3(self.local(before)),
            weights: weights.map(s),
            has_gravity: self.gravity.iter().any(|g| *g != T::zero()),
            has_damping: self.setup.mass_damping != 0.0,
            number,
        }
    }

    /// Takes the steps with all threads; `Some((step, element))` where an element failed.
    pub(super) fn run_steps(
        &mut self,
        steps: &[Step],
        plan: &[Conditions<T>],
        free_rim: bool,
    ) -> Option<(usize, usize)> {
        let (view, books) = (self.view(), self.books());
        let power = Pointer(self.power.as_mut_ptr());
        let mut step_contact = std::mem::take(&mut self.step_contact);
        let mut touching_before = self.touching_before;
        let mut rim = self.rim;
        let shared_rim = Pointer(&raw mut rim);
        let host = Pointer(&raw mut step_contact);
        let host_touching = Pointer(&raw mut touching_before);
        let failed = AtomicUsize::new(usize::MAX);
        let failed_step = AtomicUsize::new(usize::MAX);
        let members = self.shares.len();
        let barrier = SpinBarrier::new(members);
        let (first, engine) = (self.steps, &*self);
        let held = self.rim.q;
        let work = |member: usize| {
            // SAFETY: shares do not overlap, barriers stand between what one writes and another reads, and the rim's
            // state and the host's records are written by member 0 only.
            for (n, step) in steps.iter().enumerate() {
                let books = &books[n % 2];
                // Lines that move early have no rim nodes: the motion of a free rim is nothing to them.
                let without_rim;
                let early = match plan.get(n) {
                    Some(conditions) => conditions,
                    None => {
                        without_rim = engine.conditions(first + n as u64, step, &held, &held, false);
                        &without_rim
                    }
                };
                let bad =
                    unsafe { engine.early(member, early, &view, books, power.get(), step.dtm(), false) };
                if let Some(element) = bad.0 {
                    failed.fetch_min(element, Ordering::Relaxed);
                    failed_step.store(n, Ordering::Relaxed);
                }
                barrier.wait();
                if failed.load(Ordering::Relaxed) != usize::MAX {
                    return;
                }
                let own;
                let conditions = if free_rim {
                    let state = unsafe { *shared_rim.get() };
                    let reaction = unsafe { engine.reaction(&view, engine.local(&state.q)) };
                    let (q, rate) = state.advanced(&engine.setup, step, &reaction);
                    own = engine.conditions(first + n as u64, step, &state.q, &q, false);
                    barrier.wait();
                    if member == 0 {
                        unsafe { *shared_rim.get() = RimState { q, rate, ..state } };
                    }
                    &own
                } else {
                    &plan[n]
                };
                unsafe { engine.late(member, conditions, &view, books, false) };
                barrier.wait();
                if member == 0 && engine.road.is_some() {
                    let (host, touching) = unsafe { (&mut *host.get(), &mut *host_touching.get()) };
                    let lines = unsafe { std::slice::from_raw_parts(books.contact, engine.contact[0].len()) };
                    host.push(contact_of(lines, step.dtm(), touching));
                }
            }
        };
        std::thread::scope(|scope| {
            for member in 1..members {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
        self.rim = rim;
        self.step_contact = step_contact;
        self.touching_before = touching_before;
        let element = failed.load(Ordering::Relaxed);
        (element != usize::MAX).then(|| (failed_step.load(Ordering::Relaxed), element))
    }

    /// A member's forces, and the nodes that move before the threads meet: none of the rim.
    ///
    /// # Safety
    /// No other thread works on this share.
    #[allow(clippy::too_many_arguments)] // what a step needs
    unsafe fn early(
        &self,
        member: usize,
        conditions: &Conditions<T>,
        view: &View<T>,
        books: &Books,
        power: *mut f64,
        weight: f64,
        probe: bool,
    ) -> Failed {
        let mut failed = Failed(None);
        for task in &self.shares[member].early {
            match *task {
                Task::Forces(item) => unsafe {
                    let bad = self.forces(item as usize, view, power, weight);
                    failed.0 = [failed.0, bad.0].into_iter().flatten().min();
                },
                Task::Move(line) => unsafe {
                    node_pass(&self.nodes, conditions, line as usize, view, books, probe);
                },
            }
        }
        failed
    }

    /// Forces of an item.
    ///
    /// # Safety
    /// As [`Kernel::forces`].
    pub(super) unsafe fn forces(&self, item: usize, view: &View<T>, power: *mut f64, weight: f64) -> Failed {
        unsafe {
            let power = Power { sums: power.add(item * WIDEST), weight };
            self.kernel.forces(&self.elements, item, view, power)
        }
    }

    /// The nodes of a member that wait for all forces.
    ///
    /// # Safety
    /// No other thread works on this share.
    unsafe fn late(&self, member: usize, c: &Conditions<T>, view: &View<T>, books: &Books, probe: bool) {
        for &line in &self.shares[member].late {
            unsafe { node_pass(&self.nodes, c, line as usize, view, books, probe) };
        }
    }

    /// The step after the window, not taken.
    pub(super) fn probe(&mut self, next: &Step) -> Probe {
        let fresh = vec![LineSums::default(); self.sums.len()];
        let window = std::mem::replace(&mut self.sums, fresh);
        let mut power = vec![0.0; self.power.len()];
        let (view, [books, _]) = (self.view(), self.books());
        let shared_power = Pointer(power.as_mut_ptr());
        let members = self.shares.len();
        let barrier = SpinBarrier::new(members);
        let engine = &*self;
        let work = |member: usize| {
            // SAFETY: as in `run_steps`; nothing but forces and sums is written.
            unsafe {
                let weight = 0.5 * next.dt_before;
                let held = &engine.rim.q;
                let without_rim = engine.conditions(engine.steps, next, held, held, true);
                engine.early(member, &without_rim, &view, &books, shared_power.get(), weight, true);
                barrier.wait();
                let reaction = engine.reaction(&view, engine.local(&engine.rim.q));
                let (q, _) = engine.rim.advanced(&engine.setup, next, &reaction);
                let c = engine.conditions(engine.steps, next, &engine.rim.q, &q, true);
                barrier.wait();
                engine.late(member, &c, &view, &books, true);
            }
        };
        std::thread::scope(|scope| {
            for member in 1..members {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
        let totals = total(&std::mem::replace(&mut self.sums, window));
        let mut half_works = totals.works;
        half_works.viscous = -power.iter().sum::<f64>();
        half_works.internal -= half_works.viscous;
        Probe {
            mixed_kinetic: totals.mixed_kinetic,
            half_works,
            net_force: totals.net_force2.sqrt(),
            internal_force: totals.internal_force2.sqrt(),
        }
    }

    /// Internal force of node `i` of a line: its slots, first to last.
    ///
    /// # Safety
    /// No thread writes forces.
    pub(super) unsafe fn gather(line: &Line, i: usize, view: &View<T>) -> Vec3<T> {
        let mut f = [T::zero(); 3];
        for (k, &slot) in line.slots.iter().enumerate() {
            for d in 0..3 {
                let part = unsafe { *view.f[d].add(slot + i) };
                f[d] = if k == 0 { part } else { f[d] + part };
            }
        }
        f
    }

    /// Sums the reaction of the rubber (and of body forces on the rim nodes), node by node in order.
    ///
    /// # Safety
    /// No thread writes forces or positions.
    unsafe fn reaction(&self, view: &View<T>, axle: [f64; 3]) -> Reaction {
        let mut sum = Reaction::default();
        for &(line, i) in &self.rim_nodes {
            let line = &self.nodes.lines[line];
            let (n, f_int) = (line.start + i, unsafe { Self::gather(line, i, view) });
            let weight = |i: usize| (self.nodes.mass.slice()[n] * self.gravity[i]).to_f64();
            let f: [f64; 3] = std::array::from_fn(|i| weight(i) - f_int[i].to_f64());
            let arm: [f64; 3] = std::array::from_fn(|i| unsafe { *view.x[i].add(n) }.to_f64() - axle[i]);
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sum.force[i] += f[i];
                sum.moment[i] += arm[j] * f[k] - arm[k] * f[j];
            }
        }
        sum
    }
}

/// A step's contact from its lines, first to last; `before`: nodes that touched in the step before.
fn contact_of(lines: &[LineContact], dtm: f64, before: &mut u32) -> StepContact {
    let mut sum = StepContact { dtm, ..StepContact::default() };
    let (mut entered, mut switched) = (0, 0);
    for line in lines {
        for d in 0..3 {
            sum.force[d] += line.force[d];
        }
        sum.touching += line.touching;
        entered += line.entered;
        switched += line.switched;
    }
    // Those of the step before that are not among the touching have left.
    let left = before.saturating_sub(sum.touching - entered);
    sum.changes = entered + switched + left;
    *before = sum.touching;
    sum
}

/// A pointer that threads may share under a pass's rules.
pub(super) struct Pointer<T>(pub *mut T);
// SAFETY: dereferenced only in unsafe code that keeps threads apart.
unsafe impl<T> Send for Pointer<T> {}
unsafe impl<T> Sync for Pointer<T> {}
impl<T> Pointer<T> {
    pub(super) fn get(&self) -> *mut T {
        self.0
    }
}
