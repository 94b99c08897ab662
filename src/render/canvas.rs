//! Flat additions to a picture: text, lines, arrows, discs. Coordinates are pixels from the top left.

use ab_glyph::{Font, FontRef, OutlineCurve};
use image::RgbaImage;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};

use super::colour::WHITE;
use crate::{Error, Result};

/// Weight of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    Regular,
    Medium,
}

/// Which point of a text stands at the given place, horizontally; vertically it is the middle of a capital.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Left,
    Middle,
    Right,
}

/// The two fonts of the pictures.
#[derive(Debug)]
pub struct Fonts {
    regular: FontRef<'static>,
    medium: FontRef<'static>,
}

/// Height of a capital letter over the font size (Roboto: 1456/2048).
const CAPITAL: f64 = 0.711;

impl Fonts {
    pub fn new() -> Result<Fonts> {
        let read = |bytes: &'static [u8]| {
            FontRef::try_from_slice(bytes).map_err(|e| Error::Picture { problem: format!("font: {e}") })
        };
        Ok(Fonts {
            regular: read(include_bytes!("../../assets/fonts/Roboto-Regular.ttf"))?,
            medium: read(include_bytes!("../../assets/fonts/Roboto-Medium.ttf"))?,
        })
    }

    fn get(&self, weight: Weight) -> &FontRef<'static> {
        match weight {
            Weight::Regular => &self.regular,
            Weight::Medium => &self.medium,
        }
    }

    /// Advance of a text of `size` pixels.
    pub fn width(&self, text: &str, weight: Weight, size: f64) -> f64 {
        let font = self.get(weight);
        let units = f64::from(font.units_per_em().unwrap_or(1.0));
        text.chars().map(|c| f64::from(font.h_advance_unscaled(font.glyph_id(c)))).sum::<f64>() * size / units
    }

    /// Outline of a text with its baseline's start at the origin, y downwards.
    fn outline(&self, text: &str, weight: Weight, size: f64) -> Option<Path> {
        let font = self.get(weight);
        let scale = size as f32 / font.units_per_em().unwrap_or(1.0);
        let mut builder = PathBuilder::new();
        let mut pen = 0.0;
        for c in text.chars() {
            let glyph = font.glyph_id(c);
            let curves = font.outline(glyph).map(|o| o.curves).unwrap_or_default();
            contours(&mut builder, &curves, |p| ((pen + p.x) * scale, -p.y * scale));
            pen += font.h_advance_unscaled(glyph);
        }
        builder.finish()
    }
}

/// Appends a glyph's curves, closing each contour.
fn contours(
    builder: &mut PathBuilder,
    curves: &[OutlineCurve],
    place: impl Fn(ab_glyph::Point) -> (f32, f32),
) {
    let mut last = None;
    for curve in curves {
        let (from, to) = match curve {
            OutlineCurve::Line(a, b) => (*a, *b),
            OutlineCurve::Quad(a, _, b) => (*a, *b),
            OutlineCurve::Cubic(a, _, _, b) => (*a, *b),
        };
        if last != Some(from) {
            if last.is_some() {
                builder.close();
            }
            let (x, y) = place(from);
            builder.move_to(x, y);
        }
        let (x, y) = place(to);
        match curve {
            OutlineCurve::Line(..) => builder.line_to(x, y),
            OutlineCurve::Quad(_, c, _) => {
                let (cx, cy) = place(*c);
                builder.quad_to(cx, cy, x, y);
            }
            OutlineCurve::Cubic(_, c, d, _) => {
                let ((cx, cy), (dx, dy)) = (place(*c), place(*d));
                builder.cubic_to(cx, cy, dx, dy, x, y);
            }
        }
        last = Some(to);
    }
    if last.is_some() {
        builder.close();
    }
}

/// A picture being lettered.
pub struct Canvas<'f> {
    pixmap: Pixmap,
    fonts: &'f Fonts,
    /// Pixels per design unit: 1 at a height of 900.
    pub unit: f64,
}

impl<'f> Canvas<'f> {
    /// Starts from an opaque picture.
    pub fn new(picture: RgbaImage, fonts: &'f Fonts, unit: f64) -> Result<Canvas<'f>> {
        let size = tiny_skia::IntSize::from_wh(picture.width(), picture.height());
        let pixmap = size.and_then(|size| Pixmap::from_vec(picture.into_raw(), size));
        let pixmap = pixmap.ok_or_else(|| Error::Picture { problem: "it has no pixels".into() })?;
        Ok(Canvas { pixmap, fonts, unit })
    }

    /// The finished picture.
    pub fn finish(self) -> Result<RgbaImage> {
        let (width, height) = (self.pixmap.width(), self.pixmap.height());
        RgbaImage::from_raw(width, height, self.pixmap.take())
            .ok_or_else(|| Error::Picture { problem: "its pixels do not match its size".into() })
    }

    /// Writes `text` at `at`, `size` in design units, turned by `turn` degrees clockwise.
    #[allow(clippy::too_many_arguments)] // what a text is; naming them in a struct would only lengthen calls
    pub fn text(
        &mut self,
        text: &str,
        at: [f64; 2],
        anchor: Anchor,
        weight: Weight,
        size: f64,
        colour: [u8; 3],
        turn: f64,
    ) {
        let pixels = size * self.unit;
        let width = self.fonts.width(text, weight, pixels);
        let shift = match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::Right => -width,
        };
        let Some(path) = self.fonts.outline(text, weight, pixels) else { return };
        let transform = Transform::from_translate(shift as f32, (0.5 * CAPITAL * pixels) as f32)
            .post_concat(Transform::from_rotate(turn as f32))
            .post_translate(at[0] as f32, at[1] as f32);
        self.pixmap.fill_path(&path, &paint(colour, 1.0), FillRule::Winding, transform, None);
    }

    /// A polyline `width` pixels wide; `dash`: lengths of strokes and gaps [pixels], or none.
    pub fn line(&mut self, points: &[[f64; 2]], width: f64, colour: [u8; 3], dash: Option<[f64; 2]>) {
        let Some(path) = polyline(points, false) else { return };
        let dash = dash.and_then(|d| StrokeDash::new(d.map(|l| l as f32).to_vec(), 0.0));
        let stroke = Stroke { dash, ..stroke(width) };
        self.pixmap.stroke_path(&path, &paint(colour, 1.0), &stroke, Transform::identity(), None);
    }

    /// A filled polygon with an optional outline (width, colour).
    pub fn polygon(&mut self, points: &[[f64; 2]], fill: [u8; 3], outline: Option<(f64, [u8; 3])>) {
        if let Some(path) = polyline(points, true) {
            self.shape(&path, fill, outline);
        }
    }

    /// A filled disc with an optional outline.
    pub fn disc(&mut self, at: [f64; 2], radius: f64, fill: [u8; 3], outline: Option<(f64, [u8; 3])>) {
        if let Some(path) = PathBuilder::from_circle(at[0] as f32, at[1] as f32, radius as f32) {
            self.shape(&path, fill, outline);
        }
    }

    fn shape(&mut self, path: &Path, fill: [u8; 3], outline: Option<(f64, [u8; 3])>) {
        let to = Transform::identity();
        self.pixmap.fill_path(path, &paint(fill, 1.0), FillRule::Winding, to, None);
        if let Some((width, colour)) = outline {
            self.pixmap.stroke_path(path, &paint(colour, 1.0), &stroke(width), to, None);
        }
    }

    /// An arrow with a light rim that keeps it readable on any colour; shorter than its head: the head shrinks.
    pub fn arrow(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: [u8; 3]) {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = dx.hypot(dy);
        if length < 0.5 {
            return;
        }
        let (ux, uy) = (dx / length, dy / length);
        let head = (4.6 * width).min(0.6 * length);
        let (half, shaft) = (0.42 * head, (0.5 * width).min(0.2 * head));
        let at = |along: f64, side: f64| [from[0] + ux * along - uy * side, from[1] + uy * along + ux * side];
        let neck = length - head;
        let points = [
            at(0.0, -shaft),
            at(neck, -shaft),
            at(neck, -half),
            at(length, 0.0),
            at(neck, half),
            at(neck, shaft),
            at(0.0, shaft),
        ];
        if let Some(path) = polyline(&points, true) {
            let to = Transform::identity();
            let rim = stroke(1.6 * self.unit);
            self.pixmap.stroke_path(&path, &paint(WHITE, 0.85), &rim, to, None);
            self.pixmap.fill_path(&path, &paint(colour, 1.0), FillRule::Winding, to, None);
        }
    }
}

fn stroke(width: f64) -> Stroke {
    Stroke { width: width as f32, line_cap: LineCap::Butt, line_join: LineJoin::Round, ..Default::default() }
}

fn paint([r, g, b]: [u8; 3], opacity: f64) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Default::default() };
    let alpha = (opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
    paint.set_color(Color::from_rgba8(r, g, b, alpha));
    paint
}

fn polyline(points: &[[f64; 2]], close: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (i, p) in points.iter().enumerate() {
        let (x, y) = (p[0] as f32, p[1] as f32);
        if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    if close {
        builder.close();
    }
    builder.finish()
}
