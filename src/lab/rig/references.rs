//! Numbers of other programs for the paper's wheel, from `references.toml`.
//!
//! [`reference`]`("slip5-viscous.road_fy")` is a quantity of a run. A name that is not in the file is a mistake in the
//! caller, so it ends the program at once and says what there is.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

const FILE: &str = include_str!("references.toml");

/// How near this program must come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Within {
    /// |got - value| <= t |value|
    Relative(f64),
    /// |got - value| <= t, in the reference's unit.
    Absolute(f64),
}

/// A quantity of a run that somebody else made too.
#[derive(Debug, Clone)]
pub struct Reference {
    /// `run.quantity`
    pub name: String,
    /// In SI units.
    pub value: f64,
    /// As its source writes it, with its unit: `"38.88 mm"`.
    pub text: String,
    /// SI unit, empty for a number.
    pub unit: &'static str,
    pub within: Within,
    /// Why the tolerance is what it is.
    pub reason: String,
    /// Run and elements, in words.
    pub what: String,
    /// Who says so.
    pub source: String,
}

impl Reference {
    /// Whether a value in SI units comes near enough; never for NaN.
    pub fn holds(&self, got: f64) -> bool {
        let off = (got - self.value).abs();
        match self.within {
            Within::Relative(t) => off <= t * self.value.abs(),
            Within::Absolute(t) => off <= t,
        }
    }

    /// Asserts that it does.
    ///
    /// # Panics
    /// If it does not.
    #[track_caller]
    pub fn assert(&self, got: f64) {
        assert!(
            self.holds(got),
            "{} ({}): {got:e}, expected {} within {:?} ({}; source: {})",
            self.name,
            self.what,
            self.text,
            self.within,
            self.reason,
            self.source
        );
    }
}

/// A run of the file.
#[derive(Debug)]
pub struct Run {
    /// Shipped scenes that are this run.
    pub scenes: Vec<String>,
    /// Its tolerance as it is written, for quantities without one of their own.
    pub tolerance: String,
    /// Names of its quantities.
    pub quantities: Vec<String>,
}

/// All of the file.
struct Book {
    runs: BTreeMap<String, Run>,
    references: BTreeMap<String, Reference>,
}

/// The quantity of a run: `"straight-viscous.road_fx"`, or `"straight-viscous.road_fx_bins.0"` of a series.
///
/// # Panics
/// If the file has no such name.
#[track_caller]
pub fn reference(name: &str) -> &'static Reference {
    let all = &BOOK.references;
    all.get(name).unwrap_or_else(|| {
        let run = name.split('.').next().unwrap_or_default();
        let near: Vec<&str> =
            all.keys().map(String::as_str).filter(|n| n.split('.').next() == Some(run)).collect();
        let runs: Vec<&String> = BOOK.runs.keys().collect();
        panic!("references.toml has no {name:?}; of this run it has {near:?}; runs: {runs:?}")
    })
}

/// Every value of a series, in order.
///
/// # Panics
/// If the file has no such series.
#[track_caller]
pub fn series(name: &str) -> Vec<&'static Reference> {
    let found: Vec<_> = (0..).map_while(|k| BOOK.references.get(&format!("{name}.{k}"))).collect();
    assert!(!found.is_empty(), "references.toml has no series {name:?}");
    found
}

/// Every quantity.
pub fn all() -> impl Iterator<Item = &'static Reference> {
    BOOK.references.values()
}

/// Quantities of a run with their names, series left out.
///
/// # Panics
/// If the file has no such run.
#[track_caller]
pub fn quantities(run: &str) -> impl Iterator<Item = (&'static str, &'static Reference)> {
    let found = BOOK.runs.get(run);
    let found = found.unwrap_or_else(|| panic!("references.toml has no run {run:?}: {:?}", BOOK.runs.keys()));
    let names = found.quantities.iter().filter(|q| !q.contains('.'));
    names.map(move |q| (q.as_str(), reference(&format!("{run}.{q}"))))
}

/// Every run, by name.
pub fn runs() -> impl Iterator<Item = (&'static str, &'static Run)> {
    BOOK.runs.iter().map(|(name, run)| (name.as_str(), run))
}

/// A node of the pressed wheel in another program: where it was and the road's force on it.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// Undeformed position relative to the axle [m].
    pub position: [f64; 3],
    /// [N]
    pub force: [f64; 3],
}

/// Contact forces node by node of an independent implicit solver: [`pressed-q1p0`](reference), at 300 N. Its source
/// stands beside the file.
///
/// # Panics
/// If the built-in file is damaged.
pub fn pressed_nodes() -> Vec<Node> {
    let mut reader = csv::Reader::from_reader(include_str!("wheel_static/880_q1p0_mu1_300N.csv").as_bytes());
    let rows = reader.deserialize::<(u32, [f64; 3], [f64; 3], [f64; 3])>();
    // The file is in mm.
    rows.map(|row| row.expect("a row of numbers"))
        .map(|(_, place, _, force)| Node { position: place.map(|c| 1e-3 * c), force })
        .collect()
}

static BOOK: LazyLock<Book> = LazyLock::new(|| read(FILE).unwrap_or_else(|e| panic!("references.toml: {e}")));

/// The file as it is written.
#[derive(Deserialize)]
struct Written {
    sources: BTreeMap<String, String>,
    #[serde(flatten)]
    runs: BTreeMap<String, WrittenRun>,
}

#[derive(Deserialize)]
struct WrittenRun {
    what: String,
    source: String,
    scenes: Vec<String>,
    tolerance: String,
    reason: String,
    #[serde(flatten)]
    quantities: BTreeMap<String, Quantity>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Quantity {
    Plain(String),
    Own { value: String, tolerance: String, reason: String },
    Series { values: Vec<String>, tolerance: String, reason: String },
}

fn read(text: &str) -> Result<Book, String> {
    let written: Written = toml::from_str(text).map_err(|e| e.to_string())?;
    let mut book = Book { runs: BTreeMap::new(), references: BTreeMap::new() };
    for (name, run) in written.runs {
        let source = written.sources.get(&run.source);
        let source = source.ok_or_else(|| format!("{name}: there is no source {:?}", run.source))?;
        let mut quantities = Vec::new();
        for (quantity, said) in &run.quantities {
            let (values, tolerance, reason) = match said {
                Quantity::Plain(value) => (vec![(quantity.clone(), value)], &run.tolerance, &run.reason),
                Quantity::Own { value, tolerance, reason } => {
                    (vec![(quantity.clone(), value)], tolerance, reason)
                }
                Quantity::Series { values, tolerance, reason } => {
                    let entries = values.iter().enumerate().map(|(k, v)| (format!("{quantity}.{k}"), v));
                    (entries.collect(), tolerance, reason)
                }
            };
            for (quantity, text) in values {
                let (value, unit) = quantity_of(text).map_err(|e| format!("{name}.{quantity}: {e}"))?;
                let reference = Reference {
                    name: format!("{name}.{quantity}"),
                    value,
                    text: text.clone(),
                    unit,
                    within: within(tolerance, unit).map_err(|e| format!("{name}.{quantity}: {e}"))?,
                    reason: reason.clone(),
                    what: run.what.clone(),
                    source: source.clone(),
                };
                book.references.insert(reference.name.clone(), reference);
                quantities.push(quantity);
            }
        }
        book.runs.insert(name, Run { scenes: run.scenes, tolerance: run.tolerance, quantities });
    }
    Ok(book)
}

/// Units of the file: as they are written, in SI, and the factor.
const UNITS: [(&str, &str, f64); 6] = [
    ("", "", 1.0),
    ("N", "N", 1.0),
    ("N m", "N m", 1.0),
    ("rad/s", "rad/s", 1.0),
    ("s", "s", 1.0),
    ("mm", "m", 1e-3),
];

/// Value in SI units and its unit.
fn quantity_of(text: &str) -> Result<(f64, &'static str), String> {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let number: f64 = number.parse().map_err(|_| format!("{text:?} does not begin with a number"))?;
    let known = UNITS.iter().find(|u| u.0 == unit);
    let (_, si, factor) = known.ok_or_else(|| format!("{text:?}: no unit {unit:?} is known"))?;
    Ok((number * factor, si))
}

fn within(text: &str, unit: &str) -> Result<Within, String> {
    if let Some(percent) = text.strip_suffix(" %") {
        let percent: f64 = percent.parse().map_err(|_| format!("{text:?} is no percentage"))?;
        return Ok(Within::Relative(percent / 100.0));
    }
    match quantity_of(text)? {
        (value, own) if own == unit => Ok(Within::Absolute(value)),
        (_, own) => Err(format!("a tolerance in {own:?} of a value in {unit:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_has_value_unit_source_tolerance_and_reason() {
        let radius = reference("free.free_rolling_radius");
        assert_eq!((radius.value, radius.unit), (38.88 * 1e-3, "m"));
        assert!(radius.holds(radius.value + 2.9e-5) && !radius.holds(radius.value + 3.1e-5));
        assert!(!radius.holds(f64::NAN));
        for reference in all() {
            assert!(!reference.reason.is_empty() && !reference.source.is_empty(), "{reference:?}");
        }
        assert_eq!(series("straight-viscous.road_fx_bins").len(), 10);
    }

    #[test]
    #[should_panic(expected = "references.toml has no \"free.mass\"")]
    fn an_unknown_name_ends_the_program() {
        reference("free.mass");
    }

    #[test]
    fn mistakes_in_the_file_are_named() {
        let run = |text: &str| {
            let head =
                "[sources]\na = \"b\"\n[run]\nwhat = \"\"\nscenes = []\nreason = \"\"\ntolerance = \"1 %\"\n";
            read(&format!("{head}{text}")).err().expect("a mistake")
        };
        assert!(run("source = \"a\"\nfx = \"3 stone\"").contains("run.fx: \"3 stone\""));
        assert!(run("source = \"a\"\nfx = \"N\"").contains("does not begin with a number"));
        assert!(run("source = \"c\"").contains("there is no source \"c\""));
        let own = "source = \"a\"\nfx = { value = \"3 N\", tolerance = \"1 mm\", reason = \"\" }";
        assert!(run(own).contains("a tolerance in"));
    }
}
