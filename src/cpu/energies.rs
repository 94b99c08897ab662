//! Stored energies, once a sample: in double precision whatever the engine's, four or eight elements at a time where
//! the machine can.

use super::family::{LawFamily, MooneyRivlinEq4Law, MooneyRivlinLaw, NeoHookeanLaw};
use super::layout::Item;
use crate::engine::EnergyTotals;
use crate::physics::element::{Class, Corners, Energy, Formulation, Full, Q1p0, SameShape, UniformGradient};
use crate::physics::lanes::{Array, Lanes, Level, WIDEST};
#[cfg(target_arch = "x86_64")]
use crate::physics::lanes::{F64x4, F64x8};
use crate::physics::material::Law;
use crate::physics::scalar::Real;
use crate::scene;
use std::sync::Arc;

/// The elements, and their geometry by shape class.
pub struct Stored {
    pub element: scene::Element,
    pub law: scene::Law,
    pub level: Level,
    pub classes: Arc<[Class<f64>]>,
    /// Classes by lane of the table of shapes, whose batches have so many lanes.
    pub shapes: Vec<[u32; WIDEST]>,
    pub width: usize,
}

impl Stored {
    /// Energies of the elements of `items` at the positions `x`, by place, one component after the other.
    pub fn totals<T: Real>(&self, items: &[Item], x: [&[T]; 3]) -> EnergyTotals {
        match self.element {
            scene::Element::Q1p0 => self.with::<Q1p0, T>(items, x),
            scene::Element::Full => self.with::<Full, T>(items, x),
            scene::Element::UniformGradient { .. } => self.with::<UniformGradient, T>(items, x),
        }
    }

    fn with<F: Formulation, T: Real>(&self, items: &[Item], x: [&[T]; 3]) -> EnergyTotals {
        match self.law {
            scene::Law::NeoHookean { .. } => self.sum::<F, NeoHookeanLaw, T>(items, x),
            scene::Law::MooneyRivlin { .. } => self.sum::<F, MooneyRivlinLaw, T>(items, x),
            scene::Law::MooneyRivlinEq4 { .. } => self.sum::<F, MooneyRivlinEq4Law, T>(items, x),
        }
    }

    fn sum<F: Formulation, L: LawFamily, T: Real>(&self, items: &[Item], x: [&[T]; 3]) -> EnergyTotals {
        #[cfg(target_arch = "x86_64")]
        match self.level {
            Level::Avx512 => return self.sum_by::<T, WIDE>(items, x, avx512::<F, L>),
            Level::Avx2 => return self.sum_by::<T, WIDTH>(items, x, avx2::<F, L>),
            Level::Portable => {}
        }
        self.sum_by::<T, WIDTH>(items, x, batch_in::<Array<f64, WIDTH>, F, L, WIDTH>)
    }

    fn sum_by<T: Real, const W: usize>(
        &self,
        items: &[Item],
        x: [&[T]; 3],
        batch: impl Fn(&scene::Law, &Class<f64>, &Gathered<W>) -> Batch<W>,
    ) -> EnergyTotals {
        let mut totals = EnergyTotals::default();
        let mut corners = [[[0.0; W]; 3]; 8];
        for item in items {
            let places = item.corners();
            let class_of = |k: usize| self.shapes[item.shapes()[k / self.width] as usize][k % self.width];
            let mut at = 0;
            while at < places.len() {
                let class = class_of(at);
                let count = (at..places.len()).take(W).take_while(|k| class_of(*k) == class).count();
                for lane in 0..W {
                    let hex = &places[at + lane.min(count - 1)];
                    for (corner, &n) in corners.iter_mut().zip(hex) {
                        for d in 0..3 {
                            corner[d][lane] = x[d][n as usize].to_f64();
                        }
                    }
                }
                let energy = batch(&self.law, &self.classes[class as usize], &corners);
                for lane in 0..count {
                    totals.strain += energy.strain[lane];
                    totals.hourglass += energy.hourglass[lane];
                    totals.min_jacobian = totals.min_jacobian.min(energy.min_j[lane]);
                }
                at += count;
            }
        }
        totals
    }
}

/// Elements at a time.
const WIDTH: usize = 4;
#[cfg(target_arch = "x86_64")]
const WIDE: usize = 8;
type Gathered<const W: usize> = [[[f64; W]; 3]; 8];

struct Batch<const W: usize> {
    strain: [f64; W],
    hourglass: [f64; W],
    min_j: [f64; W],
}

#[cfg(target_arch = "x86_64")]
fn avx2<F: Formulation, L: LawFamily>(
    law: &scene::Law,
    class: &Class<f64>,
    x: &Gathered<WIDTH>,
) -> Batch<WIDTH> {
    #[target_feature(enable = "avx2,fma")]
    fn inner<F: Formulation, L: LawFamily>(
        law: &scene::Law,
        class: &Class<f64>,
        x: &Gathered<WIDTH>,
    ) -> Batch<WIDTH> {
        batch_in::<F64x4, F, L, WIDTH>(law, class, x)
    }
    // SAFETY: it is called at the level that says that the machine has the instructions.
    unsafe { inner::<F, L>(law, class, x) }
}

#[cfg(target_arch = "x86_64")]
fn avx512<F: Formulation, L: LawFamily>(
    law: &scene::Law,
    class: &Class<f64>,
    x: &Gathered<WIDE>,
) -> Batch<WIDE> {
    #[target_feature(enable = "avx512f,fma")]
    fn inner<F: Formulation, L: LawFamily>(
        law: &scene::Law,
        class: &Class<f64>,
        x: &Gathered<WIDE>,
    ) -> Batch<WIDE> {
        batch_in::<F64x8, F, L, WIDE>(law, class, x)
    }
    // SAFETY: it is called at the level that says that the machine has the instructions.
    unsafe { inner::<F, L>(law, class, x) }
}

#[inline(always)]
fn batch_in<N: Lanes<Real = f64>, F: Formulation, L: LawFamily, const W: usize>(
    law: &scene::Law,
    class: &Class<f64>,
    x: &Gathered<W>,
) -> Batch<W> {
    let law = <L::Law<N> as Law<N>>::new(law);
    let mut corners: Corners<N> = [[N::zero(); 3]; 8];
    for c in 0..8 {
        for d in 0..3 {
            // SAFETY: W is the width of the lanes.
            corners[c][d] = unsafe { N::load(x[c][d].as_ptr(), 0) };
        }
    }
    let Energy { strain, hourglass, min_j } = F::energy(&law, &SameShape(class), &corners);
    let mut batch = Batch { strain: [0.0; W], hourglass: [0.0; W], min_j: [0.0; W] };
    // SAFETY: as above.
    unsafe {
        strain.store(batch.strain.as_mut_ptr(), 0);
        hourglass.store(batch.hourglass.as_mut_ptr(), 0);
        min_j.store(batch.min_j.as_mut_ptr(), 0);
    }
    batch
}
