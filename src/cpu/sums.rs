//! What steps add up besides moving nodes: by line, and over all lines in fixed order.

use crate::engine::{StepContact, Works};
use crate::physics::lanes::WIDEST;

/// Sums of a line over the steps of a window, in double precision; arrays have one sum a lane.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct LineSums {
    /// Work of the whole internal force, the viscous part included.
    pub internal: [f64; WIDEST],
    pub body_force: [f64; WIDEST],
    pub damping: [f64; WIDEST],
    pub rim: [f64; WIDEST],
    /// Internal force on rim nodes and its moment about the axle, times the mean step.
    pub rim_impulse: [[f64; WIDEST]; 3],
    pub rim_moment_impulse: [[f64; WIDEST]; 3],
    pub mixed_kinetic: [f64; WIDEST],
    pub net_force2: [f64; WIDEST],
    pub internal_force2: [f64; WIDEST],
    pub normal: f64,
    pub friction: f64,
}

impl Default for LineSums {
    fn default() -> Self {
        let none = [0.0; WIDEST];
        LineSums {
            internal: none,
            body_force: none,
            damping: none,
            rim: none,
            rim_impulse: [none; 3],
            rim_moment_impulse: [none; 3],
            mixed_kinetic: none,
            net_force2: none,
            internal_force2: none,
            normal: 0.0,
            friction: 0.0,
        }
    }
}

/// Contact of a line in one step.
#[derive(Debug, Clone, Copy, Default)]
pub struct LineContact {
    pub force: [f64; 3],
    pub touching: u32,
    /// Of those: nodes that were free the step before, and nodes that changed between stick and slip.
    pub entered: u32,
    pub switched: u32,
}

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
