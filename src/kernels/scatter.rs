//! Forces of a batch of elements onto the slots of its lines: what a row's elements give their front corners is carried into
//! the next batch, so that a node gets the force of both its neighbours in the row at once.
//!
//! All of it is inlined into the pass of a kernel ([`super::elements`]).

use super::fetch::Copied;
use super::layout::{Item, Loose};
use super::rows::{Batch, Row, Rows};
use super::shared::Places;
use crate::physics::element::Corners;
use crate::physics::element::hex8::{BACK, FRONT};
use crate::physics::lanes::{Lanes, first};
use crate::physics::scalar::Real;
use crate::physics::tensor::Vec3;

/// Calls a function for every line of a row and every direction. Not a loop: where one is left standing, forces have addresses
/// and go through memory.
macro_rules! each_component {
    ($of:ident($($argument:expr),*)) => {{
        each_component!($of, 0, ($($argument),*));
        each_component!($of, 1, ($($argument),*));
        each_component!($of, 2, ($($argument),*));
        each_component!($of, 3, ($($argument),*));
    }};
    ($of:ident, $k:literal, ($($argument:expr),*)) => {{
        $of($k, 0, $($argument),*);
        $of($k, 1, $($argument),*);
        $of($k, 2, $($argument),*);
    }};
}

/// What the elements in the lanes of the batch before give their front corners, by line of the row.
pub type Carry<N> = [Vec3<N>; 4];

/// Adds the forces of batch `b` of an item: to the lines of its rows, or into `copy` if it is loose.
///
/// # Safety
/// An item of the early phase of [`Shared`](super::shared::Shared)'s contract; its batches come in order, with the `carry` of the one before.
#[inline(always)]
pub unsafe fn add_batch<N: Lanes>(
    item: &Item,
    b: usize,
    places: &Places<N::Real>,
    copy: &mut Copied<N::Real>,
    carry: &mut Carry<N>,
    f: &Corners<N>,
) {
    match item {
        // SAFETY: one of its batches; the slots of its lines are the item's.
        Item::Rows(rows) => unsafe { add_to_rows(rows, rows.batches.get_unchecked(b), places, f, carry) },
        Item::Loose(_) => {
            for c in 0..8 {
                for d in 0..3 {
                    // SAFETY: a copy has room for a vector a corner.
                    unsafe { f[c][d].store(copy.f[d].as_mut_ptr(), c * N::WIDTH) };
                }
            }
        }
    }
}

/// Adds the forces of loose elements, which `copy` holds, lane by lane.
///
/// # Safety
/// An item of the early phase of [`Shared`](super::shared::Shared)'s contract.
#[inline(always)]
pub unsafe fn add_loose<T: Real>(loose: &Loose, places: &Places<T>, copy: &Copied<T>, width: usize) {
    for (c, slots) in loose.f.iter().enumerate() {
        for (lane, &slot) in slots[..loose.elements.len()].iter().enumerate() {
            for d in 0..3 {
                // SAFETY: the slots of its lines are the item's.
                unsafe { *places.f[d].add(slot as usize) += copy.f[d][c * width + lane] };
            }
        }
    }
}

/// Adds a batch's forces to the lines of its row and of the next; `carry`: what the elements in the lanes of the batch before
/// give their front corners.
///
/// # Safety
/// A batch of these rows, in an item of the early phase of [`Shared`](super::shared::Shared)'s contract.
#[inline(always)]
unsafe fn add_to_rows<N: Lanes>(
    rows: &Rows,
    batch: &Batch,
    places: &Places<N::Real>,
    f: &Corners<N>,
    carry: &mut Carry<N>,
) {
    // SAFETY: the slots of both rows are the item's.
    unsafe {
        // Copies, for the reason that `Places` has.
        let (row, batch) = (&{ *rows.row_of(batch) }, &{ *batch });
        each_component!(add_to_row(row, places, batch, f, carry));
        if batch.at() + batch.lanes() < row.count {
            return;
        }
        each_component!(end_of_row(row, places, batch.lanes(), carry));
        if batch.next() > 0 {
            let next = &{ *rows.row_after(batch) };
            each_component!(start_of_row(next, places, batch, f));
        } else {
            *carry = [[N::zero(); 3]; 4];
        }
    }
}

/// Adds the forces of the lanes on a row to its line `k`, direction `d`.
///
/// # Safety
/// As [`add_to_rows`].
#[inline(always)]
unsafe fn add_to_row<N: Lanes>(
    k: usize,
    d: usize,
    row: &Row,
    places: &Places<N::Real>,
    batch: &Batch,
    f: &Corners<N>,
    carry: &mut Carry<N>,
) {
    let count = batch.lanes();
    let to = row.f[k] + batch.at();
    let (mut back, front) = (f[BACK[k]][d], f[FRONT[k]][d]);
    if count < N::WIDTH {
        back = back.choose(N::zero(), first(count));
    }
    let mut sum = back + front.moved_up(carry[k][d]);
    carry[k][d] = front;
    if count < N::WIDTH {
        // An open row's last node has its force of the element before it alone.
        sum = sum.choose(N::zero(), first(count + usize::from(!row.closed)));
    }
    // SAFETY: a slot is a vector longer than its line.
    unsafe {
        if row.add[k] {
            sum += N::load(places.f[d], to);
        }
        sum.store(places.f[d], to);
    }
}

/// What the last element of a row, in lane `lanes` - 1 of `carry`, gives its front corners, on line `k` in direction `d`: to the
/// first node of a closed row, else to a node more, which has its force already unless the batch is full.
///
/// # Safety
/// As [`add_to_rows`].
#[inline(always)]
unsafe fn end_of_row<N: Lanes>(
    k: usize,
    d: usize,
    row: &Row,
    places: &Places<N::Real>,
    lanes: usize,
    carry: &Carry<N>,
) {
    // SAFETY: a slot is a vector longer than its line.
    unsafe {
        if row.closed {
            let start = places.f[d].add(row.f[k]);
            *start += carry[k][d].lane(lanes - 1);
        } else if lanes == N::WIDTH {
            let mut last = N::zero().moved_up(carry[k][d]);
            if row.add[k] {
                last += N::load(places.f[d], row.f[k] + row.count);
            }
            last.store(places.f[d], row.f[k] + row.count);
        }
    }
}

/// Adds the forces of the lanes on the next row to the start of its line `k`, direction `d`, whose first node has nothing from a
/// lane before. What the line before has in those lanes is left alone.
///
/// # Safety
/// As [`add_to_rows`]; the batch has lanes on `row`.
#[inline(always)]
unsafe fn start_of_row<N: Lanes>(
    k: usize,
    d: usize,
    row: &Row,
    places: &Places<N::Real>,
    batch: &Batch,
    f: &Corners<N>,
) {
    let mask = batch.next_lanes();
    let behind = mask & !(1 << batch.lanes());
    let to = places.f[d].wrapping_add(row.f[k]).wrapping_sub(batch.lanes());
    let front = f[FRONT[k]][d].moved_up(N::zero()).choose(N::zero(), behind);
    let mut sum = f[BACK[k]][d] + front;
    // SAFETY: nothing but the lanes of the mask is touched.
    unsafe {
        if row.add[k] {
            sum += N::zero().load_over(to, mask);
        }
        sum.store_where(to, mask);
    }
}
