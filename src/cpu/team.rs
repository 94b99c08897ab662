//! Threads that meet twice a step: too short a meeting for a work-stealing pool to pay.

use std::sync::atomic::{AtomicUsize, Ordering};

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
