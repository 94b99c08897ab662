//! Work and impulse of every force on a line, in lanes while it is worked on.

use super::conditions::Conditions;
use super::layout::DrivenPart;
use super::sums::LineSums;
use crate::physics::lanes::{Lanes, WIDEST};
use crate::physics::node::{self, Loads, Prediction};
use crate::physics::scalar::Scalar;
use crate::physics::tensor::{Vec3, add, axpy, cross, dot, scale, sub};

/// Constants of a step in every lane.
pub struct LaneConditions<N> {
    pub dt: N,
    pub prediction: Prediction<N>,
    pub loads: Loads<N>,
    pub weights: [N; 2],
    pub inverse_dtm: N,
}

impl<N: Lanes> LaneConditions<N> {
    #[inline(always)]
    pub fn new(c: &Conditions<N::Real>) -> Self {
        let loads = Loads { gravity: splat3(c.loads.gravity), alpha: N::splat(c.loads.alpha) };
        LaneConditions {
            dt: N::splat(c.step.dt),
            prediction: c.prediction.in_lanes(),
            loads,
            weights: [N::splat(c.weights[0]), N::splat(c.weights[1])],
            inverse_dtm: N::splat(<N::Real as Scalar>::one() / c.step.dtm),
        }
    }
}

/// New velocity and position of the lanes.
#[derive(Clone, Copy)]
pub struct Moved<N> {
    pub x: Vec3<N>,
    pub v: Vec3<N>,
}

#[inline(always)]
pub fn splat3<N: Lanes>(v: Vec3<N::Real>) -> Vec3<N> {
    [N::splat(v[0]), N::splat(v[1]), N::splat(v[2])]
}

#[inline(always)]
pub fn choose3<N: Lanes>(a: Vec3<N>, other: Vec3<N>, mask: u32) -> Vec3<N> {
    [a[0].choose(other[0], mask), a[1].choose(other[1], mask), a[2].choose(other[2], mask)]
}

/// Sums of a line in one step ([`LineSums`]).
#[derive(Clone, Copy)]
pub struct LaneSums<N> {
    pub internal: N,
    pub body_force: N,
    pub damping: N,
    pub rim: N,
    pub impulse: Vec3<N>,
    pub moment: Vec3<N>,
    pub mixed_kinetic: N,
    pub net_force2: N,
    pub internal_force2: N,
}

impl<N: Lanes> LaneSums<N> {
    #[inline(always)]
    pub fn zero() -> Self {
        let (zero, none) = (N::zero(), [N::zero(); 3]);
        LaneSums {
            internal: zero,
            body_force: zero,
            damping: zero,
            rim: zero,
            impulse: none,
            moment: none,
            mixed_kinetic: zero,
            net_force2: zero,
            internal_force2: zero,
        }
    }
}

/// Adds a batch's works and, for rim nodes, what the rim does to the rubber. Lanes that hold no node have neither mass
/// nor force.
#[allow(clippy::too_many_arguments)] // a batch's whole step
#[inline(always)]
pub fn book<N: Lanes, const PROBE: bool>(
    sums: &mut LaneSums<N>,
    c: &Conditions<N::Real>,
    lanes: &LaneConditions<N>,
    rim: u32,
    mass: N,
    f_int: Vec3<N>,
    x: Vec3<N>,
    v: Vec3<N>,
    moved: &Moved<N>,
) {
    let way = axpy(moved.v, lanes.weights[1], scale(v, lanes.weights[0]));
    let gravity = lanes.loads.gravity;
    sums.internal -= dot(f_int, way);
    if c.has_gravity {
        sums.body_force += mass * dot(gravity, way);
    }
    if PROBE {
        sums.mixed_kinetic += mass * dot(v, moved.v);
    }
    let zero = N::zero();
    if rim != 0 {
        let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm);
        let work = dot(sub(add(net, f_int), scale(gravity, mass)), way);
        sums.rim += work.choose(zero, rim);
        let arm = sub(x, splat3(c.axle_before));
        let f = choose3(f_int, [zero; 3], rim);
        sums.impulse = add(sums.impulse, f);
        sums.moment = add(sums.moment, cross(arm, f));
    }
    if c.has_damping {
        let work = dot(node::damping_force(&lanes.loads, mass, v, moved.v), way);
        sums.damping += zero.choose(work, rim);
    }
    if PROBE {
        let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm);
        sums.net_force2 += zero.choose(dot(net, net), rim);
        sums.internal_force2 += zero.choose(dot(f_int, f_int), rim);
    }
}

/// Adds the works of what drives the components of a batch: the force that is needed besides all others.
#[allow(clippy::too_many_arguments)] // a batch's whole step
#[inline(always)]
pub fn book_driven<N: Lanes>(
    sums: &mut LaneSums<N>,
    c: &Conditions<N::Real>,
    lanes: &LaneConditions<N>,
    parts: &[DrivenPart],
    mass: N,
    whole: Vec3<N>,
    v: Vec3<N>,
    moved: &Moved<N>,
) {
    let way = axpy(moved.v, lanes.weights[1], scale(v, lanes.weights[0]));
    let net = scale(sub(moved.v, v), mass * lanes.inverse_dtm);
    let mut force = sub(add(net, whole), scale(lanes.loads.gravity, mass));
    if c.has_damping {
        force = sub(force, node::damping_force(&lanes.loads, mass, v, moved.v));
    }
    let zero = N::zero();
    for part in parts {
        sums.rim += (force[0] * way[0]).choose(zero, part.lanes[0]);
        sums.rim += (force[1] * way[1]).choose(zero, part.lanes[1]);
        sums.rim += (force[2] * way[2]).choose(zero, part.lanes[2]);
    }
}

/// Adds the impulses of what drives the components of a batch: the internal force that it takes, as the rim's.
#[inline(always)]
pub fn add_reactions<N: Lanes>(
    sums: &mut [[f64; WIDEST]; 3],
    parts: &[DrivenPart],
    whole: Vec3<N>,
    c: &Conditions<N::Real>,
) {
    let (zero, dtm) = (N::zero(), N::splat(c.step.dtm));
    for part in parts {
        let masks = part.lanes;
        // SAFETY: there is a sum for each of the widest lanes.
        unsafe {
            (whole[0] * dtm).choose(zero, masks[0]).add_to(sums[0].as_mut_ptr());
            (whole[1] * dtm).choose(zero, masks[1]).add_to(sums[1].as_mut_ptr());
            (whole[2] * dtm).choose(zero, masks[2]).add_to(sums[2].as_mut_ptr());
        }
    }
}

/// Adds a line's lanes to its sums in double precision.
#[inline(always)]
pub fn fold<N: Lanes, const PROBE: bool>(
    line: &mut LineSums,
    lanes: &LaneSums<N>,
    c: &Conditions<N::Real>,
    has_rim: bool,
) {
    // SAFETY: there is a sum for each of the widest lanes.
    unsafe {
        lanes.internal.add_to(line.internal.as_mut_ptr());
        if c.has_gravity {
            lanes.body_force.add_to(line.body_force.as_mut_ptr());
        }
        if c.has_damping {
            lanes.damping.add_to(line.damping.as_mut_ptr());
        }
        if has_rim {
            let dtm = N::splat(c.step.dtm);
            lanes.rim.add_to(line.rim.as_mut_ptr());
            for d in 0..3 {
                (lanes.impulse[d] * dtm).add_to(line.rim_impulse[d].as_mut_ptr());
                (lanes.moment[d] * dtm).add_to(line.rim_moment_impulse[d].as_mut_ptr());
            }
        }
        if PROBE {
            (lanes.mixed_kinetic * N::from_f64(0.5)).add_to(line.mixed_kinetic.as_mut_ptr());
            lanes.net_force2.add_to(line.net_force2.as_mut_ptr());
            lanes.internal_force2.add_to(line.internal_force2.as_mut_ptr());
        }
    }
}
