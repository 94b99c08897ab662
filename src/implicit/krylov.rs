//! Iterative linear solvers, and the interface they share with the direct one.

use super::matrix::{Block, axpy, dot, inverse, norm, times};
use super::system::System;
use crate::physics::tensor::Vec3;

/// Solves the linear systems of Newton's method.
pub trait LinearSolver {
    /// The residual, relative, that solutions to come go down to; one that is exact does not care.
    fn aim(&mut self, _residual: f64) {}
    /// Readies the solver for a matrix. `None`: it cannot be solved (singular).
    fn prepare(&mut self, system: &System) -> Option<()>;
    /// Readies the solver for a matrix with the same fixed unknowns as the last one, and nearly its entries: an
    /// iterative solver may keep its preconditioner.
    fn prepare_near(&mut self, system: &System) -> Option<()> {
        self.prepare(system)
    }
    /// y with A y = b, and the iterations it took (1 for a direct solver). `None`: no convergence.
    fn solve(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)>;
    /// Bytes held for the last matrix.
    fn bytes(&self) -> usize;
}

/// An approximate inverse, symmetric and positive for conjugate gradients.
pub trait Preconditioner {
    fn prepare(&mut self, system: &System) -> Option<()>;
    /// z = M^-1 r
    fn apply(&mut self, system: &System, r: &[Vec3<f64>], z: &mut [Vec3<f64>]);
    fn bytes(&self) -> usize;
}

/// Inverses of the 3x3 diagonal blocks.
#[derive(Debug, Default)]
pub struct BlockJacobi {
    inverses: Vec<Block>,
}

impl Preconditioner for BlockJacobi {
    fn prepare(&mut self, system: &System) -> Option<()> {
        self.inverses = (0..system.matrix.rows()).map(|i| inverse(system.matrix.diagonal(i))).collect();
        self.inverses.iter().flatten().flatten().all(|c| c.is_finite()).then_some(())
    }

    fn apply(&mut self, _system: &System, r: &[Vec3<f64>], z: &mut [Vec3<f64>]) {
        for ((z, r), b) in z.iter_mut().zip(r).zip(&self.inverses) {
            *z = times(b, *r);
        }
    }

    fn bytes(&self) -> usize {
        self.inverses.len() * size_of::<Block>()
    }
}

/// Conjugate gradients where the matrix is symmetric, restarted GMRES where slip or viscosity makes it not.
pub struct Krylov<P> {
    pub preconditioner: P,
    /// Residual to reach, relative to the right-hand side.
    pub tolerance: f64,
    pub most: usize,
}

impl<P: Preconditioner> LinearSolver for Krylov<P> {
    fn aim(&mut self, residual: f64) {
        self.tolerance = residual;
    }

    fn prepare(&mut self, system: &System) -> Option<()> {
        self.preconditioner.prepare(system)
    }

    fn prepare_near(&mut self, _system: &System) -> Option<()> {
        Some(())
    }

    fn solve(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)> {
        if norm(b) == 0.0 {
            return Some((vec![[0.0; 3]; b.len()], 0));
        }
        if system.symmetric { self.conjugate_gradients(system, b) } else { self.gmres(system, b) }
    }

    fn bytes(&self) -> usize {
        self.preconditioner.bytes()
    }
}

impl<P: Preconditioner> Krylov<P> {
    fn conjugate_gradients(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)> {
        let target = self.tolerance * norm(b);
        let zero = vec![[0.0; 3]; b.len()];
        let (mut y, mut r, mut z, mut ap) = (zero.clone(), b.to_vec(), zero.clone(), zero);
        self.preconditioner.apply(system, &r, &mut z);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        for n in 1..=self.most {
            system.matrix.multiply(&p, &mut ap);
            let curvature = dot(&p, &ap);
            // An indefinite matrix (a tangent past a limit point) has no business here.
            if curvature.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
                return self.gmres(system, b);
            }
            let alpha = rz / curvature;
            axpy(&mut y, alpha, &p);
            axpy(&mut r, -alpha, &ap);
            if norm(&r) <= target {
                return Some((y, n));
            }
            self.preconditioner.apply(system, &r, &mut z);
            let new = dot(&r, &z);
            let beta = new / rz;
            rz = new;
            for (p, z) in p.iter_mut().zip(&z) {
                (0..3).for_each(|i| p[i] = z[i] + beta * p[i]);
            }
        }
        None
    }

    /// Right-preconditioned, restarted: the residual that is watched is the true one.
    fn gmres(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)> {
        const RESTART: usize = 80;
        let target = self.tolerance * norm(b);
        let mut y = vec![[0.0; 3]; b.len()];
        let mut r = b.to_vec();
        let mut taken = 0;
        while taken < self.most {
            let cycle = Arnoldi::run(self, system, &r, target, RESTART.min(self.most - taken));
            taken += cycle.steps;
            let mut z = vec![[0.0; 3]; b.len()];
            self.preconditioner.apply(system, &cycle.combination(), &mut z);
            axpy(&mut y, 1.0, &z);
            let mut ay = vec![[0.0; 3]; b.len()];
            system.matrix.multiply(&y, &mut ay);
            r = b.to_vec();
            axpy(&mut r, -1.0, &ay);
            if norm(&r) <= target * 1.01 {
                return Some((y, taken));
            }
            if cycle.steps == 0 || !norm(&r).is_finite() {
                return None;
            }
        }
        None
    }
}

/// An orthonormal basis of the Krylov space with its Hessenberg matrix, already rotated to a triangle.
struct Arnoldi {
    basis: Vec<Vec<Vec3<f64>>>,
    triangle: Vec<Vec<f64>>,
    rhs: Vec<f64>,
    steps: usize,
}

impl Arnoldi {
    fn run<P: Preconditioner>(
        solver: &mut Krylov<P>,
        system: &System,
        r: &[Vec3<f64>],
        target: f64,
        most: usize,
    ) -> Arnoldi {
        let beta = norm(r);
        let scaled =
            |v: &[Vec3<f64>], s: f64| -> Vec<Vec3<f64>> { v.iter().map(|v| v.map(|c| c * s)).collect() };
        let mut cycle =
            Arnoldi { basis: vec![scaled(r, 1.0 / beta)], triangle: Vec::new(), rhs: vec![beta], steps: 0 };
        let mut turns: Vec<(f64, f64)> = Vec::new();
        let mut z = vec![[0.0; 3]; r.len()];
        while cycle.steps < most && cycle.rhs[cycle.steps].abs() > target {
            let mut w = vec![[0.0; 3]; r.len()];
            solver.preconditioner.apply(system, &cycle.basis[cycle.steps], &mut z);
            system.matrix.multiply(&z, &mut w);
            let mut column = Vec::new();
            for v in &cycle.basis {
                let h = dot(v, &w);
                axpy(&mut w, -h, v);
                column.push(h);
            }
            let next = norm(&w);
            for (i, &(c, s)) in turns.iter().enumerate() {
                (column[i], column[i + 1]) =
                    (c * column[i] + s * column[i + 1], -s * column[i] + c * column[i + 1]);
            }
            let k = cycle.steps;
            let length = column[k].hypot(next);
            if length == 0.0 || !length.is_finite() {
                break;
            }
            let (c, s) = (column[k] / length, next / length);
            turns.push((c, s));
            column[k] = length;
            let last = cycle.rhs[k];
            cycle.rhs[k] = c * last;
            cycle.rhs.push(-s * last);
            cycle.triangle.push(column);
            cycle.steps += 1;
            cycle.basis.push(scaled(&w, if next > 0.0 { 1.0 / next } else { 0.0 }));
        }
        cycle
    }

    /// The combination of basis vectors with the least residual.
    fn combination(&self) -> Vec<Vec3<f64>> {
        let mut weights = vec![0.0; self.steps];
        for i in (0..self.steps).rev() {
            let rest: f64 = (i + 1..self.steps).map(|j| self.triangle[j][i] * weights[j]).sum();
            weights[i] = (self.rhs[i] - rest) / self.triangle[i][i];
        }
        let mut sum = vec![[0.0; 3]; self.basis[0].len()];
        for (w, v) in weights.iter().zip(&self.basis) {
            axpy(&mut sum, *w, v);
        }
        sum
    }
}
