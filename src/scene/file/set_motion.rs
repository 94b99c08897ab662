//! `[[motion]]`: components of a node set that follow ramps, tables and sines.

use std::path::Path as FilePath;

use crate::error::{Error, Result};
use crate::scene::reader::{Bound, Item, Table};
use crate::scene::units::{ANGLE, Dimension, FREQUENCY, LENGTH, TIME};
use crate::scene::{NodeSet, Path, SetMotion, Turn};

/// A quantity that moves, and the unit of its column in a table.
struct Kind {
    key: &'static str,
    dimension: &'static Dimension,
    unit: &'static str,
}

const DISPLACEMENT: Kind = Kind { key: "displacement", dimension: &LENGTH, unit: "m" };
const ROTATION: Kind = Kind { key: "angle", dimension: &ANGLE, unit: "rad" };

/// Every `[[motion]]`.
pub(super) fn motions(item: &Item) -> Result<Vec<SetMotion>> {
    item.entries()?.iter().map(motion).collect()
}

fn motion(item: &Item) -> Result<SetMotion> {
    let table = item.table()?;
    table.only(&["nodes", "x", "y", "z", "turn"], &[])?;
    let nodes = NodeSet::read(&table.need("nodes", "\"z-max\"")?)?;
    let mut components = [None, None, None];
    for (component, name) in components.iter_mut().zip(["x", "y", "z"]) {
        *component = table.get(name).map(|item| path(&item, name, &DISPLACEMENT, &[])).transpose()?;
    }
    let turn = table.get("turn").map(|item| turn(&item)).transpose()?;
    if turn.is_none() && components.iter().all(Option::is_none) {
        let remedy =
            "add e.g. z = { displacement = \"1 mm\", ramp = \"10 ms\" }; what stays at rest is a [[hold]]";
        return Err(item.error("no component moves", remedy));
    }
    Ok(SetMotion { nodes, components, turn })
}

fn turn(item: &Item) -> Result<Turn> {
    let table = item.table()?;
    let axis = table.need("axis", "[0, 1, 0]")?;
    let vector = axis.three("[0, 1, 0]", |entry| entry.number(Bound::Any))?;
    let length = vector.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length == 0.0 {
        return Err(
            axis.error("an axis without a direction", "write a vector that is not zero, e.g. [0, 1, 0]")
        );
    }
    Ok(Turn {
        axis: vector.map(|c| c / length),
        about: table.vector_or_zero("about", &LENGTH)?,
        angle: path(item, "angle", &ROTATION, &["axis", "about"])?,
    })
}

/// A path, of one of three kinds; `name`: its column in a table; `beside`: keys that are read elsewhere.
fn path(item: &Item, name: &str, kind: &Kind, beside: &[&str]) -> Result<Path> {
    let table = item.table()?;
    let kinds = [kind.key, "amplitude", "table"];
    let given: Vec<_> = kinds.into_iter().filter(|key| table.get(key).is_some()).collect();
    let only = |keys: &[&str]| table.only(&[keys, beside].concat(), &[]);
    match given[..] {
        [key] if key == kind.key => {
            only(&[key, "ramp", "start"])?;
            Ok(Path::Ramp {
                to: table.quantity(key, kind.dimension, Bound::Any)?,
                ramp: table.quantity("ramp", &TIME, Bound::Positive)?,
                start: start(&table)?,
            })
        }
        ["amplitude"] => {
            only(&["amplitude", "frequency", "ramp", "start"])?;
            Ok(Path::Sine {
                amplitude: table.quantity("amplitude", kind.dimension, Bound::Any)?,
                frequency: table.quantity("frequency", &FREQUENCY, Bound::Positive)?,
                ramp: table.quantity_or("ramp", 0.0, &TIME, Bound::NotNegative)?,
                start: start(&table)?,
            })
        }
        ["table"] => {
            only(&["table"])?;
            let source = table.at("table");
            let rows =
                if source.text().is_ok() { read(&source, name, kind)? } else { inline(&source, kind)? };
            ascending(&source, rows)
        }
        _ => Err(item.error(
            if given.is_empty() {
                "no motion".into()
            } else {
                format!("{} exclude each other", given.join(" and "))
            },
            format!("write exactly one of {}; a component that is left out is free", kinds.join(", ")),
        )),
    }
}

fn start(table: &Table) -> Result<f64> {
    table.quantity_or("start", 0.0, &TIME, Bound::NotNegative)
}

/// Pairs of a time and a value in the scene.
fn inline(item: &Item, kind: &Kind) -> Result<Vec<[f64; 2]>> {
    let row = |entry: &Item| {
        let cells = entry.entries()?;
        let [time, value] = &cells[..] else {
            let example = format!("[\"1 ms\", \"{}\"]", kind.dimension.example);
            return Err(entry.error("not a pair of a time and a value", format!("write e.g. {example}")));
        };
        Ok([time.quantity(&TIME, Bound::NotNegative)?, value.quantity(kind.dimension, Bound::Any)?])
    };
    item.entries()?.iter().map(row).collect()
}

/// A CSV file beside the scene, with a header: its columns `time_s` and `<name>_<unit>`.
fn read(item: &Item, name: &str, kind: &Kind) -> Result<Vec<[f64; 2]>> {
    let folder = FilePath::new(item.file).parent().unwrap_or(FilePath::new(""));
    let file = folder.join(item.text()?);
    let text = std::fs::read_to_string(&file).map_err(Error::io(&file, "read this table"))?;
    let mut csv =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let bad = |problem: String| Error::Format { path: file.clone(), problem };
    let header = csv.headers().map_err(|e| bad(e.to_string()))?.clone();
    let column = |wanted: String| {
        let at = header.iter().position(|column| column == wanted);
        at.ok_or_else(|| {
            let known: Vec<_> = header.iter().collect();
            bad(format!("no column {wanted}; the first line has {}", known.join(", ")))
        })
    };
    let columns = [column("time_s".into())?, column(format!("{name}_{}", kind.unit))?];
    let row = |record: csv::Result<csv::StringRecord>| {
        let record = record.map_err(|e| bad(e.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |column: usize| {
            let text = record.get(column).unwrap_or("");
            let value: Option<f64> = text.parse().ok().filter(|v: &f64| v.is_finite());
            value.ok_or_else(|| bad(format!("line {line}: {text:?} is not a finite number")))
        };
        Ok([cell(columns[0])?, cell(columns[1])?])
    };
    csv.records().map(row).collect()
}

fn ascending(item: &Item, rows: Vec<[f64; 2]>) -> Result<Path> {
    if rows.is_empty() {
        return Err(item.error("a table without rows", "write at least two rows of a time and a value"));
    }
    if let Some(at) = rows.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
        let problem = format!("row {} of the table is not later than row {}", at + 2, at + 1);
        return Err(item.error(problem, "write rows in the order of their times, each time once"));
    }
    if rows[0][1] != 0.0 && rows[0][0] <= 0.0 {
        let problem = format!("the table begins at {} where the nodes are at 0", rows[0][1]);
        return Err(item.error(problem, "begin with the value 0 at the time 0: nothing can be moved at once"));
    }
    Ok(Path::Table(rows))
}
