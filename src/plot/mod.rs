//! Plots: curves with error bars in panels, on the flat canvas of the pictures ([`figure`]) and as SVG ([`svg`]); pages of
//! HTML that hold them ([`page`]). No GPU is needed.

mod markdown;
pub mod page;
mod panel;
pub mod svg;
mod ticks;

use image::RgbaImage;

use crate::Result;
use crate::render::canvas::{Anchor, Canvas, Fonts, Weight};
pub use panel::{Mark, Panel, Series};

/// Text and lines.
const INK: [u8; 3] = [40, 44, 52];

/// Pixels of a panel, its title and axis labels included.
const PANEL: [u32; 2] = [620, 440];
const TITLE: u32 = 64;

/// Draws panels row by row, `columns` in a row, under a title.
///
/// # Errors
/// [`Error::Picture`](crate::Error::Picture) without panels.
pub fn figure(title: &str, panels: &[Panel], columns: usize) -> Result<RgbaImage> {
    let columns = columns.clamp(1, panels.len().max(1));
    let rows = panels.len().div_ceil(columns);
    let size = [PANEL[0] * columns as u32, TITLE + PANEL[1] * rows as u32];
    let fonts = Fonts::new()?;
    let blank = RgbaImage::from_pixel(size[0], size[1], image::Rgba([255; 4]));
    let mut canvas = Canvas::new(blank, &fonts, 1.0)?;
    canvas.text(title, [24.0, 36.0], Anchor::Left, Weight::Medium, 22.0, INK, 0.0);
    for (i, panel) in panels.iter().enumerate() {
        let [left, top] =
            [(i % columns) as f64 * f64::from(PANEL[0]), (i / columns) as f64 * f64::from(PANEL[1])];
        panel.draw(&mut canvas, [left, top + f64::from(TITLE)], PANEL.map(f64::from));
    }
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> Panel {
        let line = Series {
            label: "a".into(),
            points: (0..9).map(|i| [f64::from(i), f64::from(i * i)]).collect(),
            bars: Vec::new(),
            mark: Mark::Line,
        };
        let bar = Series { label: "b".into(), points: vec![[4.0, 30.0]], bars: vec![10.0], mark: Mark::Dots };
        Panel { title: "t".into(), x: "x".into(), y: "y".into(), series: vec![line, bar], log_x: false }
    }

    #[test]
    fn a_figure_is_as_large_as_its_panels() {
        let picture = figure("title", &[curve(), curve(), curve()], 2).unwrap();
        assert_eq!((picture.width(), picture.height()), (2 * PANEL[0], TITLE + 2 * PANEL[1]));
        let dark = picture.pixels().filter(|p| p.0[0] < 128).count();
        assert!(dark > 3000, "{dark} dark pixels: text and curves");
        // The fourth place is empty.
        let empty = picture.enumerate_pixels().filter(|(x, y, _)| *x > PANEL[0] && *y > TITLE + PANEL[1]);
        assert!(empty.into_iter().all(|(_, _, p)| p.0 == [255; 4]));
    }

    #[test]
    fn an_error_bar_is_as_long_as_the_error() {
        let bars = |error: f64| {
            let mut panel = curve();
            panel.series[1].bars = vec![error];
            // The range must not follow the bar.
            panel.series[0].points.push([8.0, -200.0]);
            panel.series[0].points.push([8.0, 300.0]);
            let picture = figure("", &[panel], 1).unwrap();
            let [r, g, b] = panel::COLOURS[1];
            picture.pixels().filter(|p| p.0 == [r, g, b, 255]).count() as f64
        };
        let (none, short, long) = (bars(0.0), bars(50.0), bars(100.0));
        let growth = (long - none) / (short - none);
        assert!((1.5..2.5).contains(&growth), "{none} {short} {long}");
    }

    #[test]
    fn points_that_are_not_numbers_are_left_out() {
        let mut panel = curve();
        panel.series[0].points.push([f64::NAN, 1.0]);
        panel.series[0].points.push([1.0, f64::INFINITY]);
        assert!(figure("", &[panel], 1).is_ok());
        let empty =
            Panel { title: "t".into(), x: "x".into(), y: "y".into(), series: Vec::new(), log_x: false };
        assert!(figure("", &[empty], 1).is_ok());
    }
}
