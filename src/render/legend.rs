//! What explains a picture: title, time, colour bar, length scale, directions.

use glam::DVec3;

use super::camera::{Camera, Rect};
use super::canvas::{Anchor, Canvas, Weight};
use super::colour::{ColourMap, INK, QUIET, WHITE};
use super::scale::{Scale, prefix, quantity, round_below};

/// Title and, under or in place of it, a second line, from the top left.
pub fn heading(canvas: &mut Canvas, title: Option<&str>, second: &str) {
    let u = canvas.unit;
    let x = 40.0 * u;
    let mut y = 44.0 * u;
    if let Some(title) = title {
        canvas.text(title, [x, y], Anchor::Left, Weight::Medium, 27.0, INK, 0.0);
        y += 36.0 * u;
    }
    canvas.text(second, [x, y], Anchor::Left, Weight::Regular, 21.0, QUIET, 0.0);
}

/// `t = 30.00 ms`.
pub fn time_stamp(time: f64) -> String {
    format!("t = {}", quantity(time, "s", 4))
}

/// A vertical colour bar in `rect` with ticks to its right, and `name (unit)` above.
pub fn colour_bar(canvas: &mut Canvas, rect: Rect, scale: &Scale, map: ColourMap, name: &str) {
    let u = canvas.unit;
    let heading = if scale.unit.is_empty() { name.to_string() } else { format!("{name} ({})", scale.unit) };
    let lift = if scale.beyond[1] { 46.0 } else { 28.0 };
    canvas.text(&heading, [rect.x, rect.y - lift * u], Anchor::Left, Weight::Medium, 20.0, INK, 0.0);
    let right = rect.x + rect.width;
    let rows = rect.height.ceil() as usize;
    for row in 0..rows {
        let (y0, y1) = (row as f64, (row as f64 + 1.0).min(rect.height));
        let colour = map.at(1.0 - 0.5 * (y0 + y1) / rect.height);
        // One pixel of overlap hides the seams between anti-aliased rows.
        let y1 = (y1 + 1.0).min(rect.height);
        let (y0, y1) = (rect.y + y0, rect.y + y1);
        canvas.polygon(&[[rect.x, y0], [right, y0], [right, y1], [rect.x, y1]], colour, None);
    }
    let outline = bar_outline(canvas, rect, scale, map);
    canvas.line(&outline, 1.2 * u, INK, None);
    for (value, label) in &scale.ticks {
        let y = rect.y + rect.height * (1.0 - scale.place(*value));
        canvas.line(&[[right, y], [right + 7.0 * u, y]], 1.2 * u, INK, None);
        canvas.text(label, [right + 14.0 * u, y], Anchor::Left, Weight::Regular, 19.0, INK, 0.0);
    }
}

/// Fills the pointed ends of a bar whose range leaves values out, and returns its closed outline.
fn bar_outline(canvas: &mut Canvas, rect: Rect, scale: &Scale, map: ColourMap) -> Vec<[f64; 2]> {
    let (left, right) = (rect.x, rect.x + rect.width);
    let (top, bottom) = (rect.y, rect.y + rect.height);
    let point = 0.7 * rect.width;
    let middle = 0.5 * (left + right);
    let mut outline = vec![[left, top]];
    if scale.beyond[1] {
        let tip = [middle, top - point];
        canvas.polygon(&[[left, top], tip, [right, top]], map.at(1.0), None);
        outline.push(tip);
    }
    outline.extend([[right, top], [right, bottom]]);
    if scale.beyond[0] {
        let tip = [middle, bottom + point];
        canvas.polygon(&[[left, bottom], tip, [right, bottom]], map.at(0.0), None);
        outline.push(tip);
    }
    outline.extend([[left, bottom], [left, top]]);
    outline
}

/// A bar of a round length, at most `room` pixels long, starting at `at`, with its length above.
pub fn length_bar(canvas: &mut Canvas, at: [f64; 2], room: f64, pixels_per_metre: f64) {
    let u = canvas.unit;
    let length = round_below(room / pixels_per_metre);
    let end = at[0] + length * pixels_per_metre;
    canvas.line(&[at, [end, at[1]]], 2.4 * u, INK, None);
    for x in [at[0], end] {
        canvas.line(&[[x, at[1] - 6.0 * u], [x, at[1] + 6.0 * u]], 2.4 * u, INK, None);
    }
    let (factor, unit) = prefix("m", length);
    let label = format!("{} {unit}", (length / factor).round());
    let middle = [0.5 * (at[0] + end), at[1] - 19.0 * u];
    canvas.text(&label, middle, Anchor::Middle, Weight::Regular, 19.0, INK, 0.0);
}

/// The directions of space as seen by the camera, about `at`.
pub fn triad(canvas: &mut Canvas, camera: &Camera, at: [f64; 2]) {
    let u = canvas.unit;
    let axes = [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")];
    let mut axes = axes.map(|(axis, name)| (camera.turn(axis), name));
    // The one that points away from the eye first, so that the others lie over it.
    axes.sort_by(|a, b| a.0[2].total_cmp(&b.0[2]));
    let length = 46.0 * u;
    for ([right, up, _], name) in axes {
        let flat = right.hypot(up);
        if flat > FORESHORTENED {
            canvas.arrow(at, [at[0] + length * right, at[1] - length * up], 2.2 * u, INK);
            let reach = (length * flat + 13.0 * u) / flat;
            let label = [at[0] + reach * right, at[1] - reach * up];
            canvas.text(name, label, Anchor::Middle, Weight::Medium, 18.0, INK, 0.0);
        }
    }
    for ([right, up, back], name) in axes {
        if right.hypot(up) <= FORESHORTENED {
            along_sight(canvas, at, back > 0.0);
            // Where no other axis points: opposite to their sum.
            let sum = axes.iter().fold([0.0; 2], |s, (a, _)| [s[0] + a[0], s[1] + a[1]]);
            let label = [0, 1].map(|d| at[d] - 17.0 * u * sum[d].signum() * [1.0, -1.0][d]);
            canvas.text(name, label, Anchor::Middle, Weight::Medium, 18.0, INK, 0.0);
        }
    }
}

/// An axis shorter than this share of its length is shown as one along the line of sight.
const FORESHORTENED: f64 = 0.12;

/// The sign of an axis along the line of sight: a dot towards the reader, a cross away from the reader.
fn along_sight(canvas: &mut Canvas, at: [f64; 2], towards: bool) {
    let u = canvas.unit;
    canvas.disc(at, 7.5 * u, WHITE, Some((1.8 * u, INK)));
    if towards {
        canvas.disc(at, 2.6 * u, INK, None);
        return;
    }
    let s = 7.5 * u * std::f64::consts::FRAC_1_SQRT_2;
    for slant in [s, -s] {
        canvas.line(&[[at[0] - s, at[1] - slant], [at[0] + s, at[1] + slant]], 1.5 * u, INK, None);
    }
}
