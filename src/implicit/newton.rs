//! Newton-Raphson on an increment (eqs. 19-23) with the contact set followed along: a semi-smooth Newton method, or
//! the paper's projected relaxation inside it.

use super::contact::Status;
use super::krylov::LinearSolver;
use super::linearised::{Correction, Failure, Linearised};
use super::matrix::BlockMatrix;
use super::problem::{Increment, Iterate, Problem, Residual};
use super::relax::{self, Corrections, Relaxation};
use super::system::System;

/// What solves the linearised equations with their contact conditions.
pub enum Inner {
    /// Active set: contact laws linearised into the matrix.
    ActiveSet(Box<dyn LinearSolver>),
    /// Relaxation over node blocks with the contact laws imposed node by node.
    Relaxation(Relaxation),
    /// The same with linear corrections between the sweeps.
    Corrected(Relaxation, Corrections),
}

/// When Newton's method is done, and when it gives up.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// epsilon_NR of eq. 23: residual over the largest ||f_int|| so far.
    pub tolerance: f64,
    pub iterations: usize,
}

/// Residuals of the linear equations, relative: the loosest, and the tightest that a solver is held to.
const LOOSEST: f64 = 1e-4;
const TIGHTEST: f64 = 1e-9;

/// How exactly a linear system is solved (Dembo, Eisenstat & Steihaug 1982): with a residual of r times itself Newton's
/// method still converges quadratically, and more than what ends it is of no use. `violation` is relative to the
/// force scale, as is `asked`; at the start of an increment it does not know yet what the rim is about to do.
fn forcing(first: bool, violation: f64, asked: f64) -> f64 {
    let wanted = if first { LOOSEST } else { (0.01 * violation).max(0.3 * asked / violation) };
    wanted.clamp(TIGHTEST, LOOSEST)
}

/// Iterations in a row with a changing contact set after which it is taken to swing.
const SWINGS: usize = 6;

/// An iteration in the log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iteration {
    /// Residual before the correction, relative to the force scale.
    pub residual: f64,
    /// Contact states that changed.
    pub changes: usize,
    /// Iterations or sweeps of the inner solver.
    pub inner: usize,
    /// Share of the correction that was applied.
    pub share: f64,
}

/// A converged increment.
pub struct Converged {
    pub at: Iterate,
    pub residual: Residual,
}

/// Newton's method with what it keeps between increments.
pub struct Newton {
    pub inner: Inner,
    pub limits: Limits,
    /// Largest ||f_int|| of a converged state so far [N].
    pub scale: f64,
    matrix: BlockMatrix,
    /// Iterations of the last increment that was tried.
    log: Vec<Iteration>,
}

impl Newton {
    pub fn new(problem: &Problem<'_>, inner: Inner, limits: Limits) -> Newton {
        let matrix = BlockMatrix::of_mesh(problem.model.node_count(), &problem.model.mesh.hexes);
        Newton { inner, limits, scale: 0.0, matrix, log: Vec::new() }
    }

    /// Bytes of the matrix and the inner solver.
    pub fn bytes(&self) -> usize {
        let inner = match &self.inner {
            Inner::ActiveSet(solver) => solver.bytes(),
            Inner::Relaxation(_) => 0,
            Inner::Corrected(_, corrections) => corrections.bytes(),
        };
        self.matrix.bytes() + inner
    }

    /// Iterations of the last increment that was tried, converged or not: one entry each, the last one without a
    /// correction if it converged.
    pub fn log(&self) -> &[Iteration] {
        &self.log
    }

    /// Solves an increment from `at`, the state at its start; `stop` is asked before every correction.
    pub fn solve(
        &mut self,
        problem: &Problem<'_>,
        inc: &Increment,
        at: Iterate,
        stop: &dyn Fn() -> bool,
    ) -> Result<Converged, Failure> {
        let mut log = Vec::new();
        let result = self.iterate(problem, inc, at, stop, &mut log);
        self.log = log;
        result
    }

    /// In one piece: most of what an iteration computes is looked at by the next.
    fn iterate(
        &mut self,
        problem: &Problem<'_>,
        inc: &Increment,
        mut at: Iterate,
        stop: &dyn Fn() -> bool,
        log: &mut Vec<Iteration>,
    ) -> Result<Converged, Failure> {
        let inverted = |element| Failure::Inverted { element };
        let mut residual = problem.residual(inc, &at).map_err(inverted)?;
        let mut stiffness = vec![0.0; at.status.len()];
        let mut rounding = 0.0;
        // Iterations since the contact set last changed, and in a row in which it did.
        let (mut standing, mut swinging) = (0, 0);
        for n in 0..=self.limits.iterations {
            let changes = if n == 0 { 0 } else { update(problem, inc, &mut at, &residual, &stiffness) };
            let violation = problem.violation(inc, &at, &residual, &stiffness);
            let scale = self.scale.max(residual.force_norm).max(f64::MIN_POSITIVE);
            let mut entry = Iteration { residual: violation / scale, changes, inner: 0, share: 0.0 };
            let asked = (self.limits.tolerance * scale).max(rounding);
            let whole = log.last().is_some_and(|l| l.share == 1.0);
            if whole && changes == 0 && violation <= asked {
                log.push(entry);
                self.scale = self.scale.max(residual.force_norm);
                return Ok(Converged { at, residual });
            }
            if n == self.limits.iterations {
                log.push(entry);
                break;
            }
            if stop() {
                log.push(entry);
                return Err(Failure::Interrupted);
            }
            problem.tangent(inc, &at, &residual.v, &mut self.matrix);
            for (c, &node) in stiffness.iter_mut().zip(&problem.model.mesh.surface) {
                let d = self.matrix.diagonal(node as usize);
                *c = (d[0][0] + d[1][1] + d[2][2]) / 3.0;
            }
            rounding = self.rounding(&at);
            if let Inner::ActiveSet(solver) = &mut self.inner {
                solver.aim(forcing(n == 0, violation / scale, asked / scale));
            }
            let correction = match self.correct(problem, inc, &mut at, &residual, &stiffness, scale) {
                Ok(correction) => correction,
                Err(failure) => {
                    log.push(entry);
                    return Err(failure);
                }
            };
            entry.inner = correction.iterations;
            // While the contact set changes residuals do not compare: any will do. Once it has stood for a while the
            // residual must fall, or slip directions may swing for ever.
            standing = if n == 0 || changes > 0 { 0 } else { standing + 1 };
            swinging = if changes > 0 { swinging + 1 } else { 0 };
            // Two sets that lead to each other: half a correction ends between them, where another one follows.
            let first = if swinging >= SWINGS && swinging % 2 == 0 { 0.5 } else { 1.0 };
            let most = match standing {
                0 => f64::INFINITY,
                1..=3 => (2.0 * violation).max(asked),
                _ => (0.95 * violation).max(asked),
            };
            (at, residual, entry.share) =
                damped(problem, inc, &at, &correction, [first, most], &stiffness).map_err(inverted)?;
            log.push(entry);
        }
        let last = log.last().expect("at least one iteration");
        Err(Failure::TooMany {
            iterations: self.limits.iterations,
            residual: last.residual,
            asked: self.limits.tolerance,
            changes: last.changes,
        })
    }

    /// What rounding the positions does to the residual [N]: none can be asked to be smaller.
    fn rounding(&self, at: &Iterate) -> f64 {
        let one = |(n, x): (usize, &[f64; 3])| {
            let d = self.matrix.diagonal(n);
            let force = (d[0][0] + d[1][1] + d[2][2]) * f64::EPSILON;
            force * force * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
        };
        8.0 * at.x.iter().enumerate().map(one).sum::<f64>().sqrt()
    }

    fn correct(
        &mut self,
        problem: &Problem<'_>,
        inc: &Increment,
        at: &mut Iterate,
        residual: &Residual,
        stiffness: &[f64],
        scale: f64,
    ) -> Result<Correction, Failure> {
        let linearised = Linearised { problem, inc, residual, matrix: &self.matrix, scale };
        match &mut self.inner {
            Inner::ActiveSet(solver) => {
                let system = System::new(problem, inc, at, residual, stiffness, self.matrix.clone());
                system.solve(&mut **solver).ok_or(Failure::Singular)
            }
            Inner::Relaxation(settings) => relax::relax(settings, None, linearised, at),
            Inner::Corrected(settings, corrections) => {
                relax::relax(settings, Some(corrections), linearised, at)
            }
        }
    }
}

/// Contact states that follow from an iterate; how many changed.
fn update(
    problem: &Problem<'_>,
    inc: &Increment,
    at: &mut Iterate,
    residual: &Residual,
    stiffness: &[f64],
) -> usize {
    let Some(surface) = &inc.surface else { return 0 };
    let new: Vec<Status> = (0..at.status.len())
        .map(|k| surface.update(at.status[k], &problem.local(inc, at, &residual.r, k, stiffness)))
        .collect();
    let changes = new.iter().zip(&at.status).filter(|(a, b)| a != b).count();
    at.status = new;
    changes
}

/// Applies as much of a correction as the body can take, `first` at most: halved while an element inverts, or while the
/// residual is more than `most` [N].
fn damped(
    problem: &Problem<'_>,
    inc: &Increment,
    at: &Iterate,
    correction: &Correction,
    [first, most]: [f64; 2],
    stiffness: &[f64],
) -> Result<(Iterate, Residual, f64), usize> {
    const SMALLEST: f64 = 1.0 / 64.0;
    let mut share = first;
    loop {
        let trial = moved(problem, inc, at, correction, share);
        match problem.residual(inc, &trial) {
            Err(element) if share <= SMALLEST => return Err(element),
            Err(_) => {}
            Ok(residual) => {
                let after = problem.violation(inc, &trial, &residual, stiffness);
                if after <= most || share <= SMALLEST {
                    return Ok((trial, residual, share));
                }
            }
        }
        share *= 0.5;
    }
}

fn moved(
    problem: &Problem<'_>,
    inc: &Increment,
    at: &Iterate,
    correction: &Correction,
    share: f64,
) -> Iterate {
    let mut x = at.x.clone();
    super::matrix::axpy(&mut x, share, &correction.dx);
    let q = std::array::from_fn(|c| {
        // Exactly the target at the full share.
        if share == 1.0 { correction.q[c] } else { at.q[c] + share * (correction.q[c] - at.q[c]) }
    });
    problem.rim.place(&q, &mut x);
    if share == 1.0 {
        inc.driven.iter().for_each(|&(n, d, place)| x[n as usize][d] = place);
    }
    Iterate { x, q, status: at.status.clone() }
}
