//! The paper's inner loop (eqs. 24-25, fig. 2): relaxation over node blocks, the contact condition and Coulomb's law
//! imposed at each node as the sweep passes.
//!
//! A node that penetrates is put back on the surface; one whose normal force would pull is released; one whose
//! tangential force leaves the cone returns to it and slips. Gauss-Seidel in the order of the nodes, forward and
//! backward in turn: one thread, since every node uses its neighbours' newest values.
//!
//! Alone it converges the more slowly the finer the mesh. With [`Corrections`] between the sweeps it is a truncated
//! non-smooth Newton multigrid method: `correction.rs`.

mod correction;
mod node;
mod rim;

pub use correction::Corrections;

use super::contact::Status;
use super::linearised::{Correction, Failure, Linearised};
use super::matrix::{Block, BlockMatrix, inverse, times};
use super::problem::{Increment, Iterate, Problem, Residual, without};
use crate::physics::tensor::{Vec3, add, axpy, sub};
use node::NodeProblem;
use rim::RimBlock;

/// Settings of the relaxation.
#[derive(Debug, Clone, Copy)]
pub struct Relaxation {
    /// omega: 1 is Gauss-Seidel, more is over-, less is under-relaxation.
    pub omega: f64,
    /// epsilon_GS of eq. 25, relative to the force scale.
    pub tolerance: f64,
    /// Most sweeps.
    pub sweeps: usize,
}

/// Sweeps between two looks at the residual, which costs as much as a sweep.
const LOOK: usize = 10;

/// A sweep's working state.
struct Sweep<'a> {
    problem: &'a Problem<'a>,
    inc: &'a Increment,
    at: &'a Iterate,
    residual: &'a Residual,
    matrix: &'a BlockMatrix,
    linearised: Linearised<'a>,
    inverses: Vec<Block>,
    /// Index among the surface nodes.
    surface_index: Vec<Option<u32>>,
    omega: f64,
    /// Displacements so far, contact forces of the surface nodes, and their states.
    d: Vec<Vec3<f64>>,
    force: Vec<Vec3<f64>>,
    status: Vec<Status>,
    rim: RimBlock,
}

/// Relaxes by sweeps, with corrections between them if there are any. On success the iterate's states are those of the
/// last sweep. The iterations are the sweeps, or the linear iterations of the corrections.
///
/// # Errors
/// [`Failure::Relaxation`].
pub fn relax(
    settings: &Relaxation,
    corrections: Option<&mut Corrections>,
    linearised: Linearised<'_>,
    at: &mut Iterate,
) -> Result<Correction, Failure> {
    let mut sweep = Sweep::new(settings, linearised, at);
    // At no load the force scale is what the rim's own displacement causes.
    let asked = settings.tolerance * linearised.scale.max(sweep.residual_norm());
    let iterations = match corrections {
        Some(corrections) => sweep.with_corrections(settings, corrections, asked)?,
        None => sweep.alone(settings, asked)?,
    };
    let mut q = linearised.inc.rim.target;
    for (&c, dq) in linearised.inc.rim.free.iter().zip(&sweep.rim.dq) {
        q[c] = at.q[c] + dq;
    }
    let (dx, status) = (sweep.d, sweep.status);
    at.status = status;
    Ok(Correction { dx, q, iterations })
}

impl<'a> Sweep<'a> {
    fn new(settings: &Relaxation, linearised: Linearised<'a>, at: &'a Iterate) -> Self {
        let Linearised { problem, inc, residual, matrix, .. } = linearised;
        let count = at.x.len();
        let mut surface_index = vec![None; count];
        if inc.surface.is_some() {
            for (k, &n) in problem.model.mesh.surface.iter().enumerate() {
                surface_index[n as usize] = Some(k as u32);
            }
        }
        let mut q = inc.rim.target;
        inc.rim.free.iter().for_each(|&c| q[c] = at.q[c]);
        let mut placed = at.x.clone();
        problem.rim.place(&q, &mut placed);
        let d =
            (0..count).map(|n| if problem.on_rim[n] { sub(placed[n], at.x[n]) } else { [0.0; 3] }).collect();
        Sweep {
            inverses: (0..count).map(|i| free_inverse(matrix.diagonal(i), problem, i)).collect(),
            rim: RimBlock::new(problem, inc, at, residual, matrix),
            force: vec![[0.0; 3]; at.status.len()],
            status: at.status.clone(),
            residual,
            linearised,
            omega: settings.omega,
            problem,
            inc,
            at,
            matrix,
            surface_index,
            d,
        }
    }

    /// Sweeps until the residual is `asked` [N]; how many.
    fn alone(&mut self, settings: &Relaxation, asked: f64) -> Result<usize, Failure> {
        let (mut left, mut taken) = (f64::INFINITY, 0);
        while taken < settings.sweeps {
            for _ in 0..LOOK {
                self.run(taken % 2 == 1);
                taken += 1;
            }
            left = self.residual_norm();
            if left <= asked {
                return Ok(taken);
            }
            if !left.is_finite() {
                break;
            }
        }
        Err(Failure::Relaxation { sweeps: taken, residual: left, asked })
    }

    /// One sweep over every node, then the free rim components.
    fn run(&mut self, backward: bool) {
        let count = self.d.len();
        for k in 0..count {
            let i = if backward { count - 1 - k } else { k };
            if !self.problem.on_rim[i] {
                self.node(i);
            }
        }
        self.move_rim();
    }

    /// Eq. 24 for a node, then the contact law.
    fn node(&mut self, i: usize) {
        let coupled = self.matrix.row_times(i, &self.d);
        let own = times(self.matrix.diagonal(i), self.d[i]);
        // Everything but the node's own displacement: b = -r_i - sum_{j != i} K_ij d_j.
        let b = std::array::from_fn(|a| -self.residual.r[i][a] - coupled[a] + own[a]);
        let b = without(b, self.problem.given[i]);
        let full = times(&self.inverses[i], b);
        let relaxed = axpy(sub(full, self.d[i]), self.omega, self.d[i]);
        let (Some(k), Some(surface)) = (self.surface_index[i], &self.inc.surface) else {
            self.d[i] = relaxed;
            return;
        };
        let node = NodeProblem {
            stiffness: self.matrix.diagonal(i),
            inverse: &self.inverses[i],
            b,
            surface_index: k as usize,
            x: self.at.x[i],
            start: self.inc.start[i],
        };
        let (d, force, status) = node.project(surface, relaxed);
        (self.d[i], self.force[k as usize], self.status[k as usize]) = (d, force, status);
    }

    fn move_rim(&mut self) {
        for m in 0..self.rim.dq.len() {
            let left = self.rim_left(m);
            let change = -left / self.rim.diagonal[m];
            self.rim.dq[m] += change;
            for (&n, d) in self.problem.rim.nodes.iter().zip(&self.rim.directions[m]) {
                self.d[n as usize] = axpy(*d, change, self.d[n as usize]);
            }
        }
    }

    /// Residual of a free rim component after the displacements so far.
    fn rim_left(&self, m: usize) -> f64 {
        let c = self.inc.rim.free[m];
        let mut sum = self.residual.rim[m] + self.inc.rim.inertia[c] * self.rim.dq[m];
        for (&n, g) in self.problem.rim.nodes.iter().zip(&self.rim.directions[m]) {
            let f = self.matrix.row_times(n as usize, &self.d);
            sum += g[0] * f[0] + g[1] * f[1] + g[2] * f[2];
        }
        sum
    }

    /// r* = r + K d - contact forces, shape `[node_count]`; nothing at rim nodes [N].
    fn left(&self) -> Vec<Vec3<f64>> {
        let mut left = vec![[0.0; 3]; self.d.len()];
        self.matrix.multiply(&self.d, &mut left);
        for (i, left) in left.iter_mut().enumerate() {
            *left = without(add(self.residual.r[i], *left), self.problem.given[i]);
            if let Some(k) = self.surface_index[i] {
                *left = sub(*left, self.force[k as usize]);
            }
        }
        left
    }

    /// ||r*||, the free rim components included (eq. 25) [N].
    fn residual_norm(&self) -> f64 {
        self.norm_of(&self.left())
    }

    fn norm_of(&self, left: &[Vec3<f64>]) -> f64 {
        let rim = (0..self.rim.dq.len()).map(|m| self.rim_left(m).powi(2)).sum::<f64>();
        (super::matrix::dot(left, left) + rim).sqrt()
    }
}

/// Inverse of a node's block on its free components; held ones do not move. A rim node's is not read.
fn free_inverse(block: &Block, problem: &Problem<'_>, node: usize) -> Block {
    let given = problem.given[node];
    if problem.on_rim[node] || given == [false; 3] {
        return inverse(block);
    }
    let unit = block[0][0] + block[1][1] + block[2][2];
    let entry = |i: usize, j: usize| match (given[i] || given[j], i == j) {
        (false, _) => block[i][j],
        (true, true) => unit,
        (true, false) => 0.0,
    };
    inverse(&std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
}
