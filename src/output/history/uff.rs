//! Universal files: nodes (dataset 2411), faces (2412) and functions of time (58b, binary), as the University of Cincinnati
//! documents them (SDRL, *Universal File Formats for Modal Analysis Testing*).

use std::io::{Result, Write};

use crate::record::{History, Values};

/// A thin shell of four nodes.
const QUAD: usize = 94;

/// Writes a history. Labels of nodes are those of its places, from 1.
///
/// # Errors
/// Those of writing.
pub fn write(out: &mut dyn Write, history: &History) -> Result<()> {
    nodes(out, history)?;
    if !history.faces.is_empty() {
        faces(out, history)?;
    }
    let period = 1.0 / history.rate;
    for stretch in stretches(&history.times, period) {
        for quantity in &history.values {
            for place in 0..history.nodes.len() {
                for component in 0..quantity.components {
                    let width = history.nodes.len() * quantity.components;
                    let at = place * quantity.components + component;
                    let values = stretch.clone().map(|t| quantity.values[t * width + at]);
                    let label = Label { quantity, place, component };
                    function(out, history, &label, history.times[stretch.start], values)?;
                }
            }
        }
    }
    Ok(())
}

/// Runs of times without a gap.
fn stretches(times: &[f64], period: f64) -> Vec<std::ops::Range<usize>> {
    let mut start = 0;
    let runs = times.chunk_by(|a, b| b - a < 1.5 * period);
    runs.map(|run| {
        start += run.len();
        start - run.len()..start
    })
    .collect()
}

fn nodes(out: &mut dyn Write, history: &History) -> Result<()> {
    writeln!(out, "{:6}\n{:6}", -1, 2411)?;
    for (k, [x, y, z]) in history.positions.iter().enumerate() {
        writeln!(out, "{:10}{:10}{:10}{:10}", k + 1, 1, 1, 11)?;
        writeln!(out, "{}{}{}", exponent(*x, 25, 16), exponent(*y, 25, 16), exponent(*z, 25, 16))?;
    }
    writeln!(out, "{:6}", -1)
}

fn faces(out: &mut dyn Write, history: &History) -> Result<()> {
    writeln!(out, "{:6}\n{:6}", -1, 2412)?;
    for (k, face) in history.faces.iter().enumerate() {
        writeln!(out, "{:10}{QUAD:10}{:10}{:10}{:10}{:10}", k + 1, 1, 1, 7, 4)?;
        face.iter().try_for_each(|n| write!(out, "{:10}", n + 1))?;
        writeln!(out)?;
    }
    writeln!(out, "{:6}", -1)
}

/// What a function is of.
struct Label<'a> {
    quantity: &'a Values,
    place: usize,
    component: usize,
}

impl Label<'_> {
    /// The format's numbers of quantities.
    fn kind(&self) -> (usize, &'static str) {
        match self.quantity.name {
            "velocity" => (11, "Velocity"),
            "acceleration" => (12, "Acceleration"),
            "contact-force" => (9, "Contact force"),
            "pressure" => (15, "Pressure"),
            _ => (8, "Displacement"),
        }
    }
}

/// One dataset 58b. In one piece: the eleven records of its head stand in their order.
fn function(
    out: &mut dyn Write,
    history: &History,
    label: &Label,
    start: f64,
    values: impl ExactSizeIterator<Item = f32>,
) -> Result<()> {
    let count = values.len();
    let (kind, name) = label.kind();
    // Of a scalar no direction, else +x, +y, +z.
    let direction = if label.quantity.components == 1 { 0 } else { label.component + 1 };
    writeln!(out, "{:6}", -1)?;
    // Little-endian, IEEE 754, eleven records, then so many bytes.
    writeln!(out, "{:6}b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}", 58, 1, 2, 11, 4 * count, 0, 0, 0, 0)?;
    writeln!(out, "{:<80}", format!("hexroll {} {}", history.name, label.quantity.name))?;
    writeln!(out, "{:<80}", format!("node {} of the mesh", history.nodes[label.place]))?;
    (0..3).try_for_each(|_| writeln!(out, "{:<80}", "NONE"))?;
    // A response in time.
    let response = format!("{:<10}{:10}{direction:4}", "NONE", label.place + 1);
    writeln!(out, "{:5}{:10}{:5}{:10} {response} {:<10}{:10}{:4}", 1, 0, 0, 0, "NONE", 0, 0)?;
    // Real, single precision, even abscissa.
    let [first, step, zero] = [start, 1.0 / history.rate, 0.0].map(|v| exponent(v, 13, 5));
    writeln!(out, "{:10}{count:10}{:10}{first}{step}{zero}", 2, 1)?;
    axis(out, 17, "Time", "s")?;
    axis(out, kind, name, label.quantity.unit)?;
    axis(out, 0, "NONE", "NONE")?;
    axis(out, 0, "NONE", "NONE")?;
    for value in values {
        out.write_all(&value.to_le_bytes())?;
    }
    writeln!(out, "\n{:6}", -1)
}

fn axis(out: &mut dyn Write, kind: usize, name: &str, unit: &str) -> Result<()> {
    writeln!(out, "{kind:10}{:5}{:5}{:5} {name:<20} {unit:<20}", 0, 0, 0)
}

/// A number as FORTRAN writes it: `1.00000E+00`.
fn exponent(value: f64, width: usize, digits: usize) -> String {
    let text = format!("{value:.digits$E}");
    let (number, power) = text.split_once('E').expect("it has a power");
    let power: i32 = power.parse().expect("it is a whole number");
    let sign = if power < 0 { '-' } else { '+' };
    format!("{:>width$}", format!("{number}E{sign}{:02}", power.abs()))
}
