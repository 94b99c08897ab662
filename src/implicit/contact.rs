//! Contact and friction of a node in an implicit increment: no multiplier, no penalty, no contact parameter.
//!
//! The contact force of a node that touches is its residual, lambda = r: what the body cannot balance there. With
//! N = n . lambda, T its tangential part, g the gap and s the slip over the increment relative to the road,
//!
//! ```text
//! g >= 0, N >= 0, N g = 0;   |T| <= mu N,  T = -mu N s/|s| where it slips (eqs. 8-10)
//! ```
//!
//! The active-set form: a node is active while N - c g > 0, sticks while |q| <= mu N with q = -T + c s, and slips
//! along q otherwise. The solution does not depend on c > 0 (here the node's own stiffness), only the path to it does.

use super::matrix::{Block, product, times, transposed};
use crate::physics::friction::{Friction, Sliding};
use crate::physics::road::Road;
use crate::physics::tensor::{Vec3, cross, dot, scale, sub};

/// What a node does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Status {
    #[default]
    Free,
    Stick,
    Slip,
}

/// Road and friction of an increment.
#[derive(Debug, Clone)]
pub struct Surface {
    pub road: Road,
    pub friction: Option<Friction>,
    /// One over the area of each surface node [1/m2], as of the start of the increment; empty unless friction looks at
    /// pressure.
    pub inverse_area: Vec<f64>,
    /// Length of the increment [s].
    pub dt: f64,
    /// Gap below which a node touches [m]: round-off of its position.
    pub touch: f64,
}

/// A surface node at an iterate.
#[derive(Debug, Clone, Copy)]
pub struct Local {
    /// Rows n, t1, t2.
    pub frame: Block,
    pub gap: f64,
    /// Slip over the increment relative to the road, along t1 and t2 [m].
    pub slip: [f64; 2],
    /// Normal and tangential force of the road on the node [N].
    pub normal: f64,
    pub tangential: [f64; 2],
    /// Coefficient at its slip speed, and at rest.
    pub mu: f64,
    pub mu_at_rest: f64,
    /// A stiffness of the node [N/m].
    pub c: f64,
}

/// The linear equations of a touching node: in place of its rows, `rows` of them plus `diagonal`, unknowns being
/// components in the frame; `known` where `fixed`.
#[derive(Debug, Clone, Copy)]
pub struct Equations {
    pub rows: Block,
    /// Columns n, t1, t2: from frame components to space.
    pub columns: Block,
    pub fixed: [bool; 3],
    pub known: [f64; 3],
    pub diagonal: Block,
    /// Right-hand side of the rows that are not fixed [N].
    pub rhs: [f64; 3],
}

/// n and two unit tangents, as rows.
pub fn frame(n: Vec3<f64>) -> Block {
    let least = (0..3).min_by(|&a, &b| n[a].abs().total_cmp(&n[b].abs())).unwrap_or(0);
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let t = cross(e, n);
    let t = scale(t, 1.0 / dot(t, t).sqrt());
    [n, t, cross(n, t)]
}

impl Surface {
    /// Motion of the road's surface point over the increment.
    fn carried(&self, start: Vec3<f64>) -> Vec3<f64> {
        self.road.carried(start, self.dt)
    }

    /// Coefficient of surface node `k` under a normal force [N], sliding at a speed [m/s].
    pub fn mu(&self, k: usize, normal_force: f64, slip_speed: f64) -> f64 {
        let pressure = normal_force.max(0.0) * self.inverse_area.get(k).copied().unwrap_or(0.0);
        self.friction.map_or(0.0, |law| law.coefficient(Sliding { pressure, slip_speed }))
    }

    /// Looks at surface node `k` that started at `start`, stands at `x` and has the residual `force`.
    pub fn local(&self, k: usize, start: Vec3<f64>, x: Vec3<f64>, force: Vec3<f64>, c: f64) -> Local {
        let frame = frame(self.road.normal(x));
        let s = times(&frame, sub(x, self.carried(start)));
        let f = times(&frame, force);
        let slip = [s[1], s[2]];
        let (mu, mu_at_rest) = (self.mu(k, f[0], length(slip) / self.dt), self.mu(k, f[0], 0.0));
        let tangential = [f[1], f[2]];
        Local { frame, gap: self.road.gap(x), slip, normal: f[0], tangential, mu, mu_at_rest, c }
    }

    /// The status that follows from an iterate.
    pub fn update(&self, status: Status, node: &Local) -> Status {
        let touched = if self.friction.is_some() { Status::Stick } else { Status::Slip };
        if status == Status::Free {
            return if node.gap < -self.touch { touched } else { Status::Free };
        }
        if node.normal - node.c * node.gap <= 0.0 {
            return Status::Free;
        }
        // What slides is caught by the friction of its sliding, what stands is let go by that of rest.
        let mu = if status == Status::Slip { node.mu.min(node.mu_at_rest) } else { node.mu_at_rest };
        if self.friction.is_some() && length(node.trial()) <= mu * node.normal {
            Status::Stick
        } else {
            Status::Slip
        }
    }
}

fn length(v: [f64; 2]) -> f64 {
    v[0].hypot(v[1])
}

impl Local {
    /// q = -T + c s
    fn trial(&self) -> [f64; 2] {
        [0, 1].map(|i| self.c * self.slip[i] - self.tangential[i])
    }

    /// Direction of q.
    fn direction(&self) -> [f64; 2] {
        let q = self.trial();
        let l = length(q);
        if l > 0.0 { q.map(|q| q / l) } else { [0.0; 2] }
    }

    /// How far the node is from its law [N]: zero where gap, slip and force obey it exactly.
    pub fn violation(&self, status: Status) -> Vec3<f64> {
        match status {
            Status::Free => {
                times(&transposed(&self.frame), [self.normal, self.tangential[0], self.tangential[1]])
            }
            Status::Stick => [self.c * self.gap, self.c * self.slip[0], self.c * self.slip[1]],
            Status::Slip => {
                let (d, f) = (self.direction(), self.mu * self.normal.max(0.0));
                [self.c * self.gap, self.tangential[0] + f * d[0], self.tangential[1] + f * d[1]]
            }
        }
    }

    /// The law, linearised.
    pub fn equations(&self, status: Status) -> Equations {
        let columns = transposed(&self.frame);
        let known = [-self.gap, -self.slip[0], -self.slip[1]];
        if status != Status::Slip {
            let fixed = [status == Status::Stick; 3];
            let rhs = [-self.normal, -self.tangential[0], -self.tangential[1]];
            return Equations { rows: self.frame, columns, fixed, known, diagonal: [[0.0; 3]; 3], rhs };
        }
        let (d, f) = (self.direction(), self.mu * self.normal.max(0.0));
        let q = length(self.trial());
        // mu N / |q| is below one where a node slips; just after a change of status it may not be.
        let beta = if q > 0.0 { (f / q).min(1.0) } else { 0.0 };
        let across = |i: usize, j: usize| f64::from(i == j) - d[i] * d[j];
        let mut mix = [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
        let mut diagonal = [[0.0; 3]; 3];
        for i in 0..2 {
            mix[i + 1][0] = self.mu * d[i];
            for j in 0..2 {
                mix[i + 1][j + 1] = f64::from(i == j) - beta * across(i, j);
                diagonal[i + 1][j + 1] = beta * self.c * across(i, j);
            }
        }
        let v = self.violation(status);
        Equations {
            rows: product(&mix, &self.frame),
            columns,
            fixed: [true, false, false],
            known,
            diagonal,
            rhs: [0.0, -v[1], -v[2]],
        }
    }
}
