//! Keyword files: Abaqus' and CalculiX' input files (`.inp`), and FrontISTR's meshes.
//!
//! Read are nodes, hexahedra, sets, surfaces, parts and where they stand, included files; and materials, for the scene. What else
//! a deck says is listed: a scene says it in its own words.
//!
//! Format: Abaqus Keywords Reference Guide; FrontISTR user manual, "Mesh data".

mod assembly;
mod cards;
mod deck;
mod elements;
mod lines;
mod materials;
mod parts;
mod resolve;
mod unread;

use std::path::Path;

pub use cards::Dialect;

use super::raw::Raw;
use super::source::Place;
use crate::error::Result;
use crate::scene::{LengthUnit, MeshFile};
use deck::Deck;
use unread::Kind;

/// The mesh of a keyword file.
pub fn read(file: &MeshFile, dialect: Dialect) -> Result<Raw> {
    let deck = deck::read(&file.path, dialect, &file.drop)?;
    let place = Place { file: file.path.clone(), line: None };
    let section = file.revolve.is_some();
    only(&deck, section, &place)?;
    let mut raw = assembly::assembled(&deck, section, &place)?;
    raw.notes = notes(&deck, section);
    raw.format = match dialect {
        Dialect::Abaqus => "Abaqus deck".into(),
        Dialect::FrontIstr => "FrontISTR mesh".into(),
    };
    Ok(raw)
}

/// What a deck says of materials, as lines of a scene, each material with its place; empty if it says nothing.
pub fn materials(path: &Path, dialect: Dialect, unit: &LengthUnit, drop: &[String]) -> Result<Vec<String>> {
    let deck = deck::read(path, dialect, drop)?;
    let mut lines = Vec::new();
    for material in deck.materials.iter().filter(|m| m.density.is_some() || m.law.is_some()) {
        let line = material.place().and_then(|p| p.line).map_or(String::new(), |l| format!(", line {l}"));
        lines.push(format!("# material {:?}{line}", material.name));
        lines.extend(material.scene_lines(unit));
    }
    lines.extend(deck.material_notes.iter().map(|note| format!("# {note}")));
    Ok(lines)
}

/// Refuses elements that are not modelled: a body without them would be another. `section`: quadrilaterals are wanted, which are
/// revolved, and no hexahedra.
fn only(deck: &Deck, section: bool, place: &Place) -> Result<()> {
    let wanted = |name: &str| match section {
        true => elements::is_section(name),
        false => elements::shape(name).is_hexahedron,
    };
    let there = deck.types.iter().any(|(name, (count, _))| *count > 0 && wanted(name));
    let others: Vec<_> = deck
        .types
        .iter()
        .filter(|(name, (count, _))| *count > 0 && !wanted(name) && !deck.dropped.contains_key(*name))
        .filter(|(name, _)| !(there && !section && elements::marks_faces(name)))
        .collect();
    if let Some((name, (_, first))) = others.iter().max_by_key(|(_, (count, _))| *count) {
        let list: Vec<String> =
            others.iter().map(|(name, (count, _))| format!("{count} of type {name}")).collect();
        let kind = if section { "quadrilaterals of a section" } else { "hexahedra of eight nodes" };
        let problem = format!("elements that are no {kind}: {}", list.join(", "));
        return Err(first.error("*ELEMENT", problem, elements::remedy(name)));
    }
    match there {
        true => Ok(()),
        false if section => Err(place.error(
            "*ELEMENT",
            "there are no quadrilaterals of a section in this file",
            "write elements of type CGAX4 or CAX4, or leave revolve out",
        )),
        false => Err(place.error(
            "*ELEMENT",
            "there are no hexahedra in this file",
            "write elements of type C3D8 or its kin",
        )),
    }
}

/// What a user must know of a deck, in lines.
fn notes(deck: &Deck, section: bool) -> Vec<String> {
    let mut notes = Vec::new();
    for (name, (count, _)) in deck.types.iter().filter(|(_, (count, _))| *count > 0) {
        if let Some((_, nearest)) = elements::HEXAHEDRA.iter().find(|h| h.0 == name) {
            notes.push(format!("{count} elements of type {name}: {nearest}"));
        }
        if elements::marks_faces(name) && !section && !deck.dropped.contains_key(name) {
            notes.push(format!("{count} elements of type {name} only mark faces: sets have their nodes"));
        }
    }
    notes.extend(
        deck.dropped
            .iter()
            .map(|(name, count)| format!("{count} elements of type {name} are left out (body.mesh.drop)")),
    );
    for (name, (count, place, kind)) in &deck.not_taken_over {
        let line = place.line.unwrap_or(0);
        let at = format!("{}:{line}", place.file.file_name().unwrap_or_default().to_string_lossy());
        let times = if *count > 1 { format!(" ({count} times)") } else { String::new() };
        notes.push(match kind {
            Kind::Physics(instead) => {
                format!("{at}: *{name}{times} is not taken over; a scene has in its place: {instead}")
            }
            _ => format!("{at}: *{name}{times} is not known and not read"),
        });
    }
    let laws = deck.materials.iter().filter(|m| m.law.is_some() || m.density.is_some()).count();
    if laws > 0 {
        let several = if laws > 1 { format!("{laws} materials are") } else { "the material is".into() };
        notes.push(format!("{several} not taken over: [body.material] and body.density of the scene say what the body is made of"));
    }
    notes
}
