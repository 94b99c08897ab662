//! The node pass: gather, acceleration, contact projection, integration, and the book-keeping of every force.

use super::team::Shared;
use crate::engine::{SurfaceSum, Works};
use crate::physics::contact::{self, Touch};
use crate::physics::element::Corners;
use crate::physics::friction::Coulomb;
use crate::physics::node::{self, Loads, StepSize};
use crate::physics::road::Plane;
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, add, axpy, scale, sub};
use std::ops::Range;

/// Nodes whose sums are kept together.
pub const CHUNK: usize = 64;

/// What a node is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Interior,
    /// Can touch the road; index among the surface nodes.
    Surface(u32),
    /// Moves with the rim; index among the rim nodes.
    Rim(u32),
}

/// Constant data of the node pass.
pub struct Nodes<S> {
    pub mass: Vec<S>,
    pub corner_start: Vec<u32>,
    pub corners: Vec<u32>,
    pub roles: Vec<Role>,
    /// Rim nodes' positions relative to the axle in the reference orientation.
    pub rim_arms: Vec<[f64; 3]>,
}

impl<S: Real> Nodes<S> {
    /// Internal force of a node: its corners' slots in fixed order.
    #[inline(always)]
    pub fn gather(&self, n: usize, slots: &Shared<'_, Corners<S>>) -> Vec3<S> {
        let row = self.corner_start[n] as usize..self.corner_start[n + 1] as usize;
        let mut f = [S::zero(); 3];
        for &slot in &self.corners[row] {
            // SAFETY: slots are only read between the element pass and the next one.
            f = add(f, unsafe { slots.get((slot >> 3) as usize) }[(slot & 7) as usize]);
        }
        f
    }
}

/// Everything that is the same for all nodes of a step.
pub struct Conditions<S> {
    pub step: StepSize<S>,
    pub loads: Loads<S>,
    pub road: Option<Plane<S>>,
    pub friction: Option<Coulomb<S>>,
    /// Axle at the end and at the start of the step, in the engine's frame, and the rotation at the end (columns).
    pub axle: Vec3<S>,
    pub axle_before: [f64; 3],
    pub rotation: [[f64; 3]; 3],
    /// Work of a force: f . (before v(n-1/2) + after v(n+1/2)).
    pub weights: [S; 2],
}

/// Sums over a chunk of nodes.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodeSums {
    /// `internal` holds the work of the whole internal force, the viscous part included.
    pub works: Works,
    pub rim_impulse: [f64; 3],
    pub rim_moment_impulse: [f64; 3],
    pub mixed_kinetic: f64,
    pub net_force2: f64,
    pub internal_force2: f64,
}

/// A node's new state.
struct Moved<S> {
    x: Vec3<S>,
    v: Vec3<S>,
    touch: Option<Touch<S>>,
}

/// Node pass over a range. `take`: commit the step; else (the probe) leave state and surface sums alone.
#[allow(clippy::too_many_arguments)] // the pass's bindings, one by one as in the shader
pub fn pass<S: Real>(
    nodes: &Nodes<S>,
    c: &Conditions<S>,
    range: Range<usize>,
    take: bool,
    slots: &Shared<'_, Corners<S>>,
    x: &Shared<'_, Vec3<S>>,
    v: &Shared<'_, Vec3<S>>,
    surface: &Shared<'_, SurfaceSum>,
    sums: &Shared<'_, NodeSums>,
) {
    for n in range {
        // SAFETY: node n, its surface entry and its chunk belong to this member in this pass.
        let (x, v) = unsafe { (x.get_mut(n), v.get_mut(n)) };
        let chunk = unsafe { sums.get_mut(n / CHUNK) };
        let f_int = nodes.gather(n, slots);
        let mass = nodes.mass[n];
        let moved = match nodes.roles[n] {
            Role::Rim(k) => carried(c, nodes.rim_arms[k as usize], *x),
            Role::Surface(_) => free(c, mass, f_int, *x, *v, true),
            Role::Interior => free(c, mass, f_int, *x, *v, false),
        };
        book(chunk, c, nodes.roles[n], mass, f_int, *x, *v, &moved);
        if take {
            if let Role::Surface(k) = nodes.roles[n] {
                record(unsafe { surface.get_mut(k as usize) }, c.step.dtm, moved.touch.as_ref());
            }
            (*x, *v) = (moved.x, moved.v);
        }
    }
}

#[inline(always)]
fn free<S: Real>(
    c: &Conditions<S>,
    mass: S,
    f_int: Vec3<S>,
    x: Vec3<S>,
    v: Vec3<S>,
    can_touch: bool,
) -> Moved<S> {
    let v_star = node::predict(&c.loads, c.step, mass, f_int, v);
    if can_touch && let Some(road) = &c.road {
        let inertia = node::inertia(&c.loads, c.step, mass);
        let touch = contact::project(road, c.friction.as_ref(), inertia, c.step, x, v_star);
        if let Some(t) = touch {
            return Moved { x: t.x, v: t.v, touch };
        }
    }
    Moved { x: axpy(v_star, c.step.dt, x), v: v_star, touch: None }
}

/// A rim node goes where the rim puts it.
#[inline(always)]
fn carried<S: Real>(c: &Conditions<S>, arm: [f64; 3], x: Vec3<S>) -> Moved<S> {
    let turned: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| c.rotation[k][i] * arm[k]).sum());
    let x_new = add(c.axle, turned.map(S::from_f64));
    Moved { x: x_new, v: scale(sub(x_new, x), S::one() / c.step.dt), touch: None }
}

fn dot64<S: Real>(a: Vec3<S>, b: Vec3<S>) -> f64 {
    (0..3).map(|i| a[i].to_f64() * b[i].to_f64()).sum()
}

/// Adds the node's works and, for rim nodes, what the rim does to the rubber.
#[allow(clippy::too_many_arguments)] // a node's whole step
#[inline(always)]
fn book<S: Real>(
    sums: &mut NodeSums,
    c: &Conditions<S>,
    role: Role,
    mass: S,
    f_int: Vec3<S>,
    x: Vec3<S>,
    v: Vec3<S>,
    moved: &Moved<S>,
) {
    let way = axpy(moved.v, c.weights[1], scale(v, c.weights[0]));
    let weight = scale(c.loads.gravity, mass);
    let net = scale(sub(moved.v, v), mass / c.step.dtm);
    sums.works.internal -= dot64(f_int, way);
    sums.works.body_force += dot64(weight, way);
    sums.mixed_kinetic += 0.5 * mass.to_f64() * dot64(v, moved.v);
    if let Role::Rim(_) = role {
        sums.works.rim += dot64(sub(add(net, f_int), weight), way);
        let dtm = c.step.dtm.to_f64();
        let f = f_int.map(|f| f.to_f64() * dtm);
        let arm: [f64; 3] = std::array::from_fn(|i| x[i].to_f64() - c.axle_before[i]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sums.rim_impulse[i] += f[i];
            sums.rim_moment_impulse[i] += arm[j] * f[k] - arm[k] * f[j];
        }
        return;
    }
    sums.works.damping += dot64(node::damping_force(&c.loads, mass, v, moved.v), way);
    sums.net_force2 += dot64(net, net);
    sums.internal_force2 += dot64(f_int, f_int);
    if let Some(t) = &moved.touch {
        sums.works.normal += dot64(t.normal_force, way);
        sums.works.friction += dot64(t.tangential_force, way);
    }
}

#[inline(always)]
fn record<S: Real>(sum: &mut SurfaceSum, dtm: S, touch: Option<&Touch<S>>) {
    sum.touches = touch.is_some();
    sum.sticks = touch.is_some_and(|t| t.sticks);
    if let Some(t) = touch {
        for i in 0..3 {
            sum.impulse[i] += (t.normal_force[i] + t.tangential_force[i]).to_f64() * dtm.to_f64();
        }
        sum.touching += 1;
        sum.sticking += u32::from(t.sticks);
    }
}
