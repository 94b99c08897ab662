//! Rigid roads. A road answers all that anyone asks of it: gap, normal and velocity at a point, directions along which it
//! does not change, axes of a footprint on it, the surface that pictures draw. Nobody else matches on its kind.

mod base;
mod disk;
mod drum;
mod height_field;
mod nearest;
mod pieces;
mod plane;
mod profile;
mod samples;
mod wave;

pub use base::Base;
pub use disk::Disk;
pub use drum::Drum;
pub use height_field::HeightField;
pub use nearest::Smooth;
pub use plane::Plane;
pub use profile::{Profile, Shape};
pub use samples::{Border, Samples};
pub use wave::Wave;

use super::scalar::{Real, Scalar};
use super::tensor::{Vec3, axpy, cross, dot, scale, sub};

/// A rigid surface. Parameters are in f64; formulas take any scalar.
pub trait Surface: Clone + std::fmt::Debug + PartialEq + Send + Sync + 'static {
    /// Name in a scene file; with `_` for `-` the stem of its shader.
    const NAME: &'static str;

    /// Never more than the gap: what is asked of every node in every step. Where it is not negative a node is outside.
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S;
    /// Distance of x from the surface along the normal, negative inside [m] (eq. 8). High above a road with a shape it is the bound.
    fn gap<S: Real>(&self, x: Vec3<S>) -> S;
    /// Outward unit normal at the surface point nearest to x.
    fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S>;
    /// Velocity of the surface there [m/s]; square to the normal.
    fn velocity<S: Real>(&self, x: Vec3<S>) -> Vec3<S>;
    /// Mean velocity over a step of `dt` of what ends the step at x [m/s].
    #[inline(always)]
    fn velocity_over<S: Real>(&self, x: Vec3<S>, _dt: S) -> Vec3<S> {
        self.velocity(x)
    }
    /// Where the road takes what lies on it at x within `dt` [m].
    fn carried(&self, x: [f64; 3], dt: f64) -> [f64; 3] {
        axpy(self.velocity(x), dt, x)
    }
    /// How fast its velocity turns where a node stays with it, in its own plane [rad/s].
    fn turning(&self) -> f64 {
        0.0
    }

    /// Height of x over the road's level, not over what is just below it [m].
    fn height(&self, x: [f64; 3]) -> f64 {
        self.gap(x)
    }
    /// How fine its shape is; none of one that a few elements see whole.
    fn texture(&self) -> Option<Texture> {
        None
    }

    /// Whether any of it moves.
    fn moves(&self) -> bool;
    /// The same road seen from axes whose origin is at `origin` [m].
    fn seen_from(&self, origin: [f64; 3]) -> Self;
    /// Directions x, y, z along which it does not change, to the last digit: neither where it is nor how it moves.
    fn invariant(&self) -> [bool; 3];

    /// What of it acts along direction x, y or z anywhere, as a subject and its verb; `None`: it neither pushes nor drags.
    fn acts_along(&self, direction: usize) -> Option<&'static str>;

    /// Coordinates on the surface of the point nearest to x [m]: lengths along it, by which pictures are drawn.
    fn chart(&self, x: [f64; 3]) -> [f64; 2];
    /// The surface point with these coordinates [m].
    fn point(&self, chart: [f64; 2]) -> [f64; 3];
    /// Unit vectors along the coordinates at the surface point nearest to x; with the normal a right-handed set.
    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2];
    /// Longest straight lines along the coordinates that may stand for the surface in a picture [m]; infinite where it is flat.
    fn straight(&self) -> [f64; 2];

    /// Values by the shaders' names.
    fn constants(&self) -> Vec<(&'static str, f64)>;
    /// Numbers of the shaders' array `road_shape`, four a vector; none: the road has no such array.
    fn array(&self) -> Vec<f64> {
        Vec::new()
    }
    /// One line for a person.
    fn description(&self) -> String;
}

/// How fine a road's shape is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texture {
    /// Shortest wave, or shortest side [m].
    pub shortest: f64,
    /// Largest slope; infinite at a wall.
    pub steepest: f64,
    /// Smallest radius of curvature; zero at a corner [m].
    pub sharpest: f64,
}

/// Displacement within `dt` of a point that moves with `velocity` about a unit `axis` with `spin`: an arc [m].
fn turned(axis: [f64; 3], spin: f64, velocity: [f64; 3], dt: f64) -> [f64; 3] {
    let angle = spin * dt;
    // sin(a)/a and (1 - cos a)/a.
    let [along, across] = match angle == 0.0 {
        true => [1.0, 0.0],
        false => [angle.sin() / angle, 2.0 * (0.5 * angle).sin().powi(2) / angle],
    };
    axpy(cross(axis, velocity), across * dt, scale(velocity, along * dt))
}

/// Unit vectors in a plane: x, or what is left of it in the plane (of y, where the normal is along x), and what completes it.
fn tangents_of(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let start = if normal[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let along = sub(start, scale(normal, dot(start, normal)));
    let along = scale(along, 1.0 / dot(along, along).sqrt());
    [along, cross(normal, along)]
}

/// Any road.
#[derive(Debug, Clone, PartialEq)]
pub enum Road {
    Plane(Plane),
    Drum(Drum),
    Disk(Disk),
    Wave(Wave),
    Profile(Profile),
    HeightField(HeightField),
}

/// The same question to whatever road it is.
macro_rules! ask {
    ($road:expr, $surface:ident => $answer:expr) => {
        match $road {
            Road::Plane($surface) => $answer,
            Road::Drum($surface) => $answer,
            Road::Disk($surface) => $answer,
            Road::Wave($surface) => $answer,
            Road::Profile($surface) => $answer,
            Road::HeightField($surface) => $answer,
        }
    };
}

/// Questions that are handed on as they are.
macro_rules! hand_on {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(pub fn $name(&self $(, $argument: $type)*) -> $result {
            ask!(self, road => Surface::$name(road $(, $argument)*))
        })*
    };
}

/// What a road answers: see [`Surface`].
impl Road {
    /// Lanes meet two cases, whatever roads there are: a drum's, and that of planes.
    #[inline(always)]
    pub fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        let plane = match self {
            Road::Plane(plane) => *plane,
            Road::Drum(drum) => return drum.bound(x),
            Road::Disk(disk) => disk.plane,
            Road::Wave(wave) => wave.base.lifted(wave.amplitude),
            Road::Profile(profile) => profile.base.lifted(profile.shape.top()),
            Road::HeightField(field) => field.base.lifted(field.samples.top()),
        };
        plane.bound(x)
    }

    #[inline(always)]
    pub fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        ask!(self, road => road.gap(x))
    }

    #[inline(always)]
    pub fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        ask!(self, road => road.normal(x))
    }

    #[inline(always)]
    pub fn velocity<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        ask!(self, road => road.velocity(x))
    }

    #[inline(always)]
    pub fn velocity_over<S: Real>(&self, x: Vec3<S>, dt: S) -> Vec3<S> {
        ask!(self, road => road.velocity_over(x, dt))
    }

    hand_on! {
        carried(x: [f64; 3], dt: f64) -> [f64; 3];
        turning() -> f64;
        moves() -> bool;
        invariant() -> [bool; 3];
        acts_along(direction: usize) -> Option<&'static str>;
        chart(x: [f64; 3]) -> [f64; 2];
        point(chart: [f64; 2]) -> [f64; 3];
        tangents(x: [f64; 3]) -> [[f64; 3]; 2];
        straight() -> [f64; 2];
        constants() -> Vec<(&'static str, f64)>;
        array() -> Vec<f64>;
        height(x: [f64; 3]) -> f64;
        texture() -> Option<Texture>;
        description() -> String;
    }

    pub fn seen_from(&self, origin: [f64; 3]) -> Road {
        ask!(self, road => road.seen_from(origin).into())
    }

    /// Name in a scene file.
    pub fn name(&self) -> &'static str {
        fn of<S: Surface>(_: &S) -> &'static str {
            S::NAME
        }
        ask!(self, road => of(road))
    }
}

macro_rules! roads {
    ($($kind:ident),*) => {
        $(impl From<$kind> for Road {
            fn from(road: $kind) -> Road {
                Road::$kind(road)
            }
        })*
    };
}
roads!(Plane, Drum, Disk, Wave, Profile, HeightField);

impl Road {
    /// Unit vectors along the surface at the point nearest to x: square to the unit vector `across` (of the axle), and to its
    /// left. Where `across` stands on end, x or z is taken for the first.
    pub fn axes(&self, x: [f64; 3], across: [f64; 3]) -> [[f64; 3]; 2] {
        let normal = self.normal(x);
        let square = |v: [f64; 3]| sub(v, scale(normal, dot(v, normal)));
        let length = |v: [f64; 3]| dot(v, v).sqrt();
        let heading = Some(cross(across, normal)).filter(|h| length(*h) > 1e-6).unwrap_or([1.0, 0.0, 0.0]);
        let heading = [heading, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]].map(square);
        let heading =
            heading.into_iter().find(|h| length(*h) > 0.0).expect("two axes are not along one normal");
        let heading = scale(heading, 1.0 / length(heading));
        [heading, cross(normal, heading)]
    }
}
