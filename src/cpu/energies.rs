//! Stored energies, once a sample: in double precision whatever the engine's, four or eight elements at a time where
//! the machine can.

use super::layout::Item;
use super::plan::Plan;
use crate::engine::EnergyTotals;
use crate::model::Model;
use crate::physics::element::{Class, Compose, Composition, Corners, Energy, Formulation, SameShape};
use crate::physics::lanes::{InLanes, Instructions, Lanes, Level, WIDEST};
use crate::physics::material::{Hyperelastic, Viscosity};
use crate::physics::scalar::Real;
use std::marker::PhantomData;
use std::sync::Arc;

/// The elements, and their geometry by shape class.
pub struct Stored {
    pub composition: Composition,
    pub level: Level,
    pub classes: Arc<[Class<f64>]>,
    /// Classes by lane of the table of shapes, whose batches have so many lanes.
    pub shapes: Vec<[u32; WIDEST]>,
    pub width: usize,
}

impl Stored {
    /// The elements of a model, of which `plan` has batches of `width`.
    pub fn new(model: &Model, plan: &Plan, level: Level, width: usize) -> Self {
        Stored {
            composition: model.composition(),
            level,
            classes: model.classes.clone(),
            shapes: plan.shapes.clone(),
            width,
        }
    }

    /// Energies of the elements of `items` at the positions `x`, by place, one component after the other.
    pub fn totals<T: Real>(&self, items: &[Item], x: [&[T]; 3]) -> EnergyTotals {
        // Energies know nothing of viscosity.
        Composition { viscosity: None, ..self.composition }.visit(Totals { stored: self, items, x })
    }
}

struct Totals<'a, T> {
    stored: &'a Stored,
    items: &'a [Item],
    x: [&'a [T]; 3],
}

impl<T: Real> Compose for Totals<'_, T> {
    type Output = EnergyTotals;

    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, _viscosity: V) -> EnergyTotals {
        self.sum::<F, L>(law)
    }
}

impl<T: Real> Totals<'_, T> {
    fn sum<F: Formulation, L: Hyperelastic>(&self, law: L) -> EnergyTotals {
        let Stored { classes, shapes, width, level, .. } = self.stored;
        let lanes = level.width::<f64>();
        let mut totals = EnergyTotals::default();
        let mut corners = Gathered([[[0.0; MOST]; 3]; 8]);
        for item in self.items {
            let places = item.corners();
            let class_of = |k: usize| shapes[item.shapes()[k / width] as usize][k % width];
            let mut at = 0;
            while at < places.len() {
                let class = class_of(at);
                let count = (at..places.len()).take(lanes).take_while(|k| class_of(*k) == class).count();
                for lane in 0..lanes {
                    let hex = &places[at + lane.min(count - 1)];
                    for (corner, &n) in corners.0.iter_mut().zip(hex) {
                        for d in 0..3 {
                            corner[d][lane] = self.x[d][n as usize].to_f64();
                        }
                    }
                }
                let kind = PhantomData::<F>;
                let energy = level.call(OfBatch { law, class: &classes[class as usize], x: &corners, kind });
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

/// Most elements at a time.
const MOST: usize = 8;

/// Corners of a few elements of one class, lane by lane.
struct Gathered([[[f64; MOST]; 3]; 8]);

/// Their energies.
struct Batch {
    strain: [f64; MOST],
    hourglass: [f64; MOST],
    min_j: [f64; MOST],
}

struct OfBatch<'a, F, L> {
    law: L,
    class: &'a Class<f64>,
    x: &'a Gathered,
    kind: PhantomData<F>,
}

impl<F: Formulation, L: Hyperelastic> InLanes<f64> for OfBatch<'_, F, L> {
    type Output = Batch;

    #[inline(always)]
    fn run<N: Lanes<Real = f64>>(self) -> Batch {
        const { assert!(N::WIDTH <= MOST) };
        let mut corners: Corners<N> = [[N::zero(); 3]; 8];
        for c in 0..8 {
            for d in 0..3 {
                // SAFETY: there is room for the widest lanes.
                corners[c][d] = unsafe { N::load(self.x.0[c][d].as_ptr(), 0) };
            }
        }
        let Energy { strain, hourglass, min_j } = F::energy(&self.law, &SameShape(self.class), &corners);
        let mut batch = Batch { strain: [0.0; MOST], hourglass: [0.0; MOST], min_j: [0.0; MOST] };
        // SAFETY: as above.
        unsafe {
            strain.store(batch.strain.as_mut_ptr(), 0);
            hourglass.store(batch.hourglass.as_mut_ptr(), 0);
            min_j.store(batch.min_j.as_mut_ptr(), 0);
        }
        batch
    }
}
