//! The road in a picture: a plate under the body with a quiet grid.

use glam::{DVec2, DVec3};

use super::camera::Camera;
use super::colour::{ink, linear};
use super::gpu::{Geometry, Segment};
use super::scale::{round_step, round_values};
use super::surface::quad;
use crate::scene::Road;

/// A plane with axes in it: `along` is x (or what is left of it in the plane), `across` completes
/// (along, across, normal) to a right-handed set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    pub point: DVec3,
    pub along: DVec3,
    pub across: DVec3,
    pub normal: DVec3,
}

impl Plane {
    /// The plane of a road.
    pub fn of(road: Road) -> Plane {
        let Road::Plane { point, normal, .. } = road;
        let normal = DVec3::from(normal).try_normalize().unwrap_or(DVec3::Z);
        let start = if normal.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
        let along = start.reject_from_normalized(normal).normalize();
        // The origin of the plane's coordinates is the foot of the space's origin.
        let foot = normal * normal.dot(DVec3::from(point));
        Plane { point: foot, along, across: normal.cross(along), normal }
    }

    /// Coordinates in the plane [m].
    pub fn flat(&self, x: DVec3) -> DVec2 {
        DVec2::new(self.along.dot(x - self.point), self.across.dot(x - self.point))
    }

    /// Height above the plane [m].
    pub fn gap(&self, x: DVec3) -> f64 {
        self.normal.dot(x - self.point)
    }

    /// The point of the plane with the given coordinates, lifted by `height`.
    pub fn at(&self, flat: DVec2, height: f64) -> DVec3 {
        self.point + self.along * flat.x + self.across * flat.y + self.normal * height
    }
}

/// The part of a road that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    plane: Plane,
    low: DVec2,
    high: DVec2,
    thickness: f64,
    spacing: f64,
}

const TOP: [u8; 3] = [240, 241, 244];
const SIDE: [u8; 3] = [214, 217, 223];
const GRID: [u8; 3] = [196, 201, 209];

impl Plate {
    /// A plate under `points`, wider than them by `margin` times their size.
    pub fn under(plane: Plane, points: &[DVec3], margin: f64) -> Plate {
        let flats = || points.iter().map(|&p| plane.flat(p));
        let low = flats().reduce(DVec2::min).unwrap_or(DVec2::ZERO);
        let high = flats().reduce(DVec2::max).unwrap_or(DVec2::ONE);
        let size = (high - low).max_element();
        let margin = DVec2::splat(margin * size);
        Plate {
            plane,
            low: low - margin,
            high: high + margin,
            thickness: 0.045 * size,
            spacing: round_step(size, 10),
        }
    }

    /// Corners of the top, for fitting the camera.
    pub fn corners(&self) -> [DVec3; 4] {
        let [l, h] = [self.low, self.high];
        [l, DVec2::new(h.x, l.y), h, DVec2::new(l.x, h.y)].map(|c| self.plane.at(c, 0.0))
    }

    /// Corners of the bottom.
    pub fn foot(&self) -> [DVec3; 4] {
        self.corners().map(|c| c - self.plane.normal * self.thickness)
    }

    /// Draws the plate; seen from below only its grid, so that the body stays visible.
    pub fn draw(&self, camera: &Camera, unit: f64, geometry: &mut Geometry) {
        let facing = self.plane.normal.dot(camera.towards_eye());
        if facing > -1e-6 {
            let (top, foot) = (self.corners(), self.foot());
            quad(&mut geometry.plain, camera, top, [linear(TOP); 4]);
            for c in 0..4 {
                let n = (c + 1) % 4;
                quad(&mut geometry.plain, camera, [foot[c], foot[n], top[n], top[c]], [linear(SIDE); 4]);
            }
        }
        for (line, mut colour, width) in self.grid() {
            let [from, to] = line.map(|p| camera.local(p));
            if facing < 0.0 {
                // Over the body: fainter.
                colour[3] *= 0.4;
            }
            geometry.segments.push(Segment { from, to, colour, width: (width * unit) as f32 });
        }
    }

    /// Grid lines at round coordinates, and the border.
    fn grid(&self) -> Vec<([DVec3; 2], [f32; 4], f64)> {
        let at = |x: f64, y: f64| self.plane.at(DVec2::new(x, y), 0.0);
        let quiet = ink(GRID, 0.8);
        let (low, high) = (self.low, self.high);
        let columns = round_values(low.x, high.x, self.spacing).into_iter();
        let rows = round_values(low.y, high.y, self.spacing).into_iter();
        let mut lines: Vec<_> = columns.map(|x| ([at(x, low.y), at(x, high.y)], quiet, 1.0)).collect();
        lines.extend(rows.map(|y| ([at(low.x, y), at(high.x, y)], quiet, 1.0)));
        let corners = self.corners();
        lines.extend((0..4).map(|c| ([corners[c], corners[(c + 1) % 4]], ink(GRID, 1.0), 1.5)));
        lines
    }
}
