//! The deformed body on the road, coloured by a field.

use glam::DVec3;
use image::RgbaImage;

use super::camera::{Camera, Projection, Rect, View};
use super::canvas::Canvas;
use super::colour::{ColourMap, INK, RIGID, WEB, WHITE, ink, linear};
use super::gpu::{Frame, Geometry, Segment, Vertex};
use super::legend;
use super::road::{Chart, Plate};
use super::scale::{Range, Scale};
use super::surface::{edge_style, edges, facet_elements, lines, median_length, quad};
use super::{DEFAULT_SIZE, Renderer, check_size, field, unit_of};
use crate::Result;
use crate::model::mesh::Mesh;
use crate::record::Snapshot;
use crate::scene::{Field, GROUND, Road};

/// How to draw the body.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyView {
    /// Width and height [pixels].
    pub size: [u32; 2],
    pub field: Field,
    pub view: View,
    pub projection: Projection,
    /// Values that the colour bar spans.
    pub range: Range,
    pub map: ColourMap,
    /// A line above the picture; `None`: only the time.
    pub title: Option<String>,
    /// The road to draw; `None`: no road.
    pub road: Option<Road>,
    /// Whether element edges are drawn.
    pub edges: bool,
    /// Depth of the shading: 0 shows the map's own colours, 1 is black where a surface turns away.
    pub shading: f64,
}

impl Default for BodyView {
    fn default() -> Self {
        BodyView {
            size: DEFAULT_SIZE,
            field: Field::VonMises,
            view: View::Iso,
            projection: Projection::Orthographic,
            range: Range::Auto,
            map: ColourMap::default(),
            title: None,
            road: Some(GROUND),
            edges: true,
            shading: 0.35,
        }
    }
}

/// Where things stand in the picture.
struct Layout {
    unit: f64,
    body: Rect,
    bar: Rect,
}

impl Layout {
    fn new([width, height]: [u32; 2]) -> Layout {
        let unit = unit_of([width, height]);
        let [w, h] = [f64::from(width), f64::from(height)];
        let body =
            Rect { x: 150.0 * unit, y: 105.0 * unit, width: w - 460.0 * unit, height: h - 185.0 * unit };
        let bar = Rect { x: w - 262.0 * unit, y: 0.24 * h, width: 26.0 * unit, height: 0.52 * h };
        Layout { unit, body, bar }
    }
}

impl Renderer {
    /// Draws the deformed body: its boundary coloured by `options.field`, element edges, rigid nodes'
    /// facets in grey, the road, a colour bar, a length scale, the time.
    ///
    /// Errors: [`Error::Picture`](crate::Error::Picture) if the snapshot does not fit the mesh or the size
    /// is impossible, [`Error::Device`](crate::Error::Device) if the adapter fails.
    pub fn body(&mut self, mesh: &Mesh, snapshot: &Snapshot, options: &BodyView) -> Result<RgbaImage> {
        check_size(options.size, self.gpu.largest())?;
        let camera = self.body_camera(mesh, snapshot, options)?;
        let values = field::values(options.field, mesh, snapshot)?;
        let (name, unit, magnitude) = field::describe(options.field);
        let elements = facet_elements(mesh);
        let shown = shown_values(mesh, &elements, &values);
        let scale = Scale::new(&shown, unit, options.range, magnitude);
        let layout = Layout::new(options.size);

        let mut geometry = Geometry::default();
        if let Some(plate) = plate(snapshot, options) {
            plate.draw(&camera, layout.unit, &mut geometry);
        }
        paint_facets(&mut geometry, &camera, mesh, snapshot, &elements, |v| scale.place(v), &values);
        if options.edges {
            let brightness = brightness(mesh, &elements, |v| scale.place(v), &values, options.map);
            geometry.segments.extend(edge_lines(&camera, mesh, snapshot, &brightness, layout.unit));
        }
        rim_web(&mut geometry, &camera, mesh, snapshot, layout.unit);

        let [width, height] = options.size;
        let frame = Frame { x: 0, y: 0, width, height };
        let view = camera.uniform(options.shading);
        let picture = self.gpu.draw(options.size, frame, &view, &options.map.texels(), &geometry)?;

        let mut canvas = Canvas::new(picture, &self.fonts, layout.unit)?;
        legend::heading(&mut canvas, options.title.as_deref(), &legend::time_stamp(snapshot.time));
        legend::colour_bar(&mut canvas, layout.bar, &scale, options.map, name);
        let foot = f64::from(height) - 42.0 * layout.unit;
        let at = [180.0 * layout.unit, foot];
        legend::length_bar(&mut canvas, at, 240.0 * layout.unit, camera.pixels_per_metre());
        legend::triad(&mut canvas, &camera, [80.0 * layout.unit, foot - 42.0 * layout.unit]);
        canvas.finish()
    }

    /// The camera that [`Renderer::body`] uses: where a point of space stands in that picture.
    pub fn body_camera(&self, mesh: &Mesh, snapshot: &Snapshot, options: &BodyView) -> Result<Camera> {
        field::check(mesh, snapshot)?;
        let mut points: Vec<DVec3> = snapshot.x.iter().map(|&x| x.into()).collect();
        if let Some(plate) = plate(snapshot, options) {
            points.extend(plate.outline());
        }
        let rect = Layout::new(options.size).body;
        Ok(Camera::fit(options.view.axes(), options.projection, &points, rect, options.size))
    }
}

/// Ends of the values that a picture of the body shows, from zero on where they are magnitudes [SI].
///
/// # Errors
/// [`Error::Picture`](crate::Error::Picture) if the snapshot does not fit the mesh.
pub fn body_values(mesh: &Mesh, snapshot: &Snapshot, field: Field) -> Result<[f64; 2]> {
    let values = field::values(field, mesh, snapshot)?;
    let (_, _, magnitude) = field::describe(field);
    let shown = shown_values(mesh, &facet_elements(mesh), &values);
    let from = if magnitude { [0.0; 2] } else { [f64::INFINITY, f64::NEG_INFINITY] };
    Ok(shown.iter().filter(|v| v.is_finite()).fold(from, |[low, high], v| [low.min(*v), high.max(*v)]))
}

/// The road's plate, if there is a road near enough to be seen with the body.
fn plate(snapshot: &Snapshot, options: &BodyView) -> Option<Plate> {
    let chart = Chart(options.road.clone()?);
    let points: Vec<DVec3> = snapshot.x.iter().map(|&x| x.into()).collect();
    let low = points.iter().copied().reduce(DVec3::min)?;
    let high = points.iter().copied().reduce(DVec3::max)?;
    let gap = points.iter().map(|&p| chart.gap(p)).fold(f64::INFINITY, f64::min);
    (gap.abs() < (high - low).length()).then(|| Plate::under(chart, &points, 0.22))
}

fn is_rigid(mesh: &Mesh, facet: &[u32; 4]) -> bool {
    facet.iter().all(|n| mesh.rim.binary_search(n).is_ok())
}

/// Values at the corners of all facets that are coloured by the field.
fn shown_values(mesh: &Mesh, elements: &[u32], values: &field::Values) -> Vec<f64> {
    let coloured = mesh.facets.iter().zip(elements).filter(|(facet, _)| !is_rigid(mesh, facet));
    coloured.flat_map(|(&facet, &element)| values.corners(facet, element)).collect()
}

fn paint_facets(
    geometry: &mut Geometry,
    camera: &Camera,
    mesh: &Mesh,
    snapshot: &Snapshot,
    elements: &[u32],
    place: impl Fn(f64) -> f64,
    values: &field::Values,
) {
    for (&facet, &element) in mesh.facets.iter().zip(elements) {
        let corners = facet.map(|n| DVec3::from(snapshot.x[n as usize]));
        if is_rigid(mesh, &facet) {
            quad(&mut geometry.plain, camera, corners, [linear(RIGID); 4]);
        } else {
            let paint = values.corners(facet, element).map(|v| [place(v) as f32, 0.0, 0.0]);
            quad(&mut geometry.mapped, camera, corners, paint);
        }
    }
}

/// Brightness (0 to 1) of the coloured surface around every node, shape `[node_count]`: lines must stand out
/// from it.
fn brightness(
    mesh: &Mesh,
    elements: &[u32],
    place: impl Fn(f64) -> f64,
    values: &field::Values,
    map: ColourMap,
) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); mesh.nodes.len()];
    for (&facet, &element) in mesh.facets.iter().zip(elements).filter(|(f, _)| !is_rigid(mesh, f)) {
        for (node, value) in facet.into_iter().zip(values.corners(facet, element)) {
            let [r, g, b] = linear(map.at(place(value))).map(f64::from);
            let sum = &mut sums[node as usize];
            *sum = (sum.0 + 0.2126 * r + 0.7152 * g + 0.0722 * b, sum.1 + 1.0);
        }
    }
    sums.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { 1.0 }).collect()
}

/// Surfaces darker than this have light edges.
const DARK: f64 = 0.07;

/// Element edges: dark on bright colours, light on dark ones.
fn edge_lines(
    camera: &Camera,
    mesh: &Mesh,
    snapshot: &Snapshot,
    brightness: &[f64],
    unit: f64,
) -> Vec<Segment> {
    let edges = edges(&mesh.facets);
    let apart = median_length(&edges, &snapshot.x) * camera.pixels_per_metre();
    let (width, opacity) = edge_style(apart, unit);
    let is_rim = |n: u32| mesh.rim.binary_search(&n).is_ok();
    let is_dark = |&[a, b]: &[u32; 2]| {
        let mean = 0.5 * (brightness[a as usize] + brightness[b as usize]);
        mean < DARK && !(is_rim(a) && is_rim(b))
    };
    let (dark, bright): (Vec<[u32; 2]>, Vec<[u32; 2]>) = edges.into_iter().partition(is_dark);
    let mut segments = lines(camera, &dark, &snapshot.x, ink(WHITE, 0.17 * opacity), width);
    segments.extend(lines(camera, &bright, &snapshot.x, ink(INK, opacity), width));
    segments
}

/// A rim that is a cylinder about the axle gets a disc at half its width, with a spoke on it that shows how
/// far it has turned. Other rigid parts have nothing to add to their facets.
fn rim_web(geometry: &mut Geometry, camera: &Camera, mesh: &Mesh, snapshot: &Snapshot, unit: f64) {
    let (Some((axle, turn)), Some(&first)) = (snapshot.axle, mesh.rim.first()) else { return };
    let arm = |node: u32| DVec3::from(mesh.nodes[node as usize]) - DVec3::from(mesh.axle);
    let radius = |v: DVec3| v.x.hypot(v.z);
    let start = arm(first);
    if mesh.rim.iter().any(|&n| (radius(arm(n)) - radius(start)).abs() > 1e-6 * radius(start)) {
        return;
    }
    let axle = DVec3::from(axle);
    let turned = |v: DVec3| axle + DVec3::from_array(turn.map(|row| DVec3::from(row).dot(v)));
    let spoke = DVec3::new(start.x, 0.0, start.z);
    let side = DVec3::new(start.z, 0.0, -start.x);
    let normal = (turned(DVec3::Y) - axle).as_vec3().to_array();
    // A disc of `share` of the rim's radius, `lift` radii along the axle.
    let mut disc = |share: f64, lift: f64, colour: [u8; 3]| {
        const SIDES: usize = 72;
        let middle = DVec3::Y * (lift * radius(start));
        let at = |i: usize| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / SIDES as f64).sin_cos();
            turned(middle + (spoke * cos + side * sin) * share)
        };
        for i in 0..SIDES {
            for point in [turned(middle), at(i), at(i + 1)] {
                let position = camera.local(point);
                geometry.plain.push(Vertex { position, normal, paint: linear(colour) });
            }
        }
    };
    disc(1.0, 0.0, WEB);
    // The hub, on both faces, over the spoke.
    disc(0.09, 0.03, INK);
    disc(0.09, -0.03, INK);
    let [from, to] = [axle, turned(spoke)].map(|p| camera.local(p));
    geometry.segments.push(Segment { from, to, colour: ink(INK, 1.0), width: (2.2 * unit) as f32 });
}
