//! Sparse direct solution: Cholesky where the matrix is symmetric, LU where it is not (or not positive).

use super::krylov::LinearSolver;
use super::system::System;
use crate::physics::tensor::Vec3;
use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Llt, Lu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Col, Side};

enum Factors {
    Cholesky(Box<Llt<usize, f64>>),
    Lu(Box<Lu<usize, f64>>),
}

/// Factors of the last matrix.
#[derive(Default)]
pub struct Direct {
    factors: Option<Factors>,
    /// Number of every unknown that is not fixed.
    numbers: Vec<[Option<usize>; 3]>,
    unknowns: usize,
    /// Of the matrix handed over: the library does not say what its factors hold.
    bytes: usize,
}

impl LinearSolver for Direct {
    fn prepare(&mut self, system: &System) -> Option<()> {
        self.factors = None;
        self.number(system);
        let matrix = self.sparse(system)?;
        self.bytes = matrix.compute_nnz() * 16;
        if system.symmetric
            && let Ok(llt) = matrix.sp_cholesky(Side::Lower)
        {
            self.factors = Some(Factors::Cholesky(Box::new(llt)));
            return Some(());
        }
        self.factors = Some(Factors::Lu(Box::new(matrix.sp_lu().ok()?)));
        Some(())
    }

    fn solve(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)> {
        let mut column = Col::<f64>::zeros(self.unknowns);
        self.each(|n, i, k| column[k] = b[n][i]);
        let y = match self.factors.as_ref()? {
            Factors::Cholesky(llt) => llt.solve(&column),
            Factors::Lu(lu) => lu.solve(&column),
        };
        let mut out = vec![[0.0; 3]; system.rhs.len()];
        self.each(|n, i, k| out[n][i] = y[k]);
        out.iter().flatten().all(|c| c.is_finite()).then_some((out, 1))
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}

impl Direct {
    fn number(&mut self, system: &System) {
        let mut next = 0;
        let mut take = |fixed: bool| {
            (!fixed).then(|| {
                next += 1;
                next - 1
            })
        };
        self.numbers = system.fixed.iter().map(|f| f.map(&mut take)).collect();
        self.unknowns = next;
    }

    fn each(&self, mut f: impl FnMut(usize, usize, usize)) {
        for (n, numbers) in self.numbers.iter().enumerate() {
            for (i, number) in numbers.iter().enumerate() {
                if let Some(k) = number {
                    f(n, i, *k);
                }
            }
        }
    }

    fn sparse(&self, system: &System) -> Option<SparseColMat<usize, f64>> {
        let mut triplets = Vec::new();
        self.each(|n, i, k| {
            for (m, block) in system.matrix.row(n) {
                for (j, number) in self.numbers[m].iter().enumerate() {
                    if let Some(l) = number {
                        triplets.push(Triplet::new(k, *l, block[i][j]));
                    }
                }
            }
        });
        SparseColMat::try_new_from_triplets(self.unknowns, self.unknowns, &triplets).ok()
    }
}
