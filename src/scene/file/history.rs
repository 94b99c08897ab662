//! `[[output.history]]`.

use crate::error::Result;
use crate::scene::history::{Format, History, Places, Quantity};
use crate::scene::reader::{Bound, Item};
use crate::scene::units::{FREQUENCY, LENGTH};
use crate::scene::{Method, NodeSet, Stage};

/// Rates that may be asked for [Hz], and the usual one.
const RATES: [f64; 2] = [1e3, 50e3];
const USUAL: f64 = 20e3;

/// All histories of the section.
pub(super) fn histories(item: &Item, stages: &[Stage], has_road: bool) -> Result<Vec<History>> {
    let entries = item.entries()?;
    let histories = entries.iter().map(|e| history(e, stages, has_road)).collect::<Result<Vec<_>>>()?;
    for (k, entry) in entries.iter().enumerate() {
        if histories[..k].iter().any(|h| h.name == histories[k].name) {
            let problem = format!("another history has the name {:?}", histories[k].name);
            return Err(entry
                .table()?
                .at("name")
                .error(problem, "give each a name of its own: it names the file"));
        }
    }
    Ok(histories)
}

fn history(item: &Item, stages: &[Stage], has_road: bool) -> Result<History> {
    let table = item.table()?;
    table.only(&["name", "nodes", "points", "turning", "quantities", "rate", "stages", "formats"], &[])?;
    let name = table.need("name", "\"tread\"")?;
    let text = name.text()?;
    if text.is_empty() || !text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') {
        return Err(name.error(format!("{text:?} is no name of a file"), "write letters, digits, - and _"));
    }
    let rate = table.quantity_or("rate", USUAL, &FREQUENCY, Bound::Positive)?;
    if !(RATES[0]..=RATES[1]).contains(&rate) {
        return Err(table
            .at("rate")
            .error(format!("{rate} Hz is not between 1 and 50 kHz"), "write \"20 kHz\", say"));
    }
    let places = places(&table)?;
    let quantities = match table.get("quantities") {
        Some(item) => list(&item, &Quantity::ALL)?,
        None => vec![Quantity::Velocity],
    };
    if let Some(contact) = quantities.iter().find(|q| q.is_contact()) {
        let at = table.at("quantities");
        if !has_road {
            return Err(at.error(
                format!("there is no {} without a road", contact.name()),
                "add [road], or leave it out",
            ));
        }
        if !matches!(places, Places::Material(_)) {
            let problem = format!("{} belongs to nodes, and these places are between nodes", contact.name());
            return Err(at.error(problem, "write nodes = \"..\" and turning = true, or leave it out"));
        }
    }
    let formats = match table.get("formats") {
        Some(item) => list(&item, &[("npz", Format::Npz), ("uff", Format::Uff)])?,
        None => vec![Format::Npz],
    };
    let named = table.get("stages").map(|item| stage_names(&item, stages)).transpose()?;
    Ok(History { name: text.into(), places, quantities, rate, stages: named, formats })
}

fn places(table: &crate::scene::reader::Table) -> Result<Places> {
    match (table.get("nodes"), table.get("points")) {
        (Some(nodes), None) => {
            let set = NodeSet::read(&nodes)?;
            let turning = table.get("turning").map_or(Ok(true), |item| item.flag())?;
            Ok(if turning { Places::Material(set) } else { Places::Unturned(set) })
        }
        (None, Some(points)) => {
            if let Some(turning) = table.get("turning") {
                return Err(
                    turning.error("points go with the material", "leave it out, or write nodes = \"..\"")
                );
            }
            let all = points
                .entries()?
                .iter()
                .map(|p| p.vector(&LENGTH, Bound::Any))
                .collect::<Result<Vec<_>>>()?;
            match all.is_empty() {
                true => Err(points.error("no point", "write e.g. [[\"0 mm\", \"0 mm\", \"0 mm\"]]")),
                false => Ok(Places::Points(all)),
            }
        }
        (Some(_), Some(points)) => {
            Err(points.error("there are nodes already", "write either nodes or points"))
        }
        (None, None) => {
            Err(table.need("nodes", "\"outer\" (a node set), or points").expect_err("it is not there"))
        }
    }
}

/// Names of a list, each once.
fn list<T: Copy + PartialEq>(item: &Item, options: &[(&str, T)]) -> Result<Vec<T>> {
    let mut all = Vec::new();
    for entry in item.entries()? {
        let value = entry.choice(options, &[])?;
        if all.contains(&value) {
            return Err(entry.error("it is there twice", "remove one"));
        }
        all.push(value);
    }
    match all.is_empty() {
        true => {
            let known: Vec<&str> = options.iter().map(|(name, _)| *name).collect();
            Err(item.error("an empty list", format!("write some of {}", known.join(", "))))
        }
        false => Ok(all),
    }
}

fn stage_names(item: &Item, stages: &[Stage]) -> Result<Vec<String>> {
    let known: Vec<(&str, &Stage)> = stages.iter().map(|s| (s.name.as_str(), s)).collect();
    let one = |entry: &Item| {
        let name = entry.text()?;
        match known.iter().find(|(n, _)| *n == name) {
            Some((_, stage)) if matches!(stage.method, Method::Implicit(_)) => Err(entry.error(
                format!("stage {name:?} is implicit: it has increments, and no steps that an even grid could be made of"),
                "name explicit or quasi-static stages",
            )),
            Some(_) => Ok(name.to_string()),
            None => {
                let names: Vec<&str> = known.iter().map(|(n, _)| *n).collect();
                Err(entry.error(format!("there is no stage {name:?}"), format!("known: {}", names.join(", "))))
            }
        }
    };
    item.entries()?.iter().map(one).collect()
}
