//! Multiplicative relaxation of overlapping element blocks (24 unknowns each).

use crate::implicit::matrix::BlockMatrix;
use crate::physics::tensor::Vec3;
use rayon::prelude::*;

const N: usize = 24;

/// Inverses of every element's 24x24 part of the assembled matrix. In single precision: a smoother need not be exact,
/// and they are most of the memory.
#[derive(Default)]
pub struct ElementBlocks {
    inverses: Vec<[f32; N * N]>,
}

impl ElementBlocks {
    /// Inverts the blocks. `None`: one is singular.
    pub fn prepare(&mut self, hexes: &[[u32; 8]], matrix: &BlockMatrix) -> Option<()> {
        self.inverses = hexes.par_iter().map(|hex| inverted(gathered(hex, matrix))).collect::<Option<_>>()?;
        Some(())
    }

    pub fn bytes(&self) -> usize {
        self.inverses.len() * size_of::<[f32; N * N]>()
    }

    /// One sweep over the elements, each solved exactly with the newest values around it.
    pub fn sweep(
        &self,
        hexes: &[[u32; 8]],
        matrix: &BlockMatrix,
        b: &[Vec3<f64>],
        x: &mut [Vec3<f64>],
        backward: bool,
    ) {
        let count = hexes.len();
        for k in 0..count {
            let e = if backward { count - 1 - k } else { k };
            let mut r = [0.0f32; N];
            for (a, &n) in hexes[e].iter().enumerate() {
                let ax = matrix.row_times(n as usize, x);
                (0..3).for_each(|i| r[3 * a + i] = (b[n as usize][i] - ax[i]) as f32);
            }
            let inverse = &self.inverses[e];
            let mut d = [0.0f32; N];
            for (column, r) in inverse.chunks_exact(N).zip(r) {
                for (d, c) in d.iter_mut().zip(column) {
                    *d += c * r;
                }
            }
            for (a, &n) in hexes[e].iter().enumerate() {
                (0..3).for_each(|i| x[n as usize][i] += f64::from(d[3 * a + i]));
            }
        }
    }
}

/// The element's part of the matrix, row by row.
fn gathered(hex: &[u32; 8], matrix: &BlockMatrix) -> Box<[[f64; N]; N]> {
    let mut block = Box::new([[0.0; N]; N]);
    for (a, &row) in hex.iter().enumerate() {
        for (c, &column) in hex.iter().enumerate() {
            let entry = &matrix.blocks[matrix.entry(row as usize, column)];
            for i in 0..3 {
                block[3 * a + i][3 * c..3 * c + 3].copy_from_slice(&entry[i]);
            }
        }
    }
    block
}

/// Gauss-Jordan with row pivoting; the inverse column by column.
fn inverted(mut m: Box<[[f64; N]; N]>) -> Option<[f32; N * N]> {
    let mut rows: [usize; N] = std::array::from_fn(|i| i);
    for k in 0..N {
        let p = (k..N).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs()))?;
        m.swap(k, p);
        rows.swap(k, p);
        let pivot = m[k][k];
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        m[k][k] = 1.0;
        m[k].iter_mut().for_each(|c| *c /= pivot);
        let own = m[k];
        for (i, row) in m.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            debug_assert!(i != k);
            let f = row[k];
            row[k] = 0.0;
            row.iter_mut().zip(own).for_each(|(c, o)| *c -= f * o);
        }
    }
    let mut out = [0.0f32; N * N];
    for j in 0..N {
        for i in 0..N {
            out[rows[j] * N + i] = m[i][j] as f32;
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_its_block() {
        let mut m = Box::new([[0.0; N]; N]);
        for i in 0..N {
            for j in 0..N {
                // Needs pivoting: the diagonal is zero.
                m[i][j] = if i == j { 0.0 } else { 1.0 / (1.0 + (i as f64 - 1.3 * j as f64).abs()) };
            }
        }
        let inverse = inverted(m.clone()).unwrap();
        for i in 0..N {
            for j in 0..N {
                let p: f64 = (0..N).map(|k| m[i][k] * f64::from(inverse[j * N + k])).sum();
                // Single precision times a condition number of about 100.
                assert!((p - f64::from(u8::from(i == j))).abs() < 1e-4, "{i} {j} {p}");
            }
        }
    }
}
