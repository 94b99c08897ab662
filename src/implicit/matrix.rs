//! Sparse matrices of 3x3 blocks, one block row a node.

use crate::physics::tensor::Vec3;
use rayon::prelude::*;

/// A 3x3 block, row by row.
pub type Block = [[f64; 3]; 3];

/// Block rows in compressed form; columns ascend within a row.
#[derive(Debug, Clone, Default)]
pub struct BlockMatrix {
    /// Row i holds entries `start[i]..start[i + 1]`.
    pub start: Vec<usize>,
    pub columns: Vec<u32>,
    pub blocks: Vec<Block>,
}

// Components are written out where a product is the inner loop: `std::array::from_fn` is not always inlined.

/// b x
#[inline(always)]
pub fn times(b: &Block, x: Vec3<f64>) -> Vec3<f64> {
    let [r, s, t] = b;
    let by = |row: &Vec3<f64>| row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
    [by(r), by(s), by(t)]
}

/// a b
#[inline]
pub fn product(a: &Block, b: &Block) -> Block {
    let [r, s, t] = a;
    let by = |row: &Vec3<f64>, j: usize| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j];
    let row = |row: &Vec3<f64>| [by(row, 0), by(row, 1), by(row, 2)];
    [row(r), row(s), row(t)]
}

/// b^T
#[inline]
pub fn transposed(b: &Block) -> Block {
    let column = |j: usize| [b[0][j], b[1][j], b[2][j]];
    [column(0), column(1), column(2)]
}

/// Inverse of a block; entries are not finite where it is singular.
pub fn inverse(b: &Block) -> Block {
    let cof = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (p, q) = ((j + 1) % 3, (j + 2) % 3);
        b[r][p] * b[s][q] - b[r][q] * b[s][p]
    };
    let det: f64 = (0..3).map(|j| b[0][j] * cof(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cof(j, i) / det))
}

/// Inner product, summed in the order of the nodes.
pub fn dot(a: &[Vec3<f64>], b: &[Vec3<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sum()
}

/// Euclidean norm.
pub fn norm(a: &[Vec3<f64>]) -> f64 {
    dot(a, a).sqrt()
}

/// a s + b into b
pub fn axpy(b: &mut [Vec3<f64>], s: f64, a: &[Vec3<f64>]) {
    for (b, a) in b.iter_mut().zip(a) {
        for i in 0..3 {
            b[i] += s * a[i];
        }
    }
}

impl BlockMatrix {
    /// The zero matrix that couples the nodes of every hexahedron.
    pub fn of_mesh(node_count: usize, hexes: &[[u32; 8]]) -> BlockMatrix {
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); node_count];
        for hex in hexes {
            for &n in hex {
                neighbours[n as usize].extend_from_slice(hex);
            }
        }
        let mut start = Vec::with_capacity(node_count + 1);
        let mut columns = Vec::new();
        start.push(0);
        for mut row in neighbours {
            row.sort_unstable();
            row.dedup();
            columns.extend_from_slice(&row);
            start.push(columns.len());
        }
        let blocks = vec![[[0.0; 3]; 3]; columns.len()];
        BlockMatrix { start, columns, blocks }
    }

    pub fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// Entry of (row, column). Panics where the pattern has none.
    pub fn entry(&self, row: usize, column: u32) -> usize {
        let range = self.start[row]..self.start[row + 1];
        range.start + self.columns[range].binary_search(&column).expect("nodes of one element")
    }

    /// Columns and blocks of a row.
    #[inline(always)]
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &Block)> {
        let range = self.start[i]..self.start[i + 1];
        self.columns[range.clone()].iter().map(|&c| c as usize).zip(&self.blocks[range])
    }

    /// Row i of A x.
    #[inline(always)]
    pub fn row_times(&self, i: usize, x: &[Vec3<f64>]) -> Vec3<f64> {
        let mut y = [0.0; 3];
        for (j, b) in self.row(i) {
            let t = times(b, x[j]);
            for k in 0..3 {
                y[k] += t[k];
            }
        }
        y
    }

    /// A x, on all threads; the same bits whatever their number.
    pub fn multiply(&self, x: &[Vec3<f64>], y: &mut [Vec3<f64>]) {
        const CHUNK: usize = 512;
        y.par_chunks_mut(CHUNK).enumerate().for_each(|(c, y)| {
            for (k, y) in y.iter_mut().enumerate() {
                *y = self.row_times(c * CHUNK + k, x);
            }
        });
    }

    /// Diagonal block of a row.
    pub fn diagonal(&self, i: usize) -> &Block {
        &self.blocks[self.entry(i, i as u32)]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.blocks.len() * (size_of::<Block>() + 4) + self.start.len() * 8
    }
}
