//! Sums of lines over all lines, in fixed order.

use crate::engine::{StepContact, Works};
use crate::kernels::{LineContact, LineSums};
use crate::physics::lanes::WIDEST;

/// Sums over all nodes.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodeSums {
    /// `internal` holds the work of the whole internal force, the viscous part included.
    pub works: Works,
    pub rim_impulse: [f64; 3],
    pub rim_moment_impulse: [f64; 3],
    pub mixed_kinetic: f64,
    pub net_force2: f64,
    pub internal_force2: f64,
}

/// Adds the lines up, first to last, lane by lane.
pub fn total(lines: &[LineSums]) -> NodeSums {
    let mut sum = NodeSums::default();
    let across = |lanes: &[f64; WIDEST]| lanes.iter().sum::<f64>();
    for line in lines {
        sum.works.internal += across(&line.internal);
        sum.works.body_force += across(&line.body_force);
        sum.works.damping += across(&line.damping);
        sum.works.rim += across(&line.rim);
        sum.works.normal += line.normal;
        sum.works.friction += line.friction;
        for d in 0..3 {
            sum.rim_impulse[d] += across(&line.rim_impulse[d]);
            sum.rim_moment_impulse[d] += across(&line.rim_moment_impulse[d]);
        }
        sum.mixed_kinetic += across(&line.mixed_kinetic);
        sum.net_force2 += across(&line.net_force2);
        sum.internal_force2 += across(&line.internal_force2);
    }
    sum
}

/// A step's contact from its lines, first to last; `before`: nodes that touched in the step before.
pub fn contact_of(lines: &[LineContact], dtm: f64, before: &mut u32) -> StepContact {
    let mut sum = StepContact { dtm, ..StepContact::default() };
    let (mut entered, mut switched) = (0, 0);
    for line in lines {
        for d in 0..3 {
            sum.force[d] += line.force[d];
        }
        sum.touching += line.touching;
        entered += line.entered;
        switched += line.switched;
    }
    // Those of the step before that are not among the touching have left.
    let left = before.saturating_sub(sum.touching - entered);
    sum.changes = entered + switched + left;
    *before = sum.touching;
    sum
}
