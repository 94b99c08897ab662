//! Internal force and consistent tangent of the whole body.

use super::matrix::BlockMatrix;
use crate::error::Error;
use crate::instructions::compiled;
use crate::kernels::tangents::{ElementForce, ElementForces, Tangent, TangentPass};
use crate::model::Model;
use crate::physics::element::{Class, Corners};
use crate::physics::lanes::Level;
use crate::physics::tensor::Vec3;
use rayon::prelude::*;

/// Elements whose tangents are held at a time (4.6 kB each).
const BATCH: usize = 2048;

/// Element passes of a model.
pub struct Assembler<'a> {
    model: &'a Model,
    forces: Box<dyn ElementForces>,
    tangents: Box<dyn TangentPass>,
}

/// Internal force at a configuration.
#[derive(Debug, Clone, Default)]
pub struct Forces {
    /// f_int, shape `[node_count]` [N].
    pub internal: Vec<Vec3<f64>>,
    /// Viscous power [W].
    pub viscous_power: f64,
}

/// Stored energies at a configuration.
#[derive(Debug, Clone, Copy)]
pub struct Stored {
    /// [J]
    pub strain: f64,
    pub hourglass: f64,
    pub min_jacobian: f64,
}

impl<'a> Assembler<'a> {
    pub fn new(model: &'a Model) -> Self {
        let composition = model.composition();
        Assembler {
            model,
            forces: hexroll_kernels_portable::element_forces(&composition),
            tangents: compiled(Level::detect()).tangents(&composition),
        }
    }

    fn corners(&self, element: usize, field: &[Vec3<f64>]) -> Corners<f64> {
        self.model.mesh.hexes[element].map(|n| field[n as usize])
    }

    fn class(&self, element: usize) -> &Class<f64> {
        &self.model.classes[self.model.class_of[element] as usize]
    }

    /// Internal force. `Err(element)`: its det F is not positive (or not a number).
    pub fn forces(&self, x: &[Vec3<f64>], v: &[Vec3<f64>]) -> std::result::Result<Forces, usize> {
        let force = |e: usize| self.forces.force(self.class(e), &self.corners(e, x), &self.corners(e, v));
        let all: Vec<ElementForce> = (0..self.model.element_count()).into_par_iter().map(force).collect();
        if let Some(bad) =
            all.iter().position(|f| f.min_j.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater))
        {
            return Err(bad);
        }
        let mut internal = vec![[0.0; 3]; x.len()];
        for (hex, f) in self.model.mesh.hexes.iter().zip(&all) {
            for (&n, f) in hex.iter().zip(&f.f) {
                (0..3).for_each(|i| internal[n as usize][i] += f[i]);
            }
        }
        Ok(Forces { internal, viscous_power: all.iter().map(|f| f.viscous_power).sum() })
    }

    /// Consistent tangent df_int/dx, where dv_n = `rate[n]` dx_n [1/s], into a matrix of the mesh's pattern.
    pub fn tangent(&self, x: &[Vec3<f64>], v: &[Vec3<f64>], rate: &[f64], matrix: &mut BlockMatrix) {
        matrix.blocks.fill([[0.0; 3]; 3]);
        let count = self.model.element_count();
        for first in (0..count).step_by(BATCH) {
            let range = first..(first + BATCH).min(count);
            let tangents: Vec<Box<Tangent>> = range
                .clone()
                .into_par_iter()
                .map(|e| {
                    let rates = self.model.mesh.hexes[e].map(|n| rate[n as usize]);
                    self.tangents.tangent(self.class(e), &self.corners(e, x), &self.corners(e, v), &rates)
                })
                .collect();
            for (e, rows) in range.zip(&tangents) {
                scatter(&self.model.mesh.hexes[e], rows, matrix);
            }
        }
    }

    /// Stored energies.
    pub fn stored(&self, x: &[Vec3<f64>]) -> Stored {
        let energy = |e: usize| self.forces.energy(self.class(e), &self.corners(e, x));
        let all: Vec<_> = (0..self.model.element_count()).into_par_iter().map(energy).collect();
        Stored {
            strain: all.iter().map(|e| e.strain).sum(),
            hourglass: all.iter().map(|e| e.hourglass).sum(),
            min_jacobian: all.iter().map(|e| e.min_j).fold(f64::INFINITY, f64::min),
        }
    }

    /// The error of an element that cannot carry a force.
    pub fn failure(&self, element: usize, x: &[Vec3<f64>], step: u64, time: f64) -> Error {
        let finite = self.corners(element, x).iter().flatten().all(|c| c.is_finite());
        if finite {
            Error::Inverted { step, time, element }
        } else {
            Error::NotFinite { step, time, element }
        }
    }
}

fn scatter(hex: &[u32; 8], rows: &Tangent, matrix: &mut BlockMatrix) {
    for (a, &row) in hex.iter().enumerate() {
        for (b, &column) in hex.iter().enumerate() {
            let entry = matrix.entry(row as usize, column);
            let block = &mut matrix.blocks[entry];
            for i in 0..3 {
                for j in 0..3 {
                    block[i][j] += rows[a][i][3 * b + j];
                }
            }
        }
    }
}
