//! The scaling picture: time of a step against the size of the mesh, both axes logarithmic, a line an engine and
//! element.

use image::{Rgba, RgbaImage};

use super::markdown;
use super::report::Row;
use hexroll::Result;
use hexroll::render::canvas::{Anchor, Canvas, Fonts, Weight};
use hexroll::render::colour::{INK, QUIET, WHITE};

const SIZE: [u32; 2] = [1600, 900];
/// The plot's left, top, right and bottom [pixels].
const PLOT: [f64; 4] = [150.0, 110.0, 1090.0, 790.0];
/// Height that a line takes in the legend, and where the first one stands.
const PITCH: f64 = 46.0;
const FIRST: f64 = PLOT[1] + 20.0;
const GRID: [u8; 3] = [226, 229, 234];
/// Okabe and Ito's colours that carry a thin line on white.
const COLOURS: [[u8; 3]; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [60, 60, 60],
];
const DASHES: [Option<[f64; 2]>; 3] = [None, Some([14.0, 7.0]), Some([4.0, 6.0])];

/// A line of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    pub engine: String,
    pub element: String,
    pub conditions: String,
    /// (elements, us a step), ascending.
    pub points: Vec<[f64; 2]>,
}

/// Rows that differ in size only make one line.
pub fn lines(rows: &[Row]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for row in rows {
        let engine = markdown::engine(row);
        let mut conditions = String::from(if row.contact { "" } else { ", no road" });
        if row.viscosity > 0.0 {
            conditions += ", viscous";
        }
        let point = [row.elements as f64, row.us_per_step.median];
        let same =
            |l: &&mut Line| (&l.engine, &l.element, &l.conditions) == (&engine, &row.element, &conditions);
        match lines.iter_mut().find(same) {
            Some(line) => line.points.push(point),
            None => {
                lines.push(Line { engine, element: row.element.clone(), conditions, points: vec![point] });
            }
        }
    }
    lines.iter_mut().for_each(|l| l.points.sort_by(|a, b| a[0].total_cmp(&b[0])));
    lines
}

/// Whole decades around values.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Decades {
    low: i32,
    high: i32,
}

impl Decades {
    fn around(values: impl Iterator<Item = f64> + Clone) -> Decades {
        let low = values.clone().fold(f64::INFINITY, f64::min).log10().floor() as i32;
        let high = values.fold(0.0, f64::max).log10().ceil() as i32;
        Decades { low, high: high.max(low + 1) }
    }

    /// 0 at the low end, 1 at the high end.
    fn place(&self, value: f64) -> f64 {
        (value.log10() - f64::from(self.low)) / f64::from(self.high - self.low)
    }
}

/// The picture; `None` if there is nothing to draw.
pub fn scaling(rows: &[Row]) -> Result<Option<RgbaImage>> {
    let lines = lines(rows);
    if lines.is_empty() {
        return Ok(None);
    }
    let fonts = Fonts::new()?;
    let blank =
        RgbaImage::from_pixel(SIZE[0], height(lines.len()), Rgba([WHITE[0], WHITE[1], WHITE[2], 255]));
    let mut canvas = Canvas::new(blank, &fonts, 1.0)?;
    let points = || lines.iter().flat_map(|l| &l.points);
    let x = Decades::around(points().map(|p| p[0]));
    let y = Decades::around(points().map(|p| p[1]));
    let title = "Time of a whole step against the size of the mesh";
    canvas.text(title, [PLOT[0], 50.0], Anchor::Left, Weight::Medium, 27.0, INK, 0.0);
    axes(&mut canvas, x, y);
    let at = |p: &[f64; 2]| {
        let [left, top, right, bottom] = PLOT;
        [left + (right - left) * x.place(p[0]), bottom - (bottom - top) * y.place(p[1])]
    };
    let engines = distinct(lines.iter().map(|l| &l.engine));
    let elements = distinct(lines.iter().map(|l| &l.element));
    for (number, line) in lines.iter().enumerate() {
        let index = |list: &[&String], name: &String| list.iter().position(|n| *n == name).unwrap_or(0);
        let colour = COLOURS[index(&engines, &line.engine) % COLOURS.len()];
        let dash = DASHES[index(&elements, &line.element) % DASHES.len()];
        let points: Vec<[f64; 2]> = line.points.iter().map(at).collect();
        stroke(&mut canvas, &points, colour, dash);
        let (x, y) = (PLOT[2] + 40.0, FIRST + PITCH * number as f64);
        stroke(&mut canvas, &[[x, y], [x + 60.0, y]], colour, dash);
        let second = format!("{}{}", line.element, line.conditions);
        canvas.text(&line.engine, [x + 78.0, y - 9.0], Anchor::Left, Weight::Regular, 19.0, INK, 0.0);
        canvas.text(&second, [x + 78.0, y + 11.0], Anchor::Left, Weight::Regular, 17.0, QUIET, 0.0);
    }
    canvas.finish().map(Some)
}

/// Height of a picture whose legend has every line.
fn height(lines: usize) -> u32 {
    SIZE[1].max((FIRST + PITCH * lines as f64) as u32)
}

fn distinct<'a>(names: impl Iterator<Item = &'a String>) -> Vec<&'a String> {
    let mut list = Vec::new();
    names.for_each(|n| {
        if !list.contains(&n) {
            list.push(n);
        }
    });
    list
}

fn stroke(canvas: &mut Canvas, points: &[[f64; 2]], colour: [u8; 3], dash: Option<[f64; 2]>) {
    canvas.line(points, 2.6, colour, dash);
    points.iter().for_each(|&p| canvas.disc(p, 5.0, colour, Some((1.5, WHITE))));
}

fn axes(canvas: &mut Canvas, x: Decades, y: Decades) {
    let [left, top, right, bottom] = PLOT;
    for decade in x.low..=x.high {
        let at = left + (right - left) * f64::from(decade - x.low) / f64::from(x.high - x.low);
        canvas.line(&[[at, top], [at, bottom]], 1.2, GRID, None);
        let label = power(decade);
        canvas.text(&label, [at, bottom + 24.0], Anchor::Middle, Weight::Regular, 19.0, INK, 0.0);
    }
    for decade in y.low..=y.high {
        let at = bottom - (bottom - top) * f64::from(decade - y.low) / f64::from(y.high - y.low);
        canvas.line(&[[left, at], [right, at]], 1.2, GRID, None);
        let label = power(decade);
        canvas.text(&label, [left - 12.0, at], Anchor::Right, Weight::Regular, 19.0, INK, 0.0);
    }
    canvas.line(&[[left, top], [left, bottom], [right, bottom]], 1.6, INK, None);
    let middle = [0.5 * (left + right), bottom + 62.0];
    canvas.text("elements", middle, Anchor::Middle, Weight::Medium, 21.0, INK, 0.0);
    let side = [46.0, 0.5 * (top + bottom)];
    canvas.text("microseconds a step", side, Anchor::Middle, Weight::Medium, 21.0, INK, -90.0);
}

/// `1`, `10`, .. `10,000,000`, or a small decimal.
fn power(decade: i32) -> String {
    if decade < 0 {
        return format!("{:.*}", -decade as usize, 10f64.powi(decade));
    }
    let digits = format!("1{}", "0".repeat(decade as usize));
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|g| std::str::from_utf8(g).unwrap_or("")).collect();
    groups.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_has_room_for_every_line() {
        assert_eq!(height(1), SIZE[1]);
        for lines in 1..60 {
            // The second row of a line's text ends 20 pixels below its middle.
            let last = FIRST + PITCH * (lines - 1) as f64;
            assert!(last + 20.0 < f64::from(height(lines)), "{lines} lines");
        }
    }
}
