//! `[road]`: profiles and height fields.

use std::path::PathBuf;
use std::sync::Arc;

use super::hash;
use super::road::direction;
use crate::error::Result;
use crate::physics::road::{Base, Border, HeightField, Profile, Samples, Shape, Wave};
use crate::scene::Road;
use crate::scene::document::{Node, Value};
use crate::scene::heights::{Fault, Map, crg, generate, grid, picture};
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{ANGLE, LENGTH};

/// A road that has a shape of its own rests.
const MOVING: [Later; 2] = [
    ("velocity", "let the rim move: a profile or a height field rests"),
    ("angular_velocity", "let the rim move: a profile or a height field rests"),
];

/// Keys that say where the shape lies.
const PLACE: [&str; 4] = ["shape", "point", "normal", "angle"];

fn only(table: &Table, own: &[&str]) -> Result<()> {
    table.only(&[&PLACE, own].concat(), &MOVING)
}

fn base(table: &Table) -> Result<Base> {
    let angle = table.quantity_or("angle", 0.0, &ANGLE, Bound::Any)?;
    Ok(Base::turned(table.vector_or_zero("point", &LENGTH)?, direction(table, "normal", [0, 0, 1])?, angle))
}

/// A shape that depends on u alone.
pub(super) fn profile(table: &Table) -> Result<Road> {
    type Read = fn(&Table) -> Result<Road>;
    let forms: [(&str, Read); 4] = [("cosine", cosine), ("cleat", cleat), ("step", step), ("points", points)];
    table.need("form", "\"cleat\"")?.choice(&forms, &[])?(table)
}

fn cosine(table: &Table) -> Result<Road> {
    only(table, &["form", "wavelength", "amplitude"])?;
    let wavelength = table.quantity("wavelength", &LENGTH, Bound::Positive)?;
    let amplitude = table.quantity("amplitude", &LENGTH, Bound::Positive)?;
    Ok(Wave { base: base(table)?, amplitude, wavelength }.into())
}

/// A block on the plane, its middle at the point; again after every `spacing`.
fn cleat(table: &Table) -> Result<Road> {
    only(table, &["form", "height", "length", "radius", "spacing"])?;
    let height = table.quantity("height", &LENGTH, Bound::Positive)?;
    let length = table.quantity("length", &LENGTH, Bound::Positive)?;
    let period = table.get("spacing").map(|item| item.quantity(&LENGTH, Bound::Positive)).transpose()?;
    if let Some(period) = period.filter(|period| *period <= length) {
        let problem = format!("cleats of {length} m every {period} m leave no gap");
        return Err(table
            .at("spacing")
            .error(problem, "write a spacing above the length, from middle to middle"));
    }
    let half = 0.5 * length;
    shaped(table, &[[-half, 0.0], [-half, height], [half, height], [half, 0.0]], period)
}

/// Up, or down where the height is negative, at the point.
fn step(table: &Table) -> Result<Road> {
    only(table, &["form", "height", "radius"])?;
    let height = table.quantity("height", &LENGTH, Bound::Any)?;
    if height == 0.0 {
        return Err(table
            .at("height")
            .error("a step without height", "write shape = \"plane\", or a height"));
    }
    shaped(table, &[[0.0, 0.0], [0.0, height]], None)
}

fn shaped(table: &Table, vertices: &[[f64; 2]], period: Option<f64>) -> Result<Road> {
    let radius = table.quantity_or("radius", 0.0, &LENGTH, Bound::NotNegative)?;
    let shape = Shape::new(vertices, radius, period).map_err(|fits| {
        let problem = format!("corners with a radius of {radius} m do not fit");
        table.at("radius").error(problem, format!("write at most {fits:.6e} m"))
    })?;
    Ok(Profile { base: base(table)?, shape: Arc::new(shape) }.into())
}

/// Straight lines between the points of a file.
fn points(table: &Table) -> Result<Road> {
    only(table, &["form", "file", "unit", "radius", "border"])?;
    let item = table.need("file", "\"profile.csv\"")?;
    let unit = unit(table)?;
    let text = text(&item)?;
    let vertices = vertices(&text, unit).map_err(|fault| at_file(&item, &fault))?;
    let borders = [("keep", false), ("periodic", true)];
    let again = table.get("border").map_or(Ok(false), |item| item.choice(&borders, &[]))?;
    let [first, last] = [vertices[0], vertices[vertices.len() - 1]];
    if again && (first[1] - last[1]).abs() > 1e-9 * (last[0] - first[0]) {
        let problem =
            format!("the heights of the first and the last point, {} m and {} m, differ", first[1], last[1]);
        return Err(table
            .at("border")
            .error(problem, "end the points where they begin, or write border = \"keep\""));
    }
    shaped(table, &vertices, again.then_some(last[0] - first[0]))
}

/// Lines of u and height; a first line without numbers is a heading.
fn vertices(text: &str, unit: f64) -> std::result::Result<Vec<[f64; 2]>, Fault> {
    let fault =
        |line, problem: String, remedy: &str| Fault { line: Some(line), problem, remedy: remedy.into() };
    let mut vertices: Vec<[f64; 2]> = Vec::new();
    for (n, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let fields = line.split([',', ';', '\t', ' ']).map(str::trim).filter(|f| !f.is_empty());
        let numbers: std::result::Result<Vec<f64>, _> = fields.map(str::parse).collect();
        let point = match numbers.as_deref() {
            Ok(&[u, w]) if u.is_finite() && w.is_finite() => [u * unit, w * unit],
            _ if n == 0 && !line.contains(|c: char| c.is_ascii_digit()) => continue,
            _ => return Err(fault(n + 1, format!("{line:?} is no point"), "write a length and a height")),
        };
        if let Some(before) = vertices.last() {
            if point[0] < before[0] {
                let problem = format!("{} m is before the point in front of it", point[0]);
                return Err(fault(
                    n + 1,
                    problem,
                    "write the points along the road: no part of it overhangs",
                ));
            }
            let wall = vertices.len() > 1 && vertices[vertices.len() - 2][0] == point[0];
            if point == *before || (wall && point[0] == before[0]) {
                let problem = "a point that is there already, or in the middle of a wall".into();
                return Err(fault(n + 1, problem, "write the corners alone"));
            }
        }
        vertices.push(point);
    }
    match vertices.len() {
        0 | 1 => Err(Fault {
            line: None,
            problem: format!("{} points are no profile", vertices.len()),
            remedy: "write two or more".into(),
        }),
        _ => Ok(vertices),
    }
}

/// Heights on a grid, from a file or from a seed.
pub(super) fn height_field(table: &Table) -> Result<Road> {
    let (map, missing) = match (table.get("file"), table.get("generate")) {
        (Some(_), Some(item)) => {
            return Err(item.error("a file and a generator", "leave one of the two out"));
        }
        (Some(file), None) => (of_file(table, &file)?, Border::Nothing),
        (None, Some(item)) => (generated(table, &item)?, Border::Periodic),
        (None, None) => {
            let remedy = "add file = \"road.png\" or generate = \"self-affine\"";
            return Err(table.at("file").error("missing", remedy));
        }
    };
    let borders = [("periodic", Border::Periodic), ("keep", Border::Keep), ("nothing", Border::Nothing)];
    let said = table.get("border").map(|item| item.choice(&borders, &[])).transpose()?;
    let border = said.or(map.border).unwrap_or(missing);
    let mut base = base(table)?;
    base.point = base.place([map.origin[0], map.origin[1], 0.0]);
    let samples = Samples::new(map.size, map.spacing, map.heights, border);
    Ok(HeightField { base, samples: Arc::new(samples) }.into())
}

fn of_file(table: &Table, item: &Item) -> Result<Map> {
    let path = path(item)?;
    let kind = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let pixel = || table.quantity("pixel", &LENGTH, Bound::Positive);
    let read = match kind.as_str() {
        "png" => {
            only(table, &["file", "pixel", "height", "border"])?;
            picture::read(&bytes(item)?, pixel()?, table.quantity("height", &LENGTH, Bound::Positive)?)
        }
        "csv" => {
            only(table, &["file", "pixel", "unit", "border"])?;
            grid::csv(&text(item)?, pixel()?, unit(table)?)
        }
        "asc" => {
            only(table, &["file", "unit", "border"])?;
            grid::esri(&text(item)?, unit(table)?)
        }
        "crg" => {
            only(table, &["file", "border"])?;
            crg::read(&bytes(item)?)
        }
        _ => {
            let problem = format!("heights in a file .{kind} are not read");
            return Err(item.error(problem, "give .png (16-bit), .csv, .asc (ESRI) or .crg (OpenCRG)"));
        }
    };
    read.map_err(|fault| at_file(item, &fault))
}

fn generated(table: &Table, item: &Item) -> Result<Map> {
    let kinds = [("iso-8608", true), ("self-affine", false)];
    let iso = item.choice(&kinds, &[])?;
    let own: &[&str] = if iso { &["class"] } else { &["hurst", "rms"] };
    const FIELD: [&str; 8] =
        ["generate", "seed", "length", "width", "spacing", "longest", "shortest", "border"];
    only(table, &[&FIELD[..], own].concat())?;
    let length = table.quantity("length", &LENGTH, Bound::Positive)?;
    let spacing = table.quantity("spacing", &LENGTH, Bound::Positive)?;
    let extent = [length, table.quantity_or("width", length, &LENGTH, Bound::Positive)?];
    let field = generate::Field {
        extent,
        spacing,
        longest: table.quantity_or("longest", extent[0].max(extent[1]), &LENGTH, Bound::Positive)?,
        shortest: table.quantity_or("shortest", 4.0 * spacing, &LENGTH, Bound::Positive)?,
        seed: table.need("seed", "1")?.count(0, "is any whole number")? as u64,
    };
    /// Samples that are read and generated within seconds.
    const MOST: f64 = 16e6;
    let count = extent[0] / spacing * (extent[1] / spacing);
    if count > MOST {
        let problem = format!("{count:.3e} samples, above {MOST:e}");
        return Err(table.at("spacing").error(problem, "write a larger spacing, or a smaller extent"));
    }
    let spectrum = if iso { iso_8608(table)? } else { self_affine(table)? };
    generate::field(&field, spectrum).map_err(|fault| item.error(fault.problem, fault.remedy))
}

fn iso_8608(table: &Table) -> Result<generate::Spectrum> {
    let item = table.need("class", "\"C\"")?;
    let mut letters = item.text()?.chars();
    let class = letters.next().filter(|_| letters.next().is_none()).and_then(generate::class);
    let roughness =
        class.ok_or_else(|| item.error("no class of ISO 8608", "write a letter from \"A\" to \"H\""))?;
    Ok(generate::Spectrum::Iso8608 { roughness })
}

fn self_affine(table: &Table) -> Result<generate::Spectrum> {
    let item = table.need("hurst", "0.8")?;
    let hurst = item.number(Bound::Positive)?;
    if hurst > 1.0 {
        return Err(item.error(format!("a Hurst exponent of {hurst}"), "write a number above 0, up to 1"));
    }
    Ok(generate::Spectrum::SelfAffine { hurst, rms: table.quantity("rms", &LENGTH, Bound::Positive)? })
}

/// What a number of a file stands for [m].
fn unit(table: &Table) -> Result<f64> {
    table.quantity_or("unit", 1.0, &LENGTH, Bound::Positive)
}

/// A file beside the scene, unless its path begins at the root.
fn path(item: &Item) -> Result<PathBuf> {
    let folder = std::path::Path::new(item.file).parent().map(PathBuf::from).unwrap_or_default();
    Ok(folder.join(item.text()?))
}

fn bytes(item: &Item) -> Result<Vec<u8>> {
    let path = path(item)?;
    std::fs::read(&path).map_err(|e| {
        item.error(format!("{}: {e}", path.display()), "give the path of a file, from the scene's folder")
    })
}

fn text(item: &Item) -> Result<String> {
    String::from_utf8(bytes(item)?)
        .map_err(|e| item.error(format!("no text in UTF-8: {e}"), "save the file as UTF-8"))
}

fn at_file(item: &Item, fault: &Fault) -> crate::Error {
    let line = fault.line.map(|n| format!("line {n}: ")).unwrap_or_default();
    let name = item.text().unwrap_or_default();
    item.error(format!("{name}: {line}{}", fault.problem), fault.remedy.clone())
}

/// The scene with the content of its road's file in place of the path: what it is told from others by.
pub(super) fn by_content(root: &Node, file: &str) -> Result<Node> {
    let mut root = root.clone();
    if let Some(node) = file_of(&mut root) {
        let content = bytes(&Item { file, key: "road.file".into(), node })?;
        node.value = Value::Text(hash(content));
    }
    Ok(root)
}

/// The scene with the whole path of its road's file, so that a copy of it elsewhere finds the file.
pub(super) fn from_anywhere(mut root: Node, file: &str) -> Node {
    if let Some(node) = file_of(&mut root) {
        let found = path(&Item { file, key: "road.file".into(), node })
            .and_then(|path| std::path::absolute(&path).map_err(crate::Error::io(&path, "find the road")));
        if let Ok(path) = found {
            node.value = Value::Text(path.to_string_lossy().into());
        }
    }
    root
}

fn file_of(root: &mut Node) -> Option<&mut Node> {
    let Value::Table(sections) = &mut root.value else { return None };
    let Value::Table(keys) = &mut sections.get_mut("road")?.value else { return None };
    keys.get_mut("file").filter(|node| matches!(node.value, Value::Text(_)))
}
