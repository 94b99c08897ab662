//! Which file fills each role of a kernel: the one table between a scene's choices and the folders of `shaders/`.
//!
//! A folder is a *role*, its files are *variants*: they give the same names, and at most one of them is in a program. Three
//! folders are none: `kernels/` and `bench/` hold entry points, `lib/` what any program may use.

use super::{Choice, Kernel, RimKind};
use crate::gpu::layout::Real;
use crate::scene::Element;

/// A role and the variant that fills it: laws and roads by their names in scene files.
pub type Filled = (&'static str, &'static str);

/// The part that fills a role: the variant's name with `_` for `-` is the stem of its file.
pub fn part((role, variant): &Filled) -> String {
    format!("{role}/{}", variant.replace('-', "_"))
}

/// The part that says what `real` is.
pub fn real(real: Real) -> Filled {
    let variant = match real {
        Real::Single => "single",
        Real::Double => "double",
    };
    ("real", variant)
}

/// Every role that a kernel of this choice may have a part in.
pub fn filled(choice: &Choice, kernel: Kernel) -> Vec<Filled> {
    // Interior nodes meet neither road nor rim.
    let choice = if kernel == Kernel::Node { choice.interior() } else { *choice };
    let mut roles = vec![real(choice.precision.real())];
    roles.extend(element_roles(&choice));
    roles.extend(place_roles(&choice, kernel));
    roles.extend(node_roles(&choice, kernel));
    roles
}

/// What an element's force and energy are.
fn element_roles(choice: &Choice) -> Vec<Filled> {
    let Choice { extruded, viscous, relaxes, .. } = *choice;
    let has_i2 = choice.law.has_i2();
    let (element, mean) = match choice.element {
        Element::Q1p0 => ("q1p0", false),
        Element::Full => ("full", false),
        Element::UniformGradient { .. } if extruded => ("uniform_gradient_extruded", true),
        Element::UniformGradient { .. } => ("uniform_gradient", true),
    };
    let metric = if extruded { "plane" } else { "any" };
    vec![
        ("material", choice.law.name()),
        ("invariants", if has_i2 { "i2" } else { "i1" }),
        ("element", element),
        ("gradient", if mean { "mean" } else { "points" }),
        ("metric", if mean { "identity" } else { metric }),
        ("coupling", if extruded && !has_i2 { "plane" } else { "any" }),
        (
            "force",
            match (mean, viscous, relaxes) {
                (false, _, true) => "points_relaxing",
                (false, false, false) => "points_elastic",
                (false, true, false) => "points_viscous",
                (true, _, true) => "mean_relaxing",
                (true, false, false) => "mean_elastic",
                (true, true, false) => "mean_viscous",
            },
        ),
        ("viscosity", if viscous { "kelvin_voigt" } else { "none" }),
        ("memory", if relaxes { "prony" } else { "none" }),
    ]
}

/// Where things are kept: positions, forces, shape classes, and what tells elements and nodes of one another.
fn place_roles(choice: &Choice, kernel: Kernel) -> Vec<Filled> {
    let resident = kernel == Kernel::Resident;
    let alone = |elsewhere| if resident { "resident" } else { elsewhere };
    vec![
        ("body", alone("alone")),
        ("position", alone(if choice.precision.has_pairs() { "pairs" } else { "plain" })),
        ("chain", if choice.lattice { "lattice" } else { "table" }),
        ("class", if choice.shared_classes { "shared" } else { "own" }),
        ("slots", if choice.joined { "joined" } else { "apart" }),
        ("gather", alone(if choice.lattice { "lattice" } else { "table" })),
    ]
}

/// What moves a node, and what is booked of it.
fn node_roles(choice: &Choice, kernel: Kernel) -> Vec<Filled> {
    let or_none = |has: bool, variant| if has { variant } else { "none" };
    let nodes = match kernel {
        Kernel::Node => "interior",
        Kernel::Boundary => "boundary",
        _ => "all",
    };
    let sum = if kernel == Kernel::Resident { "resident" } else { "groups" };
    let mut roles = vec![
        ("nodes", nodes),
        ("gravity", or_none(choice.gravity, "uniform")),
        ("damping", or_none(choice.damping, "mass")),
        ("hold", or_none(choice.held, "components")),
        ("works", or_none(choice.other_works(), "book")),
        ("rim", or_none(choice.rim != RimKind::None, "carried")),
        ("contact", or_none(choice.road.is_some(), "project")),
        ("contact_sum", or_none(choice.road.is_some(), sum)),
    ];
    roles.extend(match choice.rim {
        RimKind::None => None,
        RimKind::Prescribed => Some(("pose", "prescribed")),
        RimKind::Free => Some(("pose", "free")),
    });
    roles.extend(choice.road.map(|road| ("road", road)));
    match &choice.friction {
        None => roles.push(("rub", "none")),
        Some(law) => roles.extend([
            ("friction", law.name()),
            ("rub", if law.is_constant() { "constant" } else { "law" }),
            ("area", or_none(law.needs_area(), "surface")),
        ]),
    }
    roles
}
