//! The equations of one increment: r(x) = f_int + effective inertia - loads = contact force (eqs. 20-22).

use super::assembly::Assembler;
use super::contact::{Local, Status, Surface};
use super::matrix::{BlockMatrix, norm};
use super::rim::RimNodes;
use crate::model::Model;
use crate::physics::rim::Coordinates;
use crate::physics::tensor::{Vec3, dot, sub};

/// A body with its boundary conditions.
pub struct Problem<'a> {
    pub model: &'a Model,
    pub assembler: Assembler<'a>,
    pub rim: RimNodes,
    /// Body force per mass [m/s2].
    pub gravity: [f64; 3],
    /// Whether a node is a rim node.
    pub on_rim: Vec<bool>,
    /// Components that do not follow from the equations: a rim node's, and those that the scene holds at rest.
    pub given: Vec<[bool; 3]>,
    /// Of these, the components that follow a motion; empty without one.
    pub driven: Vec<[bool; 3]>,
}

/// What stays the same during an increment. Per-node fields have shape `[node_count]`.
#[derive(Debug, Clone)]
pub struct Increment {
    /// Time at the end, and length [s].
    pub time: f64,
    pub dt: f64,
    /// Nodes that go by the implicit Euler rule.
    pub euler: Vec<bool>,
    /// Effective inertia m / (beta dt^2) [N/m] and its base point z: the inertia force is inertia (x - z).
    pub inertia: Vec<f64>,
    pub inertia_base: Vec<Vec3<f64>>,
    /// v = velocity_base + rate (x - rate_base).
    pub rate: Vec<f64>,
    pub rate_base: Vec<Vec3<f64>>,
    pub velocity_base: Vec<Vec3<f64>>,
    /// Mass damping [1/s].
    pub damping: f64,
    /// Positions at the start: slip is measured from there.
    pub start: Vec<Vec3<f64>>,
    pub surface: Option<Surface>,
    pub rim: RimIncrement,
    /// Node, component and position at the end of what follows a motion [m].
    pub driven: Vec<(u32, usize, f64)>,
}

/// The rim in an increment.
#[derive(Debug, Clone)]
pub struct RimIncrement {
    /// Coordinates at the end; those of free components are unknown.
    pub target: Coordinates,
    pub free: Vec<usize>,
    /// Loads on the free components at the end [N, N m].
    pub load: Coordinates,
    /// Effective inertia [N/m, N m] and its base.
    pub inertia: Coordinates,
    pub base: Coordinates,
}

/// The unknowns.
#[derive(Debug, Clone)]
pub struct Iterate {
    pub x: Vec<Vec3<f64>>,
    pub q: Coordinates,
    /// Of every surface node (empty without a road).
    pub status: Vec<Status>,
}

/// What an iterate amounts to.
#[derive(Debug, Clone)]
pub struct Residual {
    pub v: Vec<Vec3<f64>>,
    pub internal: Vec<Vec3<f64>>,
    /// r of every node; zero in equilibrium, the contact force where a node touches.
    pub r: Vec<Vec3<f64>>,
    /// Of the free rim components, in their order [N, N m].
    pub rim: Vec<f64>,
    /// The larger of ||f_int|| and the norm of the inertia forces [N]: what residuals are relative to.
    pub force_norm: f64,
    pub viscous_power: f64,
}

impl<'a> Problem<'a> {
    pub fn new(model: &'a Model, gravity: [f64; 3]) -> Self {
        let mut on_rim = vec![false; model.node_count()];
        model.mesh.rim.iter().for_each(|&n| on_rim[n as usize] = true);
        let mut given: Vec<[bool; 3]> = on_rim.iter().map(|&on| [on; 3]).collect();
        for (given, bits) in given.iter_mut().zip(&model.mesh.held) {
            (0..3).for_each(|d| given[d] |= bits >> d & 1 == 1);
        }
        let mut driven = vec![[false; 3]; if model.mesh.driven.is_empty() { 0 } else { model.node_count() }];
        for set in &model.mesh.driven {
            for &n in &set.nodes {
                (0..3).for_each(|d| driven[n as usize][d] |= set.components[d]);
            }
        }
        let (assembler, rim) = (Assembler::new(model), RimNodes::new(model));
        Problem { model, assembler, rim, gravity, on_rim, given, driven }
    }

    /// Where what follows a motion is at a time.
    pub fn driven_at(&self, time: f64) -> Vec<(u32, usize, f64)> {
        let mut all = Vec::new();
        for set in &self.model.mesh.driven {
            let pose = set.motion.pose(time);
            for &n in &set.nodes {
                let x = pose.place(set.arm(self.model.mesh.nodes[n as usize]));
                all.extend((0..3).filter(|&d| set.components[d]).map(|d| (n, d, x[d])));
            }
        }
        all
    }

    /// Whether the tangent is symmetric up to round-off: without viscosity, and in statics.
    pub fn symmetric(&self, inc: &Increment) -> bool {
        self.model.viscosity.is_none() || inc.rate.iter().all(|r| *r == 0.0)
    }

    /// Residual of an iterate. `Err(element)`: inverted.
    pub fn residual(&self, inc: &Increment, at: &Iterate) -> Result<Residual, usize> {
        let v: Vec<Vec3<f64>> = (0..at.x.len())
            .map(|n| {
                std::array::from_fn(|i| {
                    inc.velocity_base[n][i] + inc.rate[n] * (at.x[n][i] - inc.rate_base[n][i])
                })
            })
            .collect();
        let forces = self.assembler.forces(&at.x, &v)?;
        let r: Vec<Vec3<f64>> = (0..at.x.len())
            .map(|n| {
                let m = self.model.mass[n];
                std::array::from_fn(|i| {
                    forces.internal[n][i] - m * self.gravity[i]
                        + inc.inertia[n] * (at.x[n][i] - inc.inertia_base[n][i])
                        + inc.damping * m * v[n][i]
                })
            })
            .collect();
        let rim = inc.rim.free.iter().map(|&c| self.rim_residual(inc, at, c, &r)).collect();
        let inertia: f64 = (0..at.x.len())
            .map(|n| {
                let d = sub(at.x[n], inc.inertia_base[n]);
                inc.inertia[n] * inc.inertia[n] * dot(d, d)
            })
            .sum();
        let force_norm = norm(&forces.internal).max(inertia.sqrt());
        Ok(Residual { v, r, rim, force_norm, internal: forces.internal, viscous_power: forces.viscous_power })
    }

    fn rim_residual(&self, inc: &Increment, at: &Iterate, c: usize, r: &[Vec3<f64>]) -> f64 {
        let directions = self.rim.direction(&at.q, c);
        let pulled: f64 = self
            .rim
            .nodes
            .iter()
            .zip(&directions)
            .map(|(&n, d)| (0..3).map(|i| d[i] * r[n as usize][i]).sum::<f64>())
            .sum();
        pulled + inc.rim.inertia[c] * (at.q[c] - inc.rim.base[c]) - inc.rim.load[c]
    }

    /// K* = df_int/dx with the effective inertia (eq. 22).
    pub fn tangent(&self, inc: &Increment, at: &Iterate, v: &[Vec3<f64>], matrix: &mut BlockMatrix) {
        self.assembler.tangent(&at.x, v, &inc.rate, matrix);
        for n in 0..at.x.len() {
            let entry = matrix.entry(n, n as u32);
            let extra = inc.inertia[n] + inc.damping * self.model.mass[n] * inc.rate[n];
            (0..3).for_each(|i| matrix.blocks[entry][i][i] += extra);
        }
    }

    /// Surface node k at an iterate. `stiffness`: of every surface node [N/m].
    pub fn local(
        &self,
        inc: &Increment,
        at: &Iterate,
        r: &[Vec3<f64>],
        k: usize,
        stiffness: &[f64],
    ) -> Local {
        let n = self.model.mesh.surface[k] as usize;
        let surface = inc.surface.as_ref().expect("statuses exist only with a road");
        surface.local(k, inc.start[n], at.x[n], r[n], stiffness[k])
    }

    /// Norm of everything that should vanish (eq. 23's numerator) [N]: residuals of free nodes, departures from the
    /// contact law of touching ones, rim components (moments per length of the rim's arm).
    pub fn violation(&self, inc: &Increment, at: &Iterate, residual: &Residual, stiffness: &[f64]) -> f64 {
        let mut sum: f64 = 0.0;
        let square = |r: Vec3<f64>| r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        let mut done = self.on_rim.clone();
        for (k, &status) in at.status.iter().enumerate().filter(|(_, s)| **s != Status::Free) {
            done[self.model.mesh.surface[k] as usize] = true;
            sum += square(self.local(inc, at, &residual.r, k, stiffness).violation(status));
        }
        let free = residual.r.iter().zip(&self.given).zip(&done).filter(|(_, d)| !**d);
        sum += free.map(|((r, given), _)| square(without(*r, *given))).sum::<f64>();
        let arm = (self.rim.inertia / self.rim.mass.max(f64::MIN_POSITIVE)).sqrt();
        for (&c, &r) in inc.rim.free.iter().zip(&residual.rim) {
            let r = if c == crate::physics::rim::SPIN { r / arm } else { r };
            sum += r * r;
        }
        sum.sqrt()
    }
}

/// A force without its `given` components.
pub fn without(mut f: Vec3<f64>, given: [bool; 3]) -> Vec3<f64> {
    (0..3).filter(|&d| given[d]).for_each(|d| f[d] = 0.0);
    f
}
