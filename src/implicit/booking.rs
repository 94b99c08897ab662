//! What the road, the rim and every other force do to the body over a window of implicit increments.
//!
//! A force works along an increment's displacement with the mean of its values at both ends, at nodes under the
//! implicit Euler rule with its value at the end: what each rule integrates. So the energy balance closes to the
//! integrator's own dissipation: zero for average acceleration without contact and in statics, the loss of
//! momentum of landing nodes and the numerical damping otherwise.

use super::contact::Status;
use super::simulation::{Scheme, Simulation};
use crate::engine::{Probe, SurfaceSum, Window, Works};
use crate::physics::tensor::{Vec3, dot, scale, sub};

/// Sums since the last window, and the state at the end of the last increment.
pub struct Books {
    x: Vec<Vec3<f64>>,
    v: Vec<Vec3<f64>>,
    internal: Vec<Vec3<f64>>,
    contact: Vec<Vec3<f64>>,
    viscous_power: f64,
    window: Window,
}

impl Books {
    pub fn new(s: &Simulation<'_>) -> Books {
        let mut books = Books {
            x: Vec::new(),
            v: Vec::new(),
            internal: Vec::new(),
            contact: Vec::new(),
            viscous_power: 0.0,
            window: Window::default(),
        };
        books.remember(s);
        books.clear(s);
        books
    }

    fn remember(&mut self, s: &Simulation<'_>) {
        self.x.clone_from(&s.x);
        self.v.clone_from(&s.v);
        self.internal.clone_from(&s.internal);
        self.contact.clone_from(&s.contact);
        self.viscous_power = s.viscous_power;
    }

    fn clear(&mut self, s: &Simulation<'_>) {
        self.window = Window { surface: vec![SurfaceSum::default(); s.status.len()], ..Window::default() };
    }

    /// Books the increment of `dt` that `s` has just taken; mass damping `alpha` [1/s].
    pub fn book(&mut self, s: &Simulation<'_>, dt: f64, alpha: f64) {
        self.window.steps += 1;
        let in_time = s.scheme != Scheme::Static;
        let alpha = if in_time { alpha } else { 0.0 };
        for n in 0..s.x.len() {
            self.window.works.accumulate(&self.works(s, n, dt, alpha));
        }
        if in_time {
            let viscous = -0.5 * dt * (self.viscous_power + s.viscous_power);
            self.window.works.viscous += viscous;
            self.window.dissipated -= viscous;
            self.window.works.internal -= viscous;
        }
        let axle = [s.q[0], s.q[1], s.q[2]];
        let [force, moment] = s.problem.rim.resultant(axle, &s.x, |n| s.internal[n]);
        for i in 0..3 {
            self.window.rim_impulse[i] += dt * force[i];
            self.window.rim_moment_impulse[i] += dt * moment[i];
        }
        let sets = &s.problem.model.mesh.driven;
        self.window.reactions.resize(sets.len(), [0.0; 3]);
        for (sum, set) in self.window.reactions.iter_mut().zip(sets) {
            for d in (0..3).filter(|&d| set.components[d]) {
                sum[d] += dt * set.nodes.iter().map(|&n| s.internal[n as usize][d]).sum::<f64>();
            }
        }
        for (k, sum) in self.window.surface.iter_mut().enumerate() {
            let n = s.problem.model.mesh.surface[k] as usize;
            sum.touches = s.status[k] != Status::Free;
            sum.sticks = s.status[k] == Status::Stick;
            sum.touching += u32::from(sum.touches);
            sum.sticking += u32::from(sum.sticks);
            (0..3).for_each(|i| sum.impulse[i] += dt * s.contact[n][i]);
            if let Some(surface) = s.surface() {
                sum.road_work += dt * dot(s.contact[n], surface.road.velocity_over(s.x[n], dt));
            }
        }
        self.remember(s);
    }

    /// Works at a node over the last increment.
    fn works(&self, s: &Simulation<'_>, n: usize, dt: f64, alpha: f64) -> Works {
        let way = sub(s.x[n], self.x[n]);
        let mass = s.problem.model.mass[n];
        let weight = if s.euler[n] { [0.0, 1.0] } else { [0.5, 0.5] };
        let mean = |a: Vec3<f64>, b: Vec3<f64>| -> Vec3<f64> {
            std::array::from_fn(|i| weight[0] * a[i] + weight[1] * b[i])
        };
        let internal = mean(self.internal[n], s.internal[n]);
        let gravity = scale(s.problem.gravity, mass);
        let mut works =
            Works { internal: -dot(internal, way), body_force: dot(gravity, way), ..Works::default() };
        if s.problem.on_rim[n] {
            let inertia = if s.scheme == Scheme::Static { 0.0 } else { mass / dt };
            let net = scale(sub(s.v[n], self.v[n]), inertia);
            let way_of_inertia = scale(std::array::from_fn(|i| s.v[n][i] + self.v[n][i]), 0.5 * dt);
            works.rim = dot(sub(internal, gravity), way) + dot(net, way_of_inertia);
            return works;
        }
        works.damping = -alpha * mass * dot(mean(self.v[n], s.v[n]), way);
        if let Some(driven) = s.problem.driven.get(n) {
            // What drives a component balances all other forces, and gives it its inertia.
            let others = sub(sub(internal, gravity), scale(mean(self.v[n], s.v[n]), -alpha * mass));
            let inertia = if s.scheme == Scheme::Static { 0.0 } else { 0.5 * mass };
            let work = |d: usize| {
                others[d] * way[d] + inertia * (s.v[n][d] * s.v[n][d] - self.v[n][d] * self.v[n][d])
            };
            works.rim = (0..3).filter(|&d| driven[d]).map(work).sum();
        }
        let contact = mean(self.contact[n], s.contact[n]);
        if let Some(surface) = s.surface() {
            let normal = surface.road.normal(s.x[n]);
            let pressing = scale(normal, dot(contact, normal));
            works.normal = dot(pressing, way);
            works.friction = dot(sub(contact, pressing), way);
        }
        works
    }

    /// A window of one increment of `dt` in which everything stands as it does now: what a snapshot needs.
    pub fn standing(&mut self, s: &Simulation<'_>, dt: f64, residual: f64) -> Window {
        self.clear(s);
        for (sum, &n) in self.window.surface.iter_mut().zip(&s.problem.model.mesh.surface) {
            sum.impulse = scale(s.contact[n as usize], dt);
        }
        for (sum, status) in self.window.surface.iter_mut().zip(&s.status) {
            sum.touching = u32::from(*status != Status::Free);
            sum.sticking = u32::from(*status == Status::Stick);
        }
        self.window.steps = 1;
        self.take(s, residual)
    }

    /// Closes the window.
    pub fn take(&mut self, s: &Simulation<'_>, residual: f64) -> Window {
        let stored = s.problem.assembler.stored(&s.x);
        let mut window = std::mem::take(&mut self.window);
        self.clear(s);
        for (sum, &n) in window.surface.iter_mut().zip(&s.problem.model.mesh.surface) {
            (sum.x, sum.v) = (s.x[n as usize], s.v[n as usize]);
        }
        window.kinetic = s.v.iter().zip(&s.problem.model.mass).map(|(v, m)| 0.5 * m * dot(*v, *v)).sum();
        // Velocities belong to the moment itself: no half step to pair.
        window.probe = Probe {
            mixed_kinetic: window.kinetic,
            half_works: Works::default(),
            net_force: residual,
            internal_force: super::matrix::norm(&s.internal),
        };
        (window.rim, window.rim_rate) = (s.q, s.q_rate);
        (window.strain, window.hourglass, window.min_jacobian) =
            (stored.strain, stored.hourglass, stored.min_jacobian);
        window
    }
}
