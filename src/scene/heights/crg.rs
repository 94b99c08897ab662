//! OpenCRG: a curved regular grid (ASAM OpenCRG 1.2). Read here: heights over a straight reference line.
//!
//! Header sections of text begin with `$NAME` and end with `$`; a line `$$$$` ends the header. Data are records of 80 bytes: text of 10
//! (`LRFI`) or 20 (`LDFI`) characters a number, a row beginning on a line of its own; or big-endian numbers of 4 (`KRBI`, the default) or 8
//! bytes (`KDBI`), row after row.

mod header;

use header::{Channel, Format, Header};

use super::{Fault, Map, checked};
use crate::physics::road::Border;

const STRAIGHTEN: &str = "straighten the road first: heights over a straight reference line are read";

/// # Errors
/// A header that is not one, what it asks for that is not read here, and data that do not fit to it.
pub fn read(bytes: &[u8]) -> Result<Map, Fault> {
    let end = data_start(bytes)?;
    // ISO 8859-1: every byte is a character.
    let text: String = bytes[..end].iter().map(|b| char::from(*b)).collect();
    let header = header::read(&text)?;
    let format = header.format.unwrap_or(Format::Single);
    let rows = match format {
        Format::Text { width } => {
            text_rows(&bytes[end..], width, header.channels.len(), text.lines().count())?
        }
        Format::Single => {
            binary(&bytes[end..], 4, header.channels.len(), |b| f32::from_be_bytes(four(b)).into())?
        }
        Format::Double => binary(&bytes[end..], 8, header.channels.len(), |b| f64::from_be_bytes(eight(b)))?,
    };
    straight(&header, &rows)?;
    checked(map(&header, &rows)?)
}

fn four(bytes: &[u8]) -> [u8; 4] {
    bytes.try_into().expect("four bytes")
}

fn eight(bytes: &[u8]) -> [u8; 8] {
    bytes.try_into().expect("eight bytes")
}

/// The byte after the line that begins with `$$$$`.
fn data_start(bytes: &[u8]) -> Result<usize, Fault> {
    let mut at = 0;
    while at < bytes.len() {
        let end = bytes[at..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |n| at + n + 1);
        if bytes[at..end].starts_with(b"$$$$") {
            return Ok(end);
        }
        at = end;
    }
    Err(Fault::of_file("no line $$$$ ends the header", "give an OpenCRG file"))
}

/// Rows of text: each begins on a line of its own, 80 characters a record.
fn text_rows(bytes: &[u8], width: usize, count: usize, before: usize) -> Result<Vec<Vec<f64>>, Fault> {
    let a_record = 80 / width;
    let records = count.div_ceil(a_record);
    let text: String = bytes.iter().map(|b| char::from(*b)).collect();
    let lines: Vec<(usize, &str)> =
        text.lines().enumerate().map(|(n, line)| (before + n + 1, line.trim_end())).collect();
    let last = lines.iter().rposition(|(_, line)| !line.is_empty()).map_or(0, |n| n + 1);
    if last % records != 0 {
        let problem = format!("{last} lines of data, of which a row of {count} numbers takes {records}");
        return Err(Fault::of_file(problem, "complete the last row"));
    }
    let row = |lines: &[(usize, &str)]| {
        let mut numbers = Vec::with_capacity(count);
        for (k, (number, line)) in lines.iter().enumerate() {
            let here = (count - k * a_record).min(a_record);
            for f in 0..here {
                let field = line.get(f * width..line.len().min((f + 1) * width)).unwrap_or_default().trim();
                numbers.push(number_of(*number, field)?);
            }
            if line.len() > here * width {
                let problem = format!("more than {here} numbers of {width} characters");
                return Err(Fault::at(*number, problem, "write as many as $KD_DEFINITION has"));
            }
        }
        Ok(numbers)
    };
    lines[..last].chunks(records).map(row).collect()
}

fn number_of(line: usize, field: &str) -> Result<f64, Fault> {
    if field.starts_with('*') || field.eq_ignore_ascii_case("nan") {
        return Ok(f64::NAN);
    }
    let remedy = "write a number of the format's width, or *missing*";
    field.parse().map_err(|_| Fault::at(line, format!("{field:?} is no number"), remedy))
}

/// Rows of numbers of `size` bytes; what fills the last record of 80 bytes is left out.
fn binary(
    bytes: &[u8],
    size: usize,
    count: usize,
    number: impl Fn(&[u8]) -> f64,
) -> Result<Vec<Vec<f64>>, Fault> {
    let numbers: Vec<f64> = bytes.chunks_exact(size).map(number).collect();
    let (rows, left) = (numbers.len() / count, numbers.len() % count);
    // A record that is not full is filled with NaN: one of 80 bytes at most.
    let filled = left * size < 80 && numbers[rows * count..].iter().all(|v| v.is_nan());
    // Rows of NaN alone may be filling too, where a row is shorter than a record.
    if !filled || !bytes.len().is_multiple_of(size) {
        let problem = format!(
            "{} bytes of data, of which a row of {count} numbers takes {}",
            bytes.len(),
            size * count
        );
        return Err(Fault::of_file(problem, "complete the last row"));
    }
    let mut all: Vec<Vec<f64>> = numbers.chunks_exact(count).map(<[f64]>::to_vec).collect();
    let row_bytes = count * size;
    let whole = |n: usize| (n * row_bytes).div_ceil(80) * 80;
    while all.len() > 1
        && all.last().is_some_and(|row| row.iter().all(|v| v.is_nan()))
        && whole(all.len() - 1) == bytes.len()
    {
        all.pop();
    }
    Ok(all)
}

/// The reference line must be straight and level.
fn straight(header: &Header, rows: &[Vec<f64>]) -> Result<(), Fault> {
    const LEVEL: [&str; 7] = [
        "REFERENCE_LINE_START_S",
        "REFERENCE_LINE_END_S",
        "REFERENCE_LINE_START_B",
        "REFERENCE_LINE_END_B",
        "BORDER_OFFSET_U",
        "BORDER_OFFSET_V",
        "REFERENCE_LINE_OFFSET_Z",
    ];
    for (name, value, line) in &header.values {
        if LEVEL.contains(&name.as_str()) && *value != 0.0 {
            return Err(Fault::at(
                *line,
                format!("{name} = {value}: slope, banking and offsets are not read"),
                STRAIGHTEN,
            ));
        }
    }
    let [start, end] = ["REFERENCE_LINE_START_PHI", "REFERENCE_LINE_END_PHI"].map(|name| header.get(name));
    if let (Some(start), Some(end)) = (start, end)
        && (start - end).abs() > 1e-9
    {
        let problem = format!("a curved reference line: its heading goes from {start} to {end} rad");
        return Err(Fault::of_file(problem, STRAIGHTEN));
    }
    let [low, high] = ["REFERENCE_LINE_START_Z", "REFERENCE_LINE_END_Z"].map(|name| header.get(name));
    if let (Some(low), Some(high)) = (low, high)
        && (low - high).abs() > 1e-9
    {
        let problem = format!("a reference line that climbs from {low} m to {high} m");
        return Err(Fault::of_file(problem, STRAIGHTEN));
    }
    for (k, channel) in header.channels.iter().enumerate() {
        let column = || rows.iter().map(|row| row[k]).filter(|v| !v.is_nan());
        match channel {
            Channel::Heading => {
                let first = column().next().unwrap_or(0.0);
                if let Some(other) = column().find(|v| (v - first).abs() > 1e-6) {
                    let problem = format!("a curved reference line: its heading is {first} and {other} rad");
                    return Err(Fault::of_file(problem, STRAIGHTEN));
                }
            }
            Channel::Tilt => {
                if let Some(other) = column().find(|v| *v != 0.0) {
                    let problem = format!("a reference line that slopes or banks, by {other}");
                    return Err(Fault::of_file(problem, STRAIGHTEN));
                }
            }
            Channel::Section(_) => {}
        }
    }
    Ok(())
}

/// Increment along u, from wherever the header says it.
fn increment(header: &Header, rows: usize) -> Result<f64, Fault> {
    let [start, end] = ["REFERENCE_LINE_START_U", "REFERENCE_LINE_END_U"].map(|name| header.get(name));
    let said = header.get("REFERENCE_LINE_INCREMENT").or(header.virtual_u.map(|u| u[1]));
    let from_ends = match (start, end) {
        (Some(start), Some(end)) if end != start && rows > 1 => Some((end - start) / (rows - 1) as f64),
        _ => None,
    };
    let step = said.or(from_ends).filter(|step| *step > 0.0);
    let step = step.ok_or_else(|| {
        Fault::of_file("no increment along the reference line", "add REFERENCE_LINE_INCREMENT to $ROAD_CRG")
    })?;
    match from_ends {
        Some(other) if (other / step - 1.0).abs() > 1e-4 => Err(Fault::of_file(
            format!("{rows} rows {step} m apart do not reach from REFERENCE_LINE_START_U to END_U"),
            "correct the header, or complete the data",
        )),
        _ => Ok(step),
    }
}

/// v of the first long section, and their increment.
fn across(header: &Header) -> Result<[f64; 2], Fault> {
    let sections: Vec<Option<f64>> = header
        .channels
        .iter()
        .filter_map(|c| match c {
            Channel::Section(at) => Some(*at),
            _ => None,
        })
        .collect();
    let gaps = (sections.len() - 1).max(1) as f64;
    let places: Vec<f64> = sections.iter().flatten().copied().collect();
    if places.len() == sections.len() && places.len() > 1 {
        let step = (places[places.len() - 1] - places[0]) / gaps;
        let even = places.windows(2).all(|p| ((p[1] - p[0]) / step - 1.0).abs() < 1e-4);
        return match even && step > 0.0 {
            true => Ok([places[0], step]),
            false => Err(Fault::of_file(
                "long sections at uneven distances",
                "give them at equal steps of v, from right to left",
            )),
        };
    }
    let [right, left, step] = ["LONG_SECTION_V_RIGHT", "LONG_SECTION_V_LEFT", "LONG_SECTION_V_INCREMENT"]
        .map(|name| header.get(name));
    let step = step.or(right.zip(left).map(|(right, left)| (left - right) / gaps)).filter(|step| *step > 0.0);
    let step = step.ok_or_else(|| {
        Fault::of_file("no increment across the reference line", "add LONG_SECTION_V_INCREMENT to $ROAD_CRG")
    })?;
    let start = right.or(left.map(|left| left - gaps * step)).unwrap_or(-0.5 * gaps * step);
    match left {
        Some(left) if (start + gaps * step - left).abs() > 1e-4 * step => Err(Fault::of_file(
            format!(
                "{} long sections {step} m apart do not reach from {start} m to {left} m",
                sections.len()
            ),
            "correct the header, or complete the data",
        )),
        _ => Ok([start, step]),
    }
}

fn border(header: &Header) -> Result<Border, Fault> {
    // The default of the format: the last height is kept.
    let [u, v] = ["BORDER_MODE_U", "BORDER_MODE_V"].map(|name| header.get(name).unwrap_or(2.0));
    match (u, v) {
        (0.0, 0.0) => Ok(Border::Nothing),
        (2.0, 2.0) => Ok(Border::Keep),
        (3.0, 3.0) => Ok(Border::Periodic),
        _ => Err(Fault::of_file(
            format!("border modes {u} along and {v} across"),
            "use 0 (nothing), 2 (the last height) or 3 (again) for both, or write border in [road]",
        )),
    }
}

fn map(header: &Header, rows: &[Vec<f64>]) -> Result<Map, Fault> {
    let along = increment(header, rows.len())?;
    let [right, across] = across(header)?;
    let sections: Vec<usize> =
        (0..header.channels.len()).filter(|k| matches!(header.channels[*k], Channel::Section(_))).collect();
    let lift = header.get("REFERENCE_LINE_START_Z").unwrap_or(0.0);
    let heights = sections.iter().flat_map(|&k| rows.iter().map(move |row| row[k] + lift)).collect();
    Ok(Map {
        size: [rows.len(), sections.len()],
        spacing: [along, across],
        origin: [0.0, right],
        heights,
        border: Some(border(header)?),
    })
}
