//! Heights from text: lines of numbers, with ESRI's header or without.

use super::{Fault, Map, checked};

/// A grid without a header (`.csv`): a line for each v, the largest first, numbers along u between commas, semicolons or blanks; an empty
/// field or `nan` is missing. `unit`: what a height of 1 is [m].
///
/// # Errors
/// What is no number, and lines of different lengths.
pub fn csv(text: &str, pixel: f64, unit: f64) -> Result<Map, Fault> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let rows = lines.map(|(n, line)| row(n + 1, line, |_| false)).collect::<Result<Vec<_>, _>>()?;
    map(rows, pixel, unit)
}

/// ESRI's ASCII grid (`.asc`): `ncols`, `nrows`, `cellsize`, and if need be `xllcorner` or `xllcenter` with their likes in y, and
/// `NODATA_value`; then a line for each y, the largest first. `unit`: what a length of 1 in it is [m].
///
/// # Errors
/// A header that lacks something, other counts than it says, what is no number.
pub fn esri(text: &str, unit: f64) -> Result<Map, Fault> {
    let mut header = std::collections::BTreeMap::new();
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).peekable();
    while let Some((n, line)) = lines.next_if(|(_, line)| line.trim_start().starts_with(char::is_alphabetic))
    {
        let mut words = line.split_whitespace();
        let (name, value) = (words.next().unwrap_or_default().to_lowercase(), words.next());
        if name == "nan" {
            return Err(Fault::at(n + 1, "numbers before the header", "begin with ncols"));
        }
        const KNOWN: [&str; 8] = [
            "ncols",
            "nrows",
            "cellsize",
            "xllcorner",
            "yllcorner",
            "xllcenter",
            "yllcenter",
            "nodata_value",
        ];
        let value = value.and_then(|v| v.parse::<f64>().ok());
        let Some(value) = value.filter(|_| KNOWN.contains(&name.as_str())) else {
            let remedy =
                format!("a header of an ESRI ASCII grid has {}, each with a number", KNOWN.join(", "));
            return Err(Fault::at(n + 1, format!("{:?} is no line of a header", line.trim()), remedy));
        };
        header.insert(name, value);
    }
    let need = |name: &str| {
        let value = header.get(name).copied().filter(|v| *v > 0.0);
        value.ok_or_else(|| {
            Fault::of_file(format!("no {name} above zero in the header"), format!("add {name}"))
        })
    };
    let (columns, rows, cell) = (need("ncols")?, need("nrows")?, need("cellsize")?);
    let missing = header.get("nodata_value").copied().unwrap_or(-9999.0);
    let read = lines.map(|(n, line)| row(n + 1, line, |v| v == missing)).collect::<Result<Vec<_>, _>>()?;
    // Some programs break lines where they like.
    let all: Vec<f64> = read.into_iter().flatten().collect();
    if all.len() as f64 != columns * rows {
        let problem = format!("{} heights where ncols {columns} times nrows {rows} are said", all.len());
        return Err(Fault::of_file(problem, "correct the header, or the file"));
    }
    map(all.chunks(columns as usize).map(<[f64]>::to_vec).collect(), cell * unit, unit)
}

fn row(number: usize, line: &str, missing: impl Fn(f64) -> bool) -> Result<Vec<f64>, Fault> {
    let line = line.trim();
    let fields: Vec<&str> = match line.contains([',', ';']) {
        true => line.split([',', ';']).map(str::trim).collect(),
        false => line.split_whitespace().collect(),
    };
    let value = |field: &&str| {
        if field.is_empty() || field.eq_ignore_ascii_case("nan") {
            return Ok(f64::NAN);
        }
        let value = field.parse::<f64>().map_err(|_| {
            Fault::at(number, format!("{field:?} is no number"), "write numbers, with a point for decimals")
        })?;
        Ok(if missing(value) { f64::NAN } else { value })
    };
    fields.iter().map(value).collect()
}

/// The map of lines seen from above.
fn map(lines: Vec<Vec<f64>>, pixel: f64, unit: f64) -> Result<Map, Fault> {
    let columns = lines.first().map_or(0, Vec::len);
    if let Some(k) = lines.iter().position(|line| line.len() != columns) {
        let problem = format!("row {} has {} numbers, the first has {columns}", k + 1, lines[k].len());
        return Err(Fault::of_file(
            problem,
            "give as many in every row; leave the field of a missing one empty",
        ));
    }
    let size = [columns, lines.len()];
    let heights = lines.iter().rev().flatten().map(|h| h * unit).collect();
    checked(Map { size, spacing: [pixel; 2], origin: [0.0; 2], heights, border: None })
}
