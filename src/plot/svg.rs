//! A panel as SVG, for pages: sharp at any size, and a pointer that rests on it is told the values there. No script.

use std::fmt::Write;

use super::panel::{COLOURS, Frame, Mark, Panel, Series};

/// Width and height in the drawing's own units.
const SIZE: [f64; 2] = [620.0, 340.0];

/// Places along the abscissa at which a pointer is answered, at most.
const STOPS: usize = 160;

/// Points of a curve, at most: two a unit of its width show all that can be seen of it.
const POINTS: usize = 1000;

/// Something that happens at a place on the abscissa, such as the start of a stage: a dashed line with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    pub x: f64,
    pub name: String,
}

/// The panel as an `<svg>` element that needs nothing outside it.
pub fn panel(panel: &Panel, events: &[Event]) -> String {
    let at = [84.0, 34.0, SIZE[0] - 16.0, SIZE[1] - 50.0];
    let frame = panel.frame(at);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" class=\"plot\">\n",
        SIZE[0],
        SIZE[1],
        escaped(&panel.title)
    );
    grid(&mut svg, &frame);
    marked(&mut svg, &frame, events);
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        drawn(&mut svg, panel, &frame, series, &hex(*colour));
    }
    labels(&mut svg, panel, &frame);
    answers(&mut svg, panel, &frame);
    svg + "</svg>\n"
}

/// Text as it may stand in HTML and in attributes.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\'' => out += "&#39;",
            c => out.push(c),
        }
    }
    out
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn text(svg: &mut String, [x, y]: [f64; 2], class: &str, text: &str) {
    _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"{class}\">{}</text>", escaped(text));
}

fn grid(svg: &mut String, frame: &Frame) {
    let [left, top, right, bottom] = frame.at;
    for (x, tick) in frame.ticks(0, 6.0) {
        let [at, _] = frame.place([x, 0.0]);
        _ = writeln!(svg, "<path d=\"M{at:.1} {top}V{bottom}\" class=\"grid\"/>");
        text(svg, [at, bottom + 17.0], "tick middle", &tick);
    }
    for (y, tick) in frame.ticks(1, 5.0) {
        let [_, at] = frame.place([1.0, y]);
        _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{right}\" class=\"grid\"/>");
        text(svg, [left - 7.0, at + 4.0], "tick end", &tick);
    }
    _ = writeln!(svg, "<path d=\"M{left} {top}H{right}V{bottom}H{left}Z\" class=\"frame\"/>");
}

fn marked(svg: &mut String, frame: &Frame, events: &[Event]) {
    let [left, top, right, bottom] = frame.at;
    for event in events {
        let [at, _] = frame.place([event.x, 0.0]);
        if (left - 0.5..=right).contains(&at) {
            _ = writeln!(svg, "<path d=\"M{at:.1} {top}V{bottom}\" class=\"event\"/>");
            text(svg, [at + 4.0, bottom - 6.0], "event", &event.name);
        }
    }
}

/// A series: its line, error bars, dots. In one piece: what a mark means stands together.
fn drawn(svg: &mut String, panel: &Panel, frame: &Frame, series: &Series, colour: &str) {
    let points: Vec<(usize, [f64; 2])> = panel.drawable(series).collect();
    if series.mark != Mark::Dots {
        let places: Vec<[f64; 2]> = points.iter().map(|(_, p)| frame.place(*p)).collect();
        let line: Vec<String> = thinned(&places).iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        _ = writeln!(svg, "<polyline points=\"{}\" class=\"curve\" stroke=\"{colour}\"/>", line.join(" "));
    }
    for (i, [x, y]) in points {
        if let Some(bar) = series.bars.get(i).filter(|b| b.is_finite() && **b > 0.0) {
            let [[at, low], [_, high]] = [y - bar, y + bar].map(|end| frame.place([x, end]));
            let [from, to] = [at - 5.0, at + 5.0];
            _ = writeln!(
                svg,
                "<path d=\"M{at:.1} {low:.1}V{high:.1}M{from:.1} {low:.1}H{to:.1}M{from:.1} {high:.1}H{to:.1}\" \
                 class=\"curve\" stroke=\"{colour}\"/>"
            );
        }
        if series.mark != Mark::Curve {
            let [at, level] = frame.place([x, y]);
            _ = writeln!(svg, "<circle cx=\"{at:.1}\" cy=\"{level:.1}\" r=\"3.5\" fill=\"{colour}\"/>");
        }
    }
}

/// The same line with fewer points: the lowest and the highest of every stretch, so that no peak is lost.
fn thinned(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if places.len() <= POINTS {
        return places.to_vec();
    }
    let stretch = places.len().div_ceil(POINTS / 2);
    let ends = |chunk: &[[f64; 2]]| {
        let by = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let (low, high) = (chunk.iter().min_by(by), chunk.iter().max_by(by));
        let mut ends: Vec<[f64; 2]> = low.into_iter().chain(high).copied().collect();
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        ends
    };
    places.chunks(stretch).flat_map(ends).collect()
}

fn labels(svg: &mut String, panel: &Panel, frame: &Frame) {
    let [left, top, right, bottom] = frame.at;
    text(svg, [left, 20.0], "title", &panel.title);
    text(svg, [0.5 * (left + right), bottom + 38.0], "label middle", &panel.x);
    let middle = 0.5 * (top + bottom);
    let turned = format!("transform=\"rotate(-90 18 {middle:.1})\"");
    _ = writeln!(
        svg,
        "<text x=\"18\" y=\"{middle:.1}\" {turned} class=\"label middle\">{}</text>",
        escaped(&panel.y)
    );
    let named = panel.series.iter().zip(COLOURS.iter().cycle()).filter(|(s, _)| !s.label.is_empty());
    // From the right end of the title's line, the last name first.
    let mut x = right;
    for (series, colour) in named.collect::<Vec<_>>().into_iter().rev() {
        let width = 6.6 * series.label.chars().count() as f64;
        text(svg, [x, 20.0], "legend", &series.label);
        x -= width + 10.0;
        _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"16\" r=\"4\" fill=\"{}\"/>", hex(*colour));
        x -= 16.0;
    }
}

/// Strips over the panel that show the values under them: a line where the pointer is, dots on the curves, and a text.
fn answers(svg: &mut String, panel: &Panel, frame: &Frame) {
    let [left, top, right, bottom] = frame.at;
    let all: Vec<Vec<[f64; 2]>> =
        panel.series.iter().map(|s| panel.drawable(s).map(|(_, p)| p).collect()).collect();
    let mut xs: Vec<f64> = all.iter().flatten().map(|p| p[0]).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    let every = xs.len().div_ceil(STOPS).max(1);
    let stops: Vec<f64> = xs.into_iter().step_by(every).collect();
    let at: Vec<f64> = stops.iter().map(|x| frame.place([*x, 0.0])[0]).collect();
    for (i, x) in stops.iter().enumerate() {
        let from = if i == 0 { left } else { 0.5 * (at[i - 1] + at[i]) };
        let to = at.get(i + 1).map_or(right, |next| 0.5 * (at[i] + next));
        let mut told = format!("{}: {}", panel.x, digits(*x));
        let mut dots = String::new();
        for ((series, points), colour) in panel.series.iter().zip(&all).zip(COLOURS.iter().cycle()) {
            // A series that has no point here says nothing here.
            let Some(point) = points.iter().find(|p| p[0] == *x) else { continue };
            let name = if series.label.is_empty() { &panel.y } else { &series.label };
            _ = write!(told, "\n{name}: {}", digits(point[1]));
            let [px, py] = frame.place(*point);
            _ = write!(dots, "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"4\" fill=\"{}\"/>", hex(*colour));
        }
        _ = writeln!(
            svg,
            "<g class=\"answer\"><rect x=\"{from:.1}\" y=\"{top}\" width=\"{:.1}\" height=\"{:.1}\"/>\
             <path d=\"M{:.1} {top}V{bottom}\"/>{dots}<title>{}</title></g>",
            (to - from).max(0.0),
            bottom - top,
            at[i],
            escaped(&told)
        );
    }
}

/// Five digits.
fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-3..1e6).contains(&size) => format!("{value:.4e}"),
        size => format!("{value:.*}", (4 - size.log10().floor() as i32).clamp(0, 7) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: Vec<[f64; 2]>) -> Panel {
        let series = Series { label: "<fz>".into(), points, bars: Vec::new(), mark: Mark::Curve };
        Panel {
            title: "a & b".into(),
            x: "t [s]".into(),
            y: "F [N]".into(),
            series: vec![series],
            log_x: false,
        }
    }

    #[test]
    fn it_is_one_complete_element_that_tells_its_values() {
        let svg = panel(&curve(vec![[0.0, 1.0], [0.5, 1234.5], [1.0, 2.0]]), &[]);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let titles: Vec<&str> =
            document.descendants().filter(|n| n.has_tag_name("title")).filter_map(|n| n.text()).collect();
        assert_eq!(titles.len(), 3);
        assert_eq!(titles[1], "t [s]: 0.50000\n<fz>: 1234.5");
        assert!(!svg.contains("script") && !svg.contains("http"), "nothing outside is asked for");
    }

    #[test]
    fn the_strips_cover_the_frame_and_do_not_overlap() {
        let svg = panel(&curve((0..50).map(|i| [f64::from(i * i), 1.0]).collect()), &[]);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let strips: Vec<[f64; 2]> = document
            .descendants()
            .filter(|n| n.has_tag_name("rect"))
            .map(|n| ["x", "width"].map(|a| n.attribute(a).unwrap().parse().unwrap()))
            .collect();
        for pair in strips.windows(2) {
            assert!((pair[0][0] + pair[0][1] - pair[1][0]).abs() < 0.11, "{pair:?}");
        }
        let covered: f64 = strips.iter().map(|s| s[1]).sum();
        // From the left edge of the frame to the right one, to the tenths that are written.
        assert!((covered - (SIZE[0] - 16.0 - 84.0)).abs() < 0.1 * 50.0, "{covered}");
    }

    #[test]
    fn a_long_curve_keeps_its_peaks_and_not_its_size() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|i| [f64::from(i), 0.0]).collect();
        points[54_321][1] = 7.0;
        let places = thinned(&points);
        assert!(places.len() <= POINTS, "{}", places.len());
        assert!(places.iter().any(|p| p[1] == 7.0), "the only peak");
        assert!(panel(&curve(points), &[]).len() < 100_000);
    }
}
