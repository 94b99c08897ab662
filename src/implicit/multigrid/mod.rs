//! A multigrid cycle for meshes that are lattices.
//!
//! Coarser grids keep every other node (an odd number of elements leaves one that is not doubled), down to a mesh that
//! is solved directly. Coarse operators are Galerkin products P^T A P: the contact conditions in A and the truncation
//! of P reach every level, so that no coarse correction moves an unknown that a touching node has fixed. The smoother
//! relaxes overlapping blocks of one element each, all its 24 unknowns at once: near incompressibility a node alone
//! cannot move without changing the volume, and relaxing nodes one by one smooths nothing (mechanics: measured rates).

mod grid;
mod smoother;
mod transfer;

use super::direct::Direct;
use super::krylov::{LinearSolver, Preconditioner};
use super::matrix::{Block, BlockMatrix, transposed};
use super::system::{System, mean_diagonal};
use crate::error::{Error, Result};
use crate::model::mesh::Mesh;
use crate::physics::tensor::Vec3;
use grid::Grid;
use smoother::{ElementBlocks, Way};
use transfer::Transfer;

/// Nodes of a mesh that is not coarsened any more: a direct solution costs less than a sweep over the finest mesh.
const COARSEST: usize = 800;
/// Nodes of a coarsest mesh that a direct solution still takes in its stride.
const DIRECT: usize = 25_000;
/// Added to coarse diagonals, relative to their mean. Where a coarse unknown reaches fixed fine unknowns alone its row
/// is zero; this makes it regular, and whatever comes out is multiplied by zero.
const SHIFT: f64 = 1e-8;

/// A mesh below the finest, with the way to it from the next finer one.
struct Level {
    transfer: Transfer,
    matrix: BlockMatrix,
    smoother: ElementBlocks,
}

/// V(1,1) cycles on a hierarchy of meshes.
pub struct Multigrid {
    /// Finest first; the mesh that is solved on is not among them.
    levels: Vec<Level>,
    elements: Vec<[usize; 3]>,
    smoother: ElementBlocks,
    /// Where interpolation ends on the finest mesh: in frames, and not in fixed unknowns.
    ends: Vec<Option<Block>>,
    coarsest: Direct,
    coarsest_system: Option<System>,
}

impl Multigrid {
    /// The hierarchy of a mesh.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the mesh is no lattice, is too small to coarsen, or has a direction that cannot be
    /// coarsened to what a direct solution can take.
    pub fn new(mesh: &Mesh) -> Result<Multigrid> {
        let other = |what: String| Error::Unsupported {
            what,
            instead: "use linear = \"direct\", or \"block-jacobi\"".into(),
        };
        let no_lattice = || other("multigrid on a mesh that is not numbered as a lattice".into());
        let finest = Grid::new(&mesh.lattice().ok_or_else(no_lattice)?);
        let mut elements = vec![finest.elements()];
        let smoother = ElementBlocks::new(finest.hexes(), finest.elements());
        let mut levels = Vec::new();
        let mut fine = finest;
        while let Some(coarse) = fine.coarser().filter(|_| levels.is_empty() || fine.node_count() > COARSEST)
        {
            let hexes = coarse.hexes();
            elements.push(coarse.elements());
            levels.push(Level {
                transfer: Transfer::new(&fine, &coarse),
                matrix: BlockMatrix::of_mesh(coarse.node_count(), &hexes),
                smoother: ElementBlocks::new(hexes, coarse.elements()),
            });
            fine = coarse;
        }
        if levels.is_empty() || fine.node_count() > DIRECT {
            let [i, j, k] = elements[0];
            let times = levels.len();
            return Err(other(format!("multigrid on {i} x {j} x {k} elements, coarsened {times} times")));
        }
        Ok(Multigrid {
            levels,
            elements,
            smoother,
            ends: Vec::new(),
            coarsest: Direct::default(),
            coarsest_system: None,
        })
    }

    /// Elements in every direction of every mesh, the finest first.
    pub fn elements(&self) -> &[[usize; 3]] {
        &self.elements
    }

    /// x = cycle(b) on mesh `depth`, 0 being the finest, whose matrix is `finest`.
    fn cycle(&mut self, depth: usize, finest: &BlockMatrix, b: &[Vec3<f64>], x: &mut [Vec3<f64>]) {
        x.fill([0.0; 3]);
        if depth == self.levels.len() {
            let system = self.coarsest_system.as_ref().expect("prepared");
            if let Some((y, _)) = self.coarsest.solve(system, b) {
                x.copy_from_slice(&y);
            }
            return;
        }
        self.smooth(depth, finest, b, x, Way::Forward);
        let mut r = vec![[0.0; 3]; b.len()];
        self.matrix(depth, finest).multiply(x, &mut r);
        for (r, b) in r.iter_mut().zip(b) {
            (0..3).for_each(|i| r[i] = b[i] - r[i]);
        }
        let coarse_b = self.levels[depth].transfer.restricted(self.ends(depth), &r);
        let mut coarse_x = vec![[0.0; 3]; coarse_b.len()];
        self.cycle(depth + 1, finest, &coarse_b, &mut coarse_x);
        self.levels[depth].transfer.add_prolonged(self.ends(depth), &coarse_x, x);
        self.smooth(depth, finest, b, x, Way::Backward);
    }

    fn matrix<'m>(&'m self, depth: usize, finest: &'m BlockMatrix) -> &'m BlockMatrix {
        depth.checked_sub(1).map_or(finest, |d| &self.levels[d].matrix)
    }

    fn ends(&self, depth: usize) -> &[Option<Block>] {
        if depth == 0 { &self.ends } else { &[] }
    }

    fn smooth(&self, depth: usize, finest: &BlockMatrix, b: &[Vec3<f64>], x: &mut [Vec3<f64>], way: Way) {
        let smoother = depth.checked_sub(1).map_or(&self.smoother, |d| &self.levels[d].smoother);
        smoother.sweep(self.matrix(depth, finest), b, x, way);
    }
}

/// Of every node that touches or has fixed unknowns: from a vector in space to its unknowns.
fn ends(system: &System) -> Vec<Option<Block>> {
    let one = |n: usize| {
        let fixed = system.fixed[n];
        if system.columns[n].is_none() && fixed == [false; 3] {
            return None;
        }
        const UNIT: Block = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut end = system.columns[n].map_or(UNIT, |c| transposed(&c));
        (0..3).filter(|&i| fixed[i]).for_each(|i| end[i] = [0.0; 3]);
        Some(end)
    };
    (0..system.fixed.len()).map(one).collect()
}

impl Preconditioner for Multigrid {
    fn prepare(&mut self, system: &System) -> Option<()> {
        self.smoother.prepare(&system.matrix)?;
        self.ends = ends(system);
        for d in 0..self.levels.len() {
            let (finer, rest) = self.levels.split_at_mut(d);
            let level = &mut rest[0];
            match finer.last() {
                None => level.transfer.galerkin(&self.ends, &system.matrix, &mut level.matrix),
                Some(finer) => level.transfer.galerkin(&[], &finer.matrix, &mut level.matrix),
            }
            let shift = SHIFT * mean_diagonal(&level.matrix);
            for n in 0..level.matrix.rows() {
                let entry = level.matrix.entry(n, n as u32);
                (0..3).for_each(|i| level.matrix.blocks[entry][i][i] += shift);
            }
            if rest.len() > 1 {
                let level = &mut rest[0];
                level.smoother.prepare(&level.matrix)?;
            }
        }
        let last = self.levels.last().expect("at least one");
        let system = System::bare(last.matrix.clone(), system.symmetric);
        self.coarsest.prepare(&system)?;
        self.coarsest_system = Some(system);
        Some(())
    }

    fn apply(&mut self, system: &System, r: &[Vec3<f64>], z: &mut [Vec3<f64>]) {
        self.cycle(0, &system.matrix, r, z);
    }

    fn bytes(&self) -> usize {
        let level = |l: &Level| l.smoother.bytes() + l.matrix.bytes();
        self.smoother.bytes() + self.levels.iter().map(level).sum::<usize>() + self.coarsest.bytes()
    }
}
