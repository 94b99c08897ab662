//! Sums in fixed order.

use super::nodes::LineSums;
use crate::engine::Works;
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
