//! Contact that is always satisfied (eqs. 7-10, fig. 3): each surface node is its own problem, since the mass is
//! lumped (the forward-increment Lagrange multiplier of Carpenter, Taylor & Katona 1991 with a rigid target).

use super::friction::{Friction, FrictionLaw, Sliding, WithFriction};
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

/// A node before the step, and where it would go without contact.
#[derive(Debug, Clone, Copy)]
pub struct Node<S> {
    /// m (1 + alpha dtm / 2): what a force acts against over `dtm` [kg].
    pub inertia: S,
    /// Position [m] and velocity [m/s] before the step.
    pub x: Vec3<S>,
    pub v: Vec3<S>,
    /// Velocity predicted without contact [m/s].
    pub v_star: Vec3<S>,
}

/// Puts a node that would end inside the road back on its surface.
///
/// `inverse_area` [1/m2] is asked for by laws in pressure only. `None`: the node stays free. The normal force is never a
/// pull: it exists only where the predicted gap is negative.
#[inline(always)]
pub fn project<S: Real>(
    road: &Road,
    friction: Option<&Friction>,
    inverse_area: impl FnOnce() -> S,
    step: StepSize<S>,
    node: &Node<S>,
) -> Option<Touch<S>> {
    let x_star = axpy(node.v_star, step.dt, node.x);
    let gap = road.gap(x_star);
    // A NaN gap belongs to the failure report of the element pass.
    if gap.partial_cmp(&S::zero()) != Some(std::cmp::Ordering::Less) {
        return None;
    }
    let n = road.normal(x_star);
    let push = -gap / step.dt;
    let per_step = node.inertia / step.dtm;
    let pressed = axpy(n, push, node.v_star);
    let normal_force = scale(n, per_step * push);
    let (v, sticks) = match friction {
        None => (pressed, false),
        Some(law) => {
            let pressure = if law.needs_area() { per_step * push * inverse_area() } else { S::zero() };
            law.visit(Rubbed { road, dt: step.dt, node, x_star, n, push, pressure, pressed })
        }
    };
    let mut x_new = axpy(v, step.dt, node.x);
    x_new = axpy(n, -road.gap(x_new), x_new);
    let tangential_force = scale(sub(v, pressed), per_step);
    Some(Touch { x: x_new, v, normal_force, tangential_force, sticks })
}

/// Velocity after friction of a node that is pressed on the road with `push` [m/s].
struct Rubbed<'a, S> {
    road: &'a Road,
    dt: S,
    node: &'a Node<S>,
    x_star: Vec3<S>,
    n: Vec3<S>,
    push: S,
    /// Normal force over area [Pa]; zero where the law does not look at it.
    pressure: S,
    /// Velocity without friction.
    pressed: Vec3<S>,
}

impl<S: Real> WithFriction for Rubbed<'_, S> {
    /// The velocity, and whether the node sticks.
    type Output = (Vec3<S>, bool);

    /// With the road if the force that needs is within the cone, else slowed by mu fN.
    #[inline(always)]
    fn with<F: FrictionLaw>(self, law: F) -> (Vec3<S>, bool) {
        let Rubbed { road, dt, node, x_star, n, push, pressure, pressed } = self;
        let surface = road.velocity_over(x_star, dt);
        let relative = sub(pressed, surface);
        let normal_speed = dot(relative, n);
        let slip = axpy(n, -normal_speed, relative);
        let speed = dot(slip, slip).sqrt();
        let most = |slip_speed| law.coefficient(Sliding { pressure, slip_speed }) * push;
        let held = most(S::zero());
        if F::CONSTANT {
            return if speed > held {
                (axpy(slip, -(held / speed), pressed), false)
            } else {
                (axpy(n, normal_speed, surface), true)
            };
        }
        let before = slip_before(road, dt, node);
        // What slid in the step before is stopped by the friction of its sliding, not by that of rest.
        let sliding = most(before);
        if speed <= held && speed <= sliding {
            // Built from the road's velocity, not by subtraction: on a resting road a sticking node does not creep.
            return (axpy(n, normal_speed, surface), true);
        }
        (axpy(slip, -(slowed_by(speed, before, sliding, most) / speed), pressed), false)
    }
}

/// Slip speed in the step before [m/s]. What rounding leaves of a node that stuck is none: a law that jumps at rest would take
/// it for sliding. Nor is what a road turns in a step, whose velocity is not told from that of the step before.
#[inline(always)]
fn slip_before<S: Real>(road: &Road, dt: S, node: &Node<S>) -> S {
    let (surface, n) = (road.velocity_over(node.x, dt), road.normal(node.x));
    let relative = sub(node.v, surface);
    let slip = axpy(n, -dot(relative, n), relative);
    let (square, scale) = (dot(slip, slip), dot(node.v, node.v) + dot(surface, surface));
    // A dozen roundings of the velocities.
    let told = 16.0 * S::EPSILON + road.turning() * dt.to_f64();
    let rounding = S::from_f64(told * told);
    if square > rounding * scale { square.sqrt() } else { S::zero() }
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
