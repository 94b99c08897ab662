//! A study's table and picture.

use std::fmt::Write;

use super::convergence::{Convergence, Level, judge};
use super::quantity::{Quantity, present};
use crate::Result;
use crate::output::Verdict;
use crate::output::summary::{StageMeans, Summary};
use crate::plot::{Mark, Panel, Series, figure};

/// A run of a study.
#[derive(Debug, Clone)]
pub struct Run {
    /// The value of the axis, as a table shows it.
    pub label: String,
    /// Relative size of the mesh or step; none where the axis has none (precision).
    pub size: Option<f64>,
    pub summary: Summary,
}

/// A scene's runs along one axis, coarsest first.
#[derive(Debug, Clone)]
pub struct Study {
    /// Name of the scene, and its title.
    pub name: String,
    pub title: String,
    /// What is varied.
    pub axis: String,
    pub runs: Vec<Run>,
}

/// A quantity over the runs.
pub struct Row {
    pub quantity: Quantity,
    pub values: Vec<f64>,
    pub convergence: Convergence,
}

impl Study {
    /// The means of the last stage, a run each.
    fn means(&self) -> Vec<&StageMeans> {
        self.runs.iter().filter_map(|r| r.summary.stages.last()).collect()
    }

    /// Every quantity that the runs have.
    pub fn rows(&self) -> Vec<Row> {
        let means = self.means();
        let row = |quantity: Quantity| {
            let values: Vec<f64> = means.iter().map(|m| (quantity.value)(m)).collect();
            let levels: Option<Vec<Level>> = self
                .runs
                .iter()
                .zip(&values)
                .map(|(run, &value)| run.size.map(|h| Level { h, value }))
                .collect();
            let convergence = levels.map_or(Convergence::TooFew, |levels| judge(&levels));
            Row { quantity, values, convergence }
        };
        present(&means).into_iter().map(row).collect()
    }

    /// The section of a report, in Markdown.
    pub fn markdown(&self, picture: &str) -> String {
        let mut text = format!("## {}\n\n{}.\n\n", self.name, self.title);
        text += &self.run_table();
        let stage = self.means().first().map_or("", |m| m.stage.as_str());
        _ = write!(
            text,
            "\nMeans of stage \"{stage}\" over its last 30 % (a stage that settles: at its end).\n\n"
        );
        text += "| quantity |";
        self.runs.iter().for_each(|r| _ = write!(text, " {} |", r.label));
        let extrapolates = self.runs.iter().all(|r| r.size.is_some());
        text += if extrapolates { " order | extrapolated |\n" } else { " largest difference |\n" };
        let columns = self.runs.len() + if extrapolates { 3 } else { 2 };
        _ = writeln!(text, "|{}", "---|".repeat(columns));
        for row in self.rows() {
            _ = write!(text, "| {} [{}] |", row.quantity.symbol, row.quantity.unit);
            row.values.iter().for_each(|v| _ = write!(text, " {} |", number(*v)));
            text += &if extrapolates { verdict(&row.convergence) } else { difference(&row.values) };
            text.push('\n');
        }
        _ = write!(text, "\n![{} over {}]({picture})\n", self.name, self.axis);
        text
    }

    /// How each run was made and whether its contact force is to be believed.
    fn run_table(&self) -> String {
        let mut text =
            format!("| {} | elements | steps | engine | wall time [s] | contact force |\n", self.axis);
        text += "|---|---|---|---|---|---|\n";
        for run in &self.runs {
            let s = &run.summary;
            let contact = s.stages.last().and_then(|m| m.contact.as_ref());
            let contact = contact.map_or("–".into(), |c| {
                let verdict = match c.verdict {
                    Verdict::Smooth => "smooth",
                    Verdict::Tone => "hums",
                    Verdict::Chattering => "**chattering**",
                    Verdict::Rounding => "**rounding**",
                };
                format!(
                    "{verdict}, scatter {:.2} %, tone {:.2} %",
                    100.0 * c.remaining_share,
                    100.0 * c.tone_share
                )
            });
            _ = writeln!(
                text,
                "| {} | {} | {} | {} {} | {:.1} | {contact} |",
                run.label, s.elements, s.steps, s.engine, s.precision, s.wall_time_s
            );
        }
        text
    }

    /// Every number of the report: a row a quantity.
    pub fn csv(&self) -> String {
        let mut text = String::from("scene,quantity,unit");
        self.runs.iter().for_each(|r| _ = write!(text, ",{}", r.label.replace(',', " ")));
        text += ",verdict,order,value,error_bar\n";
        for row in self.rows() {
            _ = write!(text, "{},{},{}", self.name, row.quantity.name, row.quantity.unit);
            row.values.iter().for_each(|v| _ = write!(text, ",{v:e}"));
            _ = match row.convergence {
                Convergence::Monotone { value, order, error } => {
                    writeln!(text, ",extrapolated,{order:.3},{value:e},{error:e}")
                }
                Convergence::NotMonotone { finest, spread } => {
                    writeln!(text, ",not monotone,,{finest:e},{spread:e}")
                }
                Convergence::Diverging { finest, spread } => {
                    writeln!(text, ",not converging,,{finest:e},{spread:e}")
                }
                Convergence::Constant { value, .. } => writeln!(text, ",constant,,{value:e},0"),
                Convergence::TooFew => writeln!(text, ",too few,,,"),
            };
        }
        text
    }

    /// Every quantity against the size, with the extrapolated value and its error bar at zero.
    ///
    /// # Errors
    /// [`Error::Picture`](crate::Error::Picture).
    pub fn picture(&self) -> Result<image::RgbaImage> {
        figure(&format!("{}: means over {}", self.name, self.axis), &self.panels(), 3)
    }

    /// The panels of the picture.
    pub fn panels(&self) -> Vec<Panel> {
        self.rows().iter().map(|row| self.panel(row)).collect()
    }

    fn panel(&self, row: &Row) -> Panel {
        let place = |(i, run): (usize, &Run)| run.size.unwrap_or(i as f64);
        let points = self.runs.iter().enumerate().map(place).zip(&row.values).map(|(x, v)| [x, *v]).collect();
        let mut series = vec![Series { label: "runs".into(), points, bars: Vec::new(), mark: Mark::Line }];
        let title = match row.convergence {
            Convergence::Monotone { value, error, order } => {
                series.push(Series {
                    label: "extrapolated".into(),
                    points: vec![[0.0, value]],
                    bars: vec![error],
                    mark: Mark::Dots,
                });
                format!("{}: order {order:.1}", row.quantity.symbol)
            }
            Convergence::NotMonotone { .. } => format!("{}: not monotone", row.quantity.symbol),
            Convergence::Diverging { .. } => format!("{}: not converging", row.quantity.symbol),
            Convergence::Constant { .. } | Convergence::TooFew => row.quantity.symbol.into(),
        };
        let x = if self.runs.iter().all(|r| r.size.is_some()) { "relative size" } else { "run" };
        Panel {
            title,
            x: x.into(),
            y: format!("{} [{}]", row.quantity.symbol, row.quantity.unit),
            series,
            ..Panel::default()
        }
    }
}

/// Order and extrapolated value, or why there is none: two cells.
fn verdict(convergence: &Convergence) -> String {
    match *convergence {
        Convergence::Monotone { value, order, error } => {
            let (value, error) = with_error(value, error);
            format!(" {order:.2} | {value} ± {error} |")
        }
        Convergence::NotMonotone { finest, spread } => {
            format!(" – | not monotone: {}, the three finest within {} |", number(finest), number(spread))
        }
        Convergence::Diverging { finest, spread } => {
            format!(
                " – | differences do not shrink: {}, the three finest within {} |",
                number(finest),
                number(spread)
            )
        }
        Convergence::Constant { value, .. } => format!(" – | {} |", number(value)),
        Convergence::TooFew => " – | three runs or more are needed |".into(),
    }
}

/// Largest difference to the first run, relative: one cell.
fn difference(values: &[f64]) -> String {
    let worst = values.iter().map(|v| (v / values[0] - 1.0).abs()).fold(0.0, f64::max);
    format!(" {:.3} % |", 100.0 * worst)
}

/// Five digits.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if !v.is_finite() => "–".into(),
        v if !(1e-4..1e7).contains(&v) => format!("{value:.3e}"),
        v => format!("{value:.*}", (4 - v.log10().floor() as i32).clamp(0, 7) as usize),
    }
}

/// A value and its error bar, to two digits of the error.
pub fn with_error(value: f64, error: f64) -> (String, String) {
    let decimals = if error > 0.0 { (1 - error.log10().floor() as i32).clamp(0, 9) } else { 3 };
    (format!("{value:.*}", decimals as usize), format!("{error:.*}", decimals as usize))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs whose road_fz is 300 + 10 h^2, road_fx turns back, rim_my is as given.
    fn study(sizes: &[f64]) -> Study {
        let run = |(i, &h): (usize, &f64)| {
            let means = StageMeans {
                stage: "roll".into(),
                mean_road_fz_N: 300.0 + 10.0 * h * h,
                mean_road_fx_N: [100.0, 90.0, 95.0][i % 3],
                mean_road_fy_N: 1e-9,
                mean_rim_my_Nm: 4.0 + h,
                ..StageMeans::default()
            };
            let summary = Summary { stages: vec![means], ..Summary::default() };
            Run { label: format!("1/{}", (1.0 / h).round()), size: Some(h), summary }
        };
        Study {
            name: "wheel".into(),
            title: "A wheel".into(),
            axis: "refine".into(),
            runs: sizes.iter().enumerate().map(run).collect(),
        }
    }

    #[test]
    fn the_table_extrapolates_only_what_is_monotone() {
        let study = study(&[1.0, 0.5, 0.25]);
        let text = study.markdown("wheel.png");
        assert!(text.contains("| Fz [N] | 310.00 | 302.50 | 300.62 | 2.00 | 300.00 ± 0.78 |"), "{text}");
        assert!(text.contains("| Fx [N] | 100.00 | 90.000 | 95.000 | – | not monotone: 95.000"), "{text}");
        assert!(text.contains("| My [N m] | 5.0000 | 4.5000 | 4.2500 | 1.00 | 4.00 ± 0.75 |"), "{text}");
        assert!(!text.contains("Fy"), "round-off is no quantity\n{text}");
        let csv = study.csv();
        assert!(csv.starts_with("scene,quantity,unit,1/1,1/2,1/4,verdict,order,value,error_bar\n"), "{csv}");
        assert!(csv.contains("wheel,road_fx,N,1e2,9e1,9.5e1,not monotone,,9.5e1,1e1\n"), "{csv}");
        assert!(study.picture().is_ok());
    }

    #[test]
    fn two_runs_are_a_table_without_a_limit() {
        assert!(study(&[1.0, 0.5]).markdown("").contains("three runs or more"));
    }

    #[test]
    fn without_sizes_differences_are_given() {
        let mut study = study(&[1.0, 0.5]);
        study.runs.iter_mut().for_each(|r| r.size = None);
        // 302.5 for 310: 2.419 %.
        assert!(
            study.markdown("").contains("| Fz [N] | 310.00 | 302.50 | 2.419 % |"),
            "{}",
            study.markdown("")
        );
    }

    #[test]
    fn numbers_have_the_digits_they_need() {
        assert_eq!([number(315.678), number(-0.2261), number(1e-9)], ["315.68", "-0.22610", "1.000e-9"]);
        assert_eq!(with_error(315.678, 0.034), ("315.678".into(), "0.034".into()));
        assert_eq!(with_error(315.678, 12.0), ("316".into(), "12".into()));
    }
}
