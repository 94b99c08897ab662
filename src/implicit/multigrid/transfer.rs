//! Between a mesh and the one with half the elements in every direction.

use crate::implicit::matrix::{Block, times, transposed};
use crate::implicit::system::System;
use crate::physics::tensor::Vec3;
use crate::scene::MeshSpec;
use rayon::prelude::*;

/// A generated mesh's logical grid, numbered as [`crate::model::mesh`] does: j fastest, then i, then k.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    counts: [usize; 3],
    /// Whether direction i closes on itself; then it is a turn about the axle.
    wrap: bool,
}

impl Grid {
    pub fn new(spec: &MeshSpec) -> Grid {
        match *spec {
            MeshSpec::Ring { elements: [nc, nr, nw], .. } => Grid { counts: [nc, nw, nr], wrap: true },
            MeshSpec::Block { elements, .. } => Grid { counts: elements, wrap: false },
        }
    }

    fn rows(&self) -> usize {
        self.counts[0] + usize::from(!self.wrap)
    }

    fn node(&self, i: usize, j: usize, k: usize) -> usize {
        (k * (self.counts[1] + 1) + j) * self.rows() + i % self.rows()
    }

    fn node_count(&self) -> usize {
        self.rows() * (self.counts[1] + 1) * (self.counts[2] + 1)
    }
}

/// What a coarse node gives to a fine one.
#[derive(Debug, Clone, Copy)]
struct Share {
    coarse: u32,
    weight: f64,
    /// Turn from the coarse node's place on the ring to the fine one's, in half coarse elements.
    turn: i8,
}

/// Trilinear interpolation; on a ring of the cylindrical components, so that a rigid turn and a uniform pressure are
/// interpolated exactly.
pub struct Transfer {
    /// Shares of fine node n: `shares[start[n]..start[n + 1]]`.
    start: Vec<u32>,
    shares: Vec<Share>,
    /// The same by coarse node: (fine node, share index).
    coarse_start: Vec<u32>,
    to_fine: Vec<(u32, u32)>,
    /// Fine node at every coarse node.
    coincident: Vec<u32>,
    /// Turn of half a coarse element about the axle.
    half_turn: Block,
}

impl Transfer {
    pub fn new(fine: &Grid, coarse: &Grid) -> Transfer {
        let mut start = vec![0u32];
        let mut shares = Vec::new();
        for k in 0..=fine.counts[2] {
            for j in 0..=fine.counts[1] {
                for i in 0..fine.rows() {
                    push_shares(coarse, [i, j, k], &mut shares);
                    start.push(shares.len() as u32);
                }
            }
        }
        let mut coincident = vec![0; coarse.node_count()];
        for k in 0..=coarse.counts[2] {
            for i in 0..coarse.rows() {
                for j in 0..=coarse.counts[1] {
                    coincident[coarse.node(i, j, k)] = fine.node(2 * i, 2 * j, 2 * k) as u32;
                }
            }
        }
        let angle = if coarse.wrap { std::f64::consts::PI / coarse.counts[0] as f64 } else { 0.0 };
        let (s, c) = angle.sin_cos();
        // A turn about +y, the sense in which the generator counts.
        let half_turn = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]];
        let (coarse_start, to_fine) = by_coarse(coincident.len(), &start, &shares);
        Transfer { start, shares, coarse_start, to_fine, coincident, half_turn }
    }

    /// Fine node that stands where coarse node n does.
    pub fn coincident(&self, n: usize) -> usize {
        self.coincident[n] as usize
    }

    pub fn coarse_count(&self) -> usize {
        self.coincident.len()
    }

    fn turned(&self, turn: i8, v: Vec3<f64>) -> Vec3<f64> {
        match turn {
            0 => v,
            1 => times(&self.half_turn, v),
            _ => times(&transposed(&self.half_turn), v),
        }
    }

    /// Fine unknowns from coarse ones, nothing where a fine unknown is fixed.
    pub fn prolong(
        &self,
        coarse: &[Vec3<f64>],
        fine_system: &System,
        coarse_system: &System,
    ) -> Vec<Vec3<f64>> {
        let space: Vec<Vec3<f64>> = (0..coarse.len()).map(|n| coarse_system.to_space(n, coarse[n])).collect();
        (0..self.start.len() - 1)
            .into_par_iter()
            .map(|n| {
                let mut sum = [0.0; 3];
                for share in &self.shares[self.start[n] as usize..self.start[n + 1] as usize] {
                    let v = self.turned(share.turn, space[share.coarse as usize]);
                    (0..3).for_each(|i| sum[i] += share.weight * v[i]);
                }
                fine_system.truncated(n, fine_system.to_frame(n, sum))
            })
            .collect()
    }

    /// The transpose of [`Transfer::prolong`].
    pub fn restrict(
        &self,
        fine: &[Vec3<f64>],
        fine_system: &System,
        coarse_system: &System,
    ) -> Vec<Vec3<f64>> {
        let space: Vec<Vec3<f64>> = (0..fine.len())
            .into_par_iter()
            .map(|n| fine_system.to_space(n, fine_system.truncated(n, fine[n])))
            .collect();
        (0..self.coarse_count())
            .into_par_iter()
            .map(|n| {
                let mut sum = [0.0; 3];
                let range = self.coarse_start[n] as usize..self.coarse_start[n + 1] as usize;
                for &(f, share) in &self.to_fine[range] {
                    let share = &self.shares[share as usize];
                    let v = self.turned(-share.turn, space[f as usize]);
                    (0..3).for_each(|i| sum[i] += share.weight * v[i]);
                }
                coarse_system.truncated(n, coarse_system.to_frame(n, sum))
            })
            .collect()
    }
}

fn push_shares(coarse: &Grid, at: [usize; 3], shares: &mut Vec<Share>) {
    let sides = |c: usize| -> Vec<(usize, i8)> {
        if c.is_multiple_of(2) { vec![(c / 2, 0)] } else { vec![(c / 2, 1), (c / 2 + 1, -1)] }
    };
    let [i, j, k] = at.map(sides);
    let weight = 1.0 / (i.len() * j.len() * k.len()) as f64;
    for &(i, side) in &i {
        for &(j, _) in &j {
            for &(k, _) in &k {
                let turn = if coarse.wrap { side } else { 0 };
                shares.push(Share { coarse: coarse.node(i, j, k) as u32, weight, turn });
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
    use crate::model::mesh::Mesh;

    #[test]
    fn coarse_nodes_stand_on_fine_ones_and_neighbours_around() {
        let ring =
            |elements| MeshSpec::Ring { outer_radius: 0.039, inner_radius: 0.017, width: 0.0175, elements };
        let block = |elements| MeshSpec::Block { size: [1.0, 2.0, 3.0], elements };
        for (fine, coarse) in [(ring([16, 4, 2]), ring([8, 2, 1])), (block([4, 2, 6]), block([2, 1, 3]))] {
            let [f, c] = [&fine, &coarse].map(|s| Mesh::generate(s, [0.0; 3], None));
            let t = Transfer::new(&Grid::new(&fine), &Grid::new(&coarse));
            assert_eq!(t.start.len() - 1, f.nodes.len());
            for (n, x) in c.nodes.iter().enumerate() {
                let y = f.nodes[t.coincident(n)];
                assert!((0..3).all(|i| (x[i] - y[i]).abs() < 1e-14), "{n}");
            }
            // Positions about the axle are a field whose cylindrical components are linear: interpolated exactly.
            for (n, x) in f.nodes.iter().enumerate() {
                let arm = |x: &[f64; 3]| -> Vec3<f64> {
                    if Grid::new(&fine).wrap { std::array::from_fn(|i| x[i] - f.axle[i]) } else { *x }
                };
                let mut sum = [0.0; 3];
                for s in &t.shares[t.start[n] as usize..t.start[n + 1] as usize] {
                    let v = t.turned(s.turn, arm(&c.nodes[s.coarse as usize]));
                    (0..3).for_each(|i| sum[i] += s.weight * v[i]);
                }
                let x = arm(x);
                assert!((0..3).all(|i| (sum[i] - x[i]).abs() < 1e-14), "{n}: {sum:?} {x:?}");
            }
        }
    }
}
