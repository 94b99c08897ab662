//! Levels of instructions: proofs that the machine has them, and the one place that calls work compiled for them.

use super::Lanes;
use crate::scalar::Real;

/// Work that is done in lanes of `T`, whatever their number.
pub trait InLanes<T: Real> {
    type Output;
    /// Must be `#[inline(always)]`, with all it calls: it is inlined into a function that has the instructions of `N`.
    fn run<N: Lanes<Real = T>>(self) -> Self::Output;
}

/// A number's lanes at every level.
pub trait Vectors: Sized {
    /// In lanes that every machine has.
    fn portable<W: InLanes<Self>>(work: W) -> W::Output
    where
        Self: Real;
    /// # Safety
    /// The machine has AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    unsafe fn avx2<W: InLanes<Self>>(work: W) -> W::Output
    where
        Self: Real;
    /// # Safety
    /// The machine has AVX-512F and FMA.
    #[cfg(target_arch = "x86_64")]
    unsafe fn avx512<W: InLanes<Self>>(work: W) -> W::Output
    where
        Self: Real;
}

/// Proof that the machine has certain instructions.
pub trait Instructions: Copy + Send + Sync + 'static {
    /// Does the work in the widest lanes that these instructions have.
    fn call<T: Real, W: InLanes<T>>(self, work: W) -> W::Output;

    /// Lanes of `T`, for elements and nodes alike.
    fn width<T: Real>(self) -> usize {
        self.call::<T, _>(Width)
    }
}

struct Width;

impl<T: Real> InLanes<T> for Width {
    type Output = usize;
    #[inline(always)]
    fn run<N: Lanes<Real = T>>(self) -> usize {
        N::WIDTH
    }
}

/// What every machine has.
#[derive(Debug, Clone, Copy)]
pub struct Portable(());

impl Instructions for Portable {
    #[inline(always)]
    fn call<T: Real, W: InLanes<T>>(self, work: W) -> W::Output {
        T::portable(work)
    }
}

/// AVX2 and FMA; from [`Level::avx2`] alone.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub struct Avx2(());

#[cfg(target_arch = "x86_64")]
impl Instructions for Avx2 {
    #[inline(always)]
    fn call<T: Real, W: InLanes<T>>(self, work: W) -> W::Output {
        // SAFETY: a value of this type exists only where the instructions were found.
        unsafe { T::avx2(work) }
    }
}

/// AVX-512F and FMA; from [`Level::avx512`] alone.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub struct Avx512(());

#[cfg(target_arch = "x86_64")]
impl Instructions for Avx512 {
    #[inline(always)]
    fn call<T: Real, W: InLanes<T>>(self, work: W) -> W::Output {
        // SAFETY: a value of this type exists only where the instructions were found.
        unsafe { T::avx512(work) }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
enum Set {
    Portable,
    Avx2,
    Avx512,
}

/// Instructions that this machine has.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(transparent)]
pub struct Level(Set);

impl std::fmt::Debug for Level {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl Level {
    /// What every machine has.
    pub const PORTABLE: Level = Level(Set::Portable);

    /// The best this machine has.
    pub fn detect() -> Level {
        #[cfg(target_arch = "x86_64")]
        {
            if std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("fma") {
                return Level(Set::Avx512);
            }
            if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
                return Level(Set::Avx2);
            }
        }
        Level::PORTABLE
    }

    /// Every level of this machine, the least first.
    pub fn available() -> impl Iterator<Item = Level> {
        let best = Level::detect();
        [Set::Portable, Set::Avx2, Set::Avx512].into_iter().map(Level).filter(move |level| *level <= best)
    }

    /// The level of this name, if the machine has it.
    pub fn named(name: &str) -> Option<Level> {
        Level::available().find(|level| level.name() == name)
    }

    /// As in arguments and reports.
    pub fn name(self) -> &'static str {
        match self.0 {
            Set::Portable => "portable",
            Set::Avx2 => "avx2",
            Set::Avx512 => "avx512",
        }
    }

    /// What every machine has.
    pub fn portable(self) -> Portable {
        Portable(())
    }

    /// AVX2, where this level is it.
    #[cfg(target_arch = "x86_64")]
    pub fn avx2(self) -> Option<Avx2> {
        (self.0 == Set::Avx2).then_some(Avx2(()))
    }

    /// AVX-512, where this level is it.
    #[cfg(target_arch = "x86_64")]
    pub fn avx512(self) -> Option<Avx512> {
        (self.0 == Set::Avx512).then_some(Avx512(()))
    }
}

impl Instructions for Level {
    #[inline(always)]
    fn call<T: Real, W: InLanes<T>>(self, work: W) -> W::Output {
        match self.0 {
            // SAFETY: a level exists only where its instructions were found.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { T::avx512(work) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { T::avx2(work) },
            _ => T::portable(work),
        }
    }
}

/// Lane types of a number, by level.
macro_rules! vectors {
    ($real:ty, $portable:ty, $avx2:ident, $avx512:ident) => {
        impl Vectors for $real {
            #[inline(always)]
            fn portable<W: InLanes<Self>>(work: W) -> W::Output {
                work.run::<$portable>()
            }
            #[cfg(target_arch = "x86_64")]
            #[inline(always)]
            unsafe fn avx2<W: InLanes<Self>>(work: W) -> W::Output {
                #[target_feature(enable = "avx2,fma")]
                fn inside<W: InLanes<$real>>(work: W) -> W::Output {
                    work.run::<super::x86::$avx2>()
                }
                // SAFETY: the caller's promise.
                unsafe { inside(work) }
            }
            #[cfg(target_arch = "x86_64")]
            #[inline(always)]
            unsafe fn avx512<W: InLanes<Self>>(work: W) -> W::Output {
                #[target_feature(enable = "avx512f,fma")]
                fn inside<W: InLanes<$real>>(work: W) -> W::Output {
                    work.run::<super::x86::$avx512>()
                }
                // SAFETY: the caller's promise.
                unsafe { inside(work) }
            }
        }
    };
}
#[cfg(target_arch = "x86_64")]
vectors!(f64, super::x86::F64x2, F64x4, F64x8);
#[cfg(target_arch = "x86_64")]
vectors!(f32, super::x86::F32x4, F32x8, F32x16);
#[cfg(not(target_arch = "x86_64"))]
vectors!(f64, super::Array<f64, 2>, F64x4, F64x8);
#[cfg(not(target_arch = "x86_64"))]
vectors!(f32, super::Array<f32, 4>, F32x8, F32x16);
