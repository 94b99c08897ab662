//! Parameters that a law names itself: read by their names, with the units of what they measure.

use crate::error::{Error, Result};
use crate::physics::parameters::{Alias, Bound, Fault, Parameter, Quantity};
use crate::scene::reader::{Item, Table};
use crate::scene::units::{COMPRESSIBILITY, Dimension, PRESSURE, SLOWNESS, VELOCITY};

/// Values of all parameters, in their order, each under its own name or another.
pub(super) fn read(table: &Table, parameters: &[Parameter], aliases: &[Alias]) -> Result<Vec<f64>> {
    parameters.iter().map(|p| of_any_name(table, p, aliases)).collect()
}

fn of_any_name(table: &Table, parameter: &Parameter, aliases: &[Alias]) -> Result<f64> {
    let aliases: Vec<_> = aliases.iter().filter(|a| a.parameter == parameter.key).collect();
    let Some((alias, item)) = aliases.iter().find_map(|a| Some((a, table.get(a.key)?))) else {
        return value(table, parameter, &aliases);
    };
    let names = aliases.iter().map(|a| a.key).chain([parameter.key]);
    if let Some(other) = names.filter(|key| *key != alias.key).find(|key| table.get(key).is_some()) {
        let problem = format!("{} and {other} say the same thing", alias.key);
        return Err(item.error(problem, "remove one of the two"));
    }
    let bound = if alias.quantity == Quantity::Compressibility { Bound::Positive } else { parameter.bound };
    let given = match dimension(alias.quantity) {
        None => item.number(bound),
        Some(dimension) => item.quantity(dimension, bound),
    };
    match given {
        Err(_) if is_zero(&item, alias) => Err(item.error(
            "zero means incompressible in other programs, and here the bulk modulus is finite",
            "write bulk_modulus = \"65.1 MPa\", some 20 to 1000 times the shear modulus, in its place",
        )),
        given => Ok((alias.value)(given?)),
    }
}

/// Whether a compressibility is given, as zero.
fn is_zero(item: &Item, alias: &Alias) -> bool {
    alias.quantity == Quantity::Compressibility
        && item.quantity(&COMPRESSIBILITY, Bound::Any).is_ok_and(|value| value == 0.0)
}

fn value(table: &Table, parameter: &Parameter, aliases: &[&Alias]) -> Result<f64> {
    let Parameter { key, bound, .. } = *parameter;
    match (table.get(key), parameter.default, dimension(parameter.quantity)) {
        (None, Some(default), _) => Ok(default),
        (None, None, dimension) => {
            let example = dimension.map_or("1.0".into(), |d| format!("\"{}\"", d.example));
            let others: Vec<_> = aliases.iter().map(|a| format!("{} ({})", a.key, a.doc)).collect();
            let or = if others.is_empty() { String::new() } else { format!(", or {}", others.join(", or ")) };
            Err(table.at(key).error("missing", format!("add {key} = {example}{or}")))
        }
        (Some(item), _, None) => item.number(bound),
        (Some(item), _, Some(dimension)) => item.quantity(dimension, bound),
    }
}

/// Units of a quantity; none of a pure number.
fn dimension(quantity: Quantity) -> Option<&'static Dimension> {
    match quantity {
        Quantity::Number => None,
        Quantity::Stress => Some(&PRESSURE),
        Quantity::Compressibility => Some(&COMPRESSIBILITY),
        Quantity::Speed => Some(&VELOCITY),
        Quantity::Slowness => Some(&SLOWNESS),
    }
}

/// What parameters say of each other, as an error at the first one to look at.
pub(super) fn error(table: &Table, fault: Fault) -> Error {
    table.at(fault.key).error(fault.problem, fault.remedy)
}
