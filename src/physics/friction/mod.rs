//! Friction laws: how large the tangential force of a sliding node is, as a share of its normal force.

mod coulomb;
mod pressure_velocity;
mod stribeck;
mod viscous;

pub use coulomb::Coulomb;
pub use pressure_velocity::PressureVelocity;
pub use stribeck::Stribeck;
pub use viscous::Viscous;

use super::scalar::Real;
use crate::scene;

/// What a law may look at.
#[derive(Debug, Clone, Copy)]
pub struct Sliding<S> {
    /// Normal force of the node in this step [N].
    pub normal_force: S,
    /// Tangential speed relative to the road [m/s].
    pub slip_speed: S,
}

/// A friction law at a node.
pub trait Friction<S: Real>: Copy + Send + Sync {
    /// Whether the coefficient is the same whatever slides.
    const CONSTANT: bool = false;
    /// mu >= 0.
    fn coefficient(&self, sliding: Sliding<S>) -> S;
    /// Slip speed of the step before [m/s]; 0 for a node that stuck.
    fn slip_before(&self) -> S {
        S::zero()
    }
}

/// Laws in pressure and speed, of which a scene has one.
#[derive(Debug, Clone, Copy)]
pub enum PressureSpeedLaw<S> {
    Viscous(Viscous<S>),
    Stribeck(Stribeck<S>),
    PressureVelocity(PressureVelocity<S>),
}

/// Any law of a scene.
#[derive(Debug, Clone, Copy)]
pub enum AnyFriction<S> {
    Coulomb(Coulomb<S>),
    Law(PressureSpeedLaw<S>),
}

impl<S: Real> AnyFriction<S> {
    pub fn new(law: &scene::Friction) -> Self {
        let s = S::from_f64;
        match *law {
            scene::Friction::Coulomb { mu } => AnyFriction::Coulomb(Coulomb { mu: s(mu) }),
            scene::Friction::Viscous { slope } => {
                AnyFriction::Law(PressureSpeedLaw::Viscous(Viscous { slope: s(slope) }))
            }
            scene::Friction::Stribeck { still, kinetic, speed, slope } => {
                AnyFriction::Law(PressureSpeedLaw::Stribeck(Stribeck {
                    still: s(still),
                    kinetic: s(kinetic),
                    inverse_speed: s(1.0 / speed),
                    slope: s(slope),
                }))
            }
            scene::Friction::PressureVelocity { a, b, pressure, c, speed } => {
                AnyFriction::Law(PressureSpeedLaw::PressureVelocity(PressureVelocity {
                    a: s(a),
                    b: s(b),
                    inverse_pressure: s(1.0 / pressure),
                    c: s(c),
                    inverse_speed: s(1.0 / speed),
                }))
            }
        }
    }
}

impl<S: Real> PressureSpeedLaw<S> {
    /// mu at a pressure [Pa] and a speed [m/s].
    #[inline(always)]
    pub fn coefficient(&self, pressure: S, speed: S) -> S {
        match self {
            PressureSpeedLaw::Viscous(law) => law.coefficient(speed),
            PressureSpeedLaw::Stribeck(law) => law.coefficient(speed),
            PressureSpeedLaw::PressureVelocity(law) => law.coefficient(pressure, speed),
        }
    }
}

/// A law at a node whose share of the surface is known.
#[derive(Debug, Clone, Copy)]
pub struct AtNode<S> {
    pub law: PressureSpeedLaw<S>,
    /// One over the node's area [1/m2].
    pub inverse_area: S,
    /// Slip speed of the step before [m/s].
    pub slip_before: S,
}

impl<S: Real> Friction<S> for AtNode<S> {
    #[inline(always)]
    fn coefficient(&self, sliding: Sliding<S>) -> S {
        self.law.coefficient(sliding.normal_force * self.inverse_area, sliding.slip_speed)
    }
    #[inline(always)]
    fn slip_before(&self) -> S {
        self.slip_before
    }
}
