//! Contact forces as arrows in space, normal and shear to one scale.

use glam::DVec3;
use image::RgbaImage;

use super::Renderer;
use super::camera::{Camera, Projection, View};
use super::canvas::{Anchor, Canvas, Weight};
use super::colour::{INK, QUIET, SLIP, ink, linear};
use super::contact::{Contact, Touch, travel};
use super::footprint::{FootprintView, Layout, caption, colour_legend};
use super::gpu::{Frame, Geometry, Vertex};
use super::legend;
use super::road::Plate;
use super::scale::{Scale, quantity, round_below};
use super::surface::{edges, lines};
use super::symbols::{StateSymbol, state_legend, travel_legend};
use crate::Result;
use crate::model::mesh::Mesh;
use crate::record::Snapshot;

/// Sides of an arrow's shaft and head: round enough at a few pixels.
const SIDES: usize = 12;

/// Longest arrow over the size of the shown part.
const REACH: f64 = 0.42;

impl Renderer {
    pub(super) fn relief(
        &mut self,
        mesh: &Mesh,
        snapshot: &Snapshot,
        options: &FootprintView,
        contact: &Contact,
        scale: &Scale,
        view: View,
    ) -> Result<RgbaImage> {
        let layout = Layout::new(options.size);
        let axes = contact.axes;
        let largest = contact.touches.iter().map(|t| t.normal.max(t.shear.length())).fold(0.0, f64::max);
        let reach = REACH * (contact.high - contact.low).max_element();
        let metres_per_newton = if largest > 0.0 { reach / largest } else { 0.0 };
        let plate = Plate::under(contact.chart.clone(), &contact.corners(), 0.03);
        let mut points = plate.outline();
        let tip = |t: &Touch| t.x + contact.chart.axes(t.x).normal * (t.normal * metres_per_newton);
        points.extend(contact.touches.iter().map(tip));
        let camera = Camera::fit(view.axes(), Projection::Orthographic, &points, layout.plot, options.size);

        let mut geometry = Geometry::default();
        plate.draw(&camera, layout.unit, &mut geometry);
        outline(&mut geometry, &camera, snapshot, contact, layout.unit);
        let thick = 0.045 * contact.spacing;
        for touch in &contact.touches {
            let here = contact.chart.axes(touch.x);
            let normal = here.normal * (touch.normal * metres_per_newton);
            let shear = here.along * touch.shear.x + here.across * touch.shear.y;
            let place = scale.place(options.colour.of(touch)) as f32;
            arrow(&mut geometry.mapped, &camera, touch.x, normal, thick, [place, 0.0, 0.0]);
            let colour = linear(if touch.slips { SLIP } else { INK });
            arrow(&mut geometry.plain, &camera, touch.x, shear * metres_per_newton, thick, colour);
        }
        let [width, height] = options.size;
        let frame = Frame { x: 0, y: 0, width, height };
        let uniform = camera.uniform(0.35);
        let picture = self.gpu.draw(options.size, frame, &uniform, &options.map.texels(), &geometry)?;

        let mut canvas = Canvas::new(picture, &self.fonts, layout.unit)?;
        let u = layout.unit;
        caption(&mut canvas, snapshot, options, contact);
        let x = layout.legend.x;
        let mut y = colour_legend(&mut canvas, &layout, options, contact, scale);
        if largest > 0.0 {
            y = reference(&mut canvas, &camera, axes.normal, largest, metres_per_newton, [x, y]);
        } else {
            let at = [layout.plot.x, layout.plot.y];
            canvas.text("no contact", at, Anchor::Left, Weight::Medium, 30.0, QUIET, 0.0);
        }
        y = state_legend(&mut canvas, [x, y], contact, StateSymbol::Arrow);
        if let Some(way) = travel(mesh, snapshot, contact) {
            let [right, up, _] = camera.turn(axes.along * way.x + axes.across * way.y);
            travel_legend(&mut canvas, [x, y], [right, -up]);
        }
        let foot = f64::from(height) - 42.0 * u;
        legend::length_bar(&mut canvas, [180.0 * u, foot], 240.0 * u, camera.pixels_per_metre());
        legend::triad(&mut canvas, &camera, [80.0 * u, foot - 42.0 * u]);
        canvas.finish()
    }
}

/// The body's facets by the road, as lines: they must not hide the arrows.
fn outline(geometry: &mut Geometry, camera: &Camera, snapshot: &Snapshot, contact: &Contact, unit: f64) {
    let inside = |n: &u32| {
        let x = DVec3::from(snapshot.x[*n as usize]);
        let flat = contact.chart.flat(x);
        let is_near = contact.chart.gap(x) < contact.spacing;
        is_near && flat.cmpge(contact.low).all() && flat.cmple(contact.high).all()
    };
    let near: Vec<[u32; 4]> = contact.facets.iter().filter(|f| f.iter().all(inside)).copied().collect();
    geometry.segments.extend(lines(camera, &edges(&near), &snapshot.x, ink(QUIET, 0.8), 1.2 * unit));
}

/// A reference arrow along the road's normal as the camera sees it; returns where the next legend may start.
fn reference(
    canvas: &mut Canvas,
    camera: &Camera,
    normal: DVec3,
    largest: f64,
    metres_per_newton: f64,
    [x, y]: [f64; 2],
) -> f64 {
    let u = canvas.unit;
    canvas.text("Forces on the body", [x, y], Anchor::Left, Weight::Medium, 20.0, INK, 0.0);
    let [right, up, _] = camera.turn(normal);
    let pixels_per_newton = metres_per_newton * camera.pixels_per_metre();
    let room = 110.0 * u / (pixels_per_newton * right.hypot(up).max(0.05));
    let force = round_below(room.min(largest));
    let length = force * pixels_per_newton;
    let foot = [x + 14.0 * u, y + 24.0 * u + length * up.max(0.0)];
    canvas.arrow(foot, [foot[0] + length * right, foot[1] - length * up], 3.0 * u, INK);
    let label = format!("{} (normal)", quantity(force, "N", 1));
    let at = [foot[0] + 22.0 * u, foot[1] - 0.5 * length * up];
    canvas.text(&label, at, Anchor::Left, Weight::Regular, 19.0, INK, 0.0);
    foot[1] + 40.0 * u
}

/// A solid arrow of `reach` [m] from `foot`, its shaft `thick` [m] in radius.
fn arrow(into: &mut Vec<Vertex>, camera: &Camera, foot: DVec3, reach: DVec3, thick: f64, paint: [f32; 3]) {
    let length = reach.length();
    if length < 0.5 * thick {
        return;
    }
    let along = reach / length;
    let (a, b) = along.any_orthonormal_pair();
    let head = (6.0 * thick).min(0.6 * length);
    let (wide, thick) = (0.4 * head, thick.min(0.17 * head));
    let ring: Vec<DVec3> = (0..=SIDES)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / SIDES as f64).sin_cos();
            a * cos + b * sin
        })
        .collect();
    let (neck, tip) = (foot + along * (length - head), foot + reach);
    let mut corner = |at: DVec3, normal: DVec3| {
        let normal = normal.as_vec3().to_array();
        into.push(Vertex { position: camera.local(at), normal, paint });
    };
    for pair in ring.windows(2) {
        let [p, q] = [pair[0], pair[1]];
        for (at, normal) in [
            (foot + p * thick, p),
            (foot + q * thick, q),
            (neck + q * thick, q),
            (foot + p * thick, p),
            (neck + q * thick, q),
            (neck + p * thick, p),
            (neck + p * wide, p + along * 0.4),
            (neck + q * wide, q + along * 0.4),
            (tip, p + q + along * 0.8),
            (neck, -along),
            (neck + q * wide, -along),
            (neck + p * wide, -along),
        ] {
            corner(at, normal);
        }
    }
}
