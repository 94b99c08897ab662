//! The rim's prescribed motion and the loads on its free components, as functions of time.

use crate::engine::{StageSetup, Step};
use crate::physics::rim::Coordinates;
use crate::scene::{Drive, Stage, smooth};

/// Integral of [`smooth`] from 0.
fn smooth_integral(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * s * (2.5 + s * (s - 3.0))
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
    /// Body force per mass [m/s2].
    gravity: [f64; 3],
}

impl Motion {
    /// Motion of the first stage from rest at `origin`, in a body force per mass of `gravity` [m/s2].
    pub fn at_rest(origin: Coordinates, gravity: [f64; 3]) -> Motion {
        Motion {
            drives: [Drive::Hold; 6],
            start_time: 0.0,
            origin,
            start: origin,
            rate: [0.0; 6],
            load: [0.0; 6],
            gravity,
        }
    }

    /// The next stage, which starts at `time` with the rim at `now`, where free components have moved it, at `rate`.
    pub fn next(&self, stage: &Stage, time: f64, now: Coordinates, rate: Coordinates) -> Motion {
        let planned = self.rate_at(time);
        let is_free = |c: usize| matches!(self.drives[c], Drive::Free { .. });
        Motion {
            drives: stage.rim.drives(),
            start_time: time,
            origin: self.origin,
            start: now,
            rate: std::array::from_fn(|c| if is_free(c) { rate[c] } else { planned[c] }),
            load: self.load_at(time),
            gravity: self.gravity,
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

    /// What pulls on the free components at a time [N, N m]: the applied loads, and the weight of the rim's own mass along
    /// x, y and z, which no ramp holds back. The rim's centre of mass is on the axle, so that its weight has no moment.
    pub fn pull_at(&self, time: f64) -> Coordinates {
        let mut pull = self.load_at(time);
        for (component, gravity) in self.gravity.into_iter().enumerate() {
            pull[component] += self.own(component).map_or(0.0, |mass| mass * gravity);
        }
        pull
    }

    /// The rim's own mass, or inertia, against a free component [kg, kg m2].
    fn own(&self, component: usize) -> Option<f64> {
        match self.drives[component] {
            Drive::Free { mass, .. } => Some(mass),
            _ => None,
        }
    }

    /// Kinetic energy of the rim's own mass and inertia at the given rates, in its free components [J].
    pub fn own_kinetic(&self, rate: &Coordinates) -> f64 {
        (0..6).map(|c| self.own(c).map_or(0.0, |own| 0.5 * own * rate[c] * rate[c])).sum()
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
        StageSetup {
            mass_damping,
            free: std::array::from_fn(|component| self.own(component)),
            relaxed: false,
        }
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
                load: self.pull_at(at),
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
    /// At rest with its centre on the axle [m], before the first stage; `gravity`: body force per mass [m/s2].
    pub fn at_rest([x, y, z]: [f64; 3], gravity: [f64; 3]) -> RimState {
        let at = [x, y, z, 0.0, 0.0, 0.0];
        RimState { motion: Motion::at_rest(at, gravity), at, rate: [0.0; 6] }
    }

    /// Kinetic energy of its own mass and inertia, in its free components [J].
    pub fn own_kinetic(&self) -> f64 {
        self.motion.own_kinetic(&self.rate)
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
