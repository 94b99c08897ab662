//! From an entry point to everything it reaches: each name is given by exactly one of the parts at hand.

use super::scan::{Declaration, scan};
use std::collections::{BTreeMap, BTreeSet};

/// A file of WGSL, or a text that stands for one.
#[derive(Debug, Clone)]
pub struct Part {
    /// Path below `shaders/` without its ending.
    pub name: String,
    /// What the file says before its first declaration.
    pub head: String,
    pub gives: Vec<Declaration>,
}

impl Part {
    /// # Errors
    /// [`Fault::Unreadable`].
    pub fn new(name: &str, text: &str) -> Result<Part, Fault> {
        let unreadable = |why| Fault::Unreadable { part: name.into(), why };
        let (head, gives) = scan(text).map_err(unreadable)?;
        Ok(Part { name: name.into(), head: head.into(), gives })
    }
}

/// What is wrong with a set of parts.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    #[error("shaders/{part}.wgsl: {why}")]
    Unreadable { part: String, why: String },
    #[error("there is no shaders/{0}.wgsl")]
    NoPart(String),
    #[error("shaders/{part}.wgsl has no entry point `main`")]
    NoEntry { part: String },
    #[error("shaders/{part}.wgsl needs `{name}` (in `{used_in}`), which no part of this program gives")]
    Missing { part: String, used_in: String, name: String },
    #[error("shaders/{first}.wgsl and shaders/{second}.wgsl both give `{name}`")]
    Twice { name: String, first: String, second: String },
}

/// A part with those of its declarations that are reached, in their order.
pub type Reached<'p> = (&'p Part, Vec<&'p Declaration>);

/// What the entry point `main` of `entry` reaches among its own declarations and those of `others`, in that order; `known`:
/// names that the language gives.
///
/// # Errors
/// A name that two parts give, or that none does.
pub fn close<'p>(
    entry: &'p Part,
    others: &[&'p Part],
    known: impl Fn(&str) -> bool,
) -> Result<Vec<Reached<'p>>, Fault> {
    let parts: Vec<&Part> = std::iter::once(entry).chain(others.iter().copied()).collect();
    let mut by_name: BTreeMap<&str, (&Part, &Declaration)> = BTreeMap::new();
    for part in &parts {
        for declaration in &part.gives {
            if let Some((first, _)) = by_name.insert(&declaration.name, (part, declaration)) {
                let name = declaration.name.clone();
                return Err(Fault::Twice { name, first: first.name.clone(), second: part.name.clone() });
            }
        }
    }
    if !entry.gives.iter().any(|d| d.name == "main") {
        return Err(Fault::NoEntry { part: entry.name.clone() });
    }
    let mut reached = BTreeSet::from(["main"]);
    let mut open = vec!["main"];
    while let Some(name) = open.pop() {
        let (part, declaration) = by_name[name];
        for need in &declaration.needs {
            match by_name.get_key_value(need.as_str()) {
                Some((need, _)) => {
                    if reached.insert(need) {
                        open.push(need);
                    }
                }
                None if known(need) => {}
                None => {
                    return Err(Fault::Missing {
                        part: part.name.clone(),
                        used_in: name.into(),
                        name: need.clone(),
                    });
                }
            }
        }
    }
    let of_part = |part: &&'p Part| {
        let own = part.gives.iter().filter(|d| reached.contains(d.name.as_str())).collect();
        (*part, own)
    };
    Ok(parts.iter().map(of_part).filter(|(_, own): &Reached| !own.is_empty()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(name: &str, text: &str) -> Part {
        Part::new(name, text).unwrap()
    }

    fn known(name: &str) -> bool {
        ["fn", "return", "u32", "compute", "workgroup_size"].contains(&name)
    }

    #[test]
    fn only_what_the_entry_reaches_is_taken() {
        let entry = part("kernels/k", "fn main() { a(); }");
        let lib = part("lib/l", "fn a() { b(); }\nfn b() {}\nfn unused() { missing(); }");
        let idle = part("lib/idle", "fn c() {}");
        let reached = close(&entry, &[&lib, &idle], known).unwrap();
        let names: Vec<Vec<&str>> =
            reached.iter().map(|(_, own)| own.iter().map(|d| d.name.as_str()).collect()).collect();
        assert_eq!(names, [vec!["main"], vec!["a", "b"]]);
    }

    #[test]
    fn a_missing_name_is_named_with_the_part_that_needs_it() {
        let entry = part("kernels/k", "fn main() { a(); }");
        let lib = part("lib/l", "fn a() { road_gap(); }");
        let fault = close(&entry, &[&lib], known).unwrap_err();
        let text = fault.to_string();
        assert!(text.contains("shaders/lib/l.wgsl") && text.contains("`road_gap`"), "{text}");
    }

    #[test]
    fn two_parts_that_give_the_same_name_are_both_named() {
        let entry = part("kernels/k", "fn main() { a(); }");
        let (one, two) = (part("road/plane", "fn a() {}"), part("road/drum", "fn a() {}"));
        let text = close(&entry, &[&one, &two], known).unwrap_err().to_string();
        assert!(text.contains("road/plane") && text.contains("road/drum") && text.contains("`a`"), "{text}");
    }

    #[test]
    fn a_program_without_an_entry_point_is_an_error() {
        let entry = part("kernels/k", "fn other() {}");
        assert_eq!(close(&entry, &[], known).unwrap_err(), Fault::NoEntry { part: "kernels/k".into() });
    }
}
