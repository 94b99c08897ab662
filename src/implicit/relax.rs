//! The paper's inner loop (eqs. 24-25, fig. 2): relaxation over node blocks, the contact condition and Coulomb's law
//! imposed at each node as the sweep passes.
//!
//! A node that penetrates is put back on the surface; one whose normal force would pull is released; one whose
//! tangential force leaves the cone returns to it and slips. Gauss-Seidel in the order of the nodes, forward and
//! backward in turn: one thread, since every node uses its neighbours' newest values.

use super::contact::{Status, Surface, frame};
use super::matrix::{Block, BlockMatrix, inverse, product, times, transposed};
use super::newton::Failure;
use super::problem::{Increment, Iterate, Problem, Residual};
use super::system::Correction;
use crate::physics::friction::{Friction, Sliding};
use crate::physics::road::Road;
use crate::physics::tensor::{Vec3, add, axpy, sub};

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
    r: &'a [Vec3<f64>],
    matrix: &'a BlockMatrix,
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

/// The free rim components as one more block.
struct RimBlock {
    directions: Vec<Vec<Vec3<f64>>>,
    /// Diagonal of the block [N/m, N m].
    diagonal: Vec<f64>,
    dq: Vec<f64>,
}

/// Relaxes K d = -r + contact forces. On success the iterate's states are those of the sweep.
pub fn relax(
    settings: &Relaxation,
    problem: &Problem<'_>,
    inc: &Increment,
    at: &mut Iterate,
    residual: &Residual,
    matrix: &BlockMatrix,
    scale: f64,
) -> Result<Correction, Failure> {
    let mut sweep = Sweep::new(settings, problem, inc, at, residual, matrix);
    // At no load the force scale is what the rim's own displacement causes.
    let asked = settings.tolerance * scale.max(sweep.residual_norm(residual));
    let mut left = f64::INFINITY;
    let mut taken = 0;
    while taken < settings.sweeps {
        for _ in 0..LOOK {
            sweep.run(residual, taken % 2 == 1);
            taken += 1;
        }
        left = sweep.residual_norm(residual);
        if left <= asked {
            break;
        }
        if !left.is_finite() {
            return Err(Failure::Relaxation { sweeps: taken, residual: left, asked });
        }
    }
    if left > asked {
        return Err(Failure::Relaxation { sweeps: taken, residual: left, asked });
    }
    let mut q = inc.rim.target;
    for (&c, dq) in inc.rim.free.iter().zip(&sweep.rim.dq) {
        q[c] = at.q[c] + dq;
    }
    let (dx, status) = (sweep.d, sweep.status);
    at.status = status;
    Ok(Correction { dx, q, iterations: taken })
}

impl<'a> Sweep<'a> {
    fn new(
        settings: &Relaxation,
        problem: &'a Problem<'a>,
        inc: &'a Increment,
        at: &'a Iterate,
        residual: &'a Residual,
        matrix: &'a BlockMatrix,
    ) -> Self {
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
            inverses: (0..count).map(|i| inverse(matrix.diagonal(i))).collect(),
            rim: RimBlock::new(problem, inc, at, residual, matrix),
            force: vec![[0.0; 3]; at.status.len()],
            status: at.status.clone(),
            r: &residual.r,
            omega: settings.omega,
            problem,
            inc,
            at,
            matrix,
            surface_index,
            d,
        }
    }

    /// One sweep over every node, then the free rim components.
    fn run(&mut self, residual: &Residual, backward: bool) {
        let count = self.d.len();
        for k in 0..count {
            let i = if backward { count - 1 - k } else { k };
            if !self.problem.on_rim[i] {
                self.node(i);
            }
        }
        self.move_rim(residual);
    }

    /// Eq. 24 for a node, then the contact law.
    fn node(&mut self, i: usize) {
        let coupled = self.matrix.row_times(i, &self.d);
        let own = times(self.matrix.diagonal(i), self.d[i]);
        // Everything but the node's own displacement: b = -r_i - sum_{j != i} K_ij d_j.
        let b: Vec3<f64> = std::array::from_fn(|a| -self.r[i][a] - coupled[a] + own[a]);
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
            x: self.at.x[i],
            start: self.inc.start[i],
        };
        let (d, force, status) = node.project(surface, relaxed);
        (self.d[i], self.force[k as usize], self.status[k as usize]) = (d, force, status);
    }

    fn move_rim(&mut self, residual: &Residual) {
        for m in 0..self.rim.dq.len() {
            let left = self.rim_left(residual, m);
            let change = -left / self.rim.diagonal[m];
            self.rim.dq[m] += change;
            for (&n, d) in self.problem.rim.nodes.iter().zip(&self.rim.directions[m]) {
                self.d[n as usize] = axpy(*d, change, self.d[n as usize]);
            }
        }
    }

    /// Residual of a free rim component after the displacements so far.
    fn rim_left(&self, residual: &Residual, m: usize) -> f64 {
        let c = self.inc.rim.free[m];
        let mut sum = residual.rim[m] + self.inc.rim.inertia[c] * self.rim.dq[m];
        for (&n, g) in self.problem.rim.nodes.iter().zip(&self.rim.directions[m]) {
            let f = self.matrix.row_times(n as usize, &self.d);
            sum += g[0] * f[0] + g[1] * f[1] + g[2] * f[2];
        }
        sum
    }

    /// ||r*||, r* = r + K d - contact forces (eq. 25) [N].
    fn residual_norm(&self, residual: &Residual) -> f64 {
        let mut kd = vec![[0.0; 3]; self.d.len()];
        self.matrix.multiply(&self.d, &mut kd);
        let mut sum = 0.0;
        for (i, kd) in kd.iter().enumerate().filter(|(i, _)| !self.problem.on_rim[*i]) {
            let mut r = add(self.r[i], *kd);
            if let Some(k) = self.surface_index[i] {
                r = sub(r, self.force[k as usize]);
            }
            sum += r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        }
        sum += (0..self.rim.dq.len()).map(|m| self.rim_left(residual, m).powi(2)).sum::<f64>();
        sum.sqrt()
    }
}

impl RimBlock {
    fn new(
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
                let turned = if c == crate::physics::rim::SPIN {
                    problem.rim.spin_stiffness(&at.q, &residual.r)
                } else {
                    0.0
                };
                stiff + turned + inc.rim.inertia[c]
            })
            .collect();
        RimBlock { dq: vec![0.0; free.len()], directions, diagonal }
    }
}

/// K d = b + f with the contact law between d and f.
struct NodeProblem<'a> {
    stiffness: &'a Block,
    inverse: &'a Block,
    b: Vec3<f64>,
    /// Position before the correction, and at the start of the increment.
    x: Vec3<f64>,
    start: Vec3<f64>,
}

impl NodeProblem<'_> {
    /// Displacement, contact force and state; `relaxed` is the displacement without contact.
    fn project(&self, surface: &Surface, relaxed: Vec3<f64>) -> (Vec3<f64>, Vec3<f64>, Status) {
        let free = (relaxed, [0.0; 3], Status::Free);
        let unloaded = times(self.inverse, self.b);
        // The relaxed displacement decides; where over-relaxation alone penetrates, the node only just touches.
        if surface.road.gap(add(self.x, relaxed)) >= 0.0 {
            return free;
        }
        let node = surface.local(self.start, self.x, [0.0; 3], 1.0);
        let to_space = transposed(&node.frame);
        let stuck = times(&to_space, [-node.gap, -node.slip[0], -node.slip[1]]);
        if surface.friction.is_some() {
            let f = sub(times(self.stiffness, stuck), self.b);
            let [n, t1, t2] = times(&node.frame, f);
            let sliding = Sliding { normal_force: n.max(0.0), slip_speed: 0.0 };
            let mu = surface.friction.map_or(0.0, |law| law.coefficient(sliding));
            if n > 0.0 && t1.hypot(t2) <= mu * n {
                return (stuck, f, Status::Stick);
            }
        }
        self.slide(surface, stuck).unwrap_or_else(|| {
            // Its normal force would pull: released, as far as over-relaxation does not penetrate.
            let d = if surface.road.gap(add(self.x, unloaded)) >= 0.0 { unloaded } else { relaxed };
            (d, [0.0; 3], Status::Free)
        })
    }

    /// On the surface with T = -mu N s/|s|: a fixed point for the direction of the slip.
    fn slide(&self, surface: &Surface, stuck: Vec3<f64>) -> Option<(Vec3<f64>, Vec3<f64>, Status)> {
        const ROUNDS: usize = 200;
        let q = frame(surface.road.normal(self.x));
        let local = product(&product(&q, self.stiffness), &transposed(&q));
        // Unknown: slip beyond the stuck position (s1, s2) and N, with the forces' balance
        // local (0, s) = b' + (N, -mu N u), b' = Q (b - K stuck).
        let b = times(&q, sub(self.b, times(self.stiffness, stuck)));
        let (a, c, d) = (local[1][1], 0.5 * (local[1][2] + local[2][1]), local[2][2]);
        let mut u = [b[1], b[2]];
        let mut s = [0.0_f64; 2];
        let mut normal = 0.0;
        for round in 0..ROUNDS {
            let l = u[0].hypot(u[1]);
            u = if l > 0.0 { u.map(|c| c / l) } else { [0.0; 2] };
            // (A + mu u k^T) s = b_t + mu u b_n, with N = k . s - b_n
            let k = [local[0][1], local[0][2]];
            let sliding =
                Sliding { normal_force: f64::max(normal, 0.0), slip_speed: s[0].hypot(s[1]) / surface.dt };
            let mu = surface.friction.map_or(0.0, |law| law.coefficient(sliding));
            let m =
                [[a + mu * u[0] * k[0], c + mu * u[0] * k[1]], [c + mu * u[1] * k[0], d + mu * u[1] * k[1]]];
            let rhs = [b[1] + mu * u[0] * b[0], b[2] + mu * u[1] * b[0]];
            let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
            let new =
                [(rhs[0] * m[1][1] - rhs[1] * m[0][1]) / det, (m[0][0] * rhs[1] - m[1][0] * rhs[0]) / det];
            let change = (new[0] - s[0]).hypot(new[1] - s[1]);
            s = new;
            normal = k[0] * s[0] + k[1] * s[1] - b[0];
            if mu == 0.0 || (round > 0 && change <= 1e-12 * s[0].hypot(s[1])) {
                break;
            }
            // Back to the cone along -T + c s: the slip's own direction would swing where the slip is small.
            u = [0, 1].map(|i| mu * normal.max(0.0) * u[i] + 0.5 * (a + d) * s[i]);
        }
        if normal.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        let d = add(stuck, times(&transposed(&q), [0.0, s[0], s[1]]));
        let f = sub(times(self.stiffness, d), self.b);
        Some((d, f, Status::Slip))
    }
}
