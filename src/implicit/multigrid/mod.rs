//! A multigrid cycle as preconditioner, for meshes that came from a grid (mechanics: measured rates).
//!
//! Coarse operators are reassembled on coarser meshes at the fine mesh's positions, so they are consistent tangents
//! too. The smoother relaxes overlapping blocks of one element each, all its 24 unknowns at once: near
//! incompressibility a node alone cannot move without changing the volume, and relaxing nodes one by one smooths
//! nothing. Contact is honoured by truncation: a fine unknown that is fixed receives no coarse correction, and a
//! coarse node that stands where a fixed one does is fixed too.

mod smoother;
mod transfer;

use super::assembly::Assembler;
use super::direct::Direct;
use super::krylov::{LinearSolver, Preconditioner};
use super::matrix::{BlockMatrix, axpy};
use super::system::System;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::model::mesh::Mesh;
use crate::physics::tensor::Vec3;
use crate::scene::{Body, MeshSpec, Scene};
use smoother::ElementBlocks;
use transfer::Grid;
pub use transfer::Transfer;

/// Nodes of a coarsest mesh that a direct solution still takes in its stride.
const COARSEST: usize = 25_000;

/// A coarser mesh with the way to it from the next finer one.
struct Level {
    model: Model,
    transfer: Transfer,
    system: Option<System>,
    smoother: ElementBlocks,
}

/// V(1,1) cycles on a hierarchy of meshes.
pub struct Multigrid {
    /// Finest first; the mesh that is solved on is not among them.
    levels: Vec<Level>,
    hexes: Vec<[u32; 8]>,
    smoother: ElementBlocks,
    coarsest: Direct,
}

/// Halves the elements in every direction.
fn halved(spec: &MeshSpec) -> Option<MeshSpec> {
    let half = |e: [usize; 3], least: usize| {
        let even = e.iter().all(|n| n % 2 == 0) && e[0] / 2 >= least;
        even.then(|| e.map(|n| n / 2))
    };
    match *spec {
        MeshSpec::Ring { outer_radius, inner_radius, width, elements } => {
            let elements = half(elements, 8)?;
            Some(MeshSpec::Ring { outer_radius, inner_radius, width, elements })
        }
        MeshSpec::Block { size, elements } => Some(MeshSpec::Block { size, elements: half(elements, 1)? }),
    }
}

impl Multigrid {
    /// The hierarchy of a scene's mesh.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the mesh cannot be halved, or not down to what a direct solution can take.
    pub fn new(scene: &Scene, model: &Model) -> Result<Multigrid> {
        let mut levels = Vec::new();
        let mut spec = scene.body.mesh.clone();
        while let Some(coarser) = halved(&spec) {
            let body = Body { mesh: coarser.clone(), ..scene.body.clone() };
            let rim = scene.rim.as_ref().map(|r| r.nodes);
            let mesh = Mesh::graded(&coarser, &body.grading, body.offset, rim, &[]);
            // A coarse mesh so coarse that it is inside out ends the hierarchy.
            let Ok(coarse) = Model::from_mesh(mesh, &body) else { break };
            let transfer = Transfer::new(&Grid::new(&spec), &Grid::new(&coarser));
            let smoother = ElementBlocks::default();
            levels.push(Level { model: coarse, transfer, system: None, smoother });
            spec = coarser;
        }
        let coarsest = levels.last().map_or(model.node_count(), |l| l.model.node_count());
        if levels.is_empty() || coarsest > COARSEST {
            return Err(Error::Unsupported {
                what: format!(
                    "multigrid on {:?}, which can be halved {} times",
                    scene.body.mesh,
                    levels.len()
                ),
                instead: "use numbers of elements that are small numbers times powers of two, or \
                          linear = \"block-jacobi\""
                    .into(),
            });
        }
        Ok(Multigrid {
            levels,
            hexes: model.mesh.hexes.clone(),
            smoother: ElementBlocks::default(),
            coarsest: Direct::default(),
        })
    }

    /// Number of meshes, the finest included.
    pub fn depth(&self) -> usize {
        self.levels.len() + 1
    }

    /// x = cycle(b) on mesh `depth`, 0 being the finest.
    fn cycle(&mut self, depth: usize, fine: Option<&System>, b: &[Vec3<f64>], x: &mut [Vec3<f64>]) {
        x.fill([0.0; 3]);
        if depth == self.levels.len() {
            let system = self.levels[depth - 1].system.as_ref().expect("prepared");
            if let Some((y, _)) = self.coarsest.solve(system, b) {
                x.copy_from_slice(&y);
            }
            return;
        }
        // Taken out while the coarser meshes are borrowed.
        let own = depth.checked_sub(1).map(|d| self.levels[d].system.take().expect("prepared"));
        let system = own.as_ref().or(fine).expect("the finest system is given");
        self.smooth(depth, system, b, x, false);
        let mut r = vec![[0.0; 3]; b.len()];
        system.matrix.multiply(x, &mut r);
        for (r, b) in r.iter_mut().zip(b) {
            (0..3).for_each(|i| r[i] = b[i] - r[i]);
        }
        let level = &self.levels[depth];
        let coarse_system = level.system.as_ref().expect("prepared");
        let coarse_b = level.transfer.restrict(&r, system, coarse_system);
        let mut coarse_x = vec![[0.0; 3]; coarse_b.len()];
        self.cycle(depth + 1, None, &coarse_b, &mut coarse_x);
        let level = &self.levels[depth];
        let coarse_system = level.system.as_ref().expect("prepared");
        axpy(x, 1.0, &level.transfer.prolong(&coarse_x, system, coarse_system));
        self.smooth(depth, system, b, x, true);
        if let Some(d) = depth.checked_sub(1) {
            self.levels[d].system = own;
        }
    }

    fn smooth(&self, depth: usize, system: &System, b: &[Vec3<f64>], x: &mut [Vec3<f64>], backward: bool) {
        match depth {
            0 => self.smoother.sweep(&self.hexes, &system.matrix, b, x, backward),
            d => {
                let level = &self.levels[d - 1];
                level.smoother.sweep(&level.model.mesh.hexes, &system.matrix, b, x, backward);
            }
        }
    }
}

impl Level {
    /// Reassembles the coarse operator from the finer system's state.
    fn reassemble(&mut self, finer: &System) {
        let state = finer.state.injected(&self.transfer);
        let count = self.model.node_count();
        let mut matrix = BlockMatrix::of_mesh(count, &self.model.mesh.hexes);
        let assembler = Assembler::new(&self.model);
        assembler.tangent(&state.x, &state.v, &state.rate, &mut matrix);
        for n in 0..count {
            let entry = matrix.entry(n, n as u32);
            (0..3).for_each(|i| matrix.blocks[entry][i][i] += state.inertia[n] * self.model.mass[n]);
        }
        let at = |n: usize| self.transfer.coincident(n);
        let fixed = (0..count).map(|n| finer.fixed[at(n)]).collect();
        let frames = (0..count).map(|n| finer.columns[at(n)]).collect();
        self.system = Some(System::plain(matrix, fixed, frames, finer.symmetric, state));
    }
}

impl Preconditioner for Multigrid {
    fn prepare(&mut self, system: &System) -> Option<()> {
        self.smoother.prepare(&self.hexes, &system.matrix)?;
        for d in 0..self.levels.len() {
            let (finer, rest) = self.levels.split_at_mut(d);
            let level = &mut rest[0];
            level.reassemble(finer.last().map_or(Some(system), |l| l.system.as_ref()).expect("prepared"));
            let last = rest.len() == 1;
            let level = &mut self.levels[d];
            let own = level.system.as_ref().expect("just reassembled");
            if last {
                self.coarsest.prepare(own)?;
            } else {
                level.smoother.prepare(&level.model.mesh.hexes, &own.matrix)?;
            }
        }
        Some(())
    }

    fn apply(&mut self, system: &System, r: &[Vec3<f64>], z: &mut [Vec3<f64>]) {
        self.cycle(0, Some(system), r, z);
    }

    fn bytes(&self) -> usize {
        let level = |l: &Level| l.smoother.bytes() + l.system.as_ref().map_or(0, |s| s.matrix.bytes());
        self.smoother.bytes() + self.levels.iter().map(level).sum::<usize>() + self.coarsest.bytes()
    }
}
