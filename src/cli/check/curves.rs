//! What the law says in tension and where it loses stability, as a table, and as files if asked to.

use std::fmt::{Display, Formatter, Write};
use std::path::Path;

use hexroll::plot::{Mark, Panel, Series, figure};
use hexroll::scene::Law;
use hexroll::study::curves::{Test, compression, tension};
use hexroll::{Error, Result};
use serde::Serialize;

/// Stretches of the table.
const STRETCHES: [f64; 10] = [0.5, 0.75, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0, 4.0, 6.0];

/// A sample's curve.
#[derive(Debug, Serialize)]
pub struct Curve {
    pub test: Test,
    /// Nominal stress at the stretches of the table; none: no free stretch leaves the sides without stress.
    pub nominal_stress_Pa: Vec<Option<f64>>,
    /// Stretches where the law is no longer stable, within 10 and 0.1; none: it stays stable.
    pub unstable_in_tension: Option<f64>,
    pub unstable_in_compression: Option<f64>,
}

/// The curves of a law.
#[derive(Debug, Serialize)]
pub struct Curves {
    pub stretches: [f64; 10],
    pub tests: [Curve; 3],
}

impl Curves {
    pub fn of(law: &Law) -> Curves {
        let tests = Test::ALL.map(|test| Curve {
            test,
            nominal_stress_Pa: STRETCHES.map(|l| test.nominal_stress(law, l)).to_vec(),
            unstable_in_tension: test.lost(law, tension()),
            unstable_in_compression: test.lost(law, compression()),
        });
        Curves { stretches: STRETCHES, tests }
    }

    /// A sentence about stability lost in the range that rubber parts see, 0.5 to 2, which a user should not miss.
    pub fn warnings(&self, name: &str) -> impl Iterator<Item = String> {
        let lost = |curve: &Curve| {
            let ends =
                [("tension", curve.unstable_in_tension), ("compression", curve.unstable_in_compression)];
            let test = curve.test.name();
            let seen = |at: &f64| (0.5..=2.0).contains(at);
            ends.into_iter()
                .filter_map(move |(end, at)| Some(format!("{test} {end} at {:.2}", at.filter(seen)?)))
        };
        let all: Vec<_> = self.tests.iter().flat_map(lost).collect();
        let warning = format!(
            "{name} with these constants is not stable (Drucker) beyond the stretches: {}; expect no sound result there",
            all.join(", ")
        );
        (!all.is_empty()).then_some(warning).into_iter()
    }
}

impl Display for Curves {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        let row = |f: &mut Formatter, name: &str, cells: Vec<String>| {
            write!(f, "  {name:<14}")?;
            cells.iter().try_for_each(|cell| write!(f, " {cell:>8}"))?;
            writeln!(f)
        };
        writeln!(f, "law in tension: nominal stress in MPa, sides free")?;
        row(f, "stretch", self.stretches.iter().map(|l| l.to_string()).collect())?;
        for curve in &self.tests {
            let cell = |p: &Option<f64>| p.map_or("-".into(), |p| format!("{:.4}", 1e-6 * p));
            row(f, curve.test.name(), curve.nominal_stress_Pa.iter().map(cell).collect())?;
        }
        for curve in &self.tests {
            let end = |at: Option<f64>, whole: &str| {
                at.map_or(whole.into(), |at| format!("{at:.2}, where it is lost"))
            };
            writeln!(
                f,
                "  {:<14} {}: from {} to {}",
                "stability",
                curve.test.name(),
                end(curve.unstable_in_compression, "0.1"),
                end(curve.unstable_in_tension, "10"),
            )?;
        }
        Ok(())
    }
}

/// Writes `curves.csv` and `curves.png` to this folder.
///
/// # Errors
/// [`Error::Io`] where a file cannot be written, [`Error::Picture`].
pub fn write(law: &Law, folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(Error::io(folder, "make the folder"))?;
    let stretches: Vec<f64> = (0..=350).map(|i| 0.5 + 0.01 * f64::from(i)).collect();
    let curves =
        Test::ALL.map(|test| stretches.iter().map(|&l| test.nominal_stress(law, l)).collect::<Vec<_>>());
    let file = folder.join("curves.csv");
    std::fs::write(&file, table(&stretches, &curves)).map_err(Error::io(&file, "write"))?;
    let file = folder.join("curves.png");
    let problem = |e: image::ImageError| Error::Picture { problem: format!("{}: {e}", file.display()) };
    picture(law, &stretches, &curves)?.save(&file).map_err(problem)
}

type Stresses = [Vec<Option<f64>>; 3];

fn table(stretches: &[f64], curves: &Stresses) -> String {
    let mut text = String::from("stretch");
    for test in Test::ALL {
        let _ = write!(text, ",{}_Pa", test.name());
    }
    text.push('\n');
    for (i, l) in stretches.iter().enumerate() {
        let _ = write!(text, "{l:.2}");
        for curve in curves {
            let _ = write!(text, ",{}", curve[i].map_or(String::new(), |p| format!("{p:e}")));
        }
        text.push('\n');
    }
    text
}

/// One panel a test: the stable part as a line, what is not stable as a second one.
fn picture(law: &Law, stretches: &[f64], curves: &Stresses) -> Result<image::RgbaImage> {
    let panel = |(test, stresses): (&Test, &Vec<Option<f64>>)| {
        let (from, to) = (test.lost(law, compression()), test.lost(law, tension()));
        let stable = |l: f64| from.is_none_or(|from| l > from) && to.is_none_or(|to| l < to);
        let points = |wanted: bool| {
            let at = stretches.iter().zip(stresses).filter(|(l, _)| stable(**l) == wanted);
            at.filter_map(|(l, p)| Some([*l, 1e-6 * (*p)?])).collect::<Vec<_>>()
        };
        let series =
            |label: &str, points, mark| Series { label: label.into(), points, bars: Vec::new(), mark };
        let mut all = vec![series("stable", points(true), Mark::Line)];
        all.extend(
            Some(points(false)).filter(|p| !p.is_empty()).map(|p| series("not stable", p, Mark::Dots)),
        );
        let (x, y) = ("stretch".into(), "nominal stress (MPa)".into());
        Panel { title: test.name().into(), x, y, log_x: false, series: all }
    };
    let panels: Vec<Panel> = Test::ALL.iter().zip(curves).map(panel).collect();
    figure(&format!("{} in tension, sides free", law.name()), &panels, 3)
}
