//! A scene document as TOML values that remember the line they stand on.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Error, Result};

/// A value and the line of the file it stands on; `None`: it was set on the command line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    pub value: Value,
    pub line: Option<usize>,
}

/// The TOML values a scene uses (dates it does not).
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Bool(bool),
    Array(Vec<Node>),
    Table(BTreeMap<String, Node>),
}

impl Value {
    /// What a message calls such a value.
    pub fn kind(&self) -> &'static str {
        match self {
            Value::Text(_) => "a string",
            Value::Integer(_) => "a whole number",
            Value::Float(_) => "a number",
            Value::Bool(_) => "true or false",
            Value::Array(_) => "an array",
            Value::Table(_) => "a table",
        }
    }
}

/// Parses a TOML document; its syntax errors name file and line.
pub(super) fn parse(text: &str, file: &str) -> Result<Node> {
    let source = Source { text, file };
    let table = DeTable::parse(text).map_err(|e| {
        let remedy = "see https://toml.io for how tables, keys and strings are written";
        source.error(e.span(), "TOML syntax", e.message(), remedy)
    })?;
    Ok(Node { value: source.table(table.get_ref(), "")?, line: Some(1) })
}

/// Dotted path of `key` inside `parent`.
pub(super) fn join(parent: &str, key: impl std::fmt::Display) -> String {
    if parent.is_empty() { key.to_string() } else { format!("{parent}.{key}") }
}

struct Source<'a> {
    text: &'a str,
    file: &'a str,
}

impl Source<'_> {
    fn line(&self, at: usize) -> usize {
        1 + self.text.as_bytes().iter().take(at).filter(|&&b| b == b'\n').count()
    }

    fn error(&self, span: Option<Range<usize>>, key: &str, problem: &str, remedy: &str) -> Error {
        Error::Scene {
            file: self.file.into(),
            line: span.map(|s| self.line(s.start)),
            key: key.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    fn table(&self, table: &DeTable<'_>, path: &str) -> Result<Value> {
        let entry = |(key, value): (&Spanned<_>, &_)| {
            let key: &std::borrow::Cow<'_, str> = key.get_ref();
            Ok((key.to_string(), self.node(value, &join(path, key))?))
        };
        Ok(Value::Table(table.iter().map(entry).collect::<Result<_>>()?))
    }

    fn node(&self, node: &Spanned<DeValue<'_>>, path: &str) -> Result<Node> {
        let fail = |problem, remedy| self.error(Some(node.span()), path, problem, remedy);
        let value = match node.get_ref() {
            DeValue::String(s) => Value::Text(s.to_string()),
            DeValue::Boolean(b) => Value::Bool(*b),
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix())
                .map(Value::Integer)
                .map_err(|_| fail("whole number out of range", "write one that fits 64 bits"))?,
            DeValue::Float(f) => f
                .as_str()
                .parse()
                .map(Value::Float)
                .map_err(|_| fail("not a number", "write it as 1.5 or 1.5e-3"))?,
            DeValue::Datetime(_) => {
                return Err(fail("dates are not used in scenes", "put it in quotes if it is a text"));
            }
            DeValue::Array(items) => Value::Array(
                (items.iter().enumerate())
                    .map(|(i, item)| self.node(item, &join(path, i)))
                    .collect::<Result<_>>()?,
            ),
            DeValue::Table(table) => self.table(table, path)?,
        };
        Ok(Node { value, line: Some(self.line(node.span().start)) })
    }
}

/// The document as canonical TOML: keys sorted, no comments. Two files that say the same give the same text.
pub(super) fn canonical(root: &Node) -> String {
    fn plain(value: &Value) -> toml::Value {
        match value {
            Value::Text(s) => s.clone().into(),
            Value::Integer(i) => (*i).into(),
            Value::Float(f) => (*f).into(),
            Value::Bool(b) => (*b).into(),
            Value::Array(items) => items.iter().map(|i| plain(&i.value)).collect::<Vec<_>>().into(),
            Value::Table(entries) => {
                toml::Table::from_iter(entries.iter().map(|(k, v)| (k.clone(), plain(&v.value)))).into()
            }
        }
    }
    plain(&root.value).as_table().map(|t| t.to_string()).unwrap_or_default()
}
