//! A body that is taken from one equilibrium, or one moment, to the next.
//!
//! In time: Newmark with the modified average acceleration, gamma = 1/2 + delta, beta = (1 + delta)^2/4
//! (eqs. 17-18). Surface nodes that touch, or would within the step, go by the implicit Euler rule instead:
//! v(n+1) = (x(n+1) - x(n))/dt, so that a landing node gives up its normal momentum (a plastic impact, as in the
//! explicit scheme) and a landed one is not thrown back. Average acceleration would return it, and the contact force
//! would ring.

use super::contact::{Status, Surface};
use super::linearised::Failure;
use super::newton::{Converged, Iteration, Newton};
use super::problem::{Increment, Iterate, Problem, RimIncrement, without};
use crate::engine::State;
use crate::model::areas::inverse_areas;
use crate::physics::rim::Coordinates;
use crate::physics::tensor::{Vec3, axpy, dot, sub};

/// Statics or dynamics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// Equilibria along the path of the loads: no inertia, no viscosity, no mass damping.
    Static,
    /// Newmark; `delta` >= 0 is the numerical damping.
    Dynamic { delta: f64 },
}

/// Where the rim should be at the end of an increment, and when that is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// [s]
    pub time: f64,
    pub dt: f64,
    /// Coordinates; those of free components are not read.
    pub rim: Coordinates,
    pub load: Coordinates,
    /// Own mass or inertia of the free components.
    pub free: [Option<f64>; 6],
    /// Mass damping [1/s].
    pub damping: f64,
}

/// A body at a moment.
pub struct Simulation<'a> {
    pub problem: Problem<'a>,
    pub newton: Newton,
    pub scheme: Scheme,
    /// Road and friction; its `dt` is that of the last increment.
    surface: Option<Surface>,
    pub time: f64,
    pub x: Vec<Vec3<f64>>,
    pub v: Vec<Vec3<f64>>,
    /// Acceleration at this moment [m/s2]; not read of nodes that touch.
    a: Vec<Vec3<f64>>,
    pub q: Coordinates,
    pub q_rate: Coordinates,
    q_acceleration: Coordinates,
    pub status: Vec<Status>,
    /// Nodes that went by the implicit Euler rule in the last step.
    pub euler: Vec<bool>,
    /// f_int and the road's force, shape `[node_count]` [N].
    pub internal: Vec<Vec3<f64>>,
    pub contact: Vec<Vec3<f64>>,
    pub viscous_power: f64,
}

impl<'a> Simulation<'a> {
    /// Starts from positions and velocities; the rim stands at `q` and moves at `q_rate` where it is free.
    pub fn new(
        problem: Problem<'a>,
        newton: Newton,
        scheme: Scheme,
        surface: Option<Surface>,
        state: State,
        rim: [Coordinates; 2],
    ) -> Simulation<'a> {
        let nodes = state.x.len();
        let touched =
            if surface.as_ref().is_some_and(|s| s.friction.is_some()) { Status::Stick } else { Status::Slip };
        let status = match &surface {
            None => Vec::new(),
            Some(s) => {
                let at = |&n: &u32| s.road.gap(state.x[n as usize]) <= s.touch;
                problem
                    .model
                    .mesh
                    .surface
                    .iter()
                    .map(|n| if at(n) { touched } else { Status::Free })
                    .collect()
            }
        };
        Simulation {
            problem,
            newton,
            scheme,
            surface,
            time: 0.0,
            x: state.x,
            v: state.v,
            a: vec![[0.0; 3]; nodes],
            q: rim[0],
            q_rate: rim[1],
            q_acceleration: [0.0; 6],
            status,
            euler: vec![false; nodes],
            internal: vec![[0.0; 3]; nodes],
            contact: vec![[0.0; 3]; nodes],
            viscous_power: 0.0,
        }
    }

    /// Road and friction, if there is a road.
    pub fn surface(&self) -> Option<&Surface> {
        self.surface.as_ref()
    }

    /// Accelerations and contact states at the start, from the forces there; `target.dt` is not read.
    ///
    /// # Errors
    /// The element that is inverted.
    pub fn start(&mut self, target: &Target) -> Result<(), Failure> {
        self.time = target.time - target.dt;
        let forces = self
            .problem
            .assembler
            .forces(&self.x, &self.v)
            .map_err(|element| Failure::Inverted { element })?;
        self.internal = forces.internal;
        self.viscous_power = forces.viscous_power;
        for n in 0..self.x.len() {
            let m = self.problem.model.mass[n];
            self.a[n] = std::array::from_fn(|i| {
                self.problem.gravity[i] - self.internal[n][i] / m - target.damping * self.v[n][i]
            });
            if !self.problem.on_rim[n] {
                self.a[n] = without(self.a[n], self.problem.given[n]);
            }
        }
        for c in 0..6 {
            let Some(own) = target.free[c] else { continue };
            let inertia = own + self.problem.rim.node_inertia(c);
            let directions = self.problem.rim.direction(&self.q, c);
            let pull: f64 = (self.problem.rim.nodes.iter().zip(&directions))
                .map(|(&n, d)| {
                    let m = self.problem.model.mass[n as usize];
                    (0..3)
                        .map(|i| d[i] * (m * self.problem.gravity[i] - self.internal[n as usize][i]))
                        .sum::<f64>()
                })
                .sum();
            self.q_acceleration[c] = (pull + target.load[c]) / inertia - target.damping * self.q_rate[c];
        }
        Ok(())
    }

    /// Takes an increment; on failure nothing has changed. The log has one entry an iteration.
    pub fn step(&mut self, target: &Target) -> Result<Vec<Iteration>, Failure> {
        self.step_unless(target, &|| false)
    }

    /// The same unless `stop` says so between two iterations: then it fails as [`Failure::Interrupted`].
    pub fn step_unless(
        &mut self,
        target: &Target,
        stop: &dyn Fn() -> bool,
    ) -> Result<Vec<Iteration>, Failure> {
        let increment = self.increment(target);
        let at = Iterate { x: self.x.clone(), q: self.q, status: self.status.clone() };
        let done = self.newton.solve(&self.problem, &increment, at, stop)?;
        self.accept(target, &increment, done);
        Ok(self.newton.log().to_vec())
    }

    /// The equations of an increment.
    pub fn increment(&self, target: &Target) -> Increment {
        let surface = self.surface.as_ref().map(|s| self.surface_over(s, target.dt));
        let count = self.x.len();
        let mut inc = Increment {
            time: target.time,
            dt: target.dt,
            euler: vec![false; count],
            inertia: vec![0.0; count],
            inertia_base: self.x.clone(),
            rate: vec![0.0; count],
            rate_base: self.x.clone(),
            velocity_base: vec![[0.0; 3]; count],
            damping: 0.0,
            start: self.x.clone(),
            surface,
            rim: self.rim_increment(target),
            driven: self.problem.driven_at(target.time),
        };
        if let Scheme::Dynamic { delta } = self.scheme {
            inc.damping = target.damping;
            inc.euler = self.euler_nodes(target.dt, self.surface.as_ref());
            for n in 0..count {
                self.in_time(n, [target.dt, delta], &mut inc);
            }
        }
        inc
    }

    /// Road and friction of an increment of `dt` from here.
    fn surface_over(&self, surface: &Surface, dt: f64) -> Surface {
        let mesh = &self.problem.model.mesh;
        let inverse_area = match surface.friction {
            Some(law) if law.needs_area() => inverse_areas(mesh, |n| self.x[n as usize], &surface.road),
            _ => Vec::new(),
        };
        Surface { dt, inverse_area, ..surface.clone() }
    }

    /// Nodes that touch, or would within the step at their present speed and acceleration.
    fn euler_nodes(&self, dt: f64, surface: Option<&Surface>) -> Vec<bool> {
        let mut euler = vec![false; self.x.len()];
        let Some(surface) = surface else { return euler };
        for (k, &n) in self.problem.model.mesh.surface.iter().enumerate() {
            let n = n as usize;
            let (x, normal) = (self.x[n], surface.road.normal(self.x[n]));
            let sinking =
                (dt * dot(self.v[n], normal)).min(0.0) + (0.5 * dt * dt * dot(self.a[n], normal)).min(0.0);
            euler[n] = self.status[k] != Status::Free || surface.road.gap(x) + sinking <= surface.touch;
        }
        euler
    }

    /// Inertia and velocity rule of a node.
    fn in_time(&self, n: usize, [dt, delta]: [f64; 2], inc: &mut Increment) {
        let (mass, x, v) = (self.problem.model.mass[n], self.x[n], self.v[n]);
        let [gamma, beta] = newmark(delta);
        if self.problem.on_rim[n] {
            // It goes where the rim goes; its inertia is the rim's.
            (inc.rate[n], inc.rate_base[n], inc.velocity_base[n]) = (1.0 / dt, x, [0.0; 3]);
        } else if inc.euler[n] {
            inc.inertia[n] = mass / (dt * dt);
            inc.inertia_base[n] = axpy(v, dt, x);
            (inc.rate[n], inc.rate_base[n], inc.velocity_base[n]) = (1.0 / dt, x, [0.0; 3]);
        } else {
            let z = axpy(self.a[n], (0.5 - beta) * dt * dt, axpy(v, dt, x));
            inc.inertia[n] = mass / (beta * dt * dt);
            inc.inertia_base[n] = z;
            inc.rate[n] = gamma / (beta * dt);
            inc.rate_base[n] = z;
            inc.velocity_base[n] = axpy(self.a[n], (1.0 - gamma) * dt, v);
        }
    }

    fn rim_increment(&self, target: &Target) -> RimIncrement {
        let free: Vec<usize> = (0..6).filter(|&c| target.free[c].is_some()).collect();
        let mut rim =
            RimIncrement { target: target.rim, free, load: target.load, inertia: [0.0; 6], base: self.q };
        let Scheme::Dynamic { delta } = self.scheme else { return rim };
        let [gamma, beta] = newmark(delta);
        let dt = target.dt;
        for &c in &rim.free {
            let own = target.free[c].unwrap_or(0.0) + self.problem.rim.node_inertia(c);
            rim.base[c] = self.q[c] + dt * self.q_rate[c] + (0.5 - beta) * dt * dt * self.q_acceleration[c];
            // Damping alpha I dq/dt, dq/dt = base rate + gamma / (beta dt) (q - base).
            let base_rate = self.q_rate[c] + dt * (1.0 - gamma) * self.q_acceleration[c];
            rim.inertia[c] = own / (beta * dt * dt) + target.damping * own * gamma / (beta * dt);
            rim.load[c] -= target.damping * own * base_rate;
        }
        rim
    }

    fn accept(&mut self, target: &Target, inc: &Increment, done: Converged) {
        let Converged { at, residual } = done;
        let dt = target.dt;
        if let Scheme::Dynamic { delta } = self.scheme {
            self.accept_rates(target, &at.q, delta);
            let mut v = residual.v;
            for (k, &n) in self.problem.model.mesh.surface.iter().enumerate() {
                // A node that touched unforeseen lands like the others.
                if at.status.get(k).is_some_and(|s| *s != Status::Free) {
                    v[n as usize] = sub(at.x[n as usize], self.x[n as usize]).map(|c| c / dt);
                }
            }
            for n in 0..v.len() {
                self.a[n] = if inc.euler[n] {
                    sub(v[n], self.v[n]).map(|c| c / dt)
                } else {
                    let scale = inc.inertia[n] / self.problem.model.mass[n];
                    sub(at.x[n], inc.inertia_base[n]).map(|c| c * scale)
                };
            }
            self.v = v;
        } else {
            self.v.fill([0.0; 3]);
            self.q_rate = [0.0; 6];
        }
        self.contact.fill([0.0; 3]);
        for (k, &n) in self.problem.model.mesh.surface.iter().enumerate() {
            if at.status.get(k).is_some_and(|s| *s != Status::Free) {
                self.contact[n as usize] = residual.r[n as usize];
            }
        }
        self.euler.clone_from(&inc.euler);
        (self.x, self.q, self.status) = (at.x, at.q, at.status);
        (self.internal, self.viscous_power) = (residual.internal, residual.viscous_power);
        self.time = target.time;
    }

    fn accept_rates(&mut self, target: &Target, q: &Coordinates, delta: f64) {
        let [gamma, beta] = newmark(delta);
        let dt = target.dt;
        for c in 0..6 {
            if target.free[c].is_none() {
                (self.q_rate[c], self.q_acceleration[c]) = ((q[c] - self.q[c]) / dt, 0.0);
                continue;
            }
            let base = self.q[c] + dt * self.q_rate[c] + (0.5 - beta) * dt * dt * self.q_acceleration[c];
            let new = (q[c] - base) / (beta * dt * dt);
            self.q_rate[c] += dt * ((1.0 - gamma) * self.q_acceleration[c] + gamma * new);
            self.q_acceleration[c] = new;
        }
    }
}

/// gamma and beta of the modified average acceleration.
fn newmark(delta: f64) -> [f64; 2] {
    [0.5 + delta, 0.25 * (1.0 + delta) * (1.0 + delta)]
}
