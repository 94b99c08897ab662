//! `--set key=value`: dotted paths into a scene document, array entries by index.

use std::collections::BTreeMap;

use super::document::{self, Node, Value, join};
use crate::error::{Error, Result};

/// Applies one override, e.g. `stage.0.rim.z.displacement=-3 mm` or `body.mesh.elements=[88, 8, 10]`.
///
/// Tables on the way are made where they are missing, so that an optional section can be set; a key that no
/// scene knows is found when the document is read.
pub(super) fn apply(root: &mut Node, text: &str, file: &str) -> Result<()> {
    let fail = |key: &str, problem: String, remedy: &str| Error::Scene {
        file: file.into(),
        line: None,
        key: key.into(),
        problem: format!("{problem} (in --set {text})"),
        remedy: remedy.into(),
    };
    let Some((path, value)) = text.split_once('=') else {
        return Err(fail(
            text,
            "no `=`".into(),
            "write --set key=value, e.g. --set body.density=\"1100 kg/m3\"",
        ));
    };
    let path = path.trim();
    let (mut node, mut walked) = (root, String::new());
    for segment in path.split('.').map(str::trim) {
        if segment.is_empty() {
            return Err(fail(path, "an empty key".into(), "write names with single dots between them"));
        }
        let here = join(&walked, segment);
        node = child(node, segment).map_err(|problem| {
            fail(&here, problem, "name a key of a table, or an entry of an array by its index from 0")
        })?;
        walked = here;
    }
    *node = Node { value: literal(value.trim()), line: None };
    Ok(())
}

/// Entry `segment` of a table (made if missing) or of an array.
fn child<'n>(node: &'n mut Node, segment: &str) -> std::result::Result<&'n mut Node, String> {
    match &mut node.value {
        Value::Table(entries) => Ok(entries
            .entry(segment.into())
            .or_insert_with(|| Node { value: Value::Table(BTreeMap::new()), line: None })),
        Value::Array(items) => {
            let length = items.len();
            (segment.parse::<usize>().ok().and_then(|i| items.get_mut(i)))
                .ok_or_else(|| format!("{segment:?} is not an index into an array of {length}"))
        }
        other => Err(format!("{} has no keys", other.kind())),
    }
}

/// The text as a TOML value; what is not one is a string, so that shells need no second pair of quotes.
fn literal(text: &str) -> Value {
    let clear = |mut node: Node| {
        forget_lines(&mut node);
        node.value
    };
    let parsed = document::parse(&format!("value = {text}"), "").ok().and_then(|document| {
        let Value::Table(mut entries) = document.value else { return None };
        let value = entries.remove("value")?;
        entries.is_empty().then(|| clear(value))
    });
    parsed.unwrap_or_else(|| Value::Text(text.into()))
}

/// Lines of an override are not lines of the file.
fn forget_lines(node: &mut Node) {
    node.line = None;
    match &mut node.value {
        Value::Array(items) => items.iter_mut().for_each(forget_lines),
        Value::Table(entries) => entries.values_mut().for_each(forget_lines),
        _ => {}
    }
}
