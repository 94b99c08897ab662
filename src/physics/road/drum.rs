use super::{Surface, turned};
use crate::scalar::{Real, Scalar};
use crate::tensor::{Vec3, add, axpy, cross, dot, scale, sub, vec3};

/// A round drum that turns about its axis, seen from a point of its surface: a plane bent about `axis`.
///
/// With x' = x - point, its part y square to the axis, and s = n0 . x' + k y . y / 2,
///
/// ```text
/// 1 + 2 k s = (r / R)^2,   gap = 2 s / (1 + sqrt(1 + 2 k s)),   n = (n0 + k y) / sqrt(1 + 2 k s)
/// ```
///
/// on both sides of the drum, k being 1/R outside and -1/R inside. Nothing cancels, however large R is: with k = 0 it is the
/// plane through `point`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drum {
    /// A point of the surface [m].
    pub point: [f64; 3],
    /// Unit normal there, outward of the solid.
    pub normal: [f64; 3],
    /// Unit vector along the drum's axis, square to the normal.
    pub axis: [f64; 3],
    /// 1/R where a body is outside the drum, -1/R where it is inside [1/m].
    pub curvature: f64,
    /// Velocity of the surface along axis x normal [m/s]: the angular velocity about `axis` over the curvature.
    pub speed: f64,
}

impl Drum {
    /// y and sqrt(1 + 2 k s), with s.
    #[inline(always)]
    fn bent<S: Scalar>(&self, x: Vec3<S>) -> (Vec3<S>, S, S) {
        let axis = vec3::<S>(self.axis);
        let from_point = sub(x, vec3(self.point));
        let y = axpy(axis, -dot(axis, from_point), from_point);
        let half_curvature = S::from_f64(0.5 * self.curvature);
        let s = dot(y, y).mul_add(half_curvature, dot(vec3(self.normal), from_point));
        let root = s.mul_add(S::from_f64(2.0 * self.curvature), S::one()).sqrt();
        (y, root, s)
    }

    /// Along the surface at `point`, square to the axis.
    fn along(&self) -> [f64; 3] {
        cross(self.axis, self.normal)
    }
}

impl Surface for Drum {
    const NAME: &'static str = "drum";

    #[inline(always)]
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        let (_, root, s) = self.bent(x);
        (s + s) / (S::one() + root)
    }

    #[inline(always)]
    fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        self.bound(x)
    }

    #[inline(always)]
    fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        let (y, root, _) = self.bent(x);
        scale(axpy(y, S::from_f64(self.curvature), vec3(self.normal)), S::one() / root)
    }

    #[inline(always)]
    fn velocity<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        scale(cross(vec3(self.axis), self.normal(x)), S::from_f64(self.speed))
    }

    fn carried(&self, x: [f64; 3], dt: f64) -> [f64; 3] {
        add(x, turned(self.axis, self.speed * self.curvature, self.velocity(x), dt))
    }

    fn moves(&self) -> bool {
        self.speed != 0.0
    }

    fn seen_from(&self, origin: [f64; 3]) -> Self {
        Drum { point: sub(self.point, origin), ..*self }
    }

    fn invariant(&self) -> [bool; 3] {
        let along_axis = self.axis.iter().filter(|a| **a != 0.0).count() == 1;
        self.axis.map(|a| along_axis && a != 0.0)
    }

    fn acts_along(&self, direction: usize) -> Option<&'static str> {
        (!self.invariant()[direction]).then_some("the drum's normal points")
    }

    /// Arc length from `point`, and length along the axis.
    fn chart(&self, x: [f64; 3]) -> [f64; 2] {
        let n = self.normal(x);
        let angle = dot(n, self.along()).atan2(dot(n, self.normal));
        [angle / self.curvature, dot(self.axis, sub(x, self.point))]
    }

    fn point(&self, [arc, across]: [f64; 2]) -> [f64; 3] {
        let (sin, cos) = (self.curvature * arc).sin_cos();
        let bent = axpy(self.along(), sin, scale(self.normal, cos - 1.0));
        axpy(bent, 1.0 / self.curvature, axpy(self.axis, across, self.point))
    }

    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2] {
        [cross(self.axis, self.normal(x)), self.axis]
    }

    /// 3 degrees: the chord is within 0.04 % of the radius.
    fn straight(&self) -> [f64; 2] {
        [0.05 / self.curvature.abs(), f64::INFINITY]
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut all = vec![("road_curvature", self.curvature), ("road_speed", self.speed)];
        all.extend(["road_point_x", "road_point_y", "road_point_z"].into_iter().zip(self.point));
        all.extend(["road_normal_x", "road_normal_y", "road_normal_z"].into_iter().zip(self.normal));
        all.extend(["road_axis_x", "road_axis_y", "road_axis_z"].into_iter().zip(self.axis));
        all
    }

    fn description(&self) -> String {
        let Drum { point, axis, curvature, speed, .. } = self;
        let side = if *curvature > 0.0 { "outside" } else { "inside" };
        let turning = if self.moves() {
            format!("surface at {speed} m/s, {} rad/s about {axis:?}", speed * curvature)
        } else {
            "at rest".into()
        };
        format!("rigid drum of radius {} m, {side}, through {point:?} m, {turning}", 1.0 / curvature.abs())
    }
}
