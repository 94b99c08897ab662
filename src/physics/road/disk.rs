use super::plane::Plane;
use super::{Surface, turned};
use crate::scalar::{Real, Scalar};
use crate::tensor::{Vec3, add, axpy, cross, scale, sub, vec3};

/// A plane that turns about its own normal, as the disk of an abrasion tester does.
///
/// Its velocity is that of one of its points and what turning adds from there, v = v0 + spin n x (x - point): a disk however large,
/// whose centre is far away, has the digits of the plane that moves with v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    /// Where it is, and how it moves at `plane.point`.
    pub plane: Plane,
    /// Angular velocity about the normal, counterclockwise as seen from outside [rad/s].
    pub spin: f64,
}

impl Disk {
    /// The disk through `centre` that turns about `normal` (a unit vector), seen from its point nearest to `near` [m].
    pub fn about(centre: [f64; 3], normal: [f64; 3], spin: f64, near: [f64; 3]) -> Disk {
        let height: f64 = crate::tensor::dot(normal, sub(near, centre));
        let point = axpy(normal, -height, near);
        let velocity = scale(cross(normal, sub(point, centre)), spin);
        Disk { plane: Plane { point, normal, velocity }, spin }
    }

    /// Where it does not move [m]; of no use on a disk at rest.
    pub fn centre(&self) -> [f64; 3] {
        let Plane { point, normal, velocity } = self.plane;
        axpy(cross(normal, velocity), 1.0 / self.spin, point)
    }
}

impl Surface for Disk {
    const NAME: &'static str = "disk";

    #[inline(always)]
    fn bound<S: Scalar>(&self, x: Vec3<S>) -> S {
        self.plane.bound(x)
    }

    #[inline(always)]
    fn gap<S: Real>(&self, x: Vec3<S>) -> S {
        self.plane.gap(x)
    }

    #[inline(always)]
    fn normal<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        self.plane.normal(x)
    }

    #[inline(always)]
    fn velocity<S: Real>(&self, x: Vec3<S>) -> Vec3<S> {
        let from_point = sub(x, vec3(self.plane.point));
        let turning = cross(vec3(self.plane.normal), from_point);
        axpy(turning, S::from_f64(self.spin), vec3(self.plane.velocity))
    }

    /// The velocity half a step back: with the one at its end a node that sticks would come nearer to the centre with every step.
    #[inline(always)]
    fn velocity_over<S: Real>(&self, x: Vec3<S>, dt: S) -> Vec3<S> {
        let v = self.velocity(x);
        axpy(cross(vec3(self.plane.normal), v), S::from_f64(-0.5 * self.spin) * dt, v)
    }

    fn carried(&self, x: [f64; 3], dt: f64) -> [f64; 3] {
        add(x, turned(self.plane.normal, self.spin, self.velocity(x), dt))
    }

    fn turning(&self) -> f64 {
        self.spin.abs()
    }

    fn moves(&self) -> bool {
        self.spin != 0.0
    }

    fn seen_from(&self, origin: [f64; 3]) -> Self {
        Disk { plane: self.plane.seen_from(origin), ..*self }
    }

    /// Nowhere: the surface looks the same from everywhere, but its velocity does not, and must not be that of another place.
    fn invariant(&self) -> [bool; 3] {
        if self.moves() { [false; 3] } else { self.plane.invariant() }
    }

    fn acts_along(&self, direction: usize) -> Option<&'static str> {
        let normal = self.plane.normal;
        let turns = self.moves() && normal[direction].abs() < 1.0;
        match normal[direction] != 0.0 {
            true => Some("the road's normal points"),
            false => turns.then_some("the disk moves"),
        }
    }

    fn chart(&self, x: [f64; 3]) -> [f64; 2] {
        self.plane.chart(x)
    }

    fn point(&self, chart: [f64; 2]) -> [f64; 3] {
        Surface::point(&self.plane, chart)
    }

    fn tangents(&self, x: [f64; 3]) -> [[f64; 3]; 2] {
        self.plane.tangents(x)
    }

    fn straight(&self) -> [f64; 2] {
        self.plane.straight()
    }

    fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut all = self.plane.constants();
        all.extend(["road_point_x", "road_point_y", "road_point_z"].into_iter().zip(self.plane.point));
        all.push(("road_spin", self.spin));
        all
    }

    fn description(&self) -> String {
        let Plane { point, normal, .. } = self.plane;
        match self.moves() {
            true => {
                let centre = self.centre();
                format!(
                    "rigid disk about {centre:?} m, normal {normal:?}, turning by {} rad/s about it",
                    self.spin
                )
            }
            false => format!("rigid disk through {point:?} m, normal {normal:?}, at rest"),
        }
    }
}
