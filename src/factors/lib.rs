//! Factors of sparse matrices in double precision, and solutions with them.
//!
//! A crate of its own because the generic routines of `faer` are compiled where they are called: here they are compiled once.

use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Llt, Lu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{ColMut, Side};

/// A square matrix by its columns.
pub struct Matrix(SparseColMat<usize, f64>);

/// Row, column and value.
pub type Entry = Triplet<usize, usize, f64>;

impl Matrix {
    /// Of entries; several of one place are added up. `None` if one lies outside.
    pub fn new(size: usize, entries: &[Entry]) -> Option<Matrix> {
        SparseColMat::try_new_from_triplets(size, size, entries).ok().map(Matrix)
    }

    /// Bytes of its entries with their rows.
    pub fn bytes(&self) -> usize {
        self.0.compute_nnz() * (size_of::<usize>() + size_of::<f64>())
    }
}

/// Factors of a matrix.
pub trait Factors {
    /// Puts the solution in the place of the right hand side.
    fn solve(&self, b: &mut [f64]);
}

/// A = L L^T.
pub struct Cholesky(Llt<usize, f64>);

impl Cholesky {
    /// Of a symmetric matrix, of which the lower triangle is read. `None` if it is not positive definite.
    pub fn new(matrix: &Matrix) -> Option<Cholesky> {
        matrix.0.sp_cholesky(Side::Lower).ok().map(Cholesky)
    }
}

impl Factors for Cholesky {
    fn solve(&self, b: &mut [f64]) {
        self.0.solve_in_place(ColMut::from_slice_mut(b));
    }
}

/// P A Q = L U.
pub struct LowerUpper(Lu<usize, f64>);

impl LowerUpper {
    /// `None` if the matrix is singular.
    pub fn new(matrix: &Matrix) -> Option<LowerUpper> {
        matrix.0.sp_lu().ok().map(LowerUpper)
    }
}

impl Factors for LowerUpper {
    fn solve(&self, b: &mut [f64]) {
        self.0.solve_in_place(ColMut::from_slice_mut(b));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// -1 2 -1, with something added above the diagonal; the solution is known beforehand.
    fn chain(above: f64) -> (Matrix, Vec<f64>, Vec<f64>) {
        let n = 50;
        let at = |i: usize, j: usize| match j as i64 - i as i64 {
            0 => 2.0,
            1 => above - 1.0,
            -1 => -1.0,
            _ => 0.0,
        };
        let places = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        // In two halves, to be added up.
        let entries = places.flat_map(|(i, j)| [0.25, 0.75].map(|part| Entry::new(i, j, part * at(i, j))));
        let entries: Vec<Entry> = entries.filter(|e| e.val != 0.0).collect();
        let x: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let b = (0..n).map(|i| (0..n).map(|j| at(i, j) * x[j]).sum()).collect();
        (Matrix::new(n, &entries).unwrap(), x, b)
    }

    /// The condition number of the chain is 1e3: what is lost of 16 digits is three.
    fn solved(factors: &dyn Factors, x: &[f64], mut b: Vec<f64>) {
        factors.solve(&mut b);
        for (x, y) in x.iter().zip(&b) {
            assert!((x - y).abs() < 1e-12, "{y} for {x}");
        }
    }

    #[test]
    fn both_kinds_of_factors_solve() {
        let (matrix, x, b) = chain(0.0);
        solved(&Cholesky::new(&matrix).unwrap(), &x, b);
        let (matrix, x, b) = chain(0.3);
        solved(&LowerUpper::new(&matrix).unwrap(), &x, b);
    }

    #[test]
    fn what_cannot_be_factored_is_refused() {
        let diagonal = |d: [f64; 3]| Matrix::new(3, &[0, 1, 2].map(|i| Entry::new(i, i, d[i]))).unwrap();
        assert!(Cholesky::new(&diagonal([1.0, 2.0, -1.0])).is_none());
        assert!(LowerUpper::new(&diagonal([1.0, 2.0, -1.0])).is_some());
        assert!(Matrix::new(2, &[Entry::new(2, 0, 1.0)]).is_none());
    }
}
