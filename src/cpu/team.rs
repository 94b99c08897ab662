//! Threads that meet twice a step: too short a meeting for a work-stealing pool to pay.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Runs `work` on so many threads, this one the first of them; returns what it gives on this one. They meet where `work`
/// says so.
pub fn run<R>(members: usize, work: impl Fn(usize, &SpinBarrier) -> R + Sync) -> R {
    let meeting = SpinBarrier::new(members);
    std::thread::scope(|scope| {
        for member in 1..members {
            let (work, meeting) = (&work, &meeting);
            scope.spawn(move || {
                work(member, meeting);
            });
        }
        work(0, &meeting)
    })
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
