//! Stored energies, once a sample: in double precision whatever the engine's, four elements at a time where the
//! machine can.

use super::family::{LawFamily, MooneyRivlinEq4Law, MooneyRivlinLaw, NeoHookeanLaw};
use super::layout::Item;
use crate::engine::EnergyTotals;
use crate::physics::element::{Class, Corners, Energy, Formulation, Full, Q1p0, SameShape, UniformGradient};
use crate::physics::lanes::{Array, Lanes, Level};
use crate::physics::material::Law;
use crate::physics::scalar::Real;
use crate::scene;

/// The elements, and their geometry by shape class.
pub struct Stored {
    pub element: scene::Element,
    pub law: scene::Law,
    pub level: Level,
    pub classes: Vec<Class<f64>>,
    pub class_of: Vec<u32>,
    /// Places of the corners.
    pub hexes: Vec<[u32; 8]>,
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
        let mut totals = EnergyTotals::default();
        let mut corners = [[[0.0; WIDTH]; 3]; 8];
        for item in items {
            let mut rest = item.elements();
            while let Some(&first) = rest.first() {
                let class = self.class_of[first as usize];
                let alike = |e: &&u32| self.class_of[**e as usize] == class;
                let count = rest.iter().take(WIDTH).take_while(alike).count();
                for lane in 0..WIDTH {
                    let hex = &self.hexes[rest[lane.min(count - 1)] as usize];
                    for (corner, &n) in corners.iter_mut().zip(hex) {
                        for d in 0..3 {
                            corner[d][lane] = x[d][n as usize].to_f64();
                        }
                    }
                }
                let energy = self.batch::<F, L>(&self.classes[class as usize], &corners);
                for lane in 0..count {
                    totals.strain += energy.strain[lane];
                    totals.hourglass += energy.hourglass[lane];
                    totals.min_jacobian = totals.min_jacobian.min(energy.min_j[lane]);
                }
                rest = &rest[count..];
            }
        }
        totals
    }

    fn batch<F: Formulation, L: LawFamily>(&self, class: &Class<f64>, x: &Gathered) -> Batch {
        #[cfg(target_arch = "x86_64")]
        if self.level >= Level::Avx2 {
            use crate::physics::lanes::F64x4;
            #[target_feature(enable = "avx2,fma")]
            fn avx2<F: Formulation, L: LawFamily>(
                law: &scene::Law,
                class: &Class<f64>,
                x: &Gathered,
            ) -> Batch {
                batch_in::<F64x4, F, L>(law, class, x)
            }
            // SAFETY: the level says that the machine has the instructions.
            return unsafe { avx2::<F, L>(&self.law, class, x) };
        }
        batch_in::<Array<f64, WIDTH>, F, L>(&self.law, class, x)
    }
}

/// Elements at a time.
const WIDTH: usize = 4;
type Gathered = [[[f64; WIDTH]; 3]; 8];

struct Batch {
    strain: [f64; WIDTH],
    hourglass: [f64; WIDTH],
    min_j: [f64; WIDTH],
}

#[inline(always)]
fn batch_in<N: Lanes<Real = f64>, F: Formulation, L: LawFamily>(
    law: &scene::Law,
    class: &Class<f64>,
    x: &Gathered,
) -> Batch {
    let law = <L::Law<N> as Law<N>>::new(law);
    let mut corners: Corners<N> = [[N::zero(); 3]; 8];
    for c in 0..8 {
        for d in 0..3 {
            // SAFETY: WIDTH is that of the lanes.
            corners[c][d] = unsafe { N::load(x[c][d].as_ptr(), 0) };
        }
    }
    let Energy { strain, hourglass, min_j } = F::energy(&law, &SameShape(class), &corners);
    let mut batch = Batch { strain: [0.0; WIDTH], hourglass: [0.0; WIDTH], min_j: [0.0; WIDTH] };
    // SAFETY: as above.
    unsafe {
        strain.store(batch.strain.as_mut_ptr(), 0);
        hourglass.store(batch.hourglass.as_mut_ptr(), 0);
        min_j.store(batch.min_j.as_mut_ptr(), 0);
    }
    batch
}
