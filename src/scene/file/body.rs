//! `[body]`: mesh, material, element.

use crate::error::Result;
use crate::scene::reader::{Bound, Item, Later, Table};
use crate::scene::units::{ANGLE, ANGULAR_VELOCITY, DENSITY, LENGTH, PRESSURE, VELOCITY, VISCOSITY};
use crate::scene::{Body, Element, Grading, Law, Lumping, MeshSpec};

const HOURGLASS: f64 = 0.15;

const KEYS: [&str; 9] = [
    "density",
    "element",
    "hourglass",
    "mass_lumping",
    "offset",
    "velocity",
    "angular_velocity",
    "mesh",
    "material",
];

const LATER_GENERATORS: [Later; 3] = [
    ("file", "use generator = \"ring\" or \"block\""),
    ("import", "use generator = \"ring\" or \"block\""),
    ("gmsh", "use generator = \"ring\" or \"block\""),
];

pub(super) fn body(item: &Item) -> Result<Body> {
    let table = item.table()?;
    table.only(&KEYS, &[])?;
    let (law, viscosity) = material(&table.section("material", "[body.material]")?.table()?)?;
    let mesh_table = table.section("mesh", "[body.mesh]")?.table()?;
    Ok(Body {
        mesh: mesh(&mesh_table)?,
        grading: grading(&mesh_table)?,
        offset: table.vector_or_zero("offset", &LENGTH)?,
        density: table.quantity("density", &DENSITY, Bound::Positive)?,
        law,
        viscosity,
        element: element(&table)?,
        lumping: table.get("mass_lumping").map_or(Ok(Lumping::RowSum), |item| {
            item.choice(&[("row-sum", Lumping::RowSum), ("equal", Lumping::Equal)], &[])
        })?,
        velocity: table.vector_or_zero("velocity", &VELOCITY)?,
        angular_velocity: table.vector_or_zero("angular_velocity", &ANGULAR_VELOCITY)?,
    })
}

fn element(body: &Table) -> Result<Element> {
    let names = [
        ("q1p0", Element::Q1p0),
        ("full", Element::Full),
        ("uniform-gradient", Element::UniformGradient { hourglass: HOURGLASS }),
    ];
    let element = body.get("element").map_or(Ok(Element::Q1p0), |item| item.choice(&names, &[]))?;
    match (element, body.get("hourglass")) {
        (Element::UniformGradient { .. }, Some(item)) => {
            Ok(Element::UniformGradient { hourglass: item.number(Bound::Positive)? })
        }
        (_, Some(item)) => Err(item.error(
            "this element has no hourglass modes",
            "remove the key, or write element = \"uniform-gradient\"",
        )),
        (element, None) => Ok(element),
    }
}

fn mesh(table: &Table) -> Result<MeshSpec> {
    let names = [("ring", true), ("block", false)];
    let generator = table.need("generator", "\"ring\" or \"block\"")?;
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

/// Law and viscosity.
fn material(table: &Table) -> Result<(Law, Option<f64>)> {
    table.only(&["law", "shear_modulus", "bulk_modulus", "g0", "g1", "g2", "viscosity"], &[])?;
    let names =
        [("mooney-rivlin", Form::Split), ("neo-hookean", Form::Neo), ("mooney-rivlin-eq4", Form::Eq4)];
    let form = table.get("law").map_or(Ok(Form::Split), |item| item.choice(&names, &[]))?;
    let [g0, g1, g2] = if table.get("g0").or(table.get("g1")).or(table.get("g2")).is_some() {
        constants(table, form)?
    } else {
        moduli(table, form)?
    };
    let law = match form {
        Form::Eq4 => Law::MooneyRivlinEq4 { g0, g1, g2 },
        _ if g2 == 0.0 => Law::NeoHookean { g0, g1 },
        _ => Law::MooneyRivlin { g0, g1, g2 },
    };
    let eta = table.quantity_or("viscosity", 0.0, &VISCOSITY, Bound::NotNegative)?;
    Ok((law, (eta > 0.0).then_some(eta)))
}

/// How a law's constants relate to the moduli.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    /// kappa = g0, G = g1 + g2: volumetric and isochoric parts are split.
    Split,
    /// The same without g2.
    Neo,
    /// kappa = g0 + 2/3 G: the undeviatored terms of eq. 4 resist volume change too.
    Eq4,
}

impl Form {
    /// kappa - g0 for a shear modulus.
    fn bulk_of_shear(self, G: f64) -> f64 {
        if self == Form::Eq4 { 2.0 / 3.0 * G } else { 0.0 }
    }
}

/// g0, g1, g2 from G and kappa (g2 = 0).
fn moduli(table: &Table, form: Form) -> Result<[f64; 3]> {
    let G = table.quantity("shear_modulus", &PRESSURE, Bound::Positive)?;
    let kappa = table.quantity("bulk_modulus", &PRESSURE, Bound::Positive)?;
    Ok([kappa - form.bulk_of_shear(G), G, 0.0])
}

/// g0, g1, g2 as given; the moduli they amount to must be positive.
fn constants(table: &Table, form: Form) -> Result<[f64; 3]> {
    for key in ["shear_modulus", "bulk_modulus"] {
        if let Some(item) = table.get(key) {
            return Err(item.error("given besides g0, g1, g2", "write either the moduli or g0, g1, g2"));
        }
    }
    let g0 = table.quantity("g0", &PRESSURE, Bound::Any)?;
    let g1 = table.quantity("g1", &PRESSURE, Bound::Any)?;
    let g2 = table.quantity_or("g2", 0.0, &PRESSURE, Bound::Any)?;
    if let Some(item) = table.get("g2").filter(|_| form == Form::Neo && g2 != 0.0) {
        return Err(item.error("neo-hookean has no g2", "remove the key, or write law = \"mooney-rivlin\""));
    }
    let G = g1 + g2;
    if G <= 0.0 {
        return Err(table.at("g1").error(
            format!("the shear modulus g1 + g2 = {G} Pa is not positive"),
            "write g1 and g2 with a positive sum",
        ));
    }
    let kappa = g0 + form.bulk_of_shear(G);
    if kappa <= 0.0 {
        return Err(table
            .at("g0")
            .error(format!("the bulk modulus {kappa} Pa is not positive"), "write a larger g0"));
    }
    Ok([g0, g1, g2])
}
