//! Contact forces: the footprint seen through the road, or as arrows in space.

use glam::DVec3;
use image::RgbaImage;

use super::camera::{Camera, Projection, Rect, View};
use super::canvas::{Anchor, Canvas, Weight};
use super::colour::{ColourMap, INK, QUIET, ink, linear};
use super::contact::{Contact, Touch, touching, travel};
use super::gpu::{Frame, Geometry};
use super::scale::{Range, Scale, number, prefix, round_step, round_values};
use super::surface::{edge_style, edges, lines, quad};
use super::symbols::{StateSymbol, Symbols, state_legend, travel_legend};
use super::{DEFAULT_SIZE, Renderer, check_size, field, legend, unit_of};
use crate::Result;
use crate::model::mesh::Mesh;
use crate::record::Snapshot;
use crate::scene::{GROUND, Road};

/// How contact forces are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FootprintStyle {
    /// From below: the normal force as colour, the shear force as arrows.
    Flat,
    /// From `view`: normal and shear forces as arrows in space, to one scale.
    Arrows { view: View },
}

/// What colours the contact nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FootprintColour {
    /// Normal force of each node [N].
    #[default]
    Force,
    /// Normal force over the node's deformed area [Pa]: comparable between edge and middle nodes.
    Pressure,
}

/// How to draw the contact.
#[derive(Debug, Clone, PartialEq)]
pub struct FootprintView {
    /// Width and height [pixels].
    pub size: [u32; 2],
    pub style: FootprintStyle,
    pub colour: FootprintColour,
    /// Values that the colour bar spans.
    pub range: Range,
    pub map: ColourMap,
    /// A line above the picture; `None`: only time and forces.
    pub title: Option<String>,
    pub road: Road,
}

impl Default for FootprintView {
    fn default() -> Self {
        FootprintView {
            size: DEFAULT_SIZE,
            style: FootprintStyle::Flat,
            colour: FootprintColour::default(),
            range: Range::Auto,
            map: ColourMap::default(),
            title: None,
            road: GROUND,
        }
    }
}

/// Ends of the values that a picture of the contact shows, from zero on [SI].
pub fn footprint_values(mesh: &Mesh, snapshot: &Snapshot, options: &FootprintView) -> [f64; 2] {
    let touches = Contact::of(mesh, snapshot, options.road.clone()).touches;
    [0.0, touches.iter().map(|t| options.colour.of(t)).fold(0.0, f64::max)]
}

impl FootprintColour {
    pub(super) fn of(self, touch: &Touch) -> f64 {
        match self {
            FootprintColour::Force => touch.normal,
            FootprintColour::Pressure => touch.pressure,
        }
    }

    pub(super) fn name(self) -> (&'static str, &'static str) {
        match self {
            FootprintColour::Force => ("Normal force", "N"),
            FootprintColour::Pressure => ("Contact pressure", "Pa"),
        }
    }
}

/// Where things stand in the picture.
pub(super) struct Layout {
    pub unit: f64,
    /// The plot's frame.
    pub plot: Rect,
    /// The column of legends.
    pub legend: Rect,
}

impl Layout {
    pub(super) fn new([width, height]: [u32; 2]) -> Layout {
        let unit = unit_of([width, height]);
        let [w, h] = [f64::from(width), f64::from(height)];
        // Whole pixels: the frame is also the scissor of the device.
        let [x, y] = [(120.0 * unit).round(), (115.0 * unit).round()];
        let plot = Rect { x, y, width: (w - 490.0 * unit).round(), height: (h - 215.0 * unit).round() };
        let legend = Rect { x: w - 320.0 * unit, y, width: 290.0 * unit, height: plot.height };
        Layout { unit, plot, legend }
    }
}

/// Pale body seen through the road: touching, and fading with the distance from the road.
const NEAR: [u8; 3] = [222, 226, 232];
const FAR: [u8; 3] = [250, 250, 252];

impl Renderer {
    /// Draws the contact between body and road; without contact, the part of the body nearest to the road
    /// and a note.
    ///
    /// Errors: as [`Renderer::body`].
    pub fn footprint(
        &mut self,
        mesh: &Mesh,
        snapshot: &Snapshot,
        options: &FootprintView,
    ) -> Result<RgbaImage> {
        check_size(options.size, self.gpu.largest())?;
        field::check(mesh, snapshot)?;
        let contact = Contact::of(mesh, snapshot, options.road.clone());
        let (_, unit) = options.colour.name();
        let values: Vec<f64> = contact.touches.iter().map(|t| options.colour.of(t)).collect();
        let scale = Scale::new(&values, unit, options.range, true);
        match options.style {
            FootprintStyle::Flat => self.flat(mesh, snapshot, options, &contact, &scale),
            FootprintStyle::Arrows { view } => self.relief(mesh, snapshot, options, &contact, &scale, view),
        }
    }

    fn flat(
        &mut self,
        mesh: &Mesh,
        snapshot: &Snapshot,
        options: &FootprintView,
        contact: &Contact,
        scale: &Scale,
    ) -> Result<RgbaImage> {
        let layout = Layout::new(options.size);
        let axes = contact.axes;
        let axes = [axes.along, -axes.across, -axes.normal];
        let camera =
            Camera::fit(axes, Projection::Orthographic, &contact.corners(), layout.plot, options.size);
        let symbols = Symbols::new(contact, camera.pixels_per_metre(), layout.unit);
        let place = |touch: &Touch| scale.place(options.colour.of(touch));
        let mut geometry = body_from_below(mesh, snapshot, contact, &camera, layout.unit);
        if symbols.state == StateSymbol::Dot {
            let touching = contact_facets(mesh, snapshot, contact, place);
            for (corners, paint) in touching {
                quad(&mut geometry.mapped, &camera, corners, paint);
            }
        }
        let Rect { x, y, width, height } = layout.plot;
        let frame = Frame { x: x as u32, y: y as u32, width: width as u32, height: height as u32 };
        let view = camera.uniform(0.0);
        let picture = self.gpu.draw(options.size, frame, &view, &options.map.texels(), &geometry)?;

        let mut canvas = Canvas::new(picture, &self.fonts, layout.unit)?;
        caption(&mut canvas, snapshot, options, contact);
        plot_frame(&mut canvas, layout.plot, &camera, contact);
        for touch in &contact.touches {
            let fill = options.map.at(place(touch));
            symbols.node(&mut canvas, camera.project(touch.x.into()), fill, touch.slips);
        }
        symbols.arrows(&mut canvas, &camera, contact);
        if contact.touches.is_empty() {
            let middle = [x + 0.5 * width, y + 0.5 * height];
            canvas.text("no contact", middle, Anchor::Middle, Weight::Medium, 30.0, QUIET, 0.0);
        }
        let mut y = colour_legend(&mut canvas, &layout, options, contact, scale);
        y = symbols.legend(&mut canvas, [layout.legend.x, y]);
        y = state_legend(&mut canvas, [layout.legend.x, y], contact, symbols.state);
        if let Some(way) = travel(mesh, snapshot, contact) {
            travel_legend(&mut canvas, [layout.legend.x, y], [way.x, way.y]);
        }
        canvas.finish()
    }
}

fn body_from_below(
    mesh: &Mesh,
    snapshot: &Snapshot,
    contact: &Contact,
    camera: &Camera,
    unit: f64,
) -> Geometry {
    let mut geometry = Geometry::default();
    let touching = touching(mesh, snapshot);
    let reach = 0.25 * (contact.high - contact.low).length();
    let (near, far) = (linear(NEAR), linear(FAR));
    for &facet in &contact.facets {
        let corners = facet.map(|n| DVec3::from(snapshot.x[n as usize]));
        let paint = corners.map(|x| {
            let share = (contact.chart.gap(x) / reach).clamp(0.0, 1.0).sqrt() as f32;
            let touches = facet.iter().all(|&n| touching[n as usize]);
            let share = if touches { 0.0 } else { 0.25 + 0.75 * share };
            std::array::from_fn(|d| near[d] + share * (far[d] - near[d]))
        });
        quad(&mut geometry.plain, camera, corners, paint);
    }
    let edges = edges(&contact.facets);
    let (width, opacity) = edge_style(contact.spacing * camera.pixels_per_metre(), unit);
    geometry.segments = lines(camera, &edges, &snapshot.x, ink(QUIET, 0.6 * opacity), width);
    geometry
}

/// The facets whose corners all touch, with their places on the colour bar: too fine a mesh for markers.
fn contact_facets(
    mesh: &Mesh,
    snapshot: &Snapshot,
    contact: &Contact,
    place: impl Fn(&Touch) -> f64,
) -> Vec<([DVec3; 4], [[f32; 3]; 4])> {
    let mut places = vec![None; mesh.nodes.len()];
    for touch in &contact.touches {
        places[touch.node as usize] = Some(place(touch) as f32);
    }
    let facet = |facet: &[u32; 4]| {
        let corners = facet.map(|n| DVec3::from(snapshot.x[n as usize]));
        let mut paint = [[0.0; 3]; 4];
        for (paint, node) in paint.iter_mut().zip(facet) {
            paint[0] = places[*node as usize]?;
        }
        Some((corners, paint))
    };
    contact.facets.iter().filter_map(facet).collect()
}

/// Title, time and the total force.
pub(super) fn caption(canvas: &mut Canvas, snapshot: &Snapshot, options: &FootprintView, contact: &Contact) {
    let [x, y, n] = contact.total();
    let time = legend::time_stamp(snapshot.time);
    let second = if contact.touches.is_empty() {
        time
    } else {
        // One step for all three: a component that is nothing but round-off reads as zero.
        let largest = x.abs().max(y.abs()).max(n.abs());
        let (factor, unit) = prefix("N", largest);
        let step = 10f64.powf((largest / factor).max(1e-300).log10().floor() - 3.0).max(0.01);
        let [x, y, n] = [x, y, n].map(|f| number(f / factor, step));
        format!("{time}     road on body: normal {n} {unit}, shear x {x} {unit}, y {y} {unit}")
    };
    legend::heading(canvas, options.title.as_deref(), &second);
}

/// Frame with ticks and labels; x to the right, y downwards, as seen from below.
fn plot_frame(canvas: &mut Canvas, plot: Rect, camera: &Camera, contact: &Contact) {
    let u = canvas.unit;
    let (left, right, top, bottom) = (plot.x, plot.x + plot.width, plot.y, plot.y + plot.height);
    let per_metre = camera.pixels_per_metre();
    // Ticks are measured from the zero of the road's coordinates, along the axes of the picture.
    let shown = 0.5 * (contact.low + contact.high);
    let centre = camera.project(contact.chart.at(shown, 0.0).into());
    let middle = [centre[0] - shown.x * per_metre, centre[1] - shown.y * per_metre];
    let (low, high) = (
        [(left - middle[0]) / per_metre, (top - middle[1]) / per_metre],
        [(right - middle[0]) / per_metre, (bottom - middle[1]) / per_metre],
    );
    let step = round_step(high[1] - low[1], 8).max(round_step(high[0] - low[0], 16));
    let (factor, unit) = prefix("m", 1.5 * step * 5.0);
    for value in round_values(low[0], high[0], step) {
        let x = middle[0] + value * per_metre;
        canvas.line(&[[x, bottom], [x, bottom + 7.0 * u]], 1.2 * u, INK, None);
        let label = number(value / factor, step / factor);
        canvas.text(&label, [x, bottom + 22.0 * u], Anchor::Middle, Weight::Regular, 19.0, INK, 0.0);
    }
    for value in round_values(low[1], high[1], step) {
        let y = middle[1] + value * per_metre;
        canvas.line(&[[left - 7.0 * u, y], [left, y]], 1.2 * u, INK, None);
        let label = number(value / factor, step / factor);
        canvas.text(&label, [left - 13.0 * u, y], Anchor::Right, Weight::Regular, 19.0, INK, 0.0);
    }
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
    canvas.line(&corners, 1.2 * u, INK, None);
    let x_label = [0.5 * (left + right), bottom + 56.0 * u];
    canvas.text(&format!("x ({unit})"), x_label, Anchor::Middle, Weight::Medium, 20.0, INK, 0.0);
    let y_label = [left - 82.0 * u, 0.5 * (top + bottom)];
    canvas.text(&format!("y ({unit})"), y_label, Anchor::Middle, Weight::Medium, 20.0, INK, -90.0);
    let note = [right, top - 16.0 * u];
    canvas.text("seen from below", note, Anchor::Right, Weight::Regular, 17.0, QUIET, 0.0);
}

/// The colour bar, if anything touches; returns where the next legend may start.
pub(super) fn colour_legend(
    canvas: &mut Canvas,
    layout: &Layout,
    options: &FootprintView,
    contact: &Contact,
    scale: &Scale,
) -> f64 {
    let u = canvas.unit;
    let Rect { x, y, height, .. } = layout.legend;
    if contact.touches.is_empty() {
        return y + 20.0 * u;
    }
    let bar = Rect { x, y: y + 40.0 * u, width: 26.0 * u, height: 0.44 * height };
    legend::colour_bar(canvas, bar, scale, options.map, options.colour.name().0);
    bar.y + bar.height + 54.0 * u
}
