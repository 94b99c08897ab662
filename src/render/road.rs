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
#[derive(Debug, Clone, PartialEq)]
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

    /// Coordinates from `low` to `high` along the first or the second direction, between which the road is drawn straight.
    fn steps(&self, direction: usize, low: f64, high: f64) -> Vec<f64> {
        let count = ((high - low) / self.0.straight()[direction]).ceil().clamp(1.0, MOST_STEPS) as usize;
        (0..=count).map(|i| low + (high - low) * i as f64 / count as f64).collect()
    }
}

/// A picture has some thousand pixels across: finer steps are not seen.
const MOST_STEPS: f64 = 500.0;

/// The part of a road that is drawn.
#[derive(Debug, Clone, PartialEq)]
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

    /// Where the road is drawn straight, along its two coordinates.
    fn steps(&self) -> [Vec<f64>; 2] {
        let (low, high) = (self.low, self.high);
        [self.chart.steps(0, low.x, high.x), self.chart.steps(1, low.y, high.y)]
    }

    /// Points along the four edges, at the road's surface or below it: along the first coordinate, and along the second.
    fn rims(&self, below: f64) -> [Vec<DVec3>; 4] {
        let [xs, ys] = self.steps();
        let at = |x: f64, y: f64| self.chart.at(DVec2::new(x, y), -below);
        let along = |y: f64| xs.iter().map(|&x| at(x, y)).collect();
        let across = |x: f64| ys.iter().map(|&y| at(x, y)).collect();
        [along(self.low.y), along(self.high.y), across(self.low.x), across(self.high.x)]
    }

    /// Points that a picture of the plate must hold.
    pub fn outline(&self) -> Vec<DVec3> {
        [self.rims(0.0), self.rims(self.thickness)].concat().concat()
    }

    /// Draws the plate; seen from below only its grid, so that the body stays visible.
    pub fn draw(&self, camera: &Camera, unit: f64, geometry: &mut Geometry) {
        let middle = self.chart.at(0.5 * (self.low + self.high), 0.0);
        let facing = self.chart.axes(middle).normal.dot(camera.towards_eye());
        if facing > -1e-6 {
            self.draw_sides(camera, geometry);
            self.draw_top(camera, geometry);
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

    fn draw_sides(&self, camera: &Camera, geometry: &mut Geometry) {
        let (tops, feet) = (self.rims(0.0), self.rims(self.thickness));
        for (edge, reversed) in [(0, false), (1, true), (3, false), (2, true)] {
            for (top, foot) in tops[edge].windows(2).zip(feet[edge].windows(2)) {
                let [a, b] = if reversed { [1, 0] } else { [0, 1] };
                let corners = [foot[a], foot[b], top[b], top[a]];
                quad(&mut geometry.plain, camera, corners, [linear(SIDE); 4]);
            }
        }
    }

    fn draw_top(&self, camera: &Camera, geometry: &mut Geometry) {
        let [xs, ys] = self.steps();
        let line =
            |y: &f64| -> Vec<DVec3> { xs.iter().map(|&x| self.chart.at(DVec2::new(x, *y), 0.0)).collect() };
        let lines: Vec<Vec<DVec3>> = ys.iter().map(line).collect();
        for pair in lines.windows(2) {
            for (near, far) in pair[0].windows(2).zip(pair[1].windows(2)) {
                quad(&mut geometry.plain, camera, [near[0], near[1], far[1], far[0]], [linear(TOP); 4]);
            }
        }
    }

    /// Grid lines at round coordinates, and the border.
    fn grid(&self) -> Vec<([DVec3; 2], [f32; 4], f64)> {
        let at = |x: f64, y: f64| self.chart.at(DVec2::new(x, y), 0.0);
        let pieces = |points: Vec<DVec3>| -> Vec<[DVec3; 2]> {
            points.windows(2).map(|pair| [pair[0], pair[1]]).collect()
        };
        let (quiet, border) = (ink(GRID, 0.8), ink(GRID, 1.0));
        let (low, high, [xs, ys]) = (self.low, self.high, self.steps());
        let across = |x: f64| pieces(ys.iter().map(|&y| at(x, y)).collect());
        let along = |y: f64| pieces(xs.iter().map(|&x| at(x, y)).collect());
        let mut lines = Vec::new();
        let columns = round_values(low.x, high.x, self.spacing);
        lines.extend(columns.into_iter().flat_map(across).map(|line| (line, quiet, 1.0)));
        let rows = round_values(low.y, high.y, self.spacing);
        lines.extend(rows.into_iter().flat_map(along).map(|line| (line, quiet, 1.0)));
        lines.extend([low.x, high.x].into_iter().flat_map(across).map(|line| (line, border, 1.5)));
        lines.extend([low.y, high.y].into_iter().flat_map(along).map(|line| (line, border, 1.5)));
        lines
    }
}
