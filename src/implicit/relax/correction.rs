//! Corrections between the sweeps (Graeser & Kornhuber, 2009): a truncated non-smooth Newton multigrid method.
//!
//! A sweep leaves an active set. With it held, what is left of the contact problem is linear: touching nodes keep
//! their height, sticking ones their place, slipping ones are pulled by mu N against their slip, with N as the sweep left it
//! (Tresca's law; the next sweep takes Coulomb's again). Its solution, from a few multigrid cycles truncated at the
//! unknowns that are held, is projected back above the road and taken as far as the energy falls. The sweep decides
//! what touches, sticks and slips, and the corrections carry it through the body, so that iterations hardly depend on
//! the mesh.

use super::{Relaxation, Sweep};
use crate::implicit::contact::{Equations, Status, Surface, frame};
use crate::implicit::krylov::LinearSolver;
use crate::implicit::linearised::Failure;
use crate::implicit::matrix::{axpy, dot, times, transposed};
use crate::implicit::system::System;
use crate::physics::tensor::{self, Vec3, add, sub};

/// Sweeps between two corrections: forward and backward.
const SWEEPS: usize = 2;
/// A node that slips by so little that mu N over its slip is this many times its stiffness is held: the direction of
/// its slip is not known well enough to linearise.
const STIFF: f64 = 1e4;

/// The linear solver of the corrections, with what it was made ready for.
pub struct Corrections {
    solver: Box<dyn LinearSolver>,
    fixed: Vec<[bool; 3]>,
}

impl Corrections {
    /// A solver that need not be exact: a tenth to a hundredth of the residual is enough.
    pub fn new(solver: Box<dyn LinearSolver>) -> Corrections {
        Corrections { solver, fixed: Vec::new() }
    }

    pub fn bytes(&self) -> usize {
        self.solver.bytes()
    }

    /// The tangent has changed.
    fn forget(&mut self) {
        self.fixed.clear();
    }
}

/// mu N at a slipping node, with its slip so far and the slip that the correction adds, along two tangents.
struct Pulled {
    force: f64,
    slip: [f64; 2],
    more: [f64; 2],
}

impl Pulled {
    /// d/dt of force |slip + t more|.
    fn slope(&self, t: f64) -> f64 {
        let s = [0, 1].map(|i| self.slip[i] + t * self.more[i]);
        let length = s[0].hypot(s[1]);
        if length == 0.0 {
            return 0.0;
        }
        self.force * (s[0] * self.more[0] + s[1] * self.more[1]) / length
    }
}

impl Sweep<'_> {
    /// Sweeps with corrections until the residual is `asked` [N]; the linear iterations taken.
    pub(super) fn with_corrections(
        &mut self,
        settings: &Relaxation,
        corrections: &mut Corrections,
        asked: f64,
    ) -> Result<usize, Failure> {
        corrections.forget();
        let (mut sweeps, mut iterations) = (0, 0);
        loop {
            (0..SWEEPS).for_each(|s| self.run(s % 2 == 1));
            sweeps += SWEEPS;
            let left = self.left();
            let norm = self.norm_of(&left);
            if norm <= asked {
                return Ok(iterations);
            }
            if sweeps >= settings.sweeps || !norm.is_finite() {
                return Err(Failure::Relaxation { sweeps, residual: norm, asked });
            }
            iterations += self.correct(corrections, &left).ok_or(Failure::Singular)?;
        }
    }

    /// One correction; its linear iterations. `left` = r*.
    fn correct(&mut self, corrections: &mut Corrections, left: &[Vec3<f64>]) -> Option<usize> {
        let laws: Vec<_> = (0..self.d.len()).map(|n| self.held(n, left[n])).collect();
        let rhs = left.iter().map(|r| r.map(|c| -c)).collect();
        let rim_left: Vec<f64> = (0..self.rim.dq.len()).map(|m| self.rim_left(m)).collect();
        let rim_rhs = rim_left.iter().map(|r| -r).collect();
        let (problem, inc) = (self.problem, self.inc);
        let system = System::truncated(self.linearised, self.at, &laws, rhs, rim_rhs);
        let solver = &mut *corrections.solver;
        if system.fixed == corrections.fixed {
            solver.prepare_near(&system)?;
        } else {
            solver.prepare(&system)?;
            corrections.fixed.clone_from(&system.fixed);
        }
        let correction = system.solve_prepared(solver)?;
        let dq: Vec<f64> = inc.rim.free.iter().map(|&c| correction.q[c]).collect();
        let mut step = correction.dx;
        for (directions, dq) in self.rim.directions.iter().zip(&dq) {
            for (&n, d) in problem.rim.nodes.iter().zip(directions) {
                step[n as usize] = tensor::axpy(*d, *dq, step[n as usize]);
            }
        }
        self.project(&mut step);
        let share = self.share(&step, &dq, left, &rim_left);
        axpy(&mut self.d, share, &step);
        self.rim.dq.iter_mut().zip(&dq).for_each(|(q, dq)| *q += share * dq);
        Some(correction.iterations)
    }

    /// What holds node n while the correction is found; `left` = r* there.
    fn held(&self, n: usize, left: Vec3<f64>) -> Option<Equations> {
        let k = self.surface_index[n]? as usize;
        let surface = self.inc.surface.as_ref()?;
        let frame = frame(surface.road.normal(self.at.x[n]));
        let mut law = Equations {
            rows: frame,
            columns: transposed(&frame),
            fixed: [true; 3],
            known: [0.0; 3],
            diagonal: [[0.0; 3]; 3],
            rhs: times(&frame, left.map(|c| -c)),
        };
        match self.status[k] {
            Status::Free => return None,
            Status::Stick => {}
            Status::Slip => {
                let (force, slip) = self.slipping(surface, k);
                let length = slip[0].hypot(slip[1]);
                let d = self.matrix.diagonal(n);
                let stiffness = (d[0][0] + d[1][1] + d[2][2]) / 3.0;
                if force > STIFF * stiffness * length {
                    return Some(law);
                }
                law.fixed = [true, false, false];
                if force > 0.0 {
                    let along = slip.map(|s| s / length);
                    for i in 0..2 {
                        for j in 0..2 {
                            let across = f64::from(i == j) - along[i] * along[j];
                            law.diagonal[i + 1][j + 1] = force / length * across;
                        }
                    }
                }
            }
        }
        Some(law)
    }

    /// The friction force at surface node k as the last sweep left it [N], and the node's slip so far [m].
    fn slipping(&self, surface: &Surface, k: usize) -> (f64, [f64; 2]) {
        let n = self.problem.model.mesh.surface[k] as usize;
        let x = add(self.at.x[n], self.d[n]);
        let node = surface.local(k, self.inc.start[n], x, self.force[k], 1.0);
        (node.tangential[0].hypot(node.tangential[1]), node.slip)
    }

    /// Puts the step's ends back above the road.
    fn project(&self, step: &mut [Vec3<f64>]) {
        let Some(surface) = &self.inc.surface else { return };
        for &n in &self.problem.model.mesh.surface {
            let n = n as usize;
            let end = add(add(self.at.x[n], self.d[n]), step[n]);
            let gap = surface.road.gap(end);
            if gap < 0.0 {
                step[n] = tensor::axpy(surface.road.normal(end), -gap, step[n]);
            }
        }
    }

    /// How far to go along a step, 0..1: to the least energy, which is where its slope vanishes.
    fn share(&self, step: &[Vec3<f64>], dq: &[f64], left: &[Vec3<f64>], rim_left: &[f64]) -> f64 {
        const HALVINGS: usize = 50;
        let mut k_step = vec![[0.0; 3]; step.len()];
        self.matrix.multiply(step, &mut k_step);
        let (mut slope, mut curvature) = (dot(step, left), 0.0);
        for n in (0..step.len()).filter(|n| !self.problem.on_rim[*n]) {
            curvature += tensor::dot(step[n], k_step[n]);
        }
        for (m, dq) in dq.iter().enumerate() {
            let nodes = self.problem.rim.nodes.iter().zip(&self.rim.directions[m]);
            let pull: f64 = nodes.map(|(&n, d)| tensor::dot(*d, k_step[n as usize])).sum();
            slope += dq * rim_left[m];
            curvature += dq * (pull + self.inc.rim.inertia[self.inc.rim.free[m]] * dq);
        }
        let pulled = self.pulled(step);
        // `left` has the friction forces in it, at t = 0: they come in again along the way.
        slope += pulled.iter().map(|(now, _)| now).sum::<f64>();
        let slope_at = |t: f64| slope + t * curvature + pulled.iter().map(|(_, p)| p.slope(t)).sum::<f64>();
        if slope_at(1.0) <= 0.0 {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if slope_at(middle) > 0.0 { high = middle } else { low = middle }
        }
        low
    }

    /// Slipping nodes on the way: the work of the friction force of the last sweep along the step, and what replaces it.
    fn pulled(&self, step: &[Vec3<f64>]) -> Vec<(f64, Pulled)> {
        let Some(surface) = &self.inc.surface else { return Vec::new() };
        let slips = |k: &usize| self.status[*k] == Status::Slip;
        let one = |k: usize| {
            let n = self.problem.model.mesh.surface[k] as usize;
            let (force, slip) = self.slipping(surface, k);
            let [_, a, b] = times(&frame(surface.road.normal(self.at.x[n])), step[n]);
            let normal = surface.road.normal(self.at.x[n]);
            let along = sub(self.force[k], tensor::scale(normal, tensor::dot(self.force[k], normal)));
            (tensor::dot(along, step[n]), Pulled { force, slip, more: [a, b] })
        };
        (0..self.status.len()).filter(slips).map(one).collect()
    }
}
