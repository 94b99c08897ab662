//! Cameras: from metres to pixels, fitted to what must be seen.

use glam::{DMat4, DVec3, DVec4};

use super::gpu::ViewUniform;

/// From where a picture is taken. The wheel's axle is along y, it rolls towards +x, z is up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum View {
    /// Against the rolling direction: y to the right.
    Front,
    /// Along +y: x to the right.
    Side,
    /// From the side, a little ahead and above.
    Iso,
    /// Along the rolling direction: y to the left.
    Behind,
    /// From under the road: x to the right, y downwards.
    Below,
    /// Eye at `azimuth` from +x towards +y and `elevation` above the road's horizon [degrees].
    Angles { azimuth: f64, elevation: f64 },
}

impl View {
    /// (azimuth, elevation) of the eye [degrees].
    pub fn angles(self) -> (f64, f64) {
        match self {
            View::Front => (0.0, 0.0),
            View::Side => (-90.0, 0.0),
            View::Iso => (-58.0, 22.0),
            View::Behind => (180.0, 0.0),
            View::Below => (-90.0, -90.0),
            View::Angles { azimuth, elevation } => (azimuth, elevation.clamp(-90.0, 90.0)),
        }
    }

    /// Unit vectors of the picture: to the right, up, and towards the eye.
    pub(super) fn axes(self) -> [DVec3; 3] {
        let (azimuth, elevation) = self.angles();
        let (sa, ca) = azimuth.to_radians().sin_cos();
        let (se, ce) = elevation.to_radians().sin_cos();
        let right = DVec3::new(-sa, ca, 0.0);
        let back = DVec3::new(ce * ca, ce * sa, se);
        [right, back.cross(right), back]
    }
}

/// How depth is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Parallel lines stay parallel; lengths across the view are to scale everywhere.
    Orthographic,
    /// A lens that sees the body under `angle` degrees (5 to 40).
    Perspective { angle: f64 },
}

/// A rectangle of the picture in pixels from its top left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

/// A fitted camera.
#[derive(Debug, Clone)]
pub struct Camera {
    /// Origin of the picture's frame [m] and its unit [m].
    centre: DVec3,
    radius: f64,
    axes: [DVec3; 3],
    /// Distance of a perspective eye from the centre, in radii.
    distance: Option<f64>,
    /// Pixels per projected unit, and the pixel of the centre.
    zoom: f64,
    origin: [f64; 2],
    size: [u32; 2],
}

/// Depth of the view before and behind the centre, in radii. What is fitted lies within one; a footprint
/// also shows some of the body behind it.
const BEFORE: f64 = 1.1;
const BEHIND: f64 = 3.0;
/// How far lines are lifted, in radii: about a pixel at the slope of a steep surface.
const LIFT: f32 = 0.004;

impl Camera {
    /// A camera of `axes` that shows all of `points` [m] within `rect` of a picture of `size`.
    pub(super) fn fit(
        axes: [DVec3; 3],
        projection: Projection,
        points: &[DVec3],
        rect: Rect,
        size: [u32; 2],
    ) -> Camera {
        let low = points.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
        let high = points.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::ONE);
        let radius = 0.5 * (high - low).length();
        let mut camera = Camera {
            centre: 0.5 * (low + high),
            radius: if radius > 0.0 { radius } else { 1.0 },
            axes,
            distance: match projection {
                Projection::Orthographic => None,
                Projection::Perspective { angle } => {
                    Some(1.0 / (0.5 * angle.clamp(5.0, 40.0)).to_radians().sin())
                }
            },
            zoom: 1.0,
            origin: [0.0; 2],
            size,
        };
        camera.frame(points, rect);
        camera
    }

    /// Chooses zoom and origin so that the points fill the rectangle.
    fn frame(&mut self, points: &[DVec3], rect: Rect) {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for &point in points {
            let at = self.flat(point);
            low = [low[0].min(at[0]), low[1].min(at[1])];
            high = [high[0].max(at[0]), high[1].max(at[1])];
        }
        let span = |d: usize| (high[d] - low[d]).max(1e-12);
        self.zoom = (rect.width / span(0)).min(rect.height / span(1));
        let middle = [rect.x + 0.5 * rect.width, rect.y + 0.5 * rect.height];
        self.origin = [
            middle[0] - self.zoom * 0.5 * (low[0] + high[0]),
            middle[1] + self.zoom * 0.5 * (low[1] + high[1]),
        ];
    }

    /// A point [m] in the picture's frame.
    pub(super) fn local(&self, point: DVec3) -> [f32; 3] {
        ((point - self.centre) / self.radius).as_vec3().to_array()
    }

    /// Projected coordinates before zoom: right and up.
    fn flat(&self, point: DVec3) -> [f64; 2] {
        let [right, up, back] = self.axes.map(|a| a.dot(point - self.centre) / self.radius);
        let shrink = self.distance.map_or(1.0, |d| d / (d - back));
        [right * shrink, up * shrink]
    }

    /// Pixel coordinates (from the top left, pixel centres at halves) of a point [m].
    pub fn project(&self, point: [f64; 3]) -> [f64; 2] {
        let [right, up] = self.flat(DVec3::from(point));
        [self.origin[0] + self.zoom * right, self.origin[1] - self.zoom * up]
    }

    /// Pixels per metre across the view, at the depth of the body's middle.
    pub fn pixels_per_metre(&self) -> f64 {
        self.zoom / self.radius
    }

    /// Unit direction from the body towards the eye.
    pub(super) fn towards_eye(&self) -> DVec3 {
        self.axes[2]
    }

    /// Right, up and towards the eye, as components of a direction in space.
    pub(super) fn turn(&self, direction: DVec3) -> [f64; 3] {
        self.axes.map(|a| a.dot(direction))
    }

    /// What the shaders need; `shading` 0 (none) to 1.
    pub(super) fn uniform(&self, shading: f64) -> ViewUniform {
        let [right, up, back] = self.axes;
        let [w, h] = self.size.map(f64::from);
        // Rows act on (right, up, back, 1); `depth` is the row that becomes clip.w.
        let depth = self.distance.map_or(DVec4::W, |d| DVec4::new(0.0, 0.0, -1.0 / d, 1.0));
        let x = DVec4::X * (2.0 * self.zoom / w) + depth * (2.0 * self.origin[0] / w - 1.0);
        let y = DVec4::Y * (2.0 * self.zoom / h) + depth * (1.0 - 2.0 * self.origin[1] / h);
        let z = match self.distance {
            None => DVec4::new(0.0, 0.0, -1.0, BEFORE) / (BEFORE + BEHIND),
            Some(d) => {
                let (near, far) = (d - BEFORE, d + BEHIND);
                DVec4::new(0.0, 0.0, -1.0, d - near) * (far / (far - near) / d)
            }
        };
        let rotate = DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), DVec4::W);
        let clip = DMat4::from_cols(x, y, z, depth).transpose() * rotate.transpose();
        let light = (back + 0.55 * up - 0.45 * right).normalize();
        let eye = self.distance.map_or(back.extend(0.0), |d| (back * d).extend(1.0));
        ViewUniform {
            clip: clip.as_mat4().to_cols_array_2d(),
            eye: eye.as_vec4().to_array(),
            light: light.extend(shading.clamp(0.0, 1.0)).as_vec4().to_array(),
            size: self.size.map(|s| s as f32),
            lift: LIFT,
            unused: 0.0,
        }
    }
}
