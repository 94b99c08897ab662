use crate::physics::scalar::Real;

/// Stribeck's curve as Armstrong-Helouvry writes it (Control of Machines with Friction, 1991, with exponent 2):
/// mu = kinetic + (still - kinetic) exp(-(v/speed)^2) + slope v.
#[derive(Debug, Clone, Copy)]
pub struct Stribeck<S> {
    /// mu at rest, and the level it falls to.
    pub still: S,
    pub kinetic: S,
    /// One over the speed of the fall [s/m].
    pub inverse_speed: S,
    /// Viscous part [s/m].
    pub slope: S,
}

impl<S: Real> Stribeck<S> {
    /// mu at a speed [m/s].
    #[inline(always)]
    pub fn coefficient(&self, speed: S) -> S {
        let s = speed * self.inverse_speed;
        self.kinetic + (self.still - self.kinetic) * (-(s * s)).exp() + self.slope * speed
    }
}
