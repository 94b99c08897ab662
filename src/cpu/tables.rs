//! A model's numbers as the passes read them: tables by place, line and lane.

use super::plan::Plan;
use crate::kernels::{Aligned, Driven, Field};
use crate::model::Model;
use crate::physics::lanes::WIDEST;
use crate::physics::scalar::Real;
use std::ops::Range;

/// Number of a node that cannot touch.
pub const NO_SURFACE: u32 = u32::MAX;

/// Lumped masses [kg] and their inverses, by place.
pub fn masses<T: Real>(model: &Model, plan: &Plan) -> [Aligned<T>; 2] {
    let mut masses = [Aligned::zeros(plan.places), Aligned::zeros(plan.places)];
    for (&place, &m) in plan.place.iter().zip(&model.mass) {
        for (table, value) in masses.iter_mut().zip([m, 1.0 / m]) {
            table.slice_mut()[place as usize] = T::from_f64(value);
        }
    }
    masses
}

/// Tables of the lanes of batches with rim or surface nodes: number among the `surface` nodes, and position relative to the
/// axle [m] of a rim node, zero for others.
pub fn boundary<T: Real>(model: &Model, plan: &Plan, surface: &[u32], width: usize) -> (Vec<u32>, Field<T>) {
    let mut lane_of = vec![0; model.node_count()];
    for line in &plan.lines {
        for (batch, nodes) in line.batches.iter().zip(line.nodes.chunks(width)) {
            nodes.iter().zip(batch.boundary..).for_each(|(&n, at)| lane_of[n as usize] = at as usize);
        }
    }
    let mut surface_of = vec![NO_SURFACE; plan.boundary];
    for (k, &n) in surface.iter().enumerate() {
        surface_of[lane_of[n as usize]] = k as u32;
    }
    let mut rim_arms = Field::zeros(plan.boundary);
    for &n in &model.mesh.rim {
        rim_arms.set(lane_of[n as usize], sub64(model.mesh.nodes[n as usize], model.mesh.axle));
    }
    (surface_of, rim_arms)
}

/// Batches with driven nodes, with where their nodes are from the point that their set turns about; no poses yet. A node that belongs to
/// several sets has one arm: sets that turn have all components of their nodes to themselves, and others share the point.
pub fn driven<T: Real>(model: &Model, plan: &Plan, width: usize) -> Driven<T> {
    let mut arms = Field::zeros(plan.driven.len() * WIDEST);
    for line in &plan.lines {
        for (batch, nodes) in line.batches.iter().zip(line.nodes.chunks(width)).filter(|(b, _)| b.driven != 0)
        {
            let number = batch.driven as usize - 1;
            for part in &plan.driven[number] {
                let set = &model.mesh.driven[part.set as usize];
                let lanes = part.lanes.iter().fold(0, |all, lanes| all | lanes);
                for (lane, &n) in nodes.iter().enumerate().filter(|(lane, _)| lanes >> lane & 1 == 1) {
                    arms.set(number * WIDEST + lane, set.arm(model.mesh.nodes[n as usize]));
                }
            }
        }
    }
    Driven { batches: plan.driven.clone(), arms, poses: Vec::new() }
}

/// Reference geometry by lanes: these numbers of every class, one after the other.
pub fn shape_table<T: Real>(model: &Model, plan: &Plan, width: usize, numbers: Range<usize>) -> Aligned<T> {
    let length = numbers.len();
    let mut table = Aligned::zeros(plan.shapes.len() * length * width);
    for (lanes, part) in plan.shapes.iter().zip(table.slice_mut().chunks_exact_mut(length * width)) {
        for (lane, class) in lanes[..width].iter().enumerate() {
            let of_class = &model.classes[*class as usize].numbers()[numbers.clone()];
            for (i, number) in of_class.iter().enumerate() {
                part[i * width + lane] = T::from_f64(*number);
            }
        }
    }
    table
}

pub fn sub64(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}
