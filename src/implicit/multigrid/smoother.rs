//! Multiplicative relaxation of overlapping element blocks (24 unknowns each).

use crate::implicit::matrix::BlockMatrix;
use crate::physics::lanes::{InLanes, Instructions, Lanes, Level};
use crate::physics::tensor::Vec3;
use rayon::prelude::*;

const N: usize = 24;

struct Relaxation<'a> {
    blocks: &'a ElementBlocks,
    element: u32,
    matrix: &'a BlockMatrix,
    b: &'a [Vec3<f64>],
    x: &'a Shared,
}

impl InLanes<f64> for Relaxation<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes<Real = f64>>(self) {
        self.blocks.relax_in::<L>(self.element, self.matrix, self.b, self.x);
    }
}

/// Inverses of every element's 24x24 part of the assembled matrix. In single precision: a smoother need not be exact,
/// and they are most of the memory.
pub struct ElementBlocks {
    inverses: Vec<[f32; N * N]>,
    hexes: Vec<[u32; 8]>,
    slabs: Slabs,
    level: Level,
}

impl ElementBlocks {
    /// Of a grid of `counts` elements, i fastest, with their nodes.
    pub fn new(hexes: Vec<[u32; 8]>, counts: [usize; 3]) -> ElementBlocks {
        ElementBlocks { inverses: Vec::new(), hexes, slabs: Slabs::new(counts), level: Level::detect() }
    }

    /// Inverts the blocks. `None`: one is singular.
    pub fn prepare(&mut self, matrix: &BlockMatrix) -> Option<()> {
        let blocks = self.hexes.par_iter().map(|hex| inverted(gathered(hex, matrix)));
        self.inverses = blocks.collect::<Option<_>>()?;
        Some(())
    }

    pub fn bytes(&self) -> usize {
        self.inverses.len() * size_of::<[f32; N * N]>()
    }

    /// One sweep over the elements, each solved exactly with the newest values around it: slab by slab, backward in
    /// the reverse order. The same bits whatever the number of threads.
    pub fn sweep(&self, matrix: &BlockMatrix, b: &[Vec3<f64>], x: &mut [Vec3<f64>], way: Way) {
        assert_eq!(x.len(), matrix.rows());
        let mut repeated: Vec<Repeated> = x.iter().map(|x| std::array::from_fn(|c| x[c % 3])).collect();
        let shared = Shared(repeated.as_mut_ptr());
        let phase = |slabs: &[Vec<u32>]| {
            slabs.par_iter().for_each(|elements| match way {
                Way::Forward => elements.iter().for_each(|&e| self.relax(e, matrix, b, &shared)),
                Way::Backward => {
                    elements.iter().rev().for_each(|&e| self.relax(e, matrix, b, &shared));
                }
            });
        };
        let [first, second] = &self.slabs.phases;
        match way {
            Way::Forward => [first, second],
            Way::Backward => [second, first],
        }
        .into_iter()
        .for_each(|slabs| phase(slabs));
        for (x, r) in x.iter_mut().zip(&repeated) {
            x.copy_from_slice(&r[..3]);
        }
    }

    fn relax(&self, element: u32, matrix: &BlockMatrix, b: &[Vec3<f64>], x: &Shared) {
        self.level.call(Relaxation { blocks: self, element, matrix, b, x });
    }

    /// A block's nine products with the three unknowns of its column are taken lane by lane and summed over the row first.
    #[inline(always)]
    fn relax_in<L: Lanes<Real = f64>>(
        &self,
        element: u32,
        matrix: &BlockMatrix,
        b: &[Vec3<f64>],
        x: &Shared,
    ) {
        let hex = &self.hexes[element as usize];
        let mut r = [0.0f32; N];
        for (a, &n) in hex.iter().enumerate() {
            let n = n as usize;
            let row = matrix.start[n]..matrix.start[n + 1];
            let mut lanes = [L::zero(); 4];
            let mut last = 0.0;
            for (&j, block) in matrix.columns[row.clone()].iter().zip(&matrix.blocks[row]) {
                let (entries, values) = (block.as_flattened().as_ptr(), x.get(j as usize));
                for k in 0..8 / L::WIDTH {
                    // SAFETY: a block has nine entries, and nine values stand beside each other.
                    let (entry, value) =
                        unsafe { (L::load(entries, k * L::WIDTH), L::load(values, k * L::WIDTH)) };
                    lanes[k] = entry.mul_add(value, lanes[k]);
                }
                // SAFETY: the ninth.
                last += block[2][2] * unsafe { *values.add(8) };
            }
            let mut sums = [0.0; 9];
            for k in 0..8 / L::WIDTH {
                // SAFETY: the first eight of nine.
                unsafe { lanes[k].store(sums.as_mut_ptr(), k * L::WIDTH) };
            }
            sums[8] = last;
            for i in 0..3 {
                r[3 * a + i] = (b[n][i] - (sums[3 * i] + sums[3 * i + 1] + sums[3 * i + 2])) as f32;
            }
        }
        let mut d = [0.0f32; N];
        let inverse = &self.inverses[element as usize];
        for c in 0..N {
            for i in 0..N {
                d[i] += inverse[c * N + i] * r[c];
            }
        }
        for (a, &n) in hex.iter().enumerate() {
            let d: Repeated = std::array::from_fn(|c| f64::from(d[3 * a + c % 3]));
            x.add(n as usize, &d);
        }
    }
}

/// A node's three unknowns, three times: what the nine entries of a block are multiplied with.
type Repeated = [f64; 9];

/// The way of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    Forward,
    Backward,
}

/// Elements in two phases of slabs across direction i. An element reads the nodes of its neighbours and writes its own:
/// slabs of a phase are more than two elements apart, so that none reads what another writes.
struct Slabs {
    phases: [Vec<Vec<u32>>; 2],
}

impl Slabs {
    /// Of a grid of `counts` elements, i fastest.
    fn new([ni, nj, nk]: [usize; 3]) -> Slabs {
        /// Thickness of a slab with the two elements that part it from the next one; fewer would leave the second
        /// phase's slabs too near to each other.
        const THICK: usize = 8;
        const APART: usize = 2;
        let count = ni / THICK;
        let slab = |from: usize, to: usize| -> Vec<u32> {
            let rows = (0..nj * nk).map(|row| row * ni);
            rows.flat_map(|row| (from..to).map(move |i| (row + i) as u32)).collect()
        };
        if count < 2 {
            return Slabs { phases: [vec![slab(0, ni)], Vec::new()] };
        }
        let start = |s: usize| s * ni / count;
        Slabs {
            phases: [
                (0..count).map(|s| slab(start(s), start(s + 1) - APART)).collect(),
                (0..count).map(|s| slab(start(s + 1) - APART, start(s + 1))).collect(),
            ],
        }
    }
}

/// Values that the slabs of a phase share.
struct Shared(*mut Repeated);

// SAFETY: slabs of a phase neither write what another one reads or writes (`Slabs`), and phases follow each other.
unsafe impl Sync for Shared {}

impl Shared {
    #[inline(always)]
    fn get(&self, n: usize) -> *const f64 {
        // SAFETY: n is a node of the matrix, whose rows are as many as the values (`sweep`); see above for threads.
        unsafe { self.0.add(n).cast() }
    }

    #[inline(always)]
    fn add(&self, n: usize, d: &Repeated) {
        // SAFETY: as in `get`.
        unsafe {
            let x = &mut *self.0.add(n);
            for c in 0..9 {
                x[c] += d[c];
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
    fn slabs_hold_every_element_once_and_those_of_a_phase_do_not_touch() {
        for counts in [[44, 5, 4], [17, 2, 3], [16, 1, 1], [9, 2, 2], [352, 1, 1]] {
            let slabs = Slabs::new(counts);
            let mut all: Vec<u32> = slabs.phases.iter().flatten().flatten().copied().collect();
            all.sort_unstable();
            assert!(all.iter().copied().eq(0..(counts.iter().product::<usize>()) as u32), "{counts:?}");
            for phase in &slabs.phases {
                let columns = |s: &Vec<u32>| s.iter().map(|e| *e as usize % counts[0]).collect::<Vec<_>>();
                let columns: Vec<_> = phase.iter().map(columns).collect();
                for (k, a) in columns.iter().enumerate() {
                    for b in columns.iter().skip(k + 1) {
                        // Around the ring: a column's nodes and their neighbours reach two columns further.
                        let apart = |a: usize, b: usize| a.abs_diff(b).min(counts[0] - a.abs_diff(b));
                        assert!(a.iter().all(|&a| b.iter().all(|&b| apart(a, b) > 2)), "{counts:?}");
                    }
                }
            }
        }
    }

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
