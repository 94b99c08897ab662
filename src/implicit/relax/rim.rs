//! The free rim components in the relaxation.

use crate::implicit::matrix::BlockMatrix;
use crate::implicit::problem::{Increment, Iterate, Problem, Residual};
use crate::physics::rim::SPIN;
use crate::physics::tensor::Vec3;

/// The free rim components as one more block.
pub struct RimBlock {
    /// dx/dq of the rim nodes, component by component.
    pub directions: Vec<Vec<Vec3<f64>>>,
    /// Diagonal of the block [N/m, N m].
    pub diagonal: Vec<f64>,
    /// Changes so far.
    pub dq: Vec<f64>,
}

impl RimBlock {
    pub fn new(
        problem: &Problem<'_>,
        inc: &Increment,
        at: &Iterate,
        residual: &Residual,
        k: &BlockMatrix,
    ) -> Self {
        let free = &inc.rim.free;
        let directions: Vec<_> = free.iter().map(|&c| problem.rim.direction(&at.q, c)).collect();
        let diagonal = free
            .iter()
            .zip(&directions)
            .map(|(&c, direction)| {
                let mut field = vec![[0.0; 3]; at.x.len()];
                problem.rim.nodes.iter().zip(direction).for_each(|(&n, d)| field[n as usize] = *d);
                let stiff: f64 = problem
                    .rim
                    .nodes
                    .iter()
                    .zip(direction)
                    .map(|(&n, d)| {
                        let f = k.row_times(n as usize, &field);
                        d[0] * f[0] + d[1] * f[1] + d[2] * f[2]
                    })
                    .sum();
                let turned = if c == SPIN { problem.rim.spin_stiffness(&at.q, &residual.r) } else { 0.0 };
                stiff + turned + inc.rim.inertia[c]
            })
            .collect();
        RimBlock { dq: vec![0.0; free.len()], directions, diagonal }
    }
}
