//! Sums in fixed order.

use super::nodes::NodeSums;

/// Adds the chunks up, first to last.
pub fn total(chunks: &[NodeSums]) -> NodeSums {
    let mut sum = NodeSums::default();
    for c in chunks {
        sum.works.accumulate(&c.works);
        for i in 0..3 {
            sum.rim_impulse[i] += c.rim_impulse[i];
            sum.rim_moment_impulse[i] += c.rim_moment_impulse[i];
        }
        sum.mixed_kinetic += c.mixed_kinetic;
        sum.net_force2 += c.net_force2;
        sum.internal_force2 += c.internal_force2;
    }
    sum
}
