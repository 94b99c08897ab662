//! `[body.material]`: a law from its moduli, or from its own constants in one of their conventions; viscosity and relaxation.

use super::parameters;
use super::relaxation::relaxation;
use crate::error::Result;
use crate::physics::material::Kind;
use crate::scene::reader::{Bound, Table};
use crate::scene::units::{COMPRESSIBILITY, PRESSURE, VISCOSITY};
use crate::scene::{Law, Relaxation};

const MODULI: [&str; 2] = ["shear_modulus", "bulk_modulus"];

/// Further terms (J - 1)^4 / D2 and (J - 1)^6 / D3 of the volumetric energy that other programs have.
const HIGHER: [&str; 2] = ["d2", "d3"];

/// Law of slow deformation, viscosity [Pa s] and Prony series.
pub(super) fn material(table: &Table) -> Result<(Law, Option<f64>, Relaxation)> {
    let mut keys = [&["law", "viscosity", "relaxation"], &MODULI[..], &HIGHER].concat();
    for key in Law::KINDS.iter().flat_map(own) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    table.only(&keys, &[])?;
    let names: Vec<_> = Law::KINDS.iter().map(|kind| (kind.name, kind)).collect();
    let kind = table.get("law").map_or(Ok(&Law::KINDS[0]), |item| item.choice(&names, &[]))?;
    refuse_foreign(table, kind)?;
    refuse_higher(table)?;
    let given = own(kind).find(|key| !MODULI.contains(key) && table.get(key).is_some());
    let law = match given {
        Some(given) => constants(table, kind, given)?,
        None => moduli(table, kind)?,
    };
    let eta = table.quantity_or("viscosity", 0.0, &VISCOSITY, Bound::NotNegative)?;
    let (law, relaxation) = match table.get("relaxation") {
        Some(item) => relaxation(&item, law)?,
        None => (law, Relaxation::default()),
    };
    Ok((law, (eta > 0.0).then_some(eta), relaxation))
}

/// Keys of a law: its parameters, and their other names.
fn own(kind: &Kind) -> impl Iterator<Item = &'static str> + use<> {
    kind.parameters.iter().map(|p| p.key).chain(kind.aliases.iter().map(|a| a.key))
}

/// Refuses what only other laws have.
fn refuse_foreign(table: &Table, kind: &Kind) -> Result<()> {
    let has = |key: &str| MODULI.contains(&key) || own(kind).any(|k| k == key);
    for other in Law::KINDS {
        for key in own(other).filter(|key| !has(key)) {
            if let Some(item) = table.get(key) {
                return Err(item.error(
                    format!("{} has no {key}", kind.name),
                    format!("remove the key, or write law = {:?}", other.name),
                ));
            }
        }
    }
    Ok(())
}

/// Refuses terms of the volumetric energy that no law here has, unless they are zero.
fn refuse_higher(table: &Table) -> Result<()> {
    for item in HIGHER.iter().filter_map(|key| table.get(key)) {
        if item.quantity(&COMPRESSIBILITY, Bound::NotNegative)? != 0.0 {
            return Err(item.error(
                "the volumetric energy has one term, (J - 1)^2 / d1",
                "write 0 1/MPa if this term may be left out, or fit d1 alone",
            ));
        }
    }
    Ok(())
}

/// The law from shear and bulk modulus.
fn moduli(table: &Table, kind: &Kind) -> Result<Law> {
    let [shear, bulk] = MODULI.map(|key| table.quantity(key, &PRESSURE, Bound::Positive));
    (kind.from_moduli)(shear?, bulk?).map_err(|fault| parameters::error(table, fault))
}

/// The law from its own constants, of which `given` is one.
fn constants(table: &Table, kind: &Kind, given: &str) -> Result<Law> {
    let foreign = |key: &&&str| !own(kind).any(|k| k == **key);
    if let Some(item) = MODULI.iter().filter(foreign).find_map(|key| table.get(key)) {
        let all: Vec<_> = own(kind).collect();
        let remedy = format!("write either the moduli (shear_modulus, bulk_modulus) or {}", all.join(", "));
        return Err(item.error(format!("given besides {given}"), remedy));
    }
    (kind.from_values)(&parameters::read(table, kind.parameters, kind.aliases)?)
        .map_err(|fault| parameters::error(table, fault))
}
