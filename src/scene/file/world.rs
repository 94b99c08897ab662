//! `[rim]`, `[[hold]]`, `[friction]`.

use super::parameters;
use crate::error::Result;
use crate::scene::reader::{Item, Later};
use crate::scene::{Friction, Hold, NodeSet, Rim, Road, SetMotion};

const LATER_FRICTION: [Later; 1] =
    [("table", "use law = \"coulomb\", \"viscous\", \"stribeck\" or \"pressure-velocity\"")];

pub(super) fn rim(item: &Item) -> Result<Rim> {
    let table = item.table()?;
    table.only(&["nodes"], &[])?;
    Ok(Rim { nodes: NodeSet::read(&table.need("nodes", "\"inner\"")?)? })
}

/// Every `[[hold]]`.
pub(super) fn holds(item: &Item) -> Result<Vec<Hold>> {
    item.entries()?.iter().map(hold).collect()
}

fn hold(item: &Item) -> Result<Hold> {
    let table = item.table()?;
    table.only(&["nodes", "components", "reaction"], &[])?;
    let nodes = NodeSet::read(&table.need("nodes", "\"y-min\"")?)?;
    let item = table.need("components", "\"y\"")?;
    let text = item.text()?;
    let components = ['x', 'y', 'z'].map(|c| text.contains(c));
    if text.is_empty() || !text.chars().all(|c| ('x'..='z').contains(&c)) {
        return Err(item.error(format!("{text:?} names no components"), "write some of x, y, z, e.g. \"xy\""));
    }
    let reaction = table.get("reaction").map_or(Ok(false), |item| item.choice(&[("recorded", true)], &[]))?;
    Ok(Hold { nodes, components, reaction })
}

/// The road, which acts on whole vectors, must not push a held component.
pub(super) fn check_holds(item: &Item, holds: &[Hold], road: Option<&Road>) -> Result<()> {
    check_fixed(item, holds.iter().map(|hold| hold.components), road, "held")
}

/// The same of components that follow a motion.
pub(super) fn check_motions(item: &Item, motions: &[SetMotion], road: Option<&Road>) -> Result<()> {
    check_fixed(item, motions.iter().map(SetMotion::prescribed), road, "moved")
}

fn check_fixed(
    item: &Item,
    fixed: impl Iterator<Item = [bool; 3]>,
    road: Option<&Road>,
    how: &str,
) -> Result<()> {
    let Some(road) = road else { return Ok(()) };
    for (components, entry) in fixed.zip(item.entries()?) {
        for (d, name) in ["x", "y", "z"].into_iter().enumerate().filter(|(d, _)| components[*d]) {
            let Some(what) = road.acts_along(d) else { continue };
            let problem = format!("{what} along the {how} component {name}");
            return Err(entry.error(problem, "take another component, or hold these nodes with [rim]"));
        }
    }
    Ok(())
}

/// `None` for mu = 0: a frictionless scene has no friction code.
pub(super) fn friction(item: &Item, has_road: bool) -> Result<Option<Friction>> {
    let table = item.table()?;
    let names: Vec<_> = Friction::KINDS.iter().map(|kind| (kind.name, kind)).collect();
    let kind = table.get("law").map_or(Ok(&Friction::KINDS[0]), |law| law.choice(&names, &LATER_FRICTION))?;
    let keys: Vec<_> = std::iter::once("law").chain(kind.parameters.iter().map(|p| p.key)).collect();
    table.only(&keys, &[])?;
    let values = parameters::read(&table, kind.parameters, &[])?;
    let law = (kind.from_values)(&values).map_err(|fault| parameters::error(&table, fault))?;
    if !has_road {
        return Err(item.error("friction without a road", "add a section [road], or remove [friction]"));
    }
    Ok(law)
}
