//! The header of an OpenCRG file: sections of text that begin with `$NAME` and end with `$`.

use super::super::Fault;

/// Formats of the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Text { width: usize },
    Single,
    Double,
}

const FORMATS: [(&str, Format); 4] = [
    ("LRFI", Format::Text { width: 10 }),
    ("LDFI", Format::Text { width: 20 }),
    ("KRBI", Format::Single),
    ("KDBI", Format::Double),
];

/// A column of the data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Channel {
    /// The reference line's heading: constant where the line is straight.
    Heading,
    /// Its slope and banking: zero here.
    Tilt,
    /// Heights at one v, where the file says which.
    Section(Option<f64>),
}

/// What a header says.
#[derive(Debug, Default)]
pub struct Header {
    /// Values of `$ROAD_CRG` and `$ROAD_CRG_OPTS` by their names in capitals, with their lines.
    pub values: Vec<(String, f64, usize)>,
    pub format: Option<Format>,
    pub channels: Vec<Channel>,
    /// First u and increment of a line `U:`.
    pub virtual_u: Option<[f64; 2]>,
}

impl Header {
    pub fn get(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|v| v.0 == name).map(|v| v.1)
    }
}

/// # Errors
/// What is no header, and what it asks for that is not read here.
pub fn read(text: &str) -> Result<Header, Fault> {
    let mut header = Header::default();
    let mut section = None;
    for (n, line) in text.lines().enumerate() {
        let (number, line) = (n + 1, line.trim_end());
        if line.starts_with("$$$$") {
            break;
        }
        // A line that begins with a star is a comment, and what follows an exclamation mark is one.
        let content = line.split('!').next().unwrap_or_default().trim();
        if line.starts_with('*') || content.is_empty() {
            continue;
        }
        if let Some(name) = content.strip_prefix('$') {
            section = (!name.is_empty()).then(|| name.to_uppercase());
            continue;
        }
        match section.as_deref() {
            None => {
                return Err(Fault::at(
                    number,
                    format!("{content:?} stands outside of a section"),
                    "begin one: $CT",
                ));
            }
            Some("CT") => {}
            Some("ROAD_CRG" | "ROAD_CRG_OPTS") => value(&mut header, number, content)?,
            Some("KD_DEFINITION") => definition(&mut header, number, content)?,
            Some("ROAD_CRG_MODS") => {
                let remedy = "apply the modifiers to the data, and leave the section out";
                return Err(Fault::at(
                    number,
                    format!("the modifier {content:?} is not applied here"),
                    remedy,
                ));
            }
            Some("ROAD_CRG_FILE") => {
                let remedy = "give the file itself";
                return Err(Fault::at(number, format!("the data are in another file, {content:?}"), remedy));
            }
            // Map projections and what else does not move the surface.
            Some(_) => {}
        }
    }
    if header.channels.iter().all(|c| !matches!(c, Channel::Section(_))) {
        return Err(Fault::of_file(
            "no long section in $KD_DEFINITION",
            "add a line D:long section 1,m for each",
        ));
    }
    Ok(header)
}

/// `NAME = number`
fn value(header: &mut Header, number: usize, line: &str) -> Result<(), Fault> {
    let parts = line.split_once('=').map(|(name, value)| (name.trim().to_uppercase(), value.trim()));
    let found = parts.and_then(|(name, value)| Some((name, value.parse::<f64>().ok()?)));
    let Some((name, value)) = found else {
        return Err(Fault::at(number, format!("{line:?} is no value"), "write NAME = number"));
    };
    if let Some((_, _, before)) = header.values.iter().find(|v| v.0 == name) {
        let problem = format!("{name} a second time, first in line {before}");
        return Err(Fault::at(number, problem, "leave one of the two out"));
    }
    header.values.push((name, value, number));
    Ok(())
}

/// `#:LRFI`, `U:reference line u,m,0,0.01`, `D:long section 1,m`
fn definition(header: &mut Header, number: usize, line: &str) -> Result<(), Fault> {
    let fault = |problem: String, remedy: &str| Err(Fault::at(number, problem, remedy));
    let Some((kind, rest)) = line.split_once(':') else {
        return fault(format!("{line:?} defines nothing"), "write #:FORMAT, U:.. or D:..");
    };
    let rest = rest.trim();
    match kind.trim() {
        "#" => match FORMATS.iter().find(|f| f.0 == rest) {
            Some((_, format)) => header.format = Some(*format),
            None => return fault(format!("there is no format {rest:?}"), "write LRFI, LDFI, KRBI or KDBI"),
        },
        "U" => {
            let numbers: Vec<f64> = rest.split(',').skip(2).filter_map(|f| f.trim().parse().ok()).collect();
            let [start, increment] = numbers[..] else {
                return fault(
                    format!("{line:?} has no start and increment"),
                    "write U:reference line u,m,0,0.01",
                );
            };
            header.virtual_u = Some([start, increment]);
        }
        "D" => header.channels.push(channel(number, rest)?),
        _ => return fault(format!("{line:?} defines nothing"), "write #:FORMAT, U:.. or D:.."),
    }
    Ok(())
}

fn channel(number: usize, text: &str) -> Result<Channel, Fault> {
    let (name, unit) = text.split_once(',').unwrap_or((text, ""));
    let (name, unit) = (name.trim().to_lowercase(), unit.trim());
    let found = if name.starts_with("long section") {
        // "long section 3", or "long section at v = -1.5".
        let at = name.split_once('=').map(|(_, v)| v.trim().parse::<f64>());
        match at {
            None => Some((Channel::Section(None), "m")),
            Some(Ok(v)) => Some((Channel::Section(Some(v)), "m")),
            Some(Err(_)) => None,
        }
    } else if name == "reference line phi" {
        Some((Channel::Heading, "rad"))
    } else if name == "reference line slope" || name == "reference line banking" {
        Some((Channel::Tilt, "m/m"))
    } else {
        None
    };
    match found {
        Some((channel, expected)) if unit == expected => Ok(channel),
        Some((_, expected)) => Err(Fault::at(
            number,
            format!("the unit of {name:?} is {unit:?}"),
            format!("give it in {expected}"),
        )),
        None => {
            Err(Fault::at(number, format!("{text:?} is no column"), "write D:long section 1,m or at v = .."))
        }
    }
}
