//! What the processor can do at most, measured beside the engine it bounds: copies, multiply-adds in registers, and
//! meetings of threads.

use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::floor::Limits;
use hexroll::Precision;
use hexroll::physics::lanes::{InLanes, Instructions, Lanes, Level};
use hexroll::physics::scalar::Real;

/// Copy bandwidth over arrays of one size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Copy {
    /// Source and target of all threads together [bytes].
    pub bytes: usize,
    /// Arrays up to this size [bytes] are held by the same cache; none: memory.
    pub holds_to: Option<usize>,
    /// Bytes read plus bytes written [1/s].
    pub bytes_per_s: f64,
}

/// Limits of a number of threads in one precision with one set of instructions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CpuLimits {
    pub precision: Precision,
    pub lanes: String,
    pub threads: usize,
    /// In the cache of one core, in the last cache, and in memory (four times the last cache).
    pub copy: Vec<Copy>,
    /// Multiply-adds in registers, two operations each [1/s].
    pub flops_per_s: f64,
    /// Meeting of the threads; 0 for one thread [s].
    pub barrier_s: f64,
}

impl CpuLimits {
    /// Measures them: about a second.
    pub fn measure(precision: Precision, level: Level, threads: usize) -> CpuLimits {
        let (own, last) = caches();
        let sizes = [
            (threads * own / 4, Some(threads * own)),
            (last / 2, Some(last.max(threads * own))),
            (4 * last, None),
        ];
        CpuLimits {
            precision,
            lanes: level.name().into(),
            threads,
            copy: sizes
                .map(|(bytes, holds_to)| {
                    let bytes_per_s = copy_rate(bytes / (2 * threads), threads);
                    Copy { bytes, holds_to, bytes_per_s }
                })
                .to_vec(),
            flops_per_s: multiply_add_rate(precision, level, threads),
            barrier_s: if threads == 1 { 0.0 } else { barrier(threads) },
        }
    }

    /// Those that hold for arrays of `bytes` in all.
    pub fn at(&self, bytes: f64) -> Limits {
        let fits = self.copy.iter().find(|c| c.holds_to.is_none_or(|most| most as f64 >= bytes));
        let bandwidth = fits.or(self.copy.last()).map_or(f64::INFINITY, |c| c.bytes_per_s);
        Limits { bandwidth, flops: self.flops_per_s, latency: self.barrier_s }
    }
}

/// Sizes of a core's own largest cache and of the largest shared one [bytes]; 1 and 32 MiB where the system does not
/// say.
fn caches() -> (usize, usize) {
    let read = |index: usize, what: &str| {
        let path = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{what}");
        std::fs::read_to_string(path).ok().map(|text| text.trim().to_string())
    };
    let size = |index: usize| -> Option<usize> {
        let kib: usize = read(index, "size")?.strip_suffix('K')?.parse().ok()?;
        (read(index, "type")? != "Instruction").then_some(kib << 10)
    };
    let mut sizes: Vec<usize> = (0..8).filter_map(size).collect();
    sizes.sort_unstable();
    match sizes[..] {
        [.., own, last] => (own, last),
        _ => (1 << 20, 32 << 20),
    }
}

/// Most of several tries of `work`, which says how much it did, each at least `LONG` [1/s].
fn most(threads: usize, work: impl Fn() -> f64 + Sync) -> f64 {
    const TRIES: usize = 5;
    const LONG: Duration = Duration::from_millis(20);
    let alone = || {
        let begun = Instant::now();
        let mut done = 0.0;
        while begun.elapsed() < LONG {
            done += work();
        }
        done / begun.elapsed().as_secs_f64()
    };
    let together = || -> f64 {
        std::thread::scope(|scope| {
            let others: Vec<_> = (1..threads).map(|_| scope.spawn(alone)).collect();
            let own = alone();
            own + others.into_iter().map(|t| t.join().expect("a measuring thread ends")).sum::<f64>()
        })
    };
    (0..TRIES).map(|_| together()).fold(0.0, f64::max)
}

thread_local! {
    static ARRAYS: std::cell::RefCell<[Vec<u8>; 2]> = const { std::cell::RefCell::new([Vec::new(), Vec::new()]) };
}

/// Bytes read and written by copies of `bytes` on every thread.
fn copy_rate(bytes: usize, threads: usize) -> f64 {
    most(threads, || {
        ARRAYS.with_borrow_mut(|[from, to]| {
            if from.len() != bytes {
                (*from, *to) = (vec![1; bytes], vec![2; bytes]);
            }
            // A small copy at a time would mostly measure the clock.
            let rounds = ((4 << 20) / bytes.max(1)).max(1);
            for _ in 0..rounds {
                to.copy_from_slice(black_box(from));
                black_box(&mut *to);
            }
            (2 * bytes * rounds) as f64
        })
    })
}

/// Rounds of multiply-adds before the clock is looked at.
const ROUNDS: usize = 20_000;
/// Independent sums: enough to cover the latency of two pipelines, few enough for 16 registers.
const CHAINS: usize = 12;

struct MultiplyAdds;

impl<T: Real> InLanes<T> for MultiplyAdds {
    type Output = f64;

    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) -> f64 {
        let (a, b) = (black_box(N::from_f64(0.999)), black_box(N::from_f64(1e-3)));
        let mut sums = [b; CHAINS];
        for _ in 0..ROUNDS {
            for sum in &mut sums {
                *sum = sum.mul_add(a, b);
            }
        }
        black_box(&sums);
        (2 * ROUNDS * CHAINS * N::WIDTH) as f64
    }
}

fn multiply_add_rate(precision: Precision, level: Level, threads: usize) -> f64 {
    most(threads, || match precision.is_single() {
        false => level.call::<f64, _>(MultiplyAdds),
        true => level.call::<f32, _>(MultiplyAdds),
    })
}

/// Time of one meeting of threads that spin on a counter.
fn barrier(threads: usize) -> f64 {
    const MEETINGS: usize = 20_000;
    let arrived = AtomicUsize::new(0);
    let meet = || {
        let begun = Instant::now();
        for n in 1..=MEETINGS {
            arrived.fetch_add(1, Ordering::AcqRel);
            let mut spins = 0u32;
            while arrived.load(Ordering::Acquire) < n * threads {
                spins += 1;
                // With fewer cores than threads the others need this one.
                if spins > 4_000 { std::thread::yield_now() } else { std::hint::spin_loop() }
            }
        }
        begun.elapsed().as_secs_f64() / MEETINGS as f64
    };
    let once = || {
        arrived.store(0, Ordering::Relaxed);
        std::thread::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(meet);
            }
            meet()
        })
    };
    (0..5).map(|_| once()).fold(f64::INFINITY, f64::min)
}
