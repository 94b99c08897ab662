use crate::physics::scalar::Real;

/// mu = a + b exp(-p/p0) + c exp(-v/v0): a fit of tests of tread rubber at several loads and speeds (LAT 100).
#[derive(Debug, Clone, Copy)]
pub struct PressureVelocity<S> {
    pub a: S,
    pub b: S,
    /// 1/p0 [1/Pa]
    pub inverse_pressure: S,
    pub c: S,
    /// 1/v0 [s/m]
    pub inverse_speed: S,
}

impl<S: Real> PressureVelocity<S> {
    /// mu at a pressure [Pa] and a speed [m/s].
    #[inline(always)]
    pub fn coefficient(&self, pressure: S, speed: S) -> S {
        self.a
            + self.b * (-(pressure * self.inverse_pressure)).exp()
            + self.c * (-(speed * self.inverse_speed)).exp()
    }
}
