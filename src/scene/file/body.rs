//! `[body]`: mesh, material, element.

use super::material::material;
use super::mesh_file;
use crate::error::Result;
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{ANGLE, ANGULAR_VELOCITY, DENSITY, LENGTH, VELOCITY};
use crate::scene::{
    Body, Drive, Element, Grading, Implicit, ImplicitScheme, InitialVelocity, Lumping, MeshSpec, Method,
    Stage,
};

const HOURGLASS: f64 = 0.15;

const KEYS: [&str; 11] = [
    "density",
    "element",
    "hourglass",
    "hourglass_limit",
    "mass_lumping",
    "offset",
    "place",
    "velocity",
    "angular_velocity",
    "mesh",
    "material",
];

const A_FILE: &str = "write file = \"wheel.inp\" and unit = \"mm\" in place of generator";

const LATER_GENERATORS: [Later; 3] = [("file", A_FILE), ("import", A_FILE), ("gmsh", A_FILE)];

/// `has_road`: whether there is one to be placed on.
pub(super) fn body(item: &Item, has_road: bool) -> Result<Body> {
    let table = item.table()?;
    table.only(&KEYS, &[])?;
    let (law, viscosity, relaxation) = material(&table.section("material", "[body.material]")?.table()?)?;
    let mesh_table = table.section("mesh", "[body.mesh]")?.table()?;
    Ok(Body {
        mesh: mesh(&mesh_table)?,
        grading: grading(&mesh_table)?,
        offset: table.vector_or_zero("offset", &LENGTH)?,
        on_road: table.get("place").map_or(Ok(false), |item| placed_on_road(&item, has_road))?,
        density: table.quantity("density", &DENSITY, Bound::Positive)?,
        law,
        viscosity,
        relaxation,
        element: element(&table)?,
        hourglass_limit: table.get("hourglass_limit").map(|item| item.number(Bound::Positive)).transpose()?,
        lumping: table.get("mass_lumping").map_or(Ok(Lumping::RowSum), |item| {
            item.choice(&[("row-sum", Lumping::RowSum), ("equal", Lumping::Equal)], &[])
        })?,
        velocity: table.vector_or_zero("velocity", &VELOCITY)?,
        angular_velocity: table.vector_or_zero("angular_velocity", &ANGULAR_VELOCITY)?,
    })
}

/// Refuses velocities at t = 0 that the first stage takes away before anything has moved.
pub(super) fn check_start(item: &Item, body: &Body, first: &Stage) -> Result<()> {
    let is_free = |d: &Drive| matches!(d, Drive::Free { .. });
    let why = match (first.method, first.initial_velocity) {
        (Method::Implicit(Implicit { scheme: ImplicitScheme::Static { .. }, .. }), _) => {
            "nothing moves in the first stage, which is static"
        }
        (_, Some(InitialVelocity::Zero)) => "the first stage sets every velocity to zero",
        // A free component of the rim takes its rate from the body.
        (_, Some(InitialVelocity::Rim)) if !first.rim.drives().iter().any(is_free) => {
            "the first stage sets every velocity to that of the rim"
        }
        _ => return Ok(()),
    };
    let table = item.table()?;
    for (key, value) in [("velocity", body.velocity), ("angular_velocity", body.angular_velocity)] {
        if value != [0.0; 3] {
            let remedy = "remove the key, or let the first stage begin with it: explicit or dynamic, without initial_velocity";
            return Err(table.at(key).error(why, remedy));
        }
    }
    Ok(())
}

fn placed_on_road(item: &Item, has_road: bool) -> Result<bool> {
    let on_road = item.choice(&[("as-meshed", false), ("on-road", true)], &[])?;
    match on_road && !has_road {
        true => Err(item.error("the scene has no road", "add a section [road], or remove the key")),
        false => Ok(on_road),
    }
}

fn element(body: &Table) -> Result<Element> {
    let names = [
        ("q1p0", Element::Q1p0),
        ("full", Element::Full),
        ("uniform-gradient", Element::UniformGradient { hourglass: HOURGLASS }),
    ];
    let element = body.get("element").map_or(Ok(Element::Q1p0), |item| item.choice(&names, &[]))?;
    if let Element::UniformGradient { hourglass } = element {
        let hourglass = body.number_or("hourglass", hourglass, Bound::Positive)?;
        return Ok(Element::UniformGradient { hourglass });
    }
    match ["hourglass", "hourglass_limit"].into_iter().find_map(|key| body.get(key)) {
        Some(item) => Err(item.error(
            "this element has no hourglass modes",
            "remove the key, or write element = \"uniform-gradient\"",
        )),
        None => Ok(element),
    }
}

fn mesh(table: &Table) -> Result<MeshSpec> {
    if let Some(file) = table.get("file") {
        return mesh_file::read(table, &file).map(MeshSpec::File);
    }
    let names = [("ring", true), ("block", false)];
    let generator =
        table.need("generator", "\"ring\" or \"block\", or the file of a mesh: file = \"wheel.inp\"")?;
    if generator.choice(&names, &LATER_GENERATORS)? { ring(table) } else { block(table) }
}

fn ring(table: &Table) -> Result<MeshSpec> {
    let keys = ["generator", "outer_radius", "inner_radius", "width", "elements", "grading", "fine_arc"];
    table.only(&keys, &[])?;
    let outer_radius = table.quantity("outer_radius", &LENGTH, Bound::Positive)?;
    let inner_radius = table.quantity("inner_radius", &LENGTH, Bound::Positive)?;
    if inner_radius >= outer_radius {
        let problem =
            format!("an inside-out ring: {inner_radius} m is not less than the outer {outer_radius} m");
        let item = table.at("inner_radius");
        return Err(item.error(problem, "write an inner_radius less than outer_radius"));
    }
    Ok(MeshSpec::Ring {
        outer_radius,
        inner_radius,
        width: table.quantity("width", &LENGTH, Bound::Positive)?,
        elements: elements(table, "[44, 4, 5]", 3)?,
    })
}

fn block(table: &Table) -> Result<MeshSpec> {
    table.only(&["generator", "size", "elements", "grading"], &[])?;
    let size = table.need("size", "[\"40 mm\", \"40 mm\", \"20 mm\"]")?;
    Ok(MeshSpec::Block {
        size: size.vector(&LENGTH, Bound::Positive)?,
        elements: elements(table, "[8, 8, 4]", 1)?,
    })
}

/// Ratios of element sizes; equal elements by default.
fn grading(table: &Table) -> Result<Grading> {
    /// Beyond this a single element would span most of the length.
    const MOST: f64 = 1e4;
    let ratio = table.get("grading").map_or(Ok([1.0; 3]), |item| {
        item.three("[1, 0.2, 1]", |entry| {
            let ratio = entry.number(Bound::Positive)?;
            match (1.0 / MOST..=MOST).contains(&ratio) {
                true => Ok(ratio),
                false => Err(entry.error(
                    format!("element sizes that differ by a factor of {ratio}"),
                    format!("write a ratio between {} and {MOST}", 1.0 / MOST),
                )),
            }
        })
    })?;
    let fine_arc = table.quantity_or("fine_arc", 0.0, &ANGLE, Bound::NotNegative)?;
    if let Some(item) = table.get("fine_arc") {
        if fine_arc >= std::f64::consts::TAU {
            return Err(
                item.error("a whole turn of equal elements", "remove the key, or write less than 360 deg")
            );
        }
        if ratio[0] == 1.0 {
            let problem = "all elements round the ring are equal";
            return Err(item.error(problem, "remove the key, or write grading = [4, 1, 1]"));
        }
    }
    Ok(Grading { ratio, fine_arc })
}

/// Elements in three directions, at least `first` in the first.
fn elements(table: &Table, example: &str, first: usize) -> Result<[usize; 3]> {
    let item = table.need("elements", example)?;
    let counts = item.three(example, |entry| {
        let around = first > 1 && entry.key.ends_with(".0");
        let (least, why) =
            if around { (first, "are needed to close a ring") } else { (1, "is needed in every direction") };
        entry.count(least, why)
    })?;
    // Every element has eight force slots, and slots are counted in 32 bits.
    let total = counts.iter().try_fold(8_usize, |product, &n| product.checked_mul(n));
    match total.filter(|&slots| u32::try_from(slots).is_ok()) {
        Some(_) => Ok(counts),
        None => Err(item.error(
            "too many elements",
            format!("their product must not exceed {} million", u32::MAX / 8 / 1_000_000),
        )),
    }
}
