//! Parameters that a law names itself: read by their names, with the units of what they measure.

use crate::error::{Error, Result};
use crate::physics::parameters::{Fault, Parameter, Quantity};
use crate::scene::reader::Table;
use crate::scene::units::{Dimension, PRESSURE, SLOWNESS, VELOCITY};

/// Values of all parameters, in their order.
pub(super) fn read(table: &Table, parameters: &[Parameter]) -> Result<Vec<f64>> {
    parameters.iter().map(|p| value(table, p)).collect()
}

fn value(table: &Table, parameter: &Parameter) -> Result<f64> {
    let Parameter { key, bound, .. } = *parameter;
    match (table.get(key), parameter.default, dimension(parameter.quantity)) {
        (None, Some(default), _) => Ok(default),
        (None, None, None) => table.need(key, "1.0")?.number(bound),
        (None, None, Some(dimension)) => table.quantity(key, dimension, bound),
        (Some(item), _, None) => item.number(bound),
        (Some(item), _, Some(dimension)) => item.quantity(dimension, bound),
    }
}

/// Units of a quantity; none of a pure number.
fn dimension(quantity: Quantity) -> Option<&'static Dimension> {
    match quantity {
        Quantity::Number => None,
        Quantity::Stress => Some(&PRESSURE),
        Quantity::Speed => Some(&VELOCITY),
        Quantity::Slowness => Some(&SLOWNESS),
    }
}

/// What parameters say of each other, as an error at the first one to look at.
pub(super) fn error(table: &Table, fault: Fault) -> Error {
    table.at(fault.key).error(fault.problem, fault.remedy)
}
