//! The linear equations of a Newton iteration: contact laws in place of the rows of touching nodes, prescribed
//! components eliminated, free rim components as a border.

use super::contact::{Equations, Status};
use super::krylov::LinearSolver;
use super::linearised::{Correction, Linearised};
use super::matrix::{Block, BlockMatrix, dot, product, times, transposed};
use super::problem::{Increment, Iterate, Problem, Residual};
use crate::physics::rim::{Coordinates, SPIN};
use crate::physics::tensor::Vec3;

/// Equations A y = b over all nodes: an unknown that is `fixed` has a unit row and a zero right-hand side.
pub struct System {
    pub matrix: BlockMatrix,
    pub rhs: Vec<Vec3<f64>>,
    pub fixed: Vec<[bool; 3]>,
    /// Whether the matrix is symmetric up to round-off.
    pub symmetric: bool,
    /// The same without what friction adds of the normal forces' rows, where there is any: its symmetric part is
    /// positive, and makes a preconditioner.
    pub near: Option<BlockMatrix>,
    /// Frame of every touching node (columns): its unknowns are components in it.
    pub columns: Vec<Option<Block>>,
    /// Values of the fixed unknowns.
    known: Vec<Vec3<f64>>,
    border: Border,
    /// Rim coordinates that the iterate is to have, free ones as they are.
    q: Coordinates,
}

/// Free rim components: columns, rows, and the small block with its right-hand side.
#[derive(Default)]
struct Border {
    components: Vec<usize>,
    columns: Vec<Vec<Vec3<f64>>>,
    rows: Vec<Vec<Vec3<f64>>>,
    block: Vec<Vec<f64>>,
    rhs: Vec<f64>,
}

impl System {
    /// From the tangent at an iterate (consumed) and its residual.
    pub fn new(
        problem: &Problem<'_>,
        inc: &Increment,
        at: &Iterate,
        residual: &Residual,
        stiffness: &[f64],
        mut matrix: BlockMatrix,
    ) -> System {
        let count = at.x.len();
        let mut q = inc.rim.target;
        inc.rim.free.iter().for_each(|&c| q[c] = at.q[c]);
        let mut known = at.x.clone();
        problem.rim.place(&q, &mut known);
        for n in 0..count {
            known[n] =
                std::array::from_fn(|i| if problem.on_rim[n] { known[n][i] - at.x[n][i] } else { 0.0 });
        }
        for &(n, d, x) in &inc.driven {
            known[n as usize][d] = x - at.x[n as usize][d];
        }
        let mut rhs: Vec<Vec3<f64>> = residual.r.iter().map(|r| r.map(|c| -c)).collect();
        let mut fixed = problem.given.clone();
        let mut columns = vec![None; count];
        let mut laws: Vec<Option<Equations>> = vec![None; count];
        let mut symmetric = problem.symmetric(inc);
        for (k, &status) in at.status.iter().enumerate().filter(|(_, s)| **s != Status::Free) {
            let n = problem.model.mesh.surface[k] as usize;
            let node = problem.local(inc, at, &residual.r, k, stiffness);
            symmetric &= status == Status::Stick || node.mu == 0.0;
            let law = node.equations(status);
            (rhs[n], fixed[n], known[n], columns[n]) = (law.rhs, law.fixed, law.known, Some(law.columns));
            for i in 0..3 {
                if !law.fixed[i] {
                    known[n][i] = 0.0;
                }
            }
            laws[n] = Some(law);
        }
        let slips = |law: &Option<Equations>| law.is_some_and(|l| l.rows != transposed(&l.columns));
        let near = laws.iter().any(slips).then(|| {
            let framed = |l: Equations| Equations { rows: transposed(&l.columns), ..l };
            let laws: Vec<_> = laws.iter().map(|l| l.map(framed)).collect();
            let mut near = matrix.clone();
            transform(&mut near, &laws);
            near
        });
        transform(&mut matrix, &laws);
        let mut border = Border::new(problem, inc, at, residual, &matrix);
        shift_known(&matrix, &known, &mut rhs);
        border.shift_known(&known);
        let mut system = System { matrix, rhs, fixed, symmetric, near, columns, known, border, q };
        system.decouple();
        system
    }

    /// The equations that are left of a contact problem once its active set is held: of a touching node the unknowns
    /// that its law fixes are truncated, not moved. `laws` has every touching node's equations, their right-hand
    /// side included; `rhs` [N] is read elsewhere, `rim_rhs` [N, N m] belongs to the free rim components.
    pub fn truncated(
        linearised: Linearised<'_>,
        at: &Iterate,
        laws: &[Option<Equations>],
        mut rhs: Vec<Vec3<f64>>,
        rim_rhs: Vec<f64>,
    ) -> System {
        let Linearised { problem, inc, residual, matrix, .. } = linearised;
        let mut matrix = matrix.clone();
        let count = at.x.len();
        let mut fixed = problem.given.clone();
        let mut columns = vec![None; count];
        for (n, law) in laws.iter().enumerate() {
            if let Some(law) = law {
                (rhs[n], fixed[n], columns[n]) = (law.rhs, law.fixed, Some(law.columns));
            }
        }
        transform(&mut matrix, laws);
        let mut border = Border::new(problem, inc, at, residual, &matrix);
        border.rhs = rim_rhs;
        let symmetric = problem.symmetric(inc);
        let known = vec![[0.0; 3]; count];
        let (near, q) = (None, [0.0; 6]);
        let mut system = System { matrix, rhs, fixed, symmetric, near, columns, known, border, q };
        system.decouple();
        system
    }

    /// A matrix alone: no unknown is fixed, and every one is a component in space.
    pub fn bare(matrix: BlockMatrix, symmetric: bool) -> System {
        let count = matrix.rows();
        let zero = vec![[0.0; 3]; count];
        System {
            matrix,
            rhs: zero.clone(),
            fixed: vec![[false; 3]; count],
            symmetric,
            near: None,
            columns: vec![None; count],
            known: zero,
            border: Border::default(),
            q: [0.0; 6],
        }
    }

    /// Unit rows and zero columns for the fixed unknowns. The unit is a stiffness, so that norms mean something.
    fn decouple(&mut self) {
        let unit = mean_diagonal(&self.matrix);
        for matrix in [Some(&mut self.matrix), self.near.as_mut()].into_iter().flatten() {
            uncouple(matrix, &self.fixed, unit);
        }
        for i in 0..self.rhs.len() {
            clear(&mut self.rhs[i], self.fixed[i]);
            for list in [&mut self.border.columns, &mut self.border.rows] {
                list.iter_mut().for_each(|c| clear(&mut c[i], self.fixed[i]));
            }
        }
    }

    /// Solves for the correction; the border by its Schur complement. `None`: singular, or the solver failed.
    pub fn solve(&self, solver: &mut dyn LinearSolver) -> Option<Correction> {
        solver.prepare(self)?;
        self.solve_prepared(solver)
    }

    /// The same with a solver that is ready.
    pub fn solve_prepared(&self, solver: &mut dyn LinearSolver) -> Option<Correction> {
        let mut iterations = 0;
        let mut solve = |b: &[Vec3<f64>]| -> Option<Vec<Vec3<f64>>> {
            let (y, n) = solver.solve(self, b)?;
            iterations += n;
            Some(y)
        };
        let mut y = solve(&self.rhs)?;
        let border = &self.border;
        let m = border.rhs.len();
        let mut q = self.q;
        if m > 0 {
            let z = border.columns.iter().map(|c| solve(c)).collect::<Option<Vec<_>>>()?;
            let mut small: Vec<Vec<f64>> = (0..m)
                .map(|i| (0..m).map(|j| border.block[i][j] - dot(&border.rows[i], &z[j])).collect())
                .collect();
            let mut b: Vec<f64> = (0..m).map(|i| border.rhs[i] - dot(&border.rows[i], &y)).collect();
            gauss(&mut small, &mut b, &border.block)?;
            for (z, &dq) in z.iter().zip(&b) {
                super::matrix::axpy(&mut y, -dq, z);
            }
            border.components.iter().zip(&b).for_each(|(&c, dq)| q[c] += dq);
        }
        let dx = y.iter().zip(&self.known).zip(&self.columns).map(|((y, k), columns)| {
            let y: Vec3<f64> = std::array::from_fn(|i| y[i] + k[i]);
            columns.map_or(y, |c| times(&c, y))
        });
        Some(Correction { dx: dx.collect(), q, iterations })
    }
}

/// `unit` on the diagonal of the fixed unknowns, zero elsewhere in their rows and columns.
fn uncouple(matrix: &mut BlockMatrix, fixed: &[[bool; 3]], unit: f64) {
    for i in 0..fixed.len() {
        for e in matrix.start[i]..matrix.start[i + 1] {
            let j = matrix.columns[e] as usize;
            for a in 0..3 {
                for b in 0..3 {
                    if fixed[i][a] || fixed[j][b] {
                        matrix.blocks[e][a][b] = if i == j && a == b { unit } else { 0.0 };
                    }
                }
            }
        }
    }
}

fn clear(v: &mut Vec3<f64>, fixed: [bool; 3]) {
    for i in 0..3 {
        if fixed[i] {
            v[i] = 0.0;
        }
    }
}

/// Mean of the diagonal entries [N/m].
pub fn mean_diagonal(matrix: &BlockMatrix) -> f64 {
    let trace = |i: usize| (0..3).map(|a| matrix.diagonal(i)[a][a]).sum::<f64>();
    (0..matrix.rows()).map(trace).sum::<f64>() / (3 * matrix.rows()) as f64
}

/// Rows of touching nodes become their laws', columns go to their frames.
fn transform(matrix: &mut BlockMatrix, laws: &[Option<Equations>]) {
    for i in 0..laws.len() {
        for e in matrix.start[i]..matrix.start[i + 1] {
            let j = matrix.columns[e] as usize;
            if let Some(law) = &laws[i] {
                matrix.blocks[e] = product(&law.rows, &matrix.blocks[e]);
            }
            if let Some(law) = &laws[j] {
                matrix.blocks[e] = product(&matrix.blocks[e], &law.columns);
            }
            if let (true, Some(law)) = (i == j, &laws[i]) {
                for a in 0..3 {
                    (0..3).for_each(|b| matrix.blocks[e][a][b] += law.diagonal[a][b]);
                }
            }
        }
    }
}

/// rhs -= A known
fn shift_known(matrix: &BlockMatrix, known: &[Vec3<f64>], rhs: &mut [Vec3<f64>]) {
    let mut moved = vec![[0.0; 3]; known.len()];
    matrix.multiply(known, &mut moved);
    super::matrix::axpy(rhs, -1.0, &moved);
}

impl Border {
    fn new(
        problem: &Problem<'_>,
        inc: &Increment,
        at: &Iterate,
        residual: &Residual,
        matrix: &BlockMatrix,
    ) -> Border {
        let count = at.x.len();
        let directions: Vec<Vec<Vec3<f64>>> = inc
            .rim
            .free
            .iter()
            .map(|&c| {
                let mut field = vec![[0.0; 3]; count];
                let of_rim = problem.rim.direction(&at.q, c);
                problem.rim.nodes.iter().zip(of_rim).for_each(|(&n, d)| field[n as usize] = d);
                field
            })
            .collect();
        let columns: Vec<Vec<Vec3<f64>>> = directions
            .iter()
            .map(|d| {
                let mut column = vec![[0.0; 3]; count];
                matrix.multiply(d, &mut column);
                column
            })
            .collect();
        let block = (0..directions.len())
            .map(|i| {
                (0..directions.len())
                    .map(|j| {
                        let c = inc.rim.free[i];
                        let turned =
                            if c == SPIN { problem.rim.spin_stiffness(&at.q, &residual.r) } else { 0.0 };
                        let own = if i == j { inc.rim.inertia[c] + turned } else { 0.0 };
                        dot(&directions[i], &columns[j]) + own
                    })
                    .collect()
            })
            .collect();
        let rows = directions.iter().map(|d| transposed_times(problem, matrix, d)).collect();
        let rhs = residual.rim.iter().map(|r| -r).collect();
        Border { columns, rows, block, rhs, components: inc.rim.free.clone() }
    }

    /// What the fixed unknowns do to the rim's equations.
    fn shift_known(&mut self, known: &[Vec3<f64>]) {
        for (rhs, row) in self.rhs.iter_mut().zip(&self.rows) {
            *rhs -= dot(row, known);
        }
    }
}

/// A^T d for a field d that lives on the rim.
fn transposed_times(problem: &Problem<'_>, matrix: &BlockMatrix, d: &[Vec3<f64>]) -> Vec<Vec3<f64>> {
    let mut row = vec![[0.0; 3]; d.len()];
    for &n in &problem.rim.nodes {
        for (j, b) in matrix.row(n as usize) {
            let t = times(&transposed(b), d[n as usize]);
            (0..3).for_each(|i| row[j][i] += t[i]);
        }
    }
    row
}

/// Solves a small system in place with pivoting; `None` where a pivot vanishes against the scale of its row.
fn gauss(a: &mut [Vec<f64>], b: &mut [f64], scale: &[Vec<f64>]) -> Option<()> {
    let m = b.len();
    for k in 0..m {
        let p = (k..m).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, p);
        b.swap(k, p);
        if a[k][k].abs() <= 1e-9 * scale[k][k].abs() || !a[k][k].is_finite() {
            return None;
        }
        for i in k + 1..m {
            let f = a[i][k] / a[k][k];
            for j in k..m {
                a[i][j] -= f * a[k][j];
            }
            b[i] -= f * b[k];
        }
    }
    for k in (0..m).rev() {
        b[k] = (b[k] - (k + 1..m).map(|j| a[k][j] * b[j]).sum::<f64>()) / a[k][k];
    }
    Some(())
}
