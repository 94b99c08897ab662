//! Solution by sparse factors: Cholesky's where the matrix is symmetric. Where slip or viscosity makes it not, Cholesky's
//! factors of its symmetric part precondition GMRES, which is ten times as fast on the paper's mesh as LU factors; those
//! are taken where the symmetric part is not positive, or GMRES takes too long. While the same unknowns are fixed the
//! factors of an older matrix go on preconditioning, for as long as they do it well.

use super::krylov::{Krylov, LinearSolver, Preconditioner};
use super::matrix::BlockMatrix;
use super::system::System;
use crate::physics::tensor::Vec3;
use hexroll_factors::{Cholesky, Entry, LowerUpper, Matrix};

/// Residual that GMRES goes down to, relative, and the iterations after which LU factors would have been faster.
const TOLERANCE: f64 = 1e-12;
const MOST: usize = 60;
/// Iterations after which new Cholesky factors would have been faster than those of an older matrix.
const MOST_OF_OLD: usize = 14;

enum Factors {
    Cholesky(Factored<Cholesky>),
    /// Of the symmetric part.
    Half(Box<Krylov<SymmetricPart>>),
    Lu(Box<Factored<LowerUpper>>),
}

/// Solves with the factors of the last matrix.
#[derive(Default)]
pub struct Direct {
    factors: Option<Factors>,
    /// Unknowns that were fixed when the factors were found.
    fixed: Vec<[bool; 3]>,
    /// Whether the factors belong to an older matrix.
    old: bool,
}

impl LinearSolver for Direct {
    fn prepare(&mut self, system: &System) -> Option<()> {
        let half = matches!(self.factors, Some(Factors::Half(_)));
        self.old = half && !system.symmetric && self.fixed == system.fixed;
        if self.old { Some(()) } else { self.factorise(system) }
    }

    fn solve(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)> {
        let mut spent = 0;
        if let (true, Some(Factors::Half(krylov))) = (self.old, self.factors.as_mut()) {
            krylov.most = MOST_OF_OLD;
            if let Some(solved) = krylov.solve(system, b) {
                return Some(solved);
            }
            spent = MOST_OF_OLD;
            self.old = false;
            self.factorise(system)?;
        }
        let (y, taken) = self.solve_with_own(system, b)?;
        Some((y, spent + taken))
    }

    /// Of the matrix handed over: the library does not say what its factors hold.
    fn bytes(&self) -> usize {
        match &self.factors {
            None => 0,
            Some(Factors::Cholesky(f)) => f.bytes,
            Some(Factors::Half(f)) => f.bytes(),
            Some(Factors::Lu(f)) => f.bytes,
        }
    }
}

impl Direct {
    fn factorise(&mut self, system: &System) -> Option<()> {
        self.factors = None;
        self.fixed.clone_from(&system.fixed);
        let mut half = SymmetricPart::default();
        self.factors = Some(match (half.prepare(system), system.symmetric) {
            (Some(()), true) => Factors::Cholesky(half.factors?),
            (Some(()), false) => {
                Factors::Half(Box::new(Krylov { preconditioner: half, tolerance: TOLERANCE, most: MOST }))
            }
            (None, _) => Factors::Lu(lu(system)?),
        });
        Some(())
    }

    fn solve_with_own(&mut self, system: &System, b: &[Vec3<f64>]) -> Option<(Vec<Vec3<f64>>, usize)> {
        let once = |y: Vec<Vec3<f64>>| y.iter().flatten().all(|c| c.is_finite()).then_some((y, 1));
        match self.factors.as_mut()? {
            Factors::Cholesky(factors) => return once(factors.solve(b)),
            Factors::Lu(factors) => return once(factors.solve(b)),
            Factors::Half(krylov) => {
                if let Some(solved) = krylov.solve(system, b) {
                    return Some(solved);
                }
            }
        }
        let factors = lu(system)?;
        let y = factors.solve(b);
        self.factors = Some(Factors::Lu(factors));
        once(y)
    }
}

fn lu(system: &System) -> Option<Box<Factored<LowerUpper>>> {
    let numbers = Numbers::new(system);
    let matrix = numbers.sparse(&system.matrix, |own, _| own)?;
    Some(Box::new(Factored { bytes: matrix.bytes(), factors: LowerUpper::new(&matrix)?, numbers }))
}

/// Cholesky's factors of a matrix's symmetric part.
#[derive(Default)]
pub struct SymmetricPart {
    factors: Option<Factored<Cholesky>>,
}

impl Preconditioner for SymmetricPart {
    fn prepare(&mut self, system: &System) -> Option<()> {
        self.factors = None;
        let numbers = Numbers::new(system);
        let near = system.near.as_ref().unwrap_or(&system.matrix);
        let matrix = numbers.sparse(near, |own, mirrored| 0.5 * (own + mirrored))?;
        self.factors = Some(Factored { bytes: matrix.bytes(), factors: Cholesky::new(&matrix)?, numbers });
        Some(())
    }

    fn apply(&mut self, _system: &System, r: &[Vec3<f64>], z: &mut [Vec3<f64>]) {
        z.copy_from_slice(&self.factors.as_ref().expect("prepared").solve(r));
    }

    fn bytes(&self) -> usize {
        self.factors.as_ref().map_or(0, |f| f.bytes)
    }
}

/// Factors with the numbers of their unknowns.
struct Factored<F> {
    factors: F,
    numbers: Numbers,
    bytes: usize,
}

impl<F: hexroll_factors::Factors> Factored<F> {
    fn solve(&self, b: &[Vec3<f64>]) -> Vec<Vec3<f64>> {
        let mut y = vec![0.0; self.numbers.count];
        self.numbers.each(|n, i, k| y[k] = b[n][i]);
        self.factors.solve(&mut y);
        let mut out = vec![[0.0; 3]; b.len()];
        self.numbers.each(|n, i, k| out[n][i] = y[k]);
        out
    }
}

/// Number of every unknown that is not fixed.
struct Numbers {
    of: Vec<[Option<usize>; 3]>,
    count: usize,
}

impl Numbers {
    fn new(system: &System) -> Numbers {
        let mut count = 0;
        let mut take = |fixed: bool| {
            (!fixed).then(|| {
                count += 1;
                count - 1
            })
        };
        let of = system.fixed.iter().map(|f| f.map(&mut take)).collect();
        Numbers { of, count }
    }

    fn each(&self, mut f: impl FnMut(usize, usize, usize)) {
        for (n, numbers) in self.of.iter().enumerate() {
            for (i, number) in numbers.iter().enumerate() {
                if let Some(k) = number {
                    f(n, i, *k);
                }
            }
        }
    }

    /// The matrix whose entries are `of` an entry and the one across the diagonal.
    fn sparse(&self, matrix: &BlockMatrix, of: impl Fn(f64, f64) -> f64) -> Option<Matrix> {
        let mut entries = Vec::with_capacity(9 * matrix.blocks.len());
        for (n, numbers) in self.of.iter().enumerate() {
            for (m, block) in matrix.row(n) {
                let across = &matrix.blocks[matrix.entry(m, n as u32)];
                for (i, k) in numbers.iter().enumerate().filter_map(|(i, k)| Some((i, (*k)?))) {
                    for (j, l) in self.of[m].iter().enumerate().filter_map(|(j, l)| Some((j, (*l)?))) {
                        entries.push(Entry::new(k, l, of(block[i][j], across[j][i])));
                    }
                }
            }
        }
        Matrix::new(self.count, &entries)
    }
}
