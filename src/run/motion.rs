//! The rim's prescribed motion and the loads on its free components, as functions of time.

use crate::engine::{StageSetup, Step};
use crate::physics::rim::Coordinates;
use crate::scene::{Drive, RimMotion, Stage};

/// Smooth step from 0 to 1 with vanishing first and second derivatives at both ends.
fn smooth(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// Integral of [`smooth`] from 0.
fn smooth_integral(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * s * (2.5 + s * (s - 3.0))
}

impl RimMotion {
    /// Components in the order of [`Coordinates`].
    pub fn drives(&self) -> [Drive; 6] {
        [self.x, self.y, self.z, self.steer, self.camber, self.spin]
    }
}

/// Motion of the rim during one stage.
#[derive(Debug, Clone)]
pub struct Motion {
    drives: [Drive; 6],
    start_time: f64,
    /// Coordinates before the simulation, and at the start of the stage.
    origin: Coordinates,
    start: Coordinates,
    /// Rates and loads at the end of the stage before.
    rate: Coordinates,
    load: Coordinates,
}

impl Motion {
    /// Motion of the first stage from rest at `origin`.
    pub fn at_rest(origin: Coordinates) -> Motion {
        Motion {
            drives: [Drive::Hold; 6],
            start_time: 0.0,
            origin,
            start: origin,
            rate: [0.0; 6],
            load: [0.0; 6],
        }
    }

    /// The next stage, which starts at `time` with the rim at `now` (which free components have moved).
    pub fn next(&self, stage: &Stage, time: f64, now: Coordinates) -> Motion {
        Motion {
            drives: stage.rim.drives(),
            start_time: time,
            origin: self.origin,
            start: now,
            rate: self.rate_at(time),
            load: self.load_at(time),
        }
    }

    /// Coordinates at a time; free components stay at their start.
    pub fn coordinates_at(&self, time: f64) -> Coordinates {
        std::array::from_fn(|c| self.coordinate(c, time - self.start_time))
    }

    fn coordinate(&self, c: usize, t: f64) -> f64 {
        let from = self.start[c];
        match self.drives[c] {
            Drive::Hold | Drive::Free { .. } => from,
            Drive::Displacement { to, ramp } => {
                from + (self.origin[c] + to - from) * if ramp > 0.0 { smooth(t / ramp) } else { 1.0 }
            }
            Drive::Velocity { to, ramp } if ramp > 0.0 => {
                let ramped =
                    self.rate[c] * t.min(ramp) + (to - self.rate[c]) * ramp * smooth_integral(t / ramp);
                from + ramped + to * (t - ramp).max(0.0)
            }
            Drive::Velocity { to, .. } => from + to * t,
        }
    }

    /// Rates of the prescribed components at a time (just after it, where they jump).
    pub fn rate_at(&self, time: f64) -> Coordinates {
        let t = time - self.start_time;
        std::array::from_fn(|c| match self.drives[c] {
            Drive::Velocity { to, ramp } if ramp > 0.0 => {
                self.rate[c] + (to - self.rate[c]) * smooth(t / ramp)
            }
            Drive::Velocity { to, .. } => to,
            // Ramps end at rest.
            Drive::Hold | Drive::Displacement { .. } | Drive::Free { .. } => 0.0,
        })
    }

    /// Applied loads at a time; zero for prescribed components.
    pub fn load_at(&self, time: f64) -> Coordinates {
        let t = time - self.start_time;
        std::array::from_fn(|c| match self.drives[c] {
            Drive::Free { load, ramp, .. } if ramp > 0.0 => {
                self.load[c] + (load - self.load[c]) * smooth(t / ramp)
            }
            Drive::Free { load, .. } => load,
            _ => 0.0,
        })
    }

    /// Time at which every ramp of the stage is over.
    pub fn settled_after(&self) -> f64 {
        let ramp = |d: &Drive| match *d {
            Drive::Hold => 0.0,
            Drive::Displacement { ramp, .. } | Drive::Velocity { ramp, .. } | Drive::Free { ramp, .. } => {
                ramp
            }
        };
        self.start_time + self.drives.iter().map(ramp).fold(0.0, f64::max)
    }

    /// What the engine needs to know of the stage.
    pub fn setup(&self, mass_damping: f64) -> StageSetup {
        let free = self.drives.map(|d| match d {
            Drive::Free { mass, .. } => Some(mass),
            _ => None,
        });
        StageSetup { mass_damping, free }
    }

    /// Plans `count` steps of `dt` from `time`, the first after a step of `before`.
    pub fn plan(&self, time: f64, dt: f64, before: f64, count: usize) -> Vec<Step> {
        let step = |n: usize| {
            let at = time + n as f64 * dt;
            Step {
                time: at,
                dt,
                dt_before: if n == 0 { before } else { dt },
                rim: self.coordinates_at(at + dt),
                load: self.load_at(at),
            }
        };
        (0..count).map(step).collect()
    }
}

/// The rim: how it is driven, and where it is.
#[derive(Debug, Clone)]
pub struct RimState {
    pub motion: Motion,
    /// Coordinates and their half-step rates at the end of the last window.
    pub at: Coordinates,
    pub rate: Coordinates,
}

impl RimState {
    /// At rest with its centre on the axle [m], before the first stage.
    pub fn at_rest([x, y, z]: [f64; 3]) -> RimState {
        let at = [x, y, z, 0.0, 0.0, 0.0];
        RimState { motion: Motion::at_rest(at), at, rate: [0.0; 6] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_of_the_ramp_is_its_integral() {
        let n = 20_000;
        let sum: f64 = (0..n).map(|i| smooth((i as f64 + 0.5) / n as f64 * 0.7) * 0.7 / n as f64).sum();
        // Midpoint rule: error 0.7^3 max|smooth''| / (24 n^2) < 1e-9.
        assert!((sum - smooth_integral(0.7)).abs() < 1e-9);
        assert_eq!((smooth(0.0), smooth(1.0), smooth_integral(1.0)), (0.0, 1.0, 0.5));
    }
}
