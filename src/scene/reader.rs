//! A strict walk over a scene document: every value is asked for by name and type, and every complaint names
//! file, line, key, problem and remedy.

use std::collections::BTreeMap;

use super::document::{Node, Value, join};
use super::units::Dimension;
use crate::error::{Error, Result};
pub(super) use crate::physics::parameters::Bound;

/// A value of the document with its dotted key.
#[derive(Debug, Clone)]
pub(super) struct Item<'a> {
    pub file: &'a str,
    pub key: String,
    pub node: &'a Node,
}

/// A table of the document.
#[derive(Debug, Clone)]
pub(super) struct Table<'a> {
    pub item: Item<'a>,
    entries: &'a BTreeMap<String, Node>,
}

/// Something that a scene may name in a later version, and what to do until then.
pub(super) type Later = (&'static str, &'static str);

impl<'a> Item<'a> {
    /// An error at this value; one that came from the command line says so.
    pub fn error(&self, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        let mut problem = problem.into();
        if self.node.line.is_none() {
            problem += " (from --set)";
        }
        Error::Scene {
            file: self.file.into(),
            line: self.node.line,
            key: self.key.clone(),
            problem,
            remedy: remedy.into(),
        }
    }

    /// The error for something that comes in a later version.
    pub fn unsupported(&self, what: &str, instead: &str) -> Error {
        let line = self.node.line.map(|l| format!(":{l}")).unwrap_or_default();
        Error::Unsupported {
            what: format!("{}{line}: {}: {what}", self.file, self.key),
            instead: instead.into(),
        }
    }

    fn expected(&self, wanted: &str, remedy: impl Into<String>) -> Error {
        self.error(format!("{wanted} is expected here, not {}", self.node.value.kind()), remedy)
    }

    pub fn text(&self) -> Result<&'a str> {
        match &self.node.value {
            Value::Text(s) => Ok(s),
            _ => Err(self.expected("a string", "put the text in quotes")),
        }
    }

    /// A number without a unit.
    pub fn number(&self, bound: Bound) -> Result<f64> {
        let value = match self.node.value {
            Value::Float(v) => v,
            Value::Integer(v) => v as f64,
            _ => return Err(self.expected("a number without a unit", "write it without quotes, e.g. 0.9")),
        };
        if !value.is_finite() {
            return Err(self.error(format!("{value} is not a finite number"), "write a finite number"));
        }
        self.bounded(value, bound, &value.to_string())
    }

    /// A whole number of at least `least`.
    pub fn count(&self, least: usize, why: &str) -> Result<usize> {
        let Value::Integer(value) = self.node.value else {
            return Err(self.expected("a whole number", "write it without quotes or decimal point, e.g. 4"));
        };
        let enough = usize::try_from(value).ok().filter(|&n| n >= least);
        enough.ok_or_else(|| self.error(format!("{value} is too few"), format!("at least {least} {why}")))
    }

    pub fn flag(&self) -> Result<bool> {
        match self.node.value {
            Value::Bool(value) => Ok(value),
            _ => Err(self.expected("true or false", "write it without quotes")),
        }
    }

    /// A quantity with a unit, in SI.
    pub fn quantity(&self, dimension: &Dimension, bound: Bound) -> Result<f64> {
        let text = match &self.node.value {
            Value::Text(s) => s,
            Value::Integer(v) => return Err(self.bare(v, dimension)),
            Value::Float(v) => return Err(self.bare(v, dimension)),
            _ => return Err(self.expected(dimension.noun, dimension.remedy())),
        };
        let value = dimension.parse(text).map_err(|problem| self.error(problem, dimension.remedy()))?;
        self.bounded(value, bound, &format!("{text:?}"))
    }

    fn bare(&self, value: &impl std::fmt::Display, dimension: &Dimension) -> Error {
        self.error(format!("the number {value} has no unit"), dimension.remedy())
    }

    fn bounded(&self, value: f64, bound: Bound, shown: &str) -> Result<f64> {
        match bound {
            Bound::Positive if value <= 0.0 => {
                Err(self.error(format!("{shown} is not positive"), "write a value greater than zero"))
            }
            Bound::NotNegative if value < 0.0 => {
                Err(self.error(format!("{shown} is negative"), "write zero or a positive value"))
            }
            _ => Ok(value),
        }
    }

    /// Entries of an array.
    pub fn entries(&self) -> Result<Vec<Item<'a>>> {
        let Value::Array(items) = &self.node.value else {
            return Err(self.expected("an array", "write it in square brackets"));
        };
        let item = |(i, node)| Item { file: self.file, key: join(&self.key, i), node };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// Entries of an array of three; `example` shows one.
    pub fn three<T>(&self, example: &str, read: impl Fn(&Item<'a>) -> Result<T>) -> Result<[T; 3]> {
        let items = self.entries()?;
        let values = items.iter().map(read).collect::<Result<Vec<T>>>()?;
        values.try_into().map_err(|given: Vec<T>| {
            self.error(format!("{} entries where 3 are needed", given.len()), format!("write e.g. {example}"))
        })
    }

    /// Three quantities of one dimension, in SI.
    pub fn vector(&self, dimension: &Dimension, bound: Bound) -> Result<[f64; 3]> {
        let e = dimension.example;
        self.three(&format!("[\"{e}\", \"{e}\", \"{e}\"]"), |item| item.quantity(dimension, bound))
    }

    /// One of a few names; `later` are those of later versions.
    pub fn choice<T: Clone>(&self, options: &[(&str, T)], later: &[Later]) -> Result<T> {
        let name = self.text()?;
        if let Some((_, value)) = options.iter().find(|o| o.0 == name) {
            return Ok(value.clone());
        }
        if let Some((_, instead)) = later.iter().find(|l| l.0 == name) {
            return Err(self.unsupported(&format!("{name:?}"), instead));
        }
        let names: Vec<_> = options.iter().map(|o| o.0).collect();
        Err(self.error(format!("{name:?} is not known here"), one_of(name, &names)))
    }

    pub fn table(&self) -> Result<Table<'a>> {
        match &self.node.value {
            Value::Table(entries) => Ok(Table { item: self.clone(), entries }),
            _ => Err(self.expected("a table", format!("write [{}] or {{ key = value }}", self.key))),
        }
    }
}

impl<'a> Table<'a> {
    /// Refuses every key that is not in `allowed`; those of `later` come in a later version.
    pub fn only(&self, allowed: &[&str], later: &[Later]) -> Result<()> {
        let Some(key) = self.entries.keys().find(|k| !allowed.contains(&k.as_str())) else { return Ok(()) };
        let item = self.item(key, &self.entries[key]);
        match later.iter().find(|l| l.0 == key) {
            Some((_, instead)) => Err(item.unsupported("this key", instead)),
            None => Err(item.error("unknown key", one_of(key, allowed))),
        }
    }

    fn item(&self, key: &str, node: &'a Node) -> Item<'a> {
        Item { file: self.item.file, key: join(&self.item.key, key), node }
    }

    pub fn get(&self, key: &str) -> Option<Item<'a>> {
        self.entries.get(key).map(|node| self.item(key, node))
    }

    /// Where `key` is, or would be: for messages.
    pub fn at(&self, key: &str) -> Item<'a> {
        self.get(key).unwrap_or_else(|| self.item(key, self.item.node))
    }

    /// A key that must be there; `example` is a value that would be right, as TOML.
    pub fn need(&self, key: &str, example: &str) -> Result<Item<'a>> {
        self.get(key).ok_or_else(|| self.at(key).error("missing", format!("add {key} = {example}")))
    }

    /// A section that must be there, as its header is written.
    pub fn section(&self, key: &str, header: &str) -> Result<Item<'a>> {
        self.get(key).ok_or_else(|| self.at(key).error("missing", format!("add a section {header}")))
    }

    /// A required quantity in SI.
    pub fn quantity(&self, key: &str, dimension: &Dimension, bound: Bound) -> Result<f64> {
        self.need(key, &format!("\"{}\"", dimension.example))?.quantity(dimension, bound)
    }

    /// An optional quantity in SI.
    pub fn quantity_or(&self, key: &str, default: f64, dimension: &Dimension, bound: Bound) -> Result<f64> {
        self.get(key).map_or(Ok(default), |item| item.quantity(dimension, bound))
    }

    /// An optional number without a unit.
    pub fn number_or(&self, key: &str, default: f64, bound: Bound) -> Result<f64> {
        self.get(key).map_or(Ok(default), |item| item.number(bound))
    }

    /// Three optional quantities in SI, zero by default.
    pub fn vector_or_zero(&self, key: &str, dimension: &Dimension) -> Result<[f64; 3]> {
        self.get(key).map_or(Ok([0.0; 3]), |item| item.vector(dimension, Bound::Any))
    }
}

/// "did you mean ...? one of ...": the nearest name first, if one is near.
pub(super) fn one_of(given: &str, names: &[&str]) -> String {
    let near = names.iter().map(|n| (strsim::normalized_damerau_levenshtein(given, n), n));
    let best = near.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|b| b.0 > 0.5);
    let hint = best.map(|(_, name)| format!("did you mean {name}? ")).unwrap_or_default();
    format!("{hint}known here: {}", names.join(", "))
}
