//! A mesh as it is at rest, its node sets in colours.

use glam::DVec3;
use image::RgbaImage;

use super::camera::{Camera, Projection, Rect, View};
use super::canvas::{Anchor, Canvas, Weight};
use super::colour::{INK, QUIET, RIGID, ink, linear};
use super::gpu::{Frame, Geometry};
use super::legend;
use super::surface::{edge_style, edges, lines, median_length, quad};
use super::{DEFAULT_SIZE, Renderer, check_size, unit_of};
use crate::model::mesh::{Mesh, NamedNodes};
use crate::{Error, Result};

/// How to draw a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshView {
    /// Width and height [pixels].
    pub size: [u32; 2],
    pub view: View,
    /// A line above the picture.
    pub title: String,
}

impl Default for MeshView {
    fn default() -> Self {
        MeshView { size: DEFAULT_SIZE, view: View::Iso, title: String::new() }
    }
}

/// Colours of sets, those of Okabe and Ito without black: colour-blind readers tell them apart. More sets begin again.
const COLOURS: [[u8; 3]; 7] = [
    [0, 114, 178],
    [230, 159, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [213, 94, 0],
    [240, 228, 66],
];

/// Sets that the legend has room for.
const LISTED: usize = 16;

impl Renderer {
    /// Draws the outer faces of a mesh, each in the colour of the smallest set that has all four of its nodes, with edges and a
    /// legend of the sets.
    ///
    /// # Errors
    /// [`Error::Picture`] of an empty mesh or an impossible size, [`Error::Device`] if the adapter fails.
    pub fn mesh(&mut self, mesh: &Mesh, options: &MeshView) -> Result<RgbaImage> {
        check_size(options.size, self.gpu.largest())?;
        if mesh.facets.is_empty() {
            return Err(Error::Picture { problem: "the mesh has no outer faces".into() });
        }
        let unit = unit_of(options.size);
        let [w, h] = options.size.map(f64::from);
        let rect =
            Rect { x: 60.0 * unit, y: 105.0 * unit, width: w - 460.0 * unit, height: h - 185.0 * unit };
        let points: Vec<DVec3> =
            mesh.facets.iter().flatten().map(|&n| mesh.nodes[n as usize].into()).collect();
        let camera = Camera::fit(options.view.axes(), Projection::Orthographic, &points, rect, options.size);

        let sets: Vec<&NamedNodes> = mesh.sets.iter().filter(|s| s.nodes.len() < mesh.nodes.len()).collect();
        let colours = facet_colours(mesh, &sets);
        let mut geometry = Geometry::default();
        for (facet, colour) in mesh.facets.iter().zip(&colours) {
            let corners = facet.map(|n| DVec3::from(mesh.nodes[n as usize]));
            let colour = colour.map_or(RIGID, |set| COLOURS[set % COLOURS.len()]);
            quad(&mut geometry.plain, &camera, corners, [linear(colour); 4]);
        }
        let edges = edges(&mesh.facets);
        let apart = median_length(&edges, &mesh.nodes) * camera.pixels_per_metre();
        let (width, opacity) = edge_style(apart, unit);
        geometry.segments = lines(&camera, &edges, &mesh.nodes, ink(INK, opacity), width);

        let [width, height] = options.size;
        let frame = Frame { x: 0, y: 0, width, height };
        // No field is drawn: any map will do.
        let texels = super::ColourMap::default().texels();
        let picture = self.gpu.draw(options.size, frame, &camera.uniform(0.35), &texels, &geometry)?;
        let mut canvas = Canvas::new(picture, &self.fonts, unit)?;
        legend::heading(&mut canvas, Some(&options.title), &mesh.description);
        names(&mut canvas, &sets, &colours, [w - 380.0 * unit, 0.2 * h]);
        let foot = h - 42.0 * unit;
        legend::length_bar(&mut canvas, [180.0 * unit, foot], 240.0 * unit, camera.pixels_per_metre());
        legend::triad(&mut canvas, &camera, [80.0 * unit, foot - 42.0 * unit]);
        canvas.finish()
    }
}

/// The set of each facet: of those with all of its nodes the smallest, which says most.
fn facet_colours(mesh: &Mesh, sets: &[&NamedNodes]) -> Vec<Option<usize>> {
    let mut order: Vec<usize> = (0..sets.len()).collect();
    order.sort_by_key(|&s| sets[s].nodes.len());
    let has = |set: usize, n: &u32| sets[set].nodes.binary_search(n).is_ok();
    let set_of = |facet: &[u32; 4]| order.iter().copied().find(|&s| facet.iter().all(|n| has(s, n)));
    mesh.facets.iter().map(set_of).collect()
}

/// The sets by name, with their colours where faces are in them.
fn names(canvas: &mut Canvas, sets: &[&NamedNodes], colours: &[Option<usize>], [x, top]: [f64; 2]) {
    let u = canvas.unit;
    canvas.text("Node sets", [x, top - 34.0 * u], Anchor::Left, Weight::Medium, 20.0, INK, 0.0);
    for (s, set) in sets.iter().take(LISTED).enumerate() {
        let y = top + 32.0 * u * s as f64;
        let shown = colours.contains(&Some(s));
        if shown {
            let r = 9.0 * u;
            let square = [[x, y - r], [x + 2.0 * r, y - r], [x + 2.0 * r, y + r], [x, y + r]];
            canvas.polygon(&square, COLOURS[s % COLOURS.len()], None);
        }
        let text = format!(
            "{}: {} nodes{}",
            short(&set.name),
            set.nodes.len(),
            if shown { "" } else { " (no face)" }
        );
        canvas.text(
            &text,
            [x + 28.0 * u, y],
            Anchor::Left,
            Weight::Regular,
            18.0,
            if shown { INK } else { QUIET },
            0.0,
        );
    }
    if sets.len() > LISTED {
        let y = top + 32.0 * u * LISTED as f64;
        let text = format!("and {} more", sets.len() - LISTED);
        canvas.text(&text, [x + 28.0 * u, y], Anchor::Left, Weight::Regular, 18.0, QUIET, 0.0);
    }
}

/// A name that fits.
fn short(name: &str) -> String {
    const MOST: usize = 20;
    if name.chars().count() <= MOST {
        name.into()
    } else {
        name.chars().take(MOST - 1).chain(['…']).collect()
    }
}
