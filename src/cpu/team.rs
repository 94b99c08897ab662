//! Threads that meet twice a step: too short a meeting for a work-stealing pool to pay.

use std::cell::UnsafeCell;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A slice that several threads write, each its own elements.
pub struct Shared<'a, T>(&'a [UnsafeCell<T>]);

// SAFETY: access goes through `get_mut` and `get`, whose callers keep writers and readers of an element apart.
unsafe impl<T: Send + Sync> Sync for Shared<'_, T> {}

impl<'a, T> Shared<'a, T> {
    pub fn new(slice: &'a mut [T]) -> Self {
        // SAFETY: UnsafeCell<T> has the layout of T, and the exclusive borrow lasts for 'a.
        Shared(unsafe { &*(slice as *mut [T] as *const [UnsafeCell<T>]) })
    }

    /// # Safety
    /// Between two barriers, no other thread may touch element `i`.
    #[allow(clippy::mut_from_ref)] // the point of the type
    #[inline(always)]
    pub unsafe fn get_mut(&self, i: usize) -> &mut T {
        unsafe { &mut *self.0[i].get() }
    }

    /// # Safety
    /// Between two barriers, no thread may write element `i`.
    #[inline(always)]
    pub unsafe fn get(&self, i: usize) -> &T {
        unsafe { &*self.0[i].get() }
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }
}

/// A barrier that spins, then yields: a step of a small mesh is tens of microseconds.
pub struct SpinBarrier {
    members: usize,
    arrived: AtomicUsize,
    generation: AtomicUsize,
}

impl SpinBarrier {
    pub fn new(members: usize) -> Self {
        SpinBarrier { members, arrived: AtomicUsize::new(0), generation: AtomicUsize::new(0) }
    }

    /// Returns when every member has arrived; writes before it are visible after it.
    pub fn wait(&self) {
        if self.members == 1 {
            return;
        }
        let generation = self.generation.load(Ordering::Acquire);
        if self.arrived.fetch_add(1, Ordering::AcqRel) + 1 == self.members {
            self.arrived.store(0, Ordering::Relaxed);
            self.generation.store(generation.wrapping_add(1), Ordering::Release);
            return;
        }
        let mut spins = 0u32;
        while self.generation.load(Ordering::Acquire) == generation {
            spins += 1;
            // On a machine with fewer free cores than members the others need this one.
            if spins > 4_000 { std::thread::yield_now() } else { std::hint::spin_loop() }
        }
    }
}

/// The part of 0..count that a member works on, cut at multiples of `chunk`.
pub fn share(count: usize, chunk: usize, member: usize, members: usize) -> Range<usize> {
    let chunks = count.div_ceil(chunk);
    let cut = |m: usize| (chunks * m / members * chunk).min(count);
    cut(member)..cut(member + 1)
}
