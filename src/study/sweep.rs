//! A sweep's table and plot, and the cornering stiffness.

use std::fmt::Write;

use super::quantity::{Quantity, cleaned, present};
use super::report::{number, with_error};
use crate::Result;
use crate::output::Verdict;
use crate::output::summary::{StageMeans, Summary};
use crate::plot::{Mark, Panel, Series, figure};

/// A run of a sweep.
#[derive(Debug, Clone)]
pub struct Point {
    /// Values of the axes, as they were written.
    pub values: Vec<String>,
    /// The first axis's value as a number, or its place.
    pub x: f64,
    pub summary: Summary,
}

/// A scene's runs over one or more axes; the first is the abscissa of the plot.
#[derive(Debug, Clone)]
pub struct Sweep {
    pub name: String,
    pub title: String,
    /// What is varied, with units.
    pub axes: Vec<String>,
    /// In the order of the axes, the first running fastest.
    pub points: Vec<Point>,
}

/// Slope of the side force at zero slip angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffness {
    /// The other axes' values.
    pub at: String,
    /// - dFy/d alpha [N/deg], from the slip angles next to zero on either side [deg].
    pub value: f64,
    pub between: [f64; 2],
}

impl Sweep {
    fn means(&self) -> Vec<&StageMeans> {
        self.points.iter().filter_map(|p| p.summary.stages.last()).collect()
    }

    /// Points that differ in the first axis only, by the values of the others.
    fn curves(&self) -> Vec<(String, Vec<&Point>)> {
        let mut curves: Vec<(String, Vec<&Point>)> = Vec::new();
        for point in &self.points {
            let named = self.axes.iter().zip(&point.values).skip(1).map(|(a, v)| format!("{a} {v}"));
            let name = named.collect::<Vec<_>>().join(", ");
            match curves.iter_mut().find(|(n, _)| *n == name) {
                Some((_, points)) => points.push(point),
                None => curves.push((name, vec![point])),
            }
        }
        curves
    }

    /// Cornering stiffness of every curve over the slip angle that has both sides of zero.
    pub fn stiffness(&self) -> Vec<Stiffness> {
        if !self.axes[0].starts_with("slip angle") {
            return Vec::new();
        }
        let of = |(at, points): (String, Vec<&Point>)| {
            let force = |p: &&Point| (p.x, p.summary.stages.last().map_or(f64::NAN, |m| m.mean_road_fy_N));
            let sides = points.iter().map(force);
            let below = sides.clone().filter(|s| s.0 < 0.0).max_by(|a, b| a.0.total_cmp(&b.0))?;
            let above = sides.filter(|s| s.0 > 0.0).min_by(|a, b| a.0.total_cmp(&b.0))?;
            let value = -(above.1 - below.1) / (above.0 - below.0);
            Some(Stiffness { at, value, between: [below.0, above.0] })
        };
        self.curves().into_iter().filter_map(of).collect()
    }

    /// The report in Markdown. `error`: relative error bar of the side force, from a study of the mesh.
    pub fn markdown(&self, picture: &str, error: Option<f64>) -> String {
        let mut text = format!("## {}\n\n{}.\n\n", self.name, self.title);
        let quantities = present(&self.means());
        self.axes.iter().for_each(|a| _ = write!(text, "| {a} "));
        quantities.iter().for_each(|q| _ = write!(text, "| {} [{}] ", q.symbol, q.unit));
        text += "| contact force |\n|";
        text += &"---|".repeat(self.axes.len() + quantities.len() + 1);
        text.push('\n');
        for point in &self.points {
            let Some(means) = point.summary.stages.last() else { continue };
            point.values.iter().for_each(|v| _ = write!(text, "| {v} "));
            for q in &quantities {
                let all = self.means().into_iter().map(|m| (q.value)(m));
                _ = write!(text, "| {} ", number(cleaned((q.value)(means), all)));
            }
            let verdict = match means.contact.as_ref().map(|c| c.verdict) {
                None => "–",
                Some(Verdict::Smooth) => "smooth",
                Some(Verdict::Tone) => "hums",
                Some(Verdict::Chattering) => "**chattering**",
                Some(Verdict::Rounding) => "**rounding**",
            };
            _ = writeln!(text, "| {verdict} |");
        }
        text.push('\n');
        for s in self.stiffness() {
            let (value, bar) = match error {
                Some(error) => {
                    let (value, bar) = with_error(s.value, error * s.value.abs());
                    (value, format!(" ± {bar}"))
                }
                None => (number(s.value), String::new()),
            };
            let at = if s.at.is_empty() { String::new() } else { format!(" at {}", s.at) };
            let [from, to] = s.between;
            let origin = if error.is_some() {
                "; error bar of the mesh study"
            } else {
                "; no mesh study, no error bar"
            };
            _ = writeln!(
                text,
                "Cornering stiffness{at}: {value}{bar} N/deg (between {from} and {to} deg{origin}).\n"
            );
        }
        let wall: f64 = self.points.iter().map(|p| p.summary.wall_time_s).sum();
        _ = writeln!(text, "{} runs, {wall:.1} s of running.\n", self.points.len());
        _ = writeln!(text, "![{} over {}]({picture})", self.name, self.axes.join(", "));
        text
    }

    /// Every number: a row a run.
    pub fn csv(&self) -> String {
        let quantities = present(&self.means());
        let mut text = self.axes.iter().map(|a| a.replace(',', " ")).collect::<Vec<_>>().join(",");
        quantities.iter().for_each(|q| _ = write!(text, ",{} [{}]", q.name, q.unit));
        text += ",remaining_share,wall_time_s\n";
        for point in &self.points {
            let Some(means) = point.summary.stages.last() else { continue };
            text += &point.values.join(",");
            quantities.iter().for_each(|q| _ = write!(text, ",{:e}", (q.value)(means)));
            let share = means.contact.as_ref().map_or(0.0, |c| c.remaining_share);
            _ = writeln!(text, ",{share:e},{:e}", point.summary.wall_time_s);
        }
        text
    }

    /// Every quantity over the first axis, a curve for every choice of the others.
    ///
    /// # Errors
    /// [`Error::Picture`](crate::Error::Picture).
    pub fn picture(&self) -> Result<image::RgbaImage> {
        figure(&format!("{} over {}", self.name, self.axes[0]), &self.panels(), 3)
    }

    /// The panels of the picture.
    pub fn panels(&self) -> Vec<Panel> {
        present(&self.means()).iter().map(|q| self.panel(q)).collect()
    }

    fn panel(&self, quantity: &Quantity) -> Panel {
        let value = |p: &&Point| p.summary.stages.last().map_or(f64::NAN, |m| (quantity.value)(m));
        let series = self.curves().into_iter().map(|(label, mut points)| {
            points.sort_by(|a, b| a.x.total_cmp(&b.x));
            let points = points.iter().map(|p| [p.x, value(p)]).collect();
            Series { label, points, bars: Vec::new(), mark: Mark::Line }
        });
        Panel {
            title: quantity.symbol.into(),
            x: self.axes[0].clone(),
            y: format!("{} [{}]", quantity.symbol, quantity.unit),
            series: series.collect(),
            ..Panel::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fy = -20 alpha load / 300.
    fn sweep(angles: &[f64], loads: &[f64]) -> Sweep {
        let point = |(load, angle): (f64, f64)| {
            let means = StageMeans {
                mean_road_fy_N: -20.0 * angle * load / 300.0,
                mean_road_fz_N: load,
                ..StageMeans::default()
            };
            let summary = Summary { stages: vec![means], ..Summary::default() };
            Point { values: vec![angle.to_string(), load.to_string()], x: angle, summary }
        };
        let all = loads.iter().flat_map(|&l| angles.iter().map(move |&a| (l, a)));
        Sweep {
            name: "wheel".into(),
            title: "A wheel".into(),
            axes: vec!["slip angle [deg]".into(), "load [N]".into()],
            points: all.map(point).collect(),
        }
    }

    #[test]
    fn the_stiffness_is_the_slope_at_zero_for_every_load() {
        let sweep = sweep(&[-5.0, -2.5, 0.0, 2.5, 5.0], &[300.0, 600.0]);
        let found = sweep.stiffness();
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].value, found[0].between), (20.0, [-2.5, 2.5]));
        assert_eq!((found[1].value, found[1].at.as_str()), (40.0, "load [N] 600"));
        let text = sweep.markdown("p.png", Some(0.01));
        assert!(
            text.contains(
                "Cornering stiffness at load [N] 300: 20.00 ± 0.20 N/deg (between -2.5 and 2.5 deg"
            ),
            "{text}"
        );
        assert_eq!(sweep.csv().lines().count(), 11);
        assert!(sweep.picture().is_ok());
    }

    #[test]
    fn one_side_of_zero_has_no_stiffness() {
        assert_eq!(sweep(&[0.0, 2.5, 5.0], &[300.0]).stiffness(), []);
    }
}
