//! Contact of the few nodes of a batch that would end inside the road.

use super::books::Moved;
use super::conditions::Conditions;
use super::layout::{NodeBatch, Nodes};
use super::shared::Shared;
use super::sums::{LineContact, LineSums};
use crate::physics::contact::{self, Touch};
use crate::physics::lanes::{Lanes, WIDEST};
use crate::physics::node;
use crate::physics::road::Road;
use crate::physics::scalar::{Real, Scalar};
use crate::physics::tensor::{Vec3, add, axpy, dot, scale};

/// The step of a line.
#[derive(Clone, Copy)]
pub struct LineStep<'a, T> {
    pub nodes: &'a Nodes<T>,
    pub c: &'a Conditions<T>,
    /// Number of the line.
    pub line: usize,
    pub shared: &'a Shared<'a, T>,
}

/// Old and new positions and velocities of a batch, number by number, where the compiler keeps vectors on whole cache lines.
#[repr(align(64))]
struct Unpacked<T> {
    x: [[T; WIDEST]; 3],
    v: [[T; WIDEST]; 3],
    new_x: [[T; WIDEST]; 3],
    new_v: [[T; WIDEST]; 3],
}

/// Puts the nodes of a batch that would end inside the road back on it: lanes look at its bound, and those that are below it
/// at the road itself, one by one.
///
/// # Safety
/// A line of the early or the late phase of [`super::shared::Shared`]'s contract; `at`: the place of one of its batches.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // a batch in full
pub unsafe fn touch<N: Lanes, const PROBE: bool>(
    step: &LineStep<N::Real>,
    road: &Road,
    (at, batch): (usize, &NodeBatch),
    x: Vec3<N>,
    v: Vec3<N>,
    free: Moved<N>,
    sums: &mut LineSums,
    contact: &mut LineContact,
) -> Moved<N> {
    let inside = road.bound(free.x).negative() & batch.surface;
    if inside == 0 {
        return free;
    }
    let zeros = [[<N::Real as Scalar>::zero(); WIDEST]; 3];
    let places = (at, batch.boundary as usize);
    let mut batch = Unpacked { x: zeros, v: zeros, new_x: zeros, new_v: zeros };
    for d in 0..3 {
        // SAFETY: there is room for the widest lanes.
        unsafe {
            x[d].store(batch.x[d].as_mut_ptr(), 0);
            v[d].store(batch.v[d].as_mut_ptr(), 0);
            free.x[d].store(batch.new_x[d].as_mut_ptr(), 0);
            free.v[d].store(batch.new_v[d].as_mut_ptr(), 0);
        }
    }
    // SAFETY: the caller's promise.
    unsafe { touch_each::<N::Real, PROBE>(step, road, places, inside, &mut batch, sums, contact) };
    // SAFETY: as above.
    let load = |field: &[[N::Real; WIDEST]; 3], d: usize| unsafe { N::load(field[d].as_ptr(), 0) };
    Moved {
        x: [load(&batch.new_x, 0), load(&batch.new_x, 1), load(&batch.new_x, 2)],
        v: [load(&batch.new_v, 0), load(&batch.new_v, 1), load(&batch.new_v, 2)],
    }
}

/// The nodes of the lanes `inside`, one by one: few are. A function of its own, so that what friction laws need is not kept
/// ready for every line.
///
/// # Safety
/// As [`touch`].
#[inline(never)]
#[allow(clippy::too_many_arguments)] // a batch in full
unsafe fn touch_each<T: Real, const PROBE: bool>(
    step: &LineStep<T>,
    road: &Road,
    (at, boundary): (usize, usize),
    mut inside: u32,
    batch: &mut Unpacked<T>,
    sums: &mut LineSums,
    contact: &mut LineContact,
) {
    let LineStep { nodes, c, .. } = *step;
    let lane_of = |field: &[[T; WIDEST]; 3], lane: usize| [field[0][lane], field[1][lane], field[2][lane]];
    while inside != 0 {
        let lane = inside.trailing_zeros() as usize;
        inside &= inside - 1;
        let before = lane_of(&batch.v, lane);
        let k = nodes.surface_of[boundary + lane] as usize;
        let inertia = node::inertia(&c.loads, c.step, nodes.mass.slice()[at + lane]);
        let area = || nodes.inverse_area.get(k).copied().unwrap_or(T::zero());
        let (x, v_star) = (lane_of(&batch.x, lane), lane_of(&batch.new_v, lane));
        let node = contact::Node { inertia, x, v: before, v_star };
        let Some(t) = contact::project(road, c.friction.as_ref(), area, c.step, &node) else { continue };
        for d in 0..3 {
            batch.new_x[d][lane] = t.x[d];
            batch.new_v[d][lane] = t.v[d];
        }
        // SAFETY: the caller's promise; `k` is a node of the line.
        unsafe { book_touch::<T, PROBE>(step, road, k, &t, before, sums, contact) };
    }
}

/// Works of a touching node and, where the step is taken, its window sums; `k`: its number among the surface nodes.
///
/// # Safety
/// As [`touch`].
#[inline(always)]
unsafe fn book_touch<T: Real, const PROBE: bool>(
    step: &LineStep<T>,
    road: &Road,
    k: usize,
    t: &Touch<T>,
    before: Vec3<T>,
    sums: &mut LineSums,
    contact: &mut LineContact,
) {
    let c = step.c;
    let way = axpy(t.v, c.weights[1], scale(before, c.weights[0]));
    let friction_work = dot(t.tangential_force, way).to_f64();
    sums.normal += dot(t.normal_force, way).to_f64();
    sums.friction += friction_work;
    if PROBE {
        return;
    }
    // SAFETY: the entries of a line's surface nodes are whoever's who steps it.
    let (sum, last) = unsafe { step.shared.surface(k) };
    for d in 0..3 {
        let force = (t.normal_force[d] + t.tangential_force[d]).to_f64();
        sum.impulse[d] += force * c.step.dtm.to_f64();
        contact.force[d] += force;
    }
    if c.road_moves {
        let (force, surface) = (add(t.normal_force, t.tangential_force), road.velocity_over(t.x, c.step.dt));
        sum.road_work += (dot(force, surface) * c.step.dtm).to_f64();
    }
    let stays = *last == c.number && c.number > 0;
    contact.touching += 1;
    contact.entered += u32::from(!stays);
    contact.switched += u32::from(stays && sum.sticks != t.sticks);
    sum.friction_work += friction_work;
    sum.touching += 1;
    sum.sticking += u32::from(t.sticks);
    sum.sticks = t.sticks;
    *last = c.number + 1;
}
