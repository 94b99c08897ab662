//! The node pass, several nodes at a time: gather, acceleration, contact projection, integration, and the
//! book-keeping of every force.

use super::books::{
    LaneConditions, LaneSums, Moved, add_reactions, book, book_driven, choose3, fold, splat3,
};
use super::conditions::Conditions;
use super::layout::{Line, Nodes};
use super::shared::{Places, Shared};
use super::sums::LineContact;
use super::touch::{LineStep, touch};
use crate::physics::lanes::{InLanes, Instructions, Lanes, WIDEST};
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, add, axpy, combined, dot, scale};

/// A node pass, for certain instructions.
pub trait NodePass<T>: Send + Sync {
    /// Steps the nodes of a line; `probe`: only books what the step would do.
    ///
    /// # Safety
    /// A line of the early or the late phase of [`Shared`]'s contract.
    unsafe fn step(
        &self,
        nodes: &Nodes<T>,
        conditions: &Conditions<T>,
        line: usize,
        shared: &Shared<T>,
        probe: bool,
    );
}

/// The pass for these instructions.
pub fn compose<T: Real>(instructions: impl Instructions) -> Box<dyn NodePass<T>> {
    Box::new(With(instructions))
}

struct With<I>(I);

impl<T: Real, I: Instructions> NodePass<T> for With<I> {
    unsafe fn step(
        &self,
        nodes: &Nodes<T>,
        conditions: &Conditions<T>,
        line: usize,
        shared: &Shared<T>,
        probe: bool,
    ) {
        self.0.call(Pass { step: LineStep { nodes, c: conditions, line, shared }, probe });
    }
}

/// The pass over a line; made by [`NodePass::step`] alone, whose promise it holds.
struct Pass<'a, T> {
    step: LineStep<'a, T>,
    probe: bool,
}

impl<T: Real> InLanes<T> for Pass<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) {
        let Pass { step, probe } = &self;
        // SAFETY: the promise of `NodePass::step`.
        unsafe {
            if *probe {
                line_in::<N, true>(step)
            } else if step.line().plain && !step.c.has_gravity && !step.c.has_damping {
                plain_line::<N>(step)
            } else {
                line_in::<N, false>(step)
            }
        }
    }
}

impl<'a, T: Real> LineStep<'a, T> {
    /// The line, without a look at bounds.
    ///
    /// # Safety
    /// The line is one of these nodes'.
    #[inline(always)]
    unsafe fn line(&self) -> &'a Line {
        // SAFETY: the caller's promise.
        unsafe { self.nodes.lines.get_unchecked(self.line) }
    }
}

/// A line of nodes that nothing but the internal force and the road acts on: one step. What most lines are, and short
/// enough to stay in registers.
///
/// # Safety
/// A line of the early or the late phase of [`Shared`]'s contract.
#[inline(always)]
unsafe fn plain_line<N: Lanes>(step: &LineStep<N::Real>) {
    let LineStep { nodes, c, line: number, shared } = *step;
    // SAFETY: the caller's promise.
    let line = unsafe { step.line() };
    let lanes = LaneConditions::<N>::new(c);
    let road = c.road.as_ref().filter(|_| line.surface.is_some());
    let (places, inverse_mass) = (&shared.places(), nodes.inverse_mass.slice().as_ptr());
    let (forces, start) = (SlotsOf::new(line), line.start);
    let mut internal = N::zero();
    let mut contact = LineContact::default();
    for (b, batch) in line.batches.iter().enumerate() {
        let (offset, at) = (b * N::WIDTH, start + b * N::WIDTH);
        // SAFETY: nodes and slots of a line are whoever's who steps it, and arrays by place have whole vectors.
        unsafe {
            let f_int = forces.internal_force::<N>(places, offset);
            let x = load3::<N>(&places.x, at);
            let v = load3::<N>(&places.v, at);
            let w = N::load(inverse_mass, at);
            let v_star = lanes.prediction.velocity(w, f_int, v);
            let mut moved = Moved { x: axpy(v_star, lanes.dt, x), v: v_star };
            if let (true, Some(road)) = (batch.surface != 0, road) {
                let sums = shared.sums(number);
                moved = touch::<N, false>(step, road, (at, batch), x, v, moved, sums, &mut contact);
            }
            internal -= dot(f_int, axpy(moved.v, lanes.weights[1], scale(v, lanes.weights[0])));
            store3(moved.x, &places.x, at);
            store3(moved.v, &places.v, at);
        }
    }
    // SAFETY: as above, and so are its sums.
    unsafe {
        end_of_line(line, shared);
        if let Some(k) = line.surface {
            *shared.contact(c.number, k) = contact;
        }
        internal.add_to(shared.sums(number).internal.as_mut_ptr());
    }
}

/// Behind the last node of a closed line stands its first.
///
/// # Safety
/// As [`plain_line`].
#[inline(always)]
unsafe fn end_of_line<T: Real>(line: &Line, shared: &Shared<T>) {
    if !line.closed {
        return;
    }
    let end = line.start + line.nodes.len();
    for d in 0..3 {
        // SAFETY: the caller's promise; a line is a vector longer than its nodes.
        unsafe {
            *shared.x[d].add(end) = *shared.x[d].add(line.start);
            *shared.v[d].add(end) = *shared.v[d].add(line.start);
        }
    }
}

/// A line of nodes: one step, or (`PROBE`) only what it would do.
///
/// # Safety
/// As [`plain_line`].
#[inline(always)]
unsafe fn line_in<N: Lanes, const PROBE: bool>(step: &LineStep<N::Real>) {
    let LineStep { nodes, c, line: number, shared } = *step;
    // SAFETY: the caller's promise.
    let line = unsafe { step.line() };
    let lanes = LaneConditions::<N>::new(c);
    let (places, forces, start) = (&shared.places(), SlotsOf::new(line), line.start);
    let masses = (nodes.mass.slice().as_ptr(), nodes.inverse_mass.slice().as_ptr());
    let mut sums = LaneSums::zero();
    let mut contact = LineContact::default();
    for (b, batch) in line.batches.iter().enumerate() {
        let (offset, at) = (b * N::WIDTH, start + b * N::WIDTH);
        // SAFETY: nodes and slots of a line are whoever's who steps it, and arrays by place have whole vectors.
        unsafe {
            let whole = forces.internal_force::<N>(places, offset);
            let mut f_int = moving::<N>(batch.held, whole);
            let x = load3::<N>(&places.x, at);
            let v = load3::<N>(&places.v, at);
            let (mass, w) = (N::load(masses.0, at), N::load(masses.1, at));
            // Whatever holds a component takes gravity along it too.
            let v_star = moving::<N>(batch.held, lanes.prediction.velocity(w, f_int, v));
            let mut moved = Moved { x: axpy(v_star, lanes.dt, x), v: v_star };
            if let (true, Some(road)) = (batch.surface != 0, &c.road) {
                let sums = shared.sums(number);
                moved = touch::<N, PROBE>(step, road, (at, batch), x, v, moved, sums, &mut contact);
            }
            if batch.rim != 0 {
                let carried = carried::<N>(nodes, c, batch.boundary as usize);
                moved.x = choose3(carried.x, moved.x, batch.rim);
                moved.v = choose3(carried.v, moved.v, batch.rim);
            }
            if batch.driven != 0 {
                let number = batch.driven as usize - 1;
                (f_int, moved) = driven::<N>(nodes, c, number, whole, f_int, moved);
                let parts = nodes.driven.batches.get_unchecked(number);
                book_driven::<N>(&mut sums, c, &lanes, parts, mass, whole, v, &moved);
                if !PROBE {
                    add_reactions::<N>(shared.reactions(number), parts, whole, c);
                }
            }
            if PROBE && batch.held != [0; 3] {
                // What holds a node pushes back, as a road does: it belongs to the scale of forces.
                let held = dot(whole, whole) - dot(f_int, f_int);
                sums.internal_force2 += N::zero().choose(held, batch.rim);
            }
            book::<N, PROBE>(&mut sums, c, &lanes, batch.rim, mass, f_int, x, v, &moved);
            if !PROBE {
                store3(moved.x, &places.x, at);
                store3(moved.v, &places.v, at);
            }
        }
    }
    // SAFETY: as above, and so are its sums.
    unsafe {
        if !PROBE {
            end_of_line(line, shared);
        }
        if let (Some(k), false) = (line.surface, PROBE) {
            *shared.contact(c.number, k) = contact;
        }
        fold::<N, PROBE>(shared.sums(number), &sums, c, line.has_rim || line.driven);
    }
}

/// Where a line finds its internal forces.
#[derive(Clone, Copy)]
struct SlotsOf<'a> {
    slots: &'a [usize],
    /// Whether they are added to lane by lane.
    loose: bool,
}

impl<'a> SlotsOf<'a> {
    #[inline(always)]
    fn new(line: &'a Line) -> Self {
        SlotsOf { slots: &line.slots, loose: line.loose }
    }

    /// Internal force of a batch: its slots, first to last. Slots that are added to lane by lane are cleared.
    ///
    /// # Safety
    /// A line of the early or the late phase of [`Shared`]'s contract; `offset`: one of its batches.
    #[inline(always)]
    unsafe fn internal_force<N: Lanes>(self, places: &Places<N::Real>, offset: usize) -> Vec3<N> {
        let mut f = [N::zero(); 3];
        for (k, &slot) in self.slots.iter().enumerate() {
            // SAFETY: its slots are whoever's who steps it.
            unsafe {
                let part = load3::<N>(&places.f, slot + offset);
                f = if k == 0 { part } else { add(f, part) };
                if self.loose {
                    store3([N::zero(); 3], &places.f, slot + offset);
                }
            }
        }
        f
    }
}

/// A force or a velocity without its held components: whatever holds them takes the force; `held`: lanes by component.
#[inline(always)]
fn moving<N: Lanes>(held: [u32; 3], f: Vec3<N>) -> Vec3<N> {
    if held == [0; 3] {
        return f;
    }
    let zero = N::zero();
    [zero.choose(f[0], held[0]), zero.choose(f[1], held[1]), zero.choose(f[2], held[2])]
}

/// # Safety
/// A vector at `at` can be read in all three arrays.
#[inline(always)]
unsafe fn load3<N: Lanes>(field: &[*mut N::Real; 3], at: usize) -> Vec3<N> {
    // SAFETY: the caller's promise.
    unsafe { [N::load(field[0], at), N::load(field[1], at), N::load(field[2], at)] }
}

/// # Safety
/// A vector at `at` can be written in all three arrays.
#[inline(always)]
unsafe fn store3<N: Lanes>(v: Vec3<N>, field: &[*mut N::Real; 3], at: usize) {
    // SAFETY: the caller's promise.
    unsafe {
        v[0].store(field[0], at);
        v[1].store(field[1], at);
        v[2].store(field[2], at);
    }
}

/// Prescribed components go where their set takes them, with the internal force on them; other components as they are.
///
/// # Safety
/// `number` is a batch with driven nodes, and the poses of the step are there.
#[inline(always)]
unsafe fn driven<N: Lanes>(
    nodes: &Nodes<N::Real>,
    c: &Conditions<N::Real>,
    number: usize,
    whole: Vec3<N>,
    mut f_int: Vec3<N>,
    mut moved: Moved<N>,
) -> (Vec3<N>, Moved<N>) {
    let driven = &nodes.driven;
    let arms = |d| driven.arms.component(d).as_ptr();
    let at = number * WIDEST;
    // SAFETY: the caller's promise; the widest lanes have room at every batch.
    let arm = unsafe { [N::load(arms(0), at), N::load(arms(1), at), N::load(arms(2), at)] };
    // SAFETY: the caller's promise.
    for part in unsafe { driven.batches.get_unchecked(number) } {
        // SAFETY: the caller's promise.
        let pose = unsafe { driven.poses.get_unchecked(c.driven + part.set as usize) };
        let r = [splat3::<N>(pose.rotation[0]), splat3(pose.rotation[1]), splat3(pose.rotation[2])];
        let rate = [splat3::<N>(pose.rate[0]), splat3(pose.rate[1]), splat3(pose.rate[2])];
        let x = add(splat3(pose.at), combined(&r, arm[0], arm[1], arm[2]));
        let v = add(splat3(pose.velocity), combined(&rate, arm[0], arm[1], arm[2]));
        let masks = part.lanes;
        moved.x = [
            x[0].choose(moved.x[0], masks[0]),
            x[1].choose(moved.x[1], masks[1]),
            x[2].choose(moved.x[2], masks[2]),
        ];
        moved.v = [
            v[0].choose(moved.v[0], masks[0]),
            v[1].choose(moved.v[1], masks[1]),
            v[2].choose(moved.v[2], masks[2]),
        ];
        f_int = [
            whole[0].choose(f_int[0], masks[0]),
            whole[1].choose(f_int[1], masks[1]),
            whole[2].choose(f_int[2], masks[2]),
        ];
    }
    (f_int, moved)
}

/// Rim nodes go where the rim puts them; `boundary`: of their batch.
///
/// # Safety
/// There is a vector of arms at `boundary`.
#[inline(always)]
unsafe fn carried<N: Lanes>(nodes: &Nodes<N::Real>, c: &Conditions<N::Real>, boundary: usize) -> Moved<N> {
    let arms = |d| nodes.rim_arms.component(d).as_ptr();
    // SAFETY: the caller's promise.
    let arm = unsafe { [N::load(arms(0), boundary), N::load(arms(1), boundary), N::load(arms(2), boundary)] };
    let r = [splat3::<N>(c.rotation[0]), splat3(c.rotation[1]), splat3(c.rotation[2])];
    let rate = [splat3::<N>(c.rotation_rate[0]), splat3(c.rotation_rate[1]), splat3(c.rotation_rate[2])];
    Moved {
        x: add(splat3(c.axle), combined(&r, arm[0], arm[1], arm[2])),
        v: add(splat3(c.axle_velocity), combined(&rate, arm[0], arm[1], arm[2])),
    }
}
