use super::Surface;
use crate::scalar::{Real, Scalar};
use crate::tensor::{Vec3, dot, scale, sub, vec3};

/// The half-space n . x < n . point, moving in its own plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// A point of the surface [m].
    pub point: [f64; 3],
    /// Outward unit normal.
    pub normal: [f64; 3],
    /// Velocity, square to the normal [m/s].
    pub velocity: [f64; 3],
}

impl Plane {
    /// n . point [m].
    #[inline(always)]
    fn offset(&self) -> f64 {
        let (n, p) = (self.normal, self.point);
        n[0] * p[0] + n[1] * p[1] + n[2] * p[2]
    }

    /// The point nearest to the origin [m]: where its coordinates are zero.
    fn foot(&self) -> [f64; 3] {
        scale(self.normal, self.offset())
    }
}

impl Surface for Plane {
    const NAME: &'static str = "plane";

    #[inline(always)]
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        dot(vec3(self.normal), x) - S::from_f64(self.offset())
    }

    #[inline(always)]
    fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        self.bound(x)
    }

    #[inline(always)]
    fn normal<S: Real>(&self, _x: Vec3<S>) -> Vec3<S> {
        vec3(self.normal)
    }

    #[inline(always)]
    fn velocity<S: Real>(&self, _x: Vec3<S>) -> Vec3<S> {
        vec3(self.velocity)
    }

    fn moves(&self) -> bool {
        self.velocity != [0.0; 3]
    }

    fn seen_from(&self, origin: [f64; 3]) -> Self {
        Plane { point: sub(self.point, origin), ..*self }
    }

    /// Along the axes in it, where it is square to the third.
    fn invariant(&self) -> [bool; 3] {
        let along_axis = self.normal.iter().filter(|n| **n != 0.0).count() == 1;
        self.normal.map(|n| along_axis && n == 0.0)
    }

    fn acts_along(&self, direction: usize) -> Option<&'static str> {
        match (self.normal[direction] != 0.0, self.velocity[direction] != 0.0) {
            (true, _) => Some("the road's normal points"),
            (false, true) => Some("the road moves"),
            (false, false) => None,
        }
    }

    fn chart(&self, x: [f64; 3]) -> [f64; 2] {
        let from_foot = sub(x, self.foot());
        self.tangents(x).map(|t| dot(t, from_foot))
    }

    fn point(&self, chart: [f64; 2]) -> [f64; 3] {
        let ([a, b], foot) = (self.tangents([0.0; 3]), self.foot());
        std::array::from_fn(|d| foot[d] + chart[0] * a[d] + chart[1] * b[d])
    }

    fn tangents(&self, _x: [f64; 3]) -> [[f64; 3]; 2] {
        super::tangents_of(self.normal)
    }

    fn straight(&self) -> [f64; 2] {
        [f64::INFINITY; 2]
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut all = vec![("road_offset", self.offset())];
        all.extend(["road_normal_x", "road_normal_y", "road_normal_z"].into_iter().zip(self.normal));
        all.extend(["road_velocity_x", "road_velocity_y", "road_velocity_z"].into_iter().zip(self.velocity));
        all
    }

    fn description(&self) -> String {
        let Plane { point, normal, velocity } = self;
        let moving = if self.moves() { format!("moving with {velocity:?} m/s") } else { "at rest".into() };
        format!("rigid plane through {point:?} m, normal {normal:?}, {moving}")
    }
}
