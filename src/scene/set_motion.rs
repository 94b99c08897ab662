//! Motions that single components of a node set are made to follow.

use glam::{DMat3, DQuat, DVec3};

use super::NodeSet;

/// Smooth step from 0 to 1 with vanishing first and second derivatives at both ends.
pub fn smooth(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// A number that follows time, in the units of what it moves [m, rad]; times since the simulation began [s].
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// 0 until `start`, then by a smooth ramp of `ramp` > 0 to `to`.
    Ramp { to: f64, start: f64, ramp: f64 },
    /// 0 until `start`, then `amplitude` sin(2 pi `frequency` (t - `start`)), its amplitude reached by a smooth ramp (0: at once).
    Sine { amplitude: f64, frequency: f64, start: f64, ramp: f64 },
    /// Straight lines between pairs of time and value, times ascending; before and after them their first and last value.
    Table(Vec<[f64; 2]>),
}

impl Path {
    /// Value at a time.
    pub fn at(&self, time: f64) -> f64 {
        match *self {
            Path::Ramp { to, start, ramp } => to * smooth((time - start) / ramp),
            Path::Sine { amplitude, frequency, start, ramp } => {
                let t = (time - start).max(0.0);
                let reached = if ramp > 0.0 { smooth(t / ramp) } else { 1.0 };
                amplitude * reached * (std::f64::consts::TAU * frequency * t).sin()
            }
            Path::Table(ref rows) => between(rows, time),
        }
    }

    /// When it has come to rest; infinite where it never does.
    pub fn end(&self) -> f64 {
        match *self {
            Path::Ramp { start, ramp, .. } => start + ramp,
            Path::Sine { .. } => f64::INFINITY,
            Path::Table(ref rows) => rows.last().map_or(0.0, |row| row[0]),
        }
    }
}

/// See [`Path::Table`].
fn between(rows: &[[f64; 2]], time: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= time);
    match (after.checked_sub(1).map(|before| rows[before]), rows.get(after)) {
        (Some([t0, u0]), Some([t1, u1])) => u0 + (u1 - u0) * ((time - t0) / (t1 - t0)),
        (Some([_, u]), None) | (None, Some(&[_, u])) => u,
        (None, None) => 0.0,
    }
}

/// A rotation of a whole set.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// Unit vector; right-hand rule.
    pub axis: [f64; 3],
    /// A point on the axis [m].
    pub about: [f64; 3],
    /// [rad]
    pub angle: Path,
}

/// Components of a node set that follow a motion; the others stay free.
#[derive(Debug, Clone, PartialEq)]
pub struct SetMotion {
    pub nodes: NodeSet,
    /// Displacement of x, y, z from where the nodes were at the start [m]; `None`: free.
    pub components: [Option<Path>; 3],
    /// Turns the set about an axis after it is displaced; all three components are then prescribed.
    pub turn: Option<Turn>,
}

/// Where a moving set is: a node at X is at `at` + `rotation` (X - `about`), `about` being [`SetMotion::about`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// [m]
    pub at: [f64; 3],
    /// Columns.
    pub rotation: [[f64; 3]; 3],
}

impl SetMotion {
    /// The set stays where it is in these components.
    pub fn at_rest(nodes: NodeSet, components: [bool; 3]) -> SetMotion {
        let rest = |held: bool| held.then(|| Path::Table(vec![[0.0, 0.0]]));
        SetMotion { nodes, components: components.map(rest), turn: None }
    }

    /// Which components are prescribed.
    pub fn prescribed(&self) -> [bool; 3] {
        [0, 1, 2].map(|d| self.turn.is_some() || self.components[d].is_some())
    }

    /// Displacement before the turn [m], zero along free components.
    pub fn displacement(&self, time: f64) -> [f64; 3] {
        [0, 1, 2].map(|d| self.components[d].as_ref().map_or(0.0, |path| path.at(time)))
    }

    /// The point that positions of its nodes are taken from [m].
    pub fn about(&self) -> [f64; 3] {
        self.turn.as_ref().map_or([0.0; 3], |turn| turn.about)
    }

    pub fn pose(&self, time: f64) -> Pose {
        let displacement = DVec3::from(self.displacement(time));
        let rotation = self.turn.as_ref().map_or(DMat3::IDENTITY, |turn| {
            DMat3::from_quat(DQuat::from_axis_angle(DVec3::from(turn.axis), turn.angle.at(time)))
        });
        Pose {
            at: (DVec3::from(self.about()) + rotation * displacement).to_array(),
            rotation: rotation.to_cols_array_2d(),
        }
    }

    /// When all of it has come to rest [s]; infinite where it never does.
    pub fn end(&self) -> f64 {
        let paths = self.components.iter().flatten().chain(self.turn.iter().map(|turn| &turn.angle));
        paths.map(Path::end).fold(0.0, f64::max)
    }
}

impl Pose {
    /// Where a node at X is, X taken from [`SetMotion::about`] [m].
    pub fn place(&self, arm: [f64; 3]) -> [f64; 3] {
        let rotation = DMat3::from_cols_array_2d(&self.rotation);
        (DVec3::from(self.at) + rotation * DVec3::from(arm)).to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_what_they_say() {
        let ramp = Path::Ramp { to: 2.0, start: 1.0, ramp: 4.0 };
        assert_eq!([0.0, 1.0, 3.0, 5.0, 9.0].map(|t| ramp.at(t)), [0.0, 0.0, 1.0, 2.0, 2.0]);
        assert_eq!(ramp.end(), 5.0);
        let sine = Path::Sine { amplitude: 3.0, frequency: 0.5, start: 1.0, ramp: 0.0 };
        assert!((sine.at(1.5) - 3.0).abs() < 1e-15 && sine.at(0.5) == 0.0 && sine.end() == f64::INFINITY);
        let slow = Path::Sine { amplitude: 3.0, frequency: 0.5, start: 0.0, ramp: 1.0 };
        assert!((slow.at(0.5) - 1.5).abs() < 1e-15);
        let table = Path::Table(vec![[1.0, 5.0], [2.0, 7.0], [4.0, -1.0]]);
        assert_eq!(
            [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 8.0].map(|t| table.at(t)),
            [5.0, 5.0, 6.0, 7.0, 3.0, -1.0, -1.0]
        );
    }

    /// A quarter turn about y through (1, 0, 0) takes what was displaced along z to x.
    #[test]
    fn a_set_turns_after_it_is_displaced() {
        let angle = Path::Ramp { to: std::f64::consts::FRAC_PI_2, start: 0.0, ramp: 1.0 };
        let turn = Some(Turn { axis: [0.0, 1.0, 0.0], about: [1.0, 0.0, 0.0], angle });
        let motion = SetMotion { turn, ..SetMotion::at_rest("all".into(), [false; 3]) };
        assert_eq!(motion.prescribed(), [true; 3]);
        let place = motion.pose(1.0).place([0.0, 2.0, 3.0]);
        let expected = [4.0, 2.0, 0.0];
        assert!(place.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{place:?}");
    }
}
