//! Where a road with a shape of its own lies.

use super::plane::Plane;
use crate::tensor::{axpy, cross, dot, sub};

/// Axes of a road whose shape is a height over a plane: u and v lie in the plane, the third is its normal. Everything about such a road
/// is told in them, in f64: a node's coordinates are taken to them and back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// Where u, v and the height are zero [m].
    pub point: [f64; 3],
    /// Outward unit normal.
    pub normal: [f64; 3],
    /// Unit vector of u, square to the normal.
    pub along: [f64; 3],
}

impl Base {
    /// The base through `point` whose u is the part of x (or of y, where the normal is along x) in the plane, turned by `angle` [rad] about
    /// the normal.
    pub fn turned(point: [f64; 3], normal: [f64; 3], angle: f64) -> Base {
        let [x, y] = super::tangents_of(normal);
        let (sin, cos) = angle.sin_cos();
        Base { point, normal, along: std::array::from_fn(|d| cos * x[d] + sin * y[d]) }
    }

    /// Unit vector of v.
    pub fn across(&self) -> [f64; 3] {
        cross(self.normal, self.along)
    }

    /// u, v and height of a point.
    #[inline(always)]
    pub fn local(&self, x: [f64; 3]) -> [f64; 3] {
        let from = sub(x, self.point);
        [dot(self.along, from), dot(self.across(), from), dot(self.normal, from)]
    }

    /// A vector given by its parts along u, v and the normal.
    #[inline(always)]
    pub fn vector(&self, [u, v, w]: [f64; 3]) -> [f64; 3] {
        let across = self.across();
        std::array::from_fn(|d| u * self.along[d] + v * across[d] + w * self.normal[d])
    }

    /// The point with these coordinates.
    pub fn place(&self, local: [f64; 3]) -> [f64; 3] {
        axpy(self.vector(local), 1.0, self.point)
    }

    /// The plane of what is `height` over it, at rest.
    #[inline(always)]
    pub fn lifted(&self, height: f64) -> Plane {
        Plane { point: axpy(self.normal, height, self.point), normal: self.normal, velocity: [0.0; 3] }
    }

    /// The same base seen from axes whose origin is at `origin`.
    pub fn seen_from(&self, origin: [f64; 3]) -> Base {
        Base { point: sub(self.point, origin), ..*self }
    }

    /// Directions x, y, z along which a shape that depends on u alone does not change.
    pub fn invariant_across(&self) -> [bool; 3] {
        let across = self.across();
        let along_axis = across.iter().filter(|c| **c != 0.0).count() == 1;
        across.map(|c| along_axis && c != 0.0)
    }

    /// Values by the shaders' names.
    pub fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut all: Vec<(&'static str, f64)> = Vec::new();
        all.extend(["base_point_x", "base_point_y", "base_point_z"].into_iter().zip(self.point));
        all.extend(["base_normal_x", "base_normal_y", "base_normal_z"].into_iter().zip(self.normal));
        all.extend(["base_along_x", "base_along_y", "base_along_z"].into_iter().zip(self.along));
        all
    }

    /// Unit vectors of a surface with this unit normal: what is left of u along it, and what completes them.
    pub fn tangents(&self, normal: [f64; 3]) -> [[f64; 3]; 2] {
        // No normal of a height over the base lies in it along u and v at once: across is never along it.
        let across = self.across();
        let along = cross(across, normal);
        let length = dot(along, along).sqrt();
        let along = along.map(|c| c / length);
        [along, cross(normal, along)]
    }

    pub fn description(&self) -> String {
        let Base { point, normal, along } = self;
        format!("running along {along:?} through {point:?} m, normal {normal:?}")
    }
}
