//! Contact that is always satisfied (eqs. 7-10, fig. 3): each surface node is its own problem, since the mass is
//! lumped (the forward-increment Lagrange multiplier of Carpenter, Taylor & Katona 1991 with a rigid target).

use super::friction::{AnyFriction, AtNode, Coulomb, Friction, Sliding};
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

/// The same with whatever law a scene has: `inverse_area` [1/m2] and the velocity before the step, `v`, are read by laws
/// in pressure and speed only.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // a node in full
pub fn project_any<S: Real, R: Road<S>>(
    road: &R,
    friction: Option<&AnyFriction<S>>,
    inverse_area: impl FnOnce() -> S,
    inertia: S,
    step: StepSize<S>,
    x: Vec3<S>,
    v: Vec3<S>,
    v_star: Vec3<S>,
) -> Option<Touch<S>> {
    match friction {
        None => project::<S, R, Coulomb<S>>(road, None, inertia, step, x, v_star),
        Some(AnyFriction::Coulomb(law)) => project(road, Some(law), inertia, step, x, v_star),
        Some(AnyFriction::Law(law)) => {
            let relative = sub(v, road.velocity(x));
            let n = road.normal(x);
            let slip = axpy(n, -dot(relative, n), relative);
            let law = AtNode { law: *law, inverse_area: inverse_area(), slip_before: dot(slip, slip).sqrt() };
            project(road, Some(&law), inertia, step, x, v_star)
        }
    }
}

/// Velocity after friction: with the road if the force that needs is within the cone, else slowed by mu fN.
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
    let most = |slip_speed| law.coefficient(Sliding { normal_force: per_step * push, slip_speed }) * push;
    let held = most(S::zero());
    if F::CONSTANT && speed > held {
        return (axpy(slip, -(held / speed), pressed), false);
    }
    // What slid in the step before is stopped by the friction of its sliding, not by that of rest.
    let sliding = most(law.slip_before());
    if speed <= held && speed <= sliding {
        // Built from the road's velocity, not by subtraction: on a resting road a sticking node does not creep.
        return (axpy(n, normal_speed, surface), true);
    }
    (axpy(slip, -(slowed_by(speed, law.slip_before(), sliding, most) / speed), pressed), false)
}

/// Loss of speed of a node that slides, mu depending on the speed v that remains: v + mu(v) push = speed.
///
/// One fixed-point pass from the friction of the step before, `sliding` = mu(`before`) push, and one secant through the
/// two: exact in steady sliding and where mu is linear in v, to second order in what changed since elsewhere. A law
/// that falls with speed may have a root of sliding besides that of rest: this keeps to the one the node was at.
#[inline(always)]
fn slowed_by<S: Real>(speed: S, before: S, sliding: S, most: impl Fn(S) -> S) -> S {
    let zero = S::zero();
    let within = |v: S| if v > zero { v.min(speed) } else { zero };
    let first = within(speed - sliding);
    let there = most(first);
    let (way, missing) = (first - before, first + there - speed);
    // The slope of v + mu(v) push, times `way`; where mu falls too steeply for a secant the first pass stands.
    let slope = way + there - sliding;
    let remains = if slope * way > zero { within(first - missing * way / slope) } else { first };
    // A law that grows with speed must not turn the slip round.
    most(remains).min(speed)
}
