//! `[body.material.relaxation]`: a Prony series.

use crate::error::Result;
use crate::physics::material::Term;
use crate::scene::reader::{Bound, Item, Table};
use crate::scene::units::TIME;
use crate::scene::{Law, Relaxation};

const TERMS: &str = "[{ ratio = 0.3, time = \"0.1 s\" }]";

/// The series, and the law of slow deformation: that of the material, or what is left of it once all terms have relaxed.
pub(super) fn relaxation(item: &Item, law: Law) -> Result<(Law, Relaxation)> {
    let table = item.table()?;
    table.only(&["terms", "ratios", "constants", "shift"], &[])?;
    if !law.is_isochoric() {
        return Err(item.error(
            format!("{} has no isochoric part that could relax", law.name()),
            "remove the section, or write law = \"mooney-rivlin\"",
        ));
    }
    let entries = table.need("terms", TERMS)?.entries()?;
    if entries.is_empty() {
        return Err(table
            .at("terms")
            .error("a series without a term", format!("write {TERMS}, or remove the section")));
    }
    let terms = entries.iter().map(term).collect::<Result<Vec<_>>>()?;
    let share = instantaneous_share(&table, &terms)?;
    let slower = table.get("shift").map_or(Ok(1.0), |item| shift(&item.table()?))?;
    let total: f64 = terms.iter().map(|(ratio, _)| ratio).sum();
    let left = if share { 1.0 - total } else { 1.0 / (1.0 + total) };
    let of = |(ratio, time): (f64, f64)| Term {
        ratio: if share { ratio / left } else { ratio },
        time: time * slower,
    };
    let constants = [("long-term", false), ("instantaneous", true)];
    let instantaneous = table.get("constants").map_or(Ok(false), |item| item.choice(&constants, &[]))?;
    let law = if instantaneous { law.with_shear_scaled(left) } else { law };
    Ok((law, Relaxation { terms: terms.into_iter().map(of).collect() }))
}

/// Ratio and time [s] of a term.
fn term(item: &Item) -> Result<(f64, f64)> {
    let table = item.table()?;
    table.only(&["ratio", "time"], &[])?;
    let ratio = table.need("ratio", "0.3")?.number(Bound::Positive)?;
    Ok((ratio, table.quantity("time", &TIME, Bound::Positive)?))
}

/// Whether ratios are shares of the instantaneous shear modulus, of which something must be left.
fn instantaneous_share(table: &Table, terms: &[(f64, f64)]) -> Result<bool> {
    let names = [("of-instantaneous", true), ("of-long-term", false)];
    let share = table.get("ratios").map_or(Ok(true), |item| item.choice(&names, &[]))?;
    let total: f64 = terms.iter().map(|(ratio, _)| ratio).sum();
    if share && total >= 1.0 {
        return Err(table.at("terms").error(
            format!("the ratios add up to {total}: nothing is left of the instantaneous modulus"),
            "write ratios that add up to less than 1, or ratios = \"of-long-term\"",
        ));
    }
    Ok(share)
}

/// How much longer all times are than at the temperature they were measured at (Williams, Landel & Ferry 1955):
/// log10 a = -c1 (T - T0) / (c2 + T - T0).
fn shift(table: &Table) -> Result<f64> {
    table.only(&["c1", "c2", "reference", "temperature"], &[])?;
    let number = |key, bound| table.need(key, "17.44")?.number(bound);
    let (c1, c2) = (number("c1", Bound::Positive)?, number("c2", Bound::Positive)?);
    let above = number("temperature", Bound::Any)? - number("reference", Bound::Any)?;
    if c2 + above <= 0.0 {
        return Err(table.at("temperature").error(
            format!("{} K below the reference, where the shift has no end: c2 is {c2} K", -above),
            "write a temperature nearer to the reference",
        ));
    }
    let slower = 10f64.powf(-c1 * above / (c2 + above));
    match slower.is_finite() && slower > 0.0 {
        true => Ok(slower),
        false => Err(table.at("temperature").error(
            format!("all times are shifted by a factor of {slower}"),
            "write a temperature nearer to the reference",
        )),
    }
}
