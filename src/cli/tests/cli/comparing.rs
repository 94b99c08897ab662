//! `hexroll compare`.

use serde_json::Value;

use super::program::Place;

/// Every number under a key of this name, anywhere.
fn numbers(value: &Value, key: &str, found: &mut Vec<Option<f64>>) {
    match value {
        Value::Object(entries) => entries.iter().for_each(|(name, v)| match v {
            Value::Number(_) | Value::Null if name == key => found.push(v.as_f64()),
            _ => numbers(v, key, found),
        }),
        Value::Array(items) => items.iter().for_each(|v| numbers(v, key, found)),
        _ => {}
    }
}

fn errors(place: &Place, a: &str, b: &str) -> Vec<f64> {
    let done = place.hexroll(&["compare", a, b, "--json"]).expect(0);
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    let mut found = Vec::new();
    numbers(&json, "max_difference", &mut found);
    found.into_iter().map(|v| v.expect("a number")).collect()
}

#[test]
fn a_run_is_the_same_as_itself_and_other_than_another() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    for (out, mu) in [("a", "0.5"), ("b", "0.1")] {
        let set = format!("friction.coefficient={mu}");
        place.hexroll(&["run", "block.toml", "--engine", "cpu", "--out", out, "--set", &set]).expect(0);
    }
    let same = errors(&place, "a", "a");
    // 29 columns and two snapshots of fields.
    assert!(same.len() > 40 && same.iter().all(|e| *e == 0.0), "{same:?}");
    let other = errors(&place, "a", "b");
    assert!(other.iter().any(|e| *e > 0.0));
    let text = place.hexroll(&["compare", "a", "b"]).expect(0).stdout;
    for part in ["scene_hash", "road_fx_N", "von_mises", "10 matched rows"] {
        assert!(text.contains(part), "{part:?} is missing in\n{text}");
    }
}
