//! Symbols of a footprint: markers of nodes, arrows of shear forces, and what they mean.

use std::collections::HashMap;

use super::camera::Camera;
use super::canvas::{Anchor, Canvas, Weight};
use super::colour::{INK, QUIET, SLIP};
use super::contact::Contact;
use super::scale::{quantity, round_below};

/// What tells sticking from slipping nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateSymbol {
    /// A disc or a diamond, filled with the node's colour.
    Marker,
    /// A small dot over coloured facets: nodes too close for markers.
    Dot,
    /// The colour of the shear force's arrow.
    Arrow,
}

/// Sizes in pixels, chosen by the distance of the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symbols {
    pub state: StateSymbol,
    marker: f64,
    width: f64,
    pixels_per_newton: f64,
    largest: f64,
    /// Arrows are at least this far apart [pixels].
    apart: f64,
    thinned: bool,
}

/// Nodes closer than this are not marked one by one [design units].
const CROWDED: f64 = 24.0;
/// Arrows closer than this are thinned out [design units].
const ARROW_ROOM: f64 = 17.0;

fn state_colour(slips: bool) -> [u8; 3] {
    if slips { SLIP } else { INK }
}

impl Symbols {
    pub fn new(contact: &Contact, pixels_per_metre: f64, unit: f64) -> Symbols {
        let apart = contact.spacing * pixels_per_metre;
        let largest = contact.largest_shear();
        let longest = (1.1 * apart).clamp(1.2 * ARROW_ROOM * unit, 130.0 * unit);
        let crowded = apart < CROWDED * unit;
        Symbols {
            state: if crowded { StateSymbol::Dot } else { StateSymbol::Marker },
            marker: if crowded { (0.09 * apart).max(0.7 * unit) } else { (0.17 * apart).min(15.0 * unit) },
            width: (0.035 * apart).clamp(1.3 * unit, 4.2 * unit),
            pixels_per_newton: if largest > 0.0 { longest / largest } else { 0.0 },
            largest,
            apart: ARROW_ROOM * unit,
            thinned: apart < ARROW_ROOM * unit,
        }
    }

    /// Marks a node.
    pub fn node(&self, canvas: &mut Canvas, at: [f64; 2], fill: [u8; 3], slips: bool) {
        match self.state {
            StateSymbol::Marker => marker(canvas, at, self.marker, fill, slips),
            StateSymbol::Dot | StateSymbol::Arrow => {
                canvas.disc(at, self.marker, state_colour(slips), None);
            }
        }
    }

    /// Draws the shear forces; those of a fine mesh only as far apart as arrows can be told from each other.
    pub fn arrows(&self, canvas: &mut Canvas, camera: &Camera, contact: &Contact) {
        let mut drawn: HashMap<[i64; 2], Vec<[f64; 2]>> = HashMap::new();
        for touch in &contact.touches {
            let from = camera.project(touch.x.into());
            let reach = [0, 1].map(|d| touch.shear[d] * self.pixels_per_newton);
            // Shorter than three pixels nothing of a direction is left to see.
            if reach[0].hypot(reach[1]) < 3.0 * canvas.unit
                || (self.thinned && !self.has_room(&mut drawn, from))
            {
                continue;
            }
            canvas.arrow(from, [0, 1].map(|d| from[d] + reach[d]), self.width, state_colour(touch.slips));
        }
    }

    /// Whether nothing drawn so far is too near to `at`, which then counts as drawn. `drawn` is kept by cells
    /// as wide as arrows must be apart, so only the cells around need a look.
    fn has_room(&self, drawn: &mut HashMap<[i64; 2], Vec<[f64; 2]>>, at: [f64; 2]) -> bool {
        let cell = at.map(|p| (p / self.apart).floor() as i64);
        let near = (0..9).filter_map(|i| drawn.get(&[cell[0] + i % 3 - 1, cell[1] + i / 3 - 1])).flatten();
        let free = near.copied().all(|p| (p[0] - at[0]).hypot(p[1] - at[1]) >= self.apart);
        if free {
            drawn.entry(cell).or_default().push(at);
        }
        free
    }

    /// A reference arrow of a round force; returns where the next legend may start.
    pub fn legend(&self, canvas: &mut Canvas, [x, y]: [f64; 2]) -> f64 {
        let u = canvas.unit;
        if self.largest <= 0.0 {
            return y;
        }
        canvas.text("Shear force on the body", [x, y], Anchor::Left, Weight::Medium, 20.0, INK, 0.0);
        let force = round_below(self.largest);
        let y = y + 34.0 * u;
        let end = x + force * self.pixels_per_newton;
        canvas.arrow([x, y], [end, y], self.width, INK);
        let mut label = quantity(force, "N", 1);
        if self.thinned {
            label += " (not at every node)";
        }
        canvas.text(&label, [end + 14.0 * u, y], Anchor::Left, Weight::Regular, 19.0, INK, 0.0);
        y + 46.0 * u
    }
}

/// A disc where a node sticks, a diamond with a coloured rim where it slips.
fn marker(canvas: &mut Canvas, at: [f64; 2], radius: f64, fill: [u8; 3], slips: bool) {
    let rim = Some(((0.16 * radius).max(canvas.unit), state_colour(slips)));
    if slips {
        let r = 1.2 * radius;
        let points = [[at[0], at[1] - r], [at[0] + r, at[1]], [at[0], at[1] + r], [at[0] - r, at[1]]];
        canvas.polygon(&points, fill, rim);
    } else {
        canvas.disc(at, radius, fill, rim);
    }
}

/// Sticking and slipping nodes with their number; returns where the next legend may start.
pub fn state_legend(
    canvas: &mut Canvas,
    [x, mut y]: [f64; 2],
    contact: &Contact,
    symbol: StateSymbol,
) -> f64 {
    let u = canvas.unit;
    let slipping = contact.touches.iter().filter(|t| t.slips).count();
    for (slips, count) in [(false, contact.touches.len() - slipping), (true, slipping)] {
        if count == 0 {
            continue;
        }
        let (colour, at) = (state_colour(slips), [x + 10.0 * u, y]);
        match symbol {
            StateSymbol::Marker => marker(canvas, at, 9.0 * u, [236, 238, 241], slips),
            StateSymbol::Dot => canvas.disc(at, 4.0 * u, colour, None),
            StateSymbol::Arrow => canvas.arrow([x - 2.0 * u, y], [x + 26.0 * u, y], 3.0 * u, colour),
        }
        let what = match (symbol, slips) {
            (StateSymbol::Arrow, false) => "shear, sticking",
            (StateSymbol::Arrow, true) => "shear, slipping",
            (_, false) => "sticking",
            (_, true) => "slipping",
        };
        let label = format!("{what}: {count} {}", if count == 1 { "node" } else { "nodes" });
        canvas.text(&label, [x + 36.0 * u, y], Anchor::Left, Weight::Regular, 19.0, colour, 0.0);
        y += 32.0 * u;
    }
    y + 24.0 * u
}

/// An arrow in the direction of travel; `way`: right and down.
pub fn travel_legend(canvas: &mut Canvas, [x, y]: [f64; 2], way: [f64; 2]) {
    let u = canvas.unit;
    canvas.text("Direction of travel", [x, y], Anchor::Left, Weight::Medium, 20.0, INK, 0.0);
    let half = 40.0 * u;
    // Room for the arrow's own height below the heading.
    let middle = [x + half, y + 26.0 * u + half * way[1].abs()];
    let end = |sign: f64| [middle[0] + sign * half * way[0], middle[1] + sign * half * way[1]];
    canvas.arrow(end(-1.0), end(1.0), 5.0 * u, QUIET);
}
