//! Where driven sets are at the ends of steps, and what they have taken.

use super::program::Program;
use crate::engine::Step;
use crate::kernels::DrivenPose;
use crate::model::mesh::Driven;
use crate::physics::lanes::WIDEST;
use crate::physics::scalar::Real;
use crate::physics::tensor::vec3;

/// Poses of all sets step by step, in a frame with this origin [m].
pub fn poses<T: Real>(sets: &[Driven], steps: &[Step], frame: [f64; 3]) -> Vec<DrivenPose<T>> {
    let mut poses = Vec::with_capacity(sets.len() * steps.len());
    for step in steps {
        for set in sets {
            let (start, end) = (set.motion.pose(step.time), set.motion.pose(step.time + step.dt));
            let rate = |from: f64, to: f64| (to - from) / step.dt;
            let rates = |from: [f64; 3], to: [f64; 3]| vec3([0, 1, 2].map(|d| rate(from[d], to[d])));
            poses.push(DrivenPose {
                at: vec3([0, 1, 2].map(|d| end.at[d] - frame[d])),
                rotation: end.rotation.map(vec3),
                velocity: rates(start.at, end.at),
                rate: [0, 1, 2].map(|c| rates(start.rotation[c], end.rotation[c])),
            });
        }
    }
    poses
}

/// Impulses that the sets have had from their nodes, from those by batch, component and lane [N s].
pub fn reactions<T: Real>(
    program: &Program<T>,
    sets: usize,
    batches: &[[[f64; WIDEST]; 3]],
) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; sets];
    for (parts, of_batch) in program.nodes.driven.batches.iter().zip(batches) {
        for part in parts {
            for d in 0..3 {
                let lanes = (0..WIDEST).filter(|lane| part.lanes[d] >> lane & 1 == 1);
                sums[part.set as usize][d] += lanes.map(|lane| of_batch[d][lane]).sum::<f64>();
            }
        }
    }
    sums
}
