//! Rigid roads. A road answers all that anyone asks of it: gap, normal and velocity at a point, directions along which it
//! does not change, axes of a footprint on it, the surface that pictures draw. Nobody else matches on its kind.

mod drum;
mod plane;

pub use drum::Drum;
pub use plane::Plane;

use super::scalar::Scalar;
use super::tensor::{Vec3, cross, dot, scale, sub};

/// A rigid surface. Parameters are in f64; formulas take any scalar.
pub trait Surface: Copy + std::fmt::Debug + PartialEq + Send + Sync + 'static {
    /// Name in a scene file; with `_` for `-` the stem of its shader.
    const NAME: &'static str;

    /// Distance of x from the surface along the normal, negative inside [m] (eq. 8).
    fn gap<S: Scalar>(&self, x: Vec3<S>) -> S;
    /// Outward unit normal at the surface point nearest to x.
    fn normal<S: Scalar>(&self, x: Vec3<S>) -> Vec3<S>;
    /// Velocity of the surface there [m/s]; square to the normal.
    fn velocity<S: Scalar>(&self, x: Vec3<S>) -> Vec3<S>;

    /// Whether any of it moves.
    fn moves(&self) -> bool;
    /// The same road seen from axes whose origin is at `origin` [m].
    fn seen_from(&self, origin: [f64; 3]) -> Self;
    /// Directions x, y, z along which it does not change, to the last digit.
    fn invariant(&self) -> [bool; 3];

    /// What of it acts along direction x, y or z anywhere, as a subject and its verb; `None`: it neither pushes nor drags.
    fn acts_along(&self, direction: usize) -> Option<&'static str>;

    /// Coordinates on the surface of the point nearest to x [m]: lengths along it, by which pictures are drawn.
    fn chart(&self, x: [f64; 3]) -> [f64; 2];
    /// The surface point with these coordinates [m].
    fn point(&self, chart: [f64; 2]) -> [f64; 3];
    /// Unit vectors along the coordinates at the surface point nearest to x; with the normal a right-handed set.
    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2];
    /// Longest straight line along the first coordinate that may stand for the surface in a picture [m]; infinite where it is
    /// flat.
    fn straight(&self) -> f64;

    /// Values by the shaders' names.
    fn constants(&self) -> Vec<(&'static str, f64)>;
    /// One line for a person.
    fn description(&self) -> String;
}

/// Any road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Road {
    Plane(Plane),
    Drum(Drum),
}

/// The same question to whatever road it is.
macro_rules! ask {
    ($road:expr, $surface:ident => $answer:expr) => {
        match $road {
            Road::Plane($surface) => $answer,
            Road::Drum($surface) => $answer,
        }
    };
}

/// What a road answers: see [`Surface`].
impl Road {
    #[inline(always)]
    pub fn gap<S: Scalar>(&self, x: Vec3<S>) -> S {
        ask!(self, road => road.gap(x))
    }

    #[inline(always)]
    pub fn normal<S: Scalar>(&self, x: Vec3<S>) -> Vec3<S> {
        ask!(self, road => road.normal(x))
    }

    #[inline(always)]
    pub fn velocity<S: Scalar>(&self, x: Vec3<S>) -> Vec3<S> {
        ask!(self, road => road.velocity(x))
    }

    pub fn moves(&self) -> bool {
        ask!(self, road => road.moves())
    }

    pub fn seen_from(&self, origin: [f64; 3]) -> Road {
        ask!(self, road => road.seen_from(origin).into())
    }

    pub fn invariant(&self) -> [bool; 3] {
        ask!(self, road => road.invariant())
    }

    pub fn acts_along(&self, direction: usize) -> Option<&'static str> {
        ask!(self, road => road.acts_along(direction))
    }

    pub fn chart(&self, x: [f64; 3]) -> [f64; 2] {
        ask!(self, road => road.chart(x))
    }

    pub fn point(&self, chart: [f64; 2]) -> [f64; 3] {
        ask!(self, road => road.point(chart))
    }

    pub fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2] {
        ask!(self, road => road.tangents(x))
    }

    pub fn straight(&self) -> f64 {
        ask!(self, road => road.straight())
    }

    pub fn constants(&self) -> Vec<(&'static str, f64)> {
        ask!(self, road => road.constants())
    }

    pub fn description(&self) -> String {
        ask!(self, road => road.description())
    }

    /// Name in a scene file.
    pub fn name(&self) -> &'static str {
        fn of<S: Surface>(_: &S) -> &'static str {
            S::NAME
        }
        ask!(self, road => of(road))
    }
}

impl From<Drum> for Road {
    fn from(drum: Drum) -> Road {
        Road::Drum(drum)
    }
}

impl From<Plane> for Road {
    fn from(plane: Plane) -> Road {
        Road::Plane(plane)
    }
}

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
