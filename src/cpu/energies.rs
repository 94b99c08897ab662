//! Stored energies of all elements, once a sample: in double precision whatever the engine's.

use super::plan::Plan;
use crate::engine::EnergyTotals;
use crate::kernels::Item;
use crate::kernels::energies::{EnergyPass, Gathered, MOST};
use crate::model::Model;
use crate::physics::element::Class;
use crate::physics::lanes::WIDEST;
use crate::physics::scalar::Real;
use std::sync::Arc;

/// The elements, and their geometry by shape class.
pub struct Stored {
    pass: Box<dyn EnergyPass>,
    classes: Arc<[Class<f64>]>,
    /// Classes by lane of the table of shapes, whose batches have so many lanes.
    shapes: Vec<[u32; WIDEST]>,
    width: usize,
}

impl Stored {
    /// The elements of a model, of which `plan` has batches of `width`.
    pub fn new(model: &Model, plan: &Plan, pass: Box<dyn EnergyPass>, width: usize) -> Self {
        Stored { pass, classes: model.classes.clone(), shapes: plan.shapes.clone(), width }
    }

    /// Energies of the elements of `items` at the positions `x`, by place, one component after the other.
    pub fn totals<T: Real>(&self, items: &[Item], x: [&[T]; 3]) -> EnergyTotals {
        let Stored { pass, classes, shapes, width } = self;
        let lanes = pass.lanes();
        let mut totals = EnergyTotals::default();
        let mut corners = Gathered([[[0.0; MOST]; 3]; 8]);
        for item in items {
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
                            corner[d][lane] = x[d][n as usize].to_f64();
                        }
                    }
                }
                let energy = pass.batch(&classes[class as usize], &corners);
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
