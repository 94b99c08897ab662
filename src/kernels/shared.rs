//! What the threads of a step write, and the contract under which they do.

use super::state::{Aligned, Field};
use super::sums::{LineContact, LineSums, SurfaceSum};
use crate::physics::lanes::WIDEST;
use crate::physics::scalar::Real;
use std::marker::PhantomData;

/// What a body's steps write.
pub struct Arrays<T> {
    /// Positions relative to the frame and velocities, by place.
    pub x: Field<T>,
    pub v: Field<T>,
    /// Forces, by slot.
    pub f: Field<T>,
    /// Viscous work, taken by the stresses, and loss so far of the window [J], by item and lane.
    pub viscous: Vec<f64>,
    pub loss: Vec<f64>,
    /// What the points remember ([`super::memory`]).
    pub memory: Aligned<T>,
    /// Sums of the window so far, by line.
    pub sums: Vec<LineSums>,
    /// Sums of the window so far, and the last step in which a node touched plus one (0: never), by surface node.
    pub surface: Vec<SurfaceSum>,
    pub last_touch: Vec<u64>,
    /// Impulses of what drives nodes so far of the window [N s], by batch with driven nodes, component and lane.
    pub reactions: Vec<[[f64; WIDEST]; 3]>,
    /// Contact by line that can touch, of even and of odd steps: one is summed up while the other is written.
    pub contact: [Vec<LineContact>; 2],
}

/// Lengths of [`Arrays`], as a layout asks for them.
#[derive(Debug, Clone, Copy)]
pub struct Sizes {
    /// Numbers by place, and of all slots.
    pub places: usize,
    pub forces: usize,
    pub items: usize,
    /// Numbers that all points remember.
    pub memory: usize,
    pub lines: usize,
    /// Lines that can touch the road, and their nodes that can.
    pub surface_lines: usize,
    pub surface_nodes: usize,
    /// Batches with driven nodes.
    pub driven: usize,
}

impl<T: Real> Arrays<T> {
    /// Zeros.
    pub fn new(sizes: &Sizes) -> Self {
        Arrays {
            x: Field::zeros(sizes.places),
            v: Field::zeros(sizes.places),
            f: Field::zeros(sizes.forces),
            viscous: vec![0.0; sizes.items * WIDEST],
            loss: vec![0.0; sizes.items * WIDEST],
            memory: Aligned::zeros(sizes.memory),
            sums: vec![LineSums::default(); sizes.lines],
            surface: vec![SurfaceSum::default(); sizes.surface_nodes],
            last_touch: vec![0; sizes.surface_nodes],
            reactions: vec![[[0.0; WIDEST]; 3]; sizes.driven],
            contact: [0, 1].map(|_| vec![LineContact::default(); sizes.surface_lines]),
        }
    }

    /// The arrays as threads share them, nobody else meanwhile.
    pub fn shared(&mut self) -> Shared<'_, T> {
        Shared {
            x: self.x.pointers(),
            v: self.v.pointers(),
            f: self.f.pointers(),
            viscous: self.viscous.as_mut_ptr(),
            loss: self.loss.as_mut_ptr(),
            memory: self.memory.pointer(),
            sums: self.sums.as_mut_ptr(),
            surface: self.surface.as_mut_ptr(),
            last_touch: self.last_touch.as_mut_ptr(),
            reactions: self.reactions.as_mut_ptr(),
            contact: self.contact.each_mut().map(|c| c.as_mut_ptr()),
            surface_lines: self.contact[0].len(),
            arrays: PhantomData,
        }
    }
}

/// [`Arrays`] while a team of threads works on them: pointers without a lock.
///
/// # The contract
///
/// Who dereferences them is a member of one team that all goes through the same phases, with a meeting
/// (a barrier) between one phase and the next, and touches nothing but this:
///
/// | phase | a member, for | reads | writes |
/// |---|---|---|---|
/// | early | an item of its share, once | `x`, `v` of the item's lines | slots of the item's group, the item's `viscous`, `loss` and `memory` |
/// | early | a line of its share, after the item before it in the share | the line's slots | the line's `x`, `v`, `sums`, `contact` of this step, `reactions` of its batches, entries of its surface nodes; its slots, to clear them |
/// | between | any line that moves late | its slots, its `x` | |
/// | late | a late line of its share | as an early line | as an early line |
/// | after | all lines (the first member alone) | `contact` of the step before | |
///
/// The phase after a step is the early one of the next step, which writes the other half of `contact`.
///
/// The layout makes that enough. A group belongs to one member, and no two items' sums and memory are the same, so forces of
/// different members never meet. An early line is touched by items of its own member alone, and by none of them after
/// it has moved, so nobody reads nodes that move. A slot passes from one line to another within one member's share, once
/// the first line has moved; late lines keep theirs. Every line moves once, in one share. Places, slots and indices
/// lie within the arrays, lanes beyond a line's end included, because [`Arrays::new`] takes their lengths from the same layout.
/// Tests: `cpu/plan/slots.rs` follows every number through a step; `tests/determinism.rs` compares the bits of threads.
pub struct Shared<'a, T> {
    pub x: [*mut T; 3],
    pub v: [*mut T; 3],
    pub f: [*mut T; 3],
    viscous: *mut f64,
    loss: *mut f64,
    memory: *mut T,
    sums: *mut LineSums,
    surface: *mut SurfaceSum,
    last_touch: *mut u64,
    reactions: *mut [[f64; WIDEST]; 3],
    contact: [*mut LineContact; 2],
    surface_lines: usize,
    arrays: PhantomData<&'a mut Arrays<T>>,
}

/// Where positions, velocities and forces lie, by direction. A pass keeps a copy of its own: what it reads of memory that others
/// see, a compiler reads again after every number that is stored.
#[derive(Clone, Copy)]
pub struct Places<T> {
    pub x: [*mut T; 3],
    pub v: [*mut T; 3],
    pub f: [*mut T; 3],
}

// SAFETY: what it points to may be reached from several threads under the contract above, which whoever dereferences a
// pointer promises.
unsafe impl<T: Send> Send for Shared<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Send> Sync for Shared<'_, T> {}

impl<T: Real> Shared<'_, T> {
    #[inline(always)]
    pub fn places(&self) -> Places<T> {
        Places { x: self.x, v: self.v, f: self.f }
    }

    /// Sums of viscous work of an item, one a lane; and of its loss.
    #[inline(always)]
    pub fn viscous(&self, item: usize) -> *mut f64 {
        self.viscous.wrapping_add(item * WIDEST)
    }

    #[inline(always)]
    pub fn loss(&self, item: usize) -> *mut f64 {
        self.loss.wrapping_add(item * WIDEST)
    }

    /// Memory of all batches.
    #[inline(always)]
    pub fn memory(&self) -> *mut T {
        self.memory
    }

    /// Sums of a line.
    ///
    /// # Safety
    /// The caller steps the line.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // the contract keeps them apart
    pub unsafe fn sums(&self, line: usize) -> &mut LineSums {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.sums.add(line) }
    }

    /// Sums of a surface node, and its last step in contact.
    ///
    /// # Safety
    /// The caller steps the node's line.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // the contract keeps them apart
    pub unsafe fn surface(&self, k: usize) -> (&mut SurfaceSum, &mut u64) {
        // SAFETY: the caller's promise.
        unsafe { (&mut *self.surface.add(k), &mut *self.last_touch.add(k)) }
    }

    /// Impulses of what drives the nodes of a batch.
    ///
    /// # Safety
    /// The caller steps the batch's line.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // the contract keeps them apart
    pub unsafe fn reactions(&self, batch: usize) -> &mut [[f64; WIDEST]; 3] {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.reactions.add(batch) }
    }

    /// Contact in step number `step` of line `k` of those that can touch.
    ///
    /// # Safety
    /// The caller steps the line.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // the contract keeps them apart
    pub unsafe fn contact(&self, step: u64, k: usize) -> &mut LineContact {
        // SAFETY: the caller's promise.
        unsafe { &mut *self.contact[(step % 2) as usize].add(k) }
    }

    /// Contact of a step by line.
    ///
    /// # Safety
    /// The caller is the first member, in the phase after the step.
    pub unsafe fn contacts(&self, step: u64) -> &[LineContact] {
        // SAFETY: nobody writes this half until the next meeting.
        unsafe { std::slice::from_raw_parts(self.contact[(step % 2) as usize], self.surface_lines) }
    }
}
