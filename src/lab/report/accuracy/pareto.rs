//! The picture: wall time against error, a panel a problem, the front of the fastest drawn through.

use image::{Rgba, RgbaImage};

use super::cases::Problem;
use super::reference::Reference;
use super::runs::{Measured, Row};
use crate::bench::kind::Kind;
use hexroll::Result;
use hexroll::render::canvas::{Anchor, Canvas, Fonts, Weight};
use hexroll::scene::Element;

const PANEL: [f64; 2] = [560.0, 430.0];
const HEAD: f64 = 124.0;
const INK: [u8; 3] = [40, 44, 52];
const PALE: [u8; 3] = [222, 225, 230];
const UNKNOWN: [u8; 3] = [244, 240, 230];

fn colour(element: Element) -> [u8; 3] {
    match element {
        Element::Q1p0 => [31, 105, 180],
        Element::UniformGradient { .. } => [214, 110, 20],
        Element::Full => [110, 110, 118],
    }
}

/// Draws every row that has an error.
///
/// # Errors
/// [`Error::Picture`](hexroll::Error::Picture) if the canvas cannot be made.
pub fn picture(measured: &Measured) -> Result<RgbaImage> {
    let rows = &measured.rows;
    let shown: Vec<Problem> =
        Problem::ALL.into_iter().filter(|p| rows.iter().any(|r| r.problem == *p)).collect();
    let columns = shown.len().clamp(1, 2);
    let lines = shown.len().div_ceil(columns).max(1);
    let size = [PANEL[0] * columns as f64, HEAD + PANEL[1] * lines as f64].map(|v| v as u32);
    let fonts = Fonts::new()?;
    let blank = RgbaImage::from_pixel(size[0], size[1], Rgba([255; 4]));
    let mut canvas = Canvas::new(blank, &fonts, 1.0)?;
    legend(&mut canvas, rows);
    for (k, problem) in shown.into_iter().enumerate() {
        let corner = [(k % columns) as f64 * PANEL[0], HEAD + (k / columns) as f64 * PANEL[1]];
        let own: Vec<&Row> = rows.iter().filter(|r| r.problem == problem && r.error > 0.0).collect();
        let reference = measured.references.iter().find(|known| known.problem == problem);
        let within = reference.map_or(0.0, Reference::uncertainty);
        Panel::new(corner, &own, within).draw(&mut canvas, problem, &own);
    }
    canvas.finish()
}

fn legend(canvas: &mut Canvas, rows: &[Row]) {
    canvas.text("Wall time against error", [24.0, 28.0], Anchor::Left, Weight::Medium, 20.0, INK, 0.0);
    // A line each for what colours, marks and lines are: a picture of one panel has room for them.
    let (left, [elements, engines, lines]) = (24.0, [58.0, 80.0, 102.0]);
    let mut x = left;
    let names = [
        ("q1p0", Element::Q1p0),
        ("uniform-gradient", Element::UniformGradient { hourglass: 0.15 }),
        ("full", Element::Full),
    ];
    for (name, element) in names {
        canvas.disc([x + 6.0, elements], 6.0, colour(element), None);
        canvas.text(name, [x + 18.0, elements], Anchor::Left, Weight::Regular, 14.0, INK, 0.0);
        x += 40.0 + 8.0 * name.len() as f64;
    }
    x = left;
    let machines = [
        ("f64", Kind::CpuF64),
        ("f32", Kind::CpuF32),
        ("GPU f32", Kind::GpuF32),
        ("GPU f32+", Kind::GpuF32Plus),
        ("GPU f64", Kind::GpuF64),
    ];
    for (name, machine) in machines.into_iter().filter(|(_, m)| rows.iter().any(|r| r.setting.machine == *m))
    {
        mark(canvas, [x + 6.0, engines], machine, INK);
        canvas.text(name, [x + 18.0, engines], Anchor::Left, Weight::Regular, 14.0, INK, 0.0);
        x += 34.0 + 8.0 * name.len() as f64;
    }
    x = left;
    canvas.line(&[[x, lines], [x + 24.0, lines]], 1.5, INK, Some([4.0, 3.0]));
    canvas.text("fastest for its error", [x + 32.0, lines], Anchor::Left, Weight::Regular, 14.0, INK, 0.0);
    x += 32.0 + 8.0 * 22.0;
    let box_at = |r: [f64; 2]| {
        [[x, lines - r[1]], [x + r[0], lines - r[1]], [x + r[0], lines + r[1]], [x, lines + r[1]]]
    };
    canvas.polygon(&box_at([24.0, 7.0]), UNKNOWN, None);
    canvas.text(
        "within the reference's own error",
        [x + 32.0, lines],
        Anchor::Left,
        Weight::Regular,
        14.0,
        INK,
        0.0,
    );
}

/// f64 discs, f32 rings, GPU squares (pairs: open ones; f64: on a corner).
fn mark(canvas: &mut Canvas, at: [f64; 2], machine: Kind, colour: [u8; 3]) {
    let square = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]].map(|[x, y]: [f64; 2]| [at[0] + x, at[1] + y]);
    match machine {
        Kind::CpuF64 => canvas.disc(at, 5.5, colour, None),
        Kind::CpuF32 => canvas.disc(at, 4.5, [255; 3], Some((2.0, colour))),
        Kind::GpuF32 => canvas.polygon(&square(5.0), colour, None),
        Kind::GpuF32Plus => canvas.polygon(&square(4.5), [255; 3], Some((2.0, colour))),
        Kind::GpuF64 => {
            let turned = [[0.0, -7.0], [7.0, 0.0], [0.0, 7.0], [-7.0, 0.0]];
            canvas.polygon(&turned.map(|[x, y]: [f64; 2]| [at[0] + x, at[1] + y]), colour, None)
        }
    }
}

/// A panel's place and its decades.
struct Panel {
    corner: [f64; 2],
    x: [f64; 2],
    y: [f64; 2],
    /// How well the reference is known: smaller errors say nothing.
    within: f64,
}

impl Panel {
    fn new(corner: [f64; 2], rows: &[&Row], within: f64) -> Panel {
        let decades = |f: fn(&Row) -> f64| {
            let logs = || rows.iter().map(|r| f(r).log10());
            let low = logs().fold(f64::INFINITY, f64::min).floor();
            let high = logs().fold(f64::NEG_INFINITY, f64::max).ceil();
            if low.is_finite() && high > low { [low, high] } else { [-1.0, 0.0] }
        };
        Panel { corner, x: decades(|r| r.wall), y: decades(|r| r.error), within }
    }

    fn at(&self, wall: f64, error: f64) -> [f64; 2] {
        let share = |v: f64, [low, high]: [f64; 2]| (v.log10() - low) / (high - low);
        [
            self.corner[0] + 76.0 + (PANEL[0] - 104.0) * share(wall, self.x),
            self.corner[1] + PANEL[1] - 64.0 - (PANEL[1] - 108.0) * share(error, self.y),
        ]
    }

    fn draw(&self, canvas: &mut Canvas, problem: Problem, rows: &[&Row]) {
        let title = format!("{}: error of the {}", problem.name(), problem.quantity());
        let [left, top] = self.corner;
        canvas.text(&title, [left + 76.0, top + 18.0], Anchor::Left, Weight::Medium, 15.0, INK, 0.0);
        let power = |k: f64| 10.0f64.powf(k);
        let floor = power(self.y[0]);
        if self.within > floor {
            let [low, high] = self.x.map(power);
            let top = self.within.min(power(self.y[1]));
            let corners = [(low, floor), (high, floor), (high, top), (low, top)];
            canvas.polygon(&corners.map(|(wall, error)| self.at(wall, error)), UNKNOWN, None);
        }
        let mut k = self.x[0];
        while k <= self.x[1] {
            let [low, high] = [power(self.y[0]), power(self.y[1])].map(|e| self.at(power(k), e));
            canvas.line(&[low, high], 1.0, PALE, None);
            let label = format!("{} s", power(k));
            canvas.text(&label, [low[0], low[1] + 18.0], Anchor::Middle, Weight::Regular, 13.0, INK, 0.0);
            k += 1.0;
        }
        let mut k = self.y[0];
        while k <= self.y[1] {
            let [low, high] = [power(self.x[0]), power(self.x[1])].map(|w| self.at(w, power(k)));
            canvas.line(&[low, high], 1.0, PALE, None);
            let percent = 100.0 * power(k);
            let label = if percent >= 1e-3 { format!("{percent} %") } else { format!("{percent:.0e} %") };
            canvas.text(&label, [low[0] - 8.0, low[1]], Anchor::Right, Weight::Regular, 13.0, INK, 0.0);
            k += 1.0;
        }
        let front: Vec<[f64; 2]> = front(rows).iter().map(|r| self.at(r.wall, r.error)).collect();
        if front.len() > 1 {
            canvas.line(&front, 1.5, INK, Some([4.0, 3.0]));
        }
        for row in rows {
            mark(canvas, self.at(row.wall, row.error), row.setting.machine, colour(row.setting.element));
        }
    }
}

/// Rows that no other beats in both time and error, fastest first.
fn front<'a>(rows: &[&'a Row]) -> Vec<&'a Row> {
    let mut sorted = rows.to_vec();
    sorted.sort_by(|a, b| a.wall.total_cmp(&b.wall));
    let mut best = f64::INFINITY;
    sorted.retain(|r| {
        let better = r.error < best;
        best = best.min(r.error);
        better
    });
    sorted
}
