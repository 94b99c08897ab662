//! What the points of elements remember: an array of all batches, lane by lane.
//!
//! A batch has a vector for each of the six numbers of each term of each point, in this order from the slowest: point, term, number;
//! and behind them one of what its elements have lost so far \[J\].

use super::elements::ElementStep;
use super::shared::Shared;
use crate::physics::lanes::Lanes;
use crate::physics::material::{Fading, Memory};
use crate::physics::tensor::Sym3;

/// Numbers of a symmetric matrix.
const SYMMETRIC: usize = 6;

/// Vectors of a batch with so many points and terms; none without points.
pub fn vectors(points: usize, terms: usize) -> usize {
    if points == 0 { 0 } else { SYMMETRIC * points * terms + 1 }
}

/// Memory of the elements in a batch's lanes.
pub struct LaneMemory<'a, N: Lanes> {
    numbers: *mut N::Real,
    points: usize,
    step: &'a ElementStep<'a>,
}

impl<'a, N: Lanes> LaneMemory<'a, N> {
    /// Of batch number `batch` of all.
    ///
    /// # Safety
    /// The caller is in the early phase of [`Shared`]'s contract, for the item of the batch, and the memory has
    /// [`vectors`] of so many points and the step's terms for every batch, or is never asked for.
    #[inline(always)]
    pub unsafe fn new(
        shared: &Shared<N::Real>,
        batch: usize,
        points: usize,
        step: &'a ElementStep<'a>,
    ) -> Self {
        let at = batch * vectors(points, step.terms.len()) * N::WIDTH;
        LaneMemory { numbers: shared.memory().wrapping_add(at), points, step }
    }

    #[inline(always)]
    fn at(&self, point: usize, term: usize) -> usize {
        SYMMETRIC * (point * self.step.terms.len() + term) * N::WIDTH
    }

    /// Adds to what the elements have lost [J].
    #[inline(always)]
    pub fn add_loss(&mut self, loss: N) {
        let at = SYMMETRIC * self.points * self.step.terms.len() * N::WIDTH;
        // SAFETY: the promise of `LaneMemory::new`.
        unsafe { (N::load(self.numbers, at) + loss).store(self.numbers, at) };
    }
}

impl<N: Lanes> Memory<N> for LaneMemory<'_, N> {
    #[inline(always)]
    fn terms(&self) -> &[Fading] {
        self.step.terms
    }

    #[inline(always)]
    fn before(&self) -> f64 {
        self.step.before
    }

    #[inline(always)]
    fn keeps(&self) -> bool {
        self.step.keeps
    }

    #[inline(always)]
    fn relaxed(&self, point: usize, term: usize) -> Sym3<N> {
        let at = self.at(point, term);
        // SAFETY: the promise of `LaneMemory::new`.
        let number = |i: usize| unsafe { N::load(self.numbers, at + i * N::WIDTH) };
        Sym3 { xx: number(0), yy: number(1), zz: number(2), xy: number(3), xz: number(4), yz: number(5) }
    }

    #[inline(always)]
    fn keep(&mut self, point: usize, term: usize, relaxed: Sym3<N>) {
        let at = self.at(point, term);
        let Sym3 { xx, yy, zz, xy, xz, yz } = relaxed;
        // SAFETY: the promise of `LaneMemory::new`.
        unsafe {
            xx.store(self.numbers, at);
            yy.store(self.numbers, at + N::WIDTH);
            zz.store(self.numbers, at + 2 * N::WIDTH);
            xy.store(self.numbers, at + 3 * N::WIDTH);
            xz.store(self.numbers, at + 4 * N::WIDTH);
            yz.store(self.numbers, at + 5 * N::WIDTH);
        }
    }
}
