//! One pair of axes with its curves.

use super::INK;
use super::ticks::{decades, ticks};
use crate::render::canvas::{Anchor, Canvas, Weight};

/// Colours of the series in turn: Okabe & Ito's, told apart without red or green (Color Universal Design, 2008).
pub const COLOURS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0]];

const GRID: [u8; 3] = [225, 228, 233];

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Dots, joined.
    Line,
    /// Dots alone.
    Dots,
    /// A line without dots: many points.
    Curve,
}

/// Points in the order they are joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// In the legend; empty: not there.
    pub label: String,
    pub points: Vec<[f64; 2]>,
    /// Half lengths of vertical error bars, one a point; empty: none.
    pub bars: Vec<f64>,
    pub mark: Mark,
}

/// A pair of axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    pub title: String,
    /// Labels of the axes, with units.
    pub x: String,
    pub y: String,
    pub series: Vec<Series>,
    /// Whether equal factors along the abscissa are equal lengths; points at or below zero are then left out.
    pub log_x: bool,
}

/// Where numbers go.
pub(super) struct Frame {
    /// Of what stands on the axes: the logarithm of the abscissa where that is logarithmic.
    low: [f64; 2],
    high: [f64; 2],
    /// Pixels of the frame: left, top, right, bottom.
    pub at: [f64; 4],
    log_x: bool,
}

impl Frame {
    pub fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = on_axes(point, self.log_x);
        let share = |v: f64, d: usize| (v - self.low[d]) / (self.high[d] - self.low[d]);
        let [left, top, right, bottom] = self.at;
        [left + share(x, 0) * (right - left), bottom - share(y, 1) * (bottom - top)]
    }

    /// Ticks along an axis with their texts.
    pub fn ticks(&self, d: usize, wanted: f64) -> Vec<(f64, String)> {
        if d == 0 && self.log_x {
            return decades(self.low[0], self.high[0]);
        }
        let (at, decimals) = ticks(self.low[d], self.high[d], wanted);
        at.into_iter().map(|v| (v, label(v, decimals, self.low[d].abs().max(self.high[d].abs())))).collect()
    }
}

/// A tick's text: with a power of ten where the numbers of the axis are very small or large.
fn label(value: f64, decimals: usize, largest: f64) -> String {
    match (1e-4..1e7).contains(&largest) {
        true => format!("{value:.decimals$}"),
        false if value == 0.0 => "0".into(),
        // 15 digits are too many, and 2 enough for steps of 1, 2 or 5.
        false => {
            let text = format!("{value:.2e}");
            let (digits, power) = text.split_once('e').expect("it has a power");
            format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
        }
    }
}

fn on_axes([x, y]: [f64; 2], log_x: bool) -> [f64; 2] {
    // What has no logarithm is no number, and is left out.
    [if log_x { x.log10() } else { x }, y]
}

impl Panel {
    /// Draws the panel into `size` pixels from `origin`.
    pub(super) fn draw(&self, canvas: &mut Canvas, origin: [f64; 2], size: [f64; 2]) {
        let at = [origin[0] + 96.0, origin[1] + 36.0, origin[0] + size[0] - 24.0, origin[1] + size[1] - 64.0];
        let frame = self.frame(at);
        let middle = 0.5 * (at[0] + at[2]);
        canvas.text(&self.title, [at[0], origin[1] + 18.0], Anchor::Left, Weight::Medium, 17.0, INK, 0.0);
        self.grid(canvas, &frame);
        for (i, series) in self.series.iter().enumerate() {
            self.draw_series(canvas, &frame, series, COLOURS[i % COLOURS.len()]);
        }
        canvas.text(&self.x, [middle, at[3] + 44.0], Anchor::Middle, Weight::Regular, 15.0, INK, 0.0);
        let side = [origin[0] + 22.0, 0.5 * (at[1] + at[3])];
        canvas.text(&self.y, side, Anchor::Middle, Weight::Regular, 15.0, INK, -90.0);
        self.legend(canvas, &frame);
    }

    /// Where the panel's numbers go if it has these pixels: left, top, right, bottom.
    pub(super) fn frame(&self, at: [f64; 4]) -> Frame {
        let (low, high) = self.bounds();
        Frame { low, high, at, log_x: self.log_x }
    }

    /// The points of a series that can be drawn, with their places in it.
    pub(super) fn drawable<'s>(
        &self,
        series: &'s Series,
    ) -> impl Iterator<Item = (usize, [f64; 2])> + use<'s> {
        let log_x = self.log_x;
        series.points.iter().copied().enumerate().filter(move |(_, p)| finite(&on_axes(*p, log_x)))
    }

    /// Range of the points and bars, with a margin.
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for series in &self.series {
            for (i, point) in self.drawable(series) {
                let point = on_axes(point, self.log_x);
                let bar = series.bars.get(i).copied().filter(|b| b.is_finite()).unwrap_or(0.0);
                for (d, reach) in [(0, 0.0), (1, bar)] {
                    low[d] = low[d].min(point[d] - reach);
                    high[d] = high[d].max(point[d] + reach);
                }
            }
        }
        for d in 0..2 {
            if low[d] > high[d] {
                (low[d], high[d]) = (0.0, 1.0);
            }
            // A constant gets a range of a per cent of its size.
            let least = 1e-2 * low[d].abs().max(high[d].abs()).max(1e-30);
            let range = (high[d] - low[d]).max(least);
            (low[d], high[d]) = (low[d] - 0.06 * range, high[d].max(low[d] + range) + 0.06 * range);
        }
        (low, high)
    }

    fn grid(&self, canvas: &mut Canvas, frame: &Frame) {
        let [left, top, right, bottom] = frame.at;
        for (x, text) in frame.ticks(0, 6.0) {
            let [at, _] = frame.place([x, frame.low[1]]);
            canvas.line(&[[at, top], [at, bottom]], 1.0, GRID, None);
            canvas.text(&text, [at, bottom + 18.0], Anchor::Middle, Weight::Regular, 14.0, INK, 0.0);
        }
        for (y, text) in frame.ticks(1, 5.0) {
            let [_, at] = frame.place([1.0, y]);
            canvas.line(&[[left, at], [right, at]], 1.0, GRID, None);
            canvas.text(&text, [left - 8.0, at], Anchor::Right, Weight::Regular, 14.0, INK, 0.0);
        }
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        canvas.line(&corners, 1.2, INK, None);
    }

    fn legend(&self, canvas: &mut Canvas, frame: &Frame) {
        let [_, top, right, _] = frame.at;
        let named = self.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty());
        for (row, (i, series)) in named.enumerate() {
            let y = top + 16.0 + 20.0 * row as f64;
            let colour = COLOURS[i % COLOURS.len()];
            canvas.disc([right - 14.0, y], 4.0, colour, None);
            canvas.text(&series.label, [right - 26.0, y], Anchor::Right, Weight::Regular, 14.0, INK, 0.0);
        }
    }

    fn draw_series(&self, canvas: &mut Canvas, frame: &Frame, series: &Series, colour: [u8; 3]) {
        let points: Vec<(usize, [f64; 2])> = self.drawable(series).collect();
        let places: Vec<[f64; 2]> = points.iter().map(|(_, p)| frame.place(*p)).collect();
        if series.mark != Mark::Dots {
            canvas.line(&places, 2.0, colour, None);
        }
        for ((i, [x, y]), place) in points.iter().zip(&places) {
            if let Some(bar) = series.bars.get(*i).filter(|b| b.is_finite() && **b > 0.0) {
                let ends = [y - bar, y + bar].map(|end| frame.place([*x, end]));
                canvas.line(&ends, 2.0, colour, None);
                for [at, level] in ends {
                    canvas.line(&[[at - 6.0, level], [at + 6.0, level]], 2.0, colour, None);
                }
            }
            if series.mark != Mark::Curve {
                canvas.disc(*place, 4.5, colour, None);
            }
        }
    }
}

fn finite(p: &[f64; 2]) -> bool {
    p.iter().all(|c| c.is_finite())
}
