//! Corners of a batch of elements: from the lines of a row, or by way of a copy where they do not lie side by side.
//!
//! All of it is inlined into the pass of a kernel ([`super::elements`]).

use super::layout::{Item, Loose};
use super::rows::{Batch, Row, Rows};
use super::shared::Places;
use crate::physics::element::Corners;
use crate::physics::element::hex8::{BACK, FRONT};
use crate::physics::lanes::{Lanes, WIDEST};
use crate::physics::scalar::Real;
use std::cell::UnsafeCell;

/// Vectors of a field, component by component: vector c holds corner c of every lane.
pub type Vectors<T> = [[T; 8 * WIDEST]; 3];

/// Corners of a batch copied together, with nothing in common. On cache lines: what is stored is loaded again at once.
#[repr(align(64))]
pub struct Copied<T> {
    pub x: Vectors<T>,
    pub v: Vectors<T>,
    pub f: Vectors<T>,
}

const NOTHING: [[f64; 8 * WIDEST]; 3] = [[0.0; 8 * WIDEST]; 3];

thread_local! {
    /// What a thread copies to. On the stack it would lie between the values of the force routine, which cost one build
    /// half of its speed. Nothing is dropped at its end: a pass that held something to drop would have a way out at every call.
    static COPY: UnsafeCell<Copied<f64>> =
        const { UnsafeCell::new(Copied { x: NOTHING, v: NOTHING, f: NOTHING }) };
}

/// This thread's copy, for numbers that need no more memory than f64. It lives as long as the thread.
#[inline(always)]
pub fn copy_of_thread<T: Real>() -> *mut Copied<T> {
    // Large enough and aligned, and any bits are numbers (`Real` is plain data).
    const { assert!(size_of::<Copied<T>>() <= size_of::<Copied<f64>>() && align_of::<T>() <= align_of::<f64>()) };
    COPY.with(UnsafeCell::get).cast()
}

impl<T: Real> Copied<T> {
    /// Corners of loose elements; with their velocities, if asked.
    ///
    /// # Safety
    /// An item of the early phase of [`Shared`](super::shared::Shared)'s contract.
    #[inline(always)]
    pub unsafe fn read(&mut self, loose: &Loose, places: &Places<T>, width: usize, velocities: bool) {
        for (c, nodes) in loose.nodes.iter().enumerate() {
            for (lane, &n) in nodes[..width].iter().enumerate() {
                for d in 0..3 {
                    // SAFETY: the nodes of an item do not move before it has been read.
                    unsafe {
                        self.x[d][c * width + lane] = *places.x[d].add(n as usize);
                        if velocities {
                            self.v[d][c * width + lane] = *places.v[d].add(n as usize);
                        }
                    }
                }
            }
        }
    }
}

/// Positions and velocities of the corners of a batch.
pub struct Fetched<N> {
    pub x: Corners<N>,
    /// Zero unless asked for.
    pub v: Corners<N>,
}

/// Corners of batch `b` of an item. A branch chooses addresses, never between vectors: in branches all of them would be kept
/// at once, twice as many as there are registers.
///
/// # Safety
/// An item of the early phase of [`Shared`](super::shared::Shared)'s contract, which `copy` holds if it is loose; one of its batches.
#[inline(always)]
pub unsafe fn corners<N: Lanes>(
    item: &Item,
    b: usize,
    places: &Places<N::Real>,
    copy: &mut Copied<N::Real>,
    velocities: bool,
) -> Fetched<N> {
    let starts = |field: &Vectors<N::Real>| [field[0].as_ptr(), field[1].as_ptr(), field[2].as_ptr()];
    let read =
        |field: &[*mut N::Real; 3]| [field[0].cast_const(), field[1].cast_const(), field[2].cast_const()];
    let (at, x, v) = match item {
        // SAFETY: a batch of these rows, whose nodes do not move before they have been read.
        Item::Rows(rows) => unsafe {
            let batch = rows.batches.get_unchecked(b);
            if batch.next() > 0 {
                copy_across::<N>(rows, batch, &places.x, &mut copy.x);
                if velocities {
                    copy_across::<N>(rows, batch, &places.v, &mut copy.v);
                }
                (CornersAt::copied(N::WIDTH), starts(&copy.x), starts(&copy.v))
            } else {
                let at = CornersAt::on_row(rows.row_of(batch), batch);
                (at, read(&places.x), read(&places.v))
            }
        },
        Item::Loose(_) => (CornersAt::copied(N::WIDTH), starts(&copy.x), starts(&copy.v)),
    };
    // SAFETY: places of a batch on its lines, or in the copy.
    unsafe {
        let v = if velocities { at.load::<N>(&v) } else { [[N::zero(); 3]; 8] };
        Fetched { x: at.load::<N>(&x), v }
    }
}

/// Where the corners of a batch lie: a vector a corner and direction, `at[corner]` numbers from the start of the
/// direction's array.
#[derive(Clone, Copy)]
struct CornersAt {
    at: [usize; 8],
}

impl CornersAt {
    /// On the lines of a row.
    #[inline(always)]
    fn on_row(row: &Row, batch: &Batch) -> CornersAt {
        let mut at = [0; 8];
        for k in 0..4 {
            at[BACK[k]] = row.x[k] + batch.at();
            at[FRONT[k]] = row.x[k] + batch.at() + 1;
        }
        CornersAt { at }
    }

    /// In a copy.
    #[inline(always)]
    fn copied(width: usize) -> CornersAt {
        let mut at = [0; 8];
        for c in 0..8 {
            at[c] = c * width;
        }
        CornersAt { at }
    }

    /// # Safety
    /// Vectors at these places can be read in the arrays of all three directions.
    #[inline(always)]
    unsafe fn load<N: Lanes>(&self, field: &[*const N::Real; 3]) -> Corners<N> {
        let mut x = [[N::zero(); 3]; 8];
        for c in 0..8 {
            for d in 0..3 {
                // SAFETY: the caller's promise.
                x[c][d] = unsafe { N::load(field[d], self.at[c]) };
            }
        }
        x
    }
}

/// Copies the corners of a batch that goes on into the next row: vectors of the lines of its row and, in the lanes behind its last
/// element, of the next row's. Few batches do.
///
/// # Safety
/// A batch of these rows with lanes on the next one, in an item of the early phase of [`Shared`](super::shared::Shared)'s contract.
#[inline(always)]
unsafe fn copy_across<N: Lanes>(
    rows: &Rows,
    batch: &Batch,
    field: &[*mut N::Real; 3],
    copy: &mut Vectors<N::Real>,
) {
    // SAFETY: the lines of both rows can be read, and a copy has room for a vector a corner.
    unsafe {
        let (row, next) = (rows.row_of(batch), rows.row_after(batch));
        let mask = batch.next_lanes();
        for (field, copy) in field.iter().zip(copy) {
            for k in 0..4 {
                let from = field.wrapping_add(next.x[k]).wrapping_sub(batch.lanes());
                let back = N::load(*field, row.x[k] + batch.at()).load_over(from, mask);
                let front = N::load(*field, row.x[k] + batch.at() + 1).load_over(from.wrapping_add(1), mask);
                back.store(copy.as_mut_ptr(), BACK[k] * N::WIDTH);
                front.store(copy.as_mut_ptr(), FRONT[k] * N::WIDTH);
            }
        }
    }
}
