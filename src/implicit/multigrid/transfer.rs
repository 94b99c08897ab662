//! Between a mesh and the next coarser one: interpolation P, its transpose, and the Galerkin operator P^T A P.
//!
//! Interpolation is trilinear; on a ring of the cylindrical components, so that a rigid turn and a uniform pressure are
//! interpolated exactly. On the finest mesh P ends in the unknowns of the system: components in a touching node's
//! frame, and nothing where an unknown is fixed (the truncation of Graeser & Kornhuber, 2009).

use super::grid::{Grid, Part};
use crate::implicit::matrix::{Block, BlockMatrix, product, times, transposed};
use crate::physics::tensor::Vec3;
use rayon::prelude::*;

/// What a coarse node gives to a fine one.
#[derive(Debug, Clone, Copy)]
struct Share {
    coarse: u32,
    weight: f64,
    /// Entry of the turns.
    turn: u32,
}

/// The way from a node's vector in space to its unknowns; none where they are the same.
pub type Ends = [Option<Block>];

pub struct Transfer {
    /// Shares of fine node n: `shares[start[n]..start[n + 1]]`.
    start: Vec<u32>,
    shares: Vec<Share>,
    /// The same by coarse node: (fine node, share).
    coarse_start: Vec<u32>,
    to_fine: Vec<(u32, u32)>,
    /// Turns about the axle, by `ahead + zero` finest elements.
    turns: Vec<Block>,
    zero: u32,
}

impl Transfer {
    pub fn new(fine: &Grid, coarse: &Grid) -> Transfer {
        let mut start = vec![0u32];
        let mut shares: Vec<(Share, isize)> = Vec::new();
        fine.each_node(coarse, |parts| {
            push_shares(coarse, parts, &mut shares);
            start.push(shares.len() as u32);
        });
        let zero = shares.iter().map(|(_, ahead)| ahead.unsigned_abs()).max().unwrap_or(0);
        let turn = |ahead: usize| {
            let by = ahead as f64 - zero as f64;
            let angle = fine.round().map_or(0.0, |n| std::f64::consts::TAU * by / n as f64);
            let (s, c) = angle.sin_cos();
            // A turn about +y, the sense in which the generator counts.
            [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
        };
        let turns = (0..=2 * zero).map(turn).collect();
        let of = |(share, ahead): (Share, isize)| Share { turn: (zero as isize + ahead) as u32, ..share };
        let shares: Vec<Share> = shares.into_iter().map(of).collect();
        let (coarse_start, to_fine) = by_coarse(coarse.node_count(), &start, &shares);
        Transfer { start, shares, coarse_start, to_fine, turns, zero: zero as u32 }
    }

    fn of_fine(&self, n: usize) -> &[Share] {
        &self.shares[self.start[n] as usize..self.start[n + 1] as usize]
    }

    fn of_coarse(&self, n: usize) -> impl Iterator<Item = (usize, &Share)> {
        let range = self.coarse_start[n] as usize..self.coarse_start[n + 1] as usize;
        self.to_fine[range].iter().map(|&(f, s)| (f as usize, &self.shares[s as usize]))
    }

    pub fn coarse_count(&self) -> usize {
        self.coarse_start.len() - 1
    }

    fn turned(&self, turn: u32, v: Vec3<f64>) -> Vec3<f64> {
        if turn == self.zero { v } else { times(&self.turns[turn as usize], v) }
    }

    fn turned_back(&self, turn: u32, v: Vec3<f64>) -> Vec3<f64> {
        self.turned(2 * self.zero - turn, v)
    }

    /// x += P y
    pub fn add_prolonged(&self, ends: &Ends, coarse: &[Vec3<f64>], fine: &mut [Vec3<f64>]) {
        fine.par_iter_mut().enumerate().for_each(|(n, x)| {
            let mut sum = [0.0; 3];
            for share in self.of_fine(n) {
                let v = self.turned(share.turn, coarse[share.coarse as usize]);
                (0..3).for_each(|i| sum[i] += share.weight * v[i]);
            }
            if let Some(end) = end(ends, n) {
                sum = times(end, sum);
            }
            (0..3).for_each(|i| x[i] += sum[i]);
        });
    }

    /// P^T r
    pub fn restricted(&self, ends: &Ends, fine: &[Vec3<f64>]) -> Vec<Vec3<f64>> {
        let one = |n: usize| {
            let mut sum = [0.0; 3];
            for (f, share) in self.of_coarse(n) {
                let r = end(ends, f).map_or(fine[f], |end| times(&transposed(end), fine[f]));
                let v = self.turned_back(share.turn, r);
                (0..3).for_each(|i| sum[i] += share.weight * v[i]);
            }
            sum
        };
        (0..self.coarse_count()).into_par_iter().map(one).collect()
    }

    /// w end R: a block of P.
    fn block(&self, ends: &Ends, n: usize, share: &Share) -> Block {
        let turn = &self.turns[share.turn as usize];
        let block = end(ends, n).map_or(*turn, |end| product(end, turn));
        block.map(|row| row.map(|c| share.weight * c))
    }

    /// P^T A P into a matrix of the coarse mesh's pattern. Both grids are nested, so the product has that pattern.
    pub fn galerkin(&self, ends: &Ends, fine: &BlockMatrix, coarse: &mut BlockMatrix) {
        let BlockMatrix { start, columns, blocks } = coarse;
        let mut rows: Vec<&mut [Block]> = Vec::with_capacity(self.coarse_count());
        let mut rest = &mut blocks[..];
        for n in 0..self.coarse_count() {
            let (row, after) = rest.split_at_mut(start[n + 1] - start[n]);
            rows.push(row);
            rest = after;
        }
        let scratch = || Gather::new(fine.rows());
        rows.into_par_iter().enumerate().for_each_init(scratch, |gather, (n, row)| {
            let columns = &columns[start[n]..start[n + 1]];
            row.fill([[0.0; 3]; 3]);
            // Row n of P^T A first, then times P: each fine column is multiplied once.
            for (f, share) in self.of_coarse(n) {
                let left = transposed(&self.block(ends, f, share));
                for (m, a) in fine.row(f) {
                    add(gather.at(m), &product(&left, a));
                }
            }
            for (m, sum) in gather.drain() {
                for share in self.of_fine(m) {
                    let at =
                        columns.binary_search(&share.coarse).expect("the product has the mesh's pattern");
                    add(&mut row[at], &product(&sum, &self.block(ends, m, share)));
                }
            }
        });
    }
}

fn end(ends: &Ends, n: usize) -> Option<&Block> {
    ends.get(n).and_then(Option::as_ref)
}

fn add(a: &mut Block, b: &Block) {
    for i in 0..3 {
        (0..3).for_each(|j| a[i][j] += b[i][j]);
    }
}

/// A row that is being summed up: blocks of the columns met so far, in the order they were met.
struct Gather {
    place: Vec<u32>,
    met: Vec<(u32, Block)>,
}

impl Gather {
    const NONE: u32 = u32::MAX;

    fn new(columns: usize) -> Gather {
        Gather { place: vec![Gather::NONE; columns], met: Vec::new() }
    }

    fn at(&mut self, column: usize) -> &mut Block {
        if self.place[column] == Gather::NONE {
            self.place[column] = self.met.len() as u32;
            self.met.push((column as u32, [[0.0; 3]; 3]));
        }
        &mut self.met[self.place[column] as usize].1
    }

    fn drain(&mut self) -> impl Iterator<Item = (usize, Block)> {
        for (column, _) in &self.met {
            self.place[*column as usize] = Gather::NONE;
        }
        self.met.drain(..).map(|(column, block)| (column as usize, block))
    }
}

fn push_shares(coarse: &Grid, [i, j, k]: [&[Part]; 3], shares: &mut Vec<(Share, isize)>) {
    for i in i {
        for j in j {
            for k in k {
                let share = Share {
                    coarse: coarse.node(i.coarse, j.coarse, k.coarse) as u32,
                    weight: i.weight * j.weight * k.weight,
                    turn: 0,
                };
                shares.push((share, if coarse.round().is_some() { i.ahead } else { 0 }));
            }
        }
    }
}

fn by_coarse(count: usize, start: &[u32], shares: &[Share]) -> (Vec<u32>, Vec<(u32, u32)>) {
    let mut coarse_start = vec![0u32; count + 1];
    shares.iter().for_each(|s| coarse_start[s.coarse as usize + 1] += 1);
    for n in 0..count {
        coarse_start[n + 1] += coarse_start[n];
    }
    let mut next = coarse_start.clone();
    let mut to_fine = vec![(0, 0); shares.len()];
    for n in 0..start.len() - 1 {
        for s in start[n]..start[n + 1] {
            let slot = &mut next[shares[s as usize].coarse as usize];
            to_fine[*slot as usize] = (n as u32, s);
            *slot += 1;
        }
    }
    (coarse_start, to_fine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implicit::matrix::dot;
    use crate::model::mesh::Mesh;
    use crate::scene::MeshSpec;

    fn cases() -> [MeshSpec; 3] {
        let ring =
            |elements| MeshSpec::Ring { outer_radius: 0.04, inner_radius: 0.02, width: 0.02, elements };
        [ring([16, 4, 2]), ring([17, 3, 5]), MeshSpec::Block { size: [1.0, 2.0, 3.0], elements: [4, 3, 7] }]
    }

    #[test]
    fn positions_about_the_axle_are_interpolated_exactly() {
        for spec in cases() {
            let mesh = Mesh::generate(&spec);
            let fine = Grid::new(&mesh.lattice().unwrap());
            let coarse = fine.coarser().unwrap();
            let ring = fine.round().is_some();
            let arm = |x: &Vec3<f64>| -> Vec3<f64> {
                if ring { std::array::from_fn(|i| x[i] - mesh.axle[i]) } else { *x }
            };
            let t = Transfer::new(&fine, &coarse);
            // Coarse nodes are the fine nodes that take everything from one coarse node.
            let mut at_coarse = vec![[0.0; 3]; coarse.node_count()];
            for (n, x) in mesh.nodes.iter().enumerate() {
                if let [share] = t.of_fine(n) {
                    at_coarse[share.coarse as usize] = arm(x);
                }
            }
            // A field whose cylindrical components are linear.
            let mut sum = vec![[0.0; 3]; mesh.nodes.len()];
            t.add_prolonged(&[], &at_coarse, &mut sum);
            for (sum, x) in sum.iter().zip(&mesh.nodes) {
                let x = arm(x);
                assert!((0..3).all(|i| (sum[i] - x[i]).abs() < 1e-14), "{sum:?} {x:?}");
            }
        }
    }

    #[test]
    fn the_coarse_operator_is_the_one_between_the_transfers() {
        for spec in cases() {
            let fine = Grid::new(&Mesh::generate(&spec).lattice().unwrap());
            let coarse = fine.coarser().unwrap();
            let t = Transfer::new(&fine, &coarse);
            let mut a = BlockMatrix::of_mesh(fine.node_count(), &fine.hexes());
            let number = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
            a.blocks.iter_mut().flatten().flatten().enumerate().for_each(|(k, c)| *c = number(k));
            let mut ends = vec![None; fine.node_count()];
            ends[3] = Some([[0.0; 3]; 3]);
            ends[5] = Some([[0.6, 0.8, 0.0], [0.0; 3], [-0.8, 0.6, 0.0]]);
            let mut c = BlockMatrix::of_mesh(coarse.node_count(), &coarse.hexes());
            t.galerkin(&ends, &a, &mut c);
            let field = |seed: usize| -> Vec<Vec3<f64>> {
                (0..coarse.node_count()).map(|n| [0, 1, 2].map(|i| number(seed + 3 * n + i))).collect()
            };
            let (y, z) = (field(5), field(77));
            let mut py = vec![[0.0; 3]; fine.node_count()];
            let mut apy = py.clone();
            t.add_prolonged(&ends, &y, &mut py);
            a.multiply(&py, &mut apy);
            let mut cy = vec![[0.0; 3]; coarse.node_count()];
            c.multiply(&y, &mut cy);
            let restricted = t.restricted(&ends, &apy);
            // Sums of thousands of products of order one.
            assert!(cy.iter().flatten().zip(restricted.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-11));
            let mut pz = vec![[0.0; 3]; fine.node_count()];
            t.add_prolonged(&ends, &z, &mut pz);
            assert!((dot(&pz, &apy) - dot(&z, &cy)).abs() < 1e-10);
        }
    }
}
