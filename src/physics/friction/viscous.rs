use crate::physics::scalar::Real;

/// mu = slope v: a lubricant film, which holds nothing at rest.
#[derive(Debug, Clone, Copy)]
pub struct Viscous<S> {
    /// [s/m]
    pub slope: S,
}

impl<S: Real> Viscous<S> {
    /// mu at a speed [m/s].
    #[inline(always)]
    pub fn coefficient(&self, speed: S) -> S {
        self.slope * speed
    }
}
