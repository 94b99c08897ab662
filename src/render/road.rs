//! The road in a picture: a plate under the body with a quiet grid, on the road's own coordinates.

use glam::{DVec2, DVec3};

use super::camera::Camera;
use super::colour::{ink, linear};
use super::gpu::{Geometry, Segment};
use super::scale::{round_step, round_values};
use super::surface::quad;
use crate::scene::Road;

/// Unit vectors at a point of a road: along its two coordinates and outward, a right-handed set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes {
    pub along: DVec3,
    pub across: DVec3,
    pub normal: DVec3,
}

/// A road by its own coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chart(pub Road);

impl Chart {
    /// Coordinates of the surface point nearest to x [m].
    pub fn flat(&self, x: DVec3) -> DVec2 {
        self.0.chart(x.into()).into()
    }

    /// Height above the road [m].
    pub fn gap(&self, x: DVec3) -> f64 {
        self.0.gap(x.to_array())
    }

    /// The point of the road with the given coordinates, lifted by `height`.
    pub fn at(&self, flat: DVec2, height: f64) -> DVec3 {
        let x = self.0.point(flat.into());
        DVec3::from(x) + DVec3::from(self.0.normal(x)) * height
    }

    /// Axes at the surface point nearest to x.
    pub fn axes(&self, x: DVec3) -> Axes {
        let [along, across] = self.0.tangents(x.into()).map(DVec3::from);
        Axes { along, across, normal: self.0.normal(x.to_array()).into() }
    }

    /// Coordinates along the first direction from `low` to `high`, between which the road is drawn straight.
    fn steps(&self, low: f64, high: f64) -> Vec<f64> {
        let count = ((high - low) / self.0.straight()).ceil().max(1.0) as usize;
        (0..=count).map(|i| low + (high - low) * i as f64 / count as f64).collect()
    }
}

/// The part of a road that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    chart: Chart,
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
    pub fn under(chart: Chart, points: &[DVec3], margin: f64) -> Plate {
        let flats = || points.iter().map(|&p| chart.flat(p));
        let low = flats().reduce(DVec2::min).unwrap_or(DVec2::ZERO);
        let high = flats().reduce(DVec2::max).unwrap_or(DVec2::ONE);
        let size = (high - low).max_element();
        let margin = DVec2::splat(margin * size);
        Plate {
            chart,
            low: low - margin,
            high: high + margin,
            thickness: 0.045 * size,
            spacing: round_step(size, 10),
        }
    }

    /// The rim of the plate at this height, along both edges: for fitting the camera.
    fn rims(&self, height: f64) -> [Vec<DVec3>; 2] {
        [self.low.y, self.high.y].map(|y| {
            let steps = self.chart.steps(self.low.x, self.high.x);
            steps.into_iter().map(|x| self.chart.at(DVec2::new(x, y), height)).collect()
        })
    }

    /// Points that a picture of the plate must hold.
    pub fn outline(&self) -> Vec<DVec3> {
        [self.rims(0.0), self.rims(-self.thickness)].concat().concat()
    }

    /// Draws the plate; seen from below only its grid, so that the body stays visible.
    pub fn draw(&self, camera: &Camera, unit: f64, geometry: &mut Geometry) {
        let middle = self.chart.at(0.5 * (self.low + self.high), 0.0);
        let facing = self.chart.axes(middle).normal.dot(camera.towards_eye());
        if facing > -1e-6 {
            let ([near, far], [near_foot, far_foot]) = (self.rims(0.0), self.rims(-self.thickness));
            let last = near.len() - 1;
            let mut side = |corners| quad(&mut geometry.plain, camera, corners, [linear(SIDE); 4]);
            for i in 0..last {
                side([near_foot[i], near_foot[i + 1], near[i + 1], near[i]]);
                side([far_foot[i + 1], far_foot[i], far[i], far[i + 1]]);
            }
            side([near_foot[last], far_foot[last], far[last], near[last]]);
            side([far_foot[0], near_foot[0], near[0], far[0]]);
            for i in 0..last {
                let top = [near[i], near[i + 1], far[i + 1], far[i]];
                quad(&mut geometry.plain, camera, top, [linear(TOP); 4]);
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
        let at = |x: f64, y: f64| self.chart.at(DVec2::new(x, y), 0.0);
        let (quiet, border) = (ink(GRID, 0.8), ink(GRID, 1.0));
        let (low, high) = (self.low, self.high);
        let across = |x: f64| [at(x, low.y), at(x, high.y)];
        let along = |y: f64| {
            let points: Vec<DVec3> = self.chart.steps(low.x, high.x).into_iter().map(|x| at(x, y)).collect();
            points.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
        };
        let mut lines = Vec::new();
        let columns = round_values(low.x, high.x, self.spacing);
        lines.extend(columns.into_iter().map(|x| (across(x), quiet, 1.0)));
        let rows = round_values(low.y, high.y, self.spacing);
        lines.extend(rows.into_iter().flat_map(along).map(|line| (line, quiet, 1.0)));
        lines.extend([low.x, high.x].map(|x| (across(x), border, 1.5)));
        lines.extend([low.y, high.y].into_iter().flat_map(along).map(|line| (line, border, 1.5)));
        lines
    }
}
