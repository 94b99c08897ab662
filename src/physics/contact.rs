//! Contact that is always satisfied (eqs. 7-10, fig. 3): each surface node is its own problem, since the mass is
//! lumped (the forward-increment Lagrange multiplier of Carpenter, Taylor & Katona 1991 with a rigid target).

use super::friction::{Friction, Sliding};
use super::node::StepSize;
use super::road::Road;
use super::scalar::Real;
use super::tensor::{Vec3, axpy, dot, scale, sub};

/// A node that touches the road in this step.
#[derive(Debug, Clone, Copy)]
pub struct Touch<S> {
    /// Corrected position at the end of the step, on the surface [m].
    pub x: Vec3<S>,
    /// Corrected half-step velocity [m/s].
    pub v: Vec3<S>,
    /// Normal and tangential force of the road on the node [N].
    pub normal_force: Vec3<S>,
    pub tangential_force: Vec3<S>,
    /// Whether it moves with the road.
    pub sticks: bool,
}

/// Puts a node that would end inside the road back on its surface.
///
/// `inertia` = m (1 + alpha dtm / 2): what a force acts against over `dtm`. `x` is the position before the step and
/// `v_star` the velocity predicted without contact. `None`: the node stays free. The normal force is never a pull:
/// it exists only where the predicted gap is negative.
#[inline(always)]
pub fn project<S: Real, R: Road<S>, F: Friction<S>>(
    road: &R,
    friction: Option<&F>,
    inertia: S,
    step: StepSize<S>,
    x: Vec3<S>,
    v_star: Vec3<S>,
) -> Option<Touch<S>> {
    let x_star = axpy(v_star, step.dt, x);
    let gap = road.gap(x_star);
    // A NaN gap belongs to the failure report of the element pass.
    if gap.partial_cmp(&S::zero()) != Some(std::cmp::Ordering::Less) {
        return None;
    }
    let n = road.normal(x_star);
    let push = -gap / step.dt;
    let per_step = inertia / step.dtm;
    let pressed = axpy(n, push, v_star);
    let normal_force = scale(n, per_step * push);
    let (v, sticks) = match friction {
        None => (pressed, false),
        Some(law) => tangential(road, law, per_step, push, x_star, n, pressed),
    };
    let mut x_new = axpy(v, step.dt, x);
    x_new = axpy(n, -road.gap(x_new), x_new);
    let tangential_force = scale(sub(v, pressed), per_step);
    Some(Touch { x: x_new, v, normal_force, tangential_force, sticks })
}

/// Velocity after Coulomb's law: with the road if the force that needs is within the cone, else slowed by mu fN.
#[inline(always)]
fn tangential<S: Real, R: Road<S>, F: Friction<S>>(
    road: &R,
    law: &F,
    per_step: S,
    push: S,
    x_star: Vec3<S>,
    n: Vec3<S>,
    pressed: Vec3<S>,
) -> (Vec3<S>, bool) {
    let surface = road.velocity(x_star);
    let relative = sub(pressed, surface);
    let normal_speed = dot(relative, n);
    let slip = axpy(n, -normal_speed, relative);
    let speed = dot(slip, slip).sqrt();
    let mu = law.coefficient(Sliding { normal_force: per_step * push, slip_speed: speed });
    let most = mu * push;
    if speed <= most {
        // Built from the road's velocity, not by subtraction: on a resting road a sticking node does not creep.
        return (axpy(n, normal_speed, surface), true);
    }
    (axpy(slip, -(most / speed), pressed), false)
}
