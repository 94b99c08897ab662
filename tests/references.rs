//! The paper's wheel has its numbers in one place, `src/lab/rig/references.toml`.
//!
//! Scenes, README and docs are read by people, so they repeat some of them. Requirement: what they repeat is what the file
//! says, digit by digit, and no source file repeats any. Changing a number in the file fails here until the texts that state
//! it have changed too.

use hexroll_lab::rig::given;
use hexroll_lab::rig::references::{self, Reference, reference, series};
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// A number of a text, what stands before it and after it up to the next blank.
#[derive(Debug)]
struct Token<'t> {
    number: &'t str,
    before: &'t str,
    after: &'t str,
}

/// Numbers of a text: digits with a point, a sign in front, an exponent behind; not within a word (`44x4x5`, `f64`).
fn numbers(text: &str) -> Vec<Token<'_>> {
    let bytes = text.as_bytes();
    let digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        if !digit(at) {
            at += 1;
            continue;
        }
        let word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_' || *b == b'.';
        let signed = at > 0 && bytes[at - 1] == b'-' && !(at > 1 && word(&bytes[at - 2]));
        let start = if signed { at - 1 } else { at };
        let inside = start > 0 && word(&bytes[start - 1]);
        let mut end = at;
        while digit(end) || (bytes.get(end) == Some(&b'.') && digit(end + 1)) {
            end += 1;
        }
        let exponent = end + 1 + usize::from(bytes.get(end + 1) == Some(&b'-'));
        if bytes.get(end) == Some(&b'e') && digit(exponent) {
            end = exponent;
            while digit(end) {
                end += 1;
            }
        }
        if !inside && !bytes.get(end).is_some_and(u8::is_ascii_alphabetic) {
            found.push(Token { number: &text[start..end], before: &text[..start], after: &text[end..] });
        }
        at = end;
    }
    found
}

/// The number of a reference as it is written.
fn digits(reference: &Reference) -> &str {
    reference.text.split(' ').next().unwrap()
}

/// Whether a number has three significant digits or more, a point, and does not end in zero: then it stands for one thing.
fn is_distinctive(number: &str) -> bool {
    let mantissa = number.split('e').next().unwrap();
    let significant =
        mantissa.trim_start_matches(['-', '0', '.']).chars().filter(char::is_ascii_digit).count();
    significant >= 3 && !number.ends_with(".0") && mantissa.contains('.')
}

/// All `.rs` files of the tree's own folders.
fn sources() -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders: Vec<PathBuf> = ["src", "tests", "benches"].map(|f| root().join(f)).into();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                files.push(path);
            }
        }
    }
    files
}

#[test]
fn no_source_file_repeats_a_reference() {
    let known: Vec<&str> = references::all().map(digits).filter(|n| is_distinctive(n)).collect();
    assert!(known.len() > 60, "{} numbers that are looked for", known.len());
    for file in sources() {
        if file.ends_with("src/lab/rig/references.rs") || file.ends_with("tests/references.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap().replace('_', "");
        for token in numbers(&text) {
            let plain = token.number.trim_start_matches('-');
            let repeated = known.iter().any(|k| k.trim_start_matches('-') == plain);
            let line = token.before.lines().count();
            assert!(!repeated, "{}:{line}: {} is in references.toml", file.display(), token.number);
        }
    }
}

/// Words of the texts for columns of the references.
const WORDS: [(&str, &str); 12] = [
    ("Fx", "road_fx"),
    ("Fy", "road_fy"),
    ("Fz", "road_fz"),
    ("Mx", "rim_mx"),
    ("My", "rim_my"),
    ("Mz", "rim_mz"),
    ("road_fx", "road_fx"),
    ("road_fy", "road_fy"),
    ("road_fz", "road_fz"),
    ("rim_mx", "rim_mx"),
    ("rim_my", "rim_my"),
    ("rim_mz", "rim_mz"),
];

/// The column that a number is said to be of: the word in front of it.
fn column_of(token: &Token<'_>) -> Option<&'static str> {
    let before = token.before.trim_end().trim_end_matches(" =").trim_end_matches('|');
    let word = before.rsplit(|c: char| c.is_whitespace() || ['|', '`', '"'].contains(&c)).next()?;
    WORDS.iter().find(|(said, _)| *said == word).map(|(_, column)| *column)
}

/// Asserts that every number of a text with a column's name in front is that of `run`; returns the columns found.
fn assert_columns(place: &str, said: &str, run: &str) -> Vec<&'static str> {
    let mut found = Vec::new();
    for token in numbers(said) {
        let Some(column) = column_of(&token) else { continue };
        // "road_fy between -130 and -160 N", "road_fx within 0.5 N of 0".
        let expected = digits(reference(&format!("{run}.{column}")));
        assert_eq!(token.number, expected, "{place}: {column} of {run}");
        found.push(column);
    }
    found
}

/// What stands behind `# Expected:` at the top of a scene, and its `expected`.
fn expectations(stem: &str) -> [String; 2] {
    let file = text(&format!("scenes/{stem}.toml"));
    let head: Vec<&str> = file.lines().take_while(|l| l.starts_with('#')).collect();
    let from = head.iter().position(|l| l.starts_with("# Expected:")).unwrap_or_else(|| panic!("{stem}"));
    let head: Vec<&str> = head[from..].iter().map(|l| l.trim_start_matches('#').trim()).collect();
    let expected =
        file.lines().find_map(|l| l.strip_prefix("expected = ")).unwrap_or_else(|| panic!("{stem}"));
    [head.join(" "), expected.to_string()]
}

/// Scenes that are a run of the references state its means and its tolerance, at their top and in `expected`; the former
/// may state other runs' numbers too, those of finer meshes by name.
#[test]
fn scenes_expect_what_the_references_say() {
    let mut checked = 0;
    for (name, run) in references::runs() {
        for stem in &run.scenes {
            for said in expectations(stem) {
                let first = said.split("elements:").next().unwrap();
                let found = assert_columns(stem, first, name);
                assert!(!found.is_empty() || name == "free", "{stem} states no force: {said}");
                let percent = first.split("within ").find_map(|s| s.split_once(" %").map(|(n, _)| n));
                if let Some(percent) = percent.filter(|p| p.parse::<f64>().is_ok())
                    && !stem.ends_with("_implicit")
                {
                    assert_eq!(format!("{percent} %"), run.tolerance, "{stem}");
                }
                checked += 1;
            }
        }
    }
    assert!(checked >= 18, "{checked} texts");
    let states = |stem: &str, names: &[&str]| {
        let [head, expected] = expectations(stem);
        for name in names {
            let number = &reference(name).text;
            assert!(
                head.contains(number) || expected.contains(number),
                "{stem} does not state {name}: {number}"
            );
        }
    };
    states("lat100_free_rolling", &["free.spin", "free.free_rolling_radius", "free.road_fz"]);
    states("lat100_free_rolling", &["free-7040.spin", "free-7040.free_rolling_radius", "free-7040.road_fz"]);
    states("lat100_slip5_viscous", &["slip5-viscous-7040.road_fx", "slip5-viscous-7040.road_fy"]);
    states("lat100_slip5_viscous", &["slip5-viscous-7040.road_fz"]);
    for stem in ["lat100_straight_viscous", "lat100_straight_relaxed", "lat100_straight_implicit"] {
        let run = "straight-viscous-7040";
        states(
            stem,
            &["road_fx", "road_fz", "rim_my"].map(|q| format!("{run}.{q}")).each_ref().map(|n| n.as_str()),
        );
    }
    for stem in ["lat100_static", "lat100_static_height", "lat100_static_relaxed"] {
        states(stem, &["pressed-q1p0-frictionless.road_fz", "pressed-quadratic.road_fz"]);
        states(stem, &["pressed-quadratic-frictionless.road_fz"]);
    }
    let nodes = format!("{} nodes in contact", reference("pressed-q1p0.contact_nodes").text);
    assert!(expectations("lat100_static_height").iter().all(|said| said.contains(&nodes)), "{nodes}");
}

/// Numbers in the "expected" columns of a file's tables about the wheel: those with a decimal point, tolerances
/// and percentages left out.
fn expected_numbers(file: &str, sections: &[&str]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let (mut column, mut section) = (None, String::new());
    for line in text(file).lines() {
        if let Some(title) = line.strip_prefix("##") {
            section = title.trim_start_matches('#').trim().into();
        }
        if !line.starts_with('|') {
            column = None;
            continue;
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        if column.is_none() {
            column = Some(cells.iter().position(|c| *c == "expected"));
        }
        let wanted = sections.is_empty() || sections.iter().any(|s| section.starts_with(s));
        let Some(Some(cell)) = column.filter(|_| wanted).map(|c| c.and_then(|c| cells.get(c))) else {
            continue;
        };
        for token in numbers(cell) {
            let tolerance =
                ["within ", "below ", "< ", "<= ", ">= "].iter().any(|w| token.before.ends_with(w));
            if token.number.contains('.') && !tolerance && !token.after.starts_with(" %") {
                found.push((line.to_string(), token.number.to_string()));
            }
        }
    }
    found
}

#[test]
fn tables_of_the_docs_expect_what_the_references_say() {
    let mut known: Vec<f64> = references::all().map(|r| digits(r).parse().unwrap()).collect();
    // Depth and height of the axle [mm].
    known.extend([1e3 * given::DEPTH, 1e3 * (given::OUTER_RADIUS - given::DEPTH)]);
    let [fx, fz] = ["road_fx", "road_fz"].map(|q| reference(&format!("straight-openradioss.{q}")).value);
    for (file, sections, least) in [
        ("README.md", &[][..], 5),
        ("docs/results.md", &[], 18),
        ("docs/convergence.md", &[], 20),
        ("docs/implicit.md", &["Measured: the wheel"], 14),
        ("docs/verification.md", &["The paper's wheel", "The pressed wheel"], 24),
    ] {
        let numbers = expected_numbers(file, sections);
        assert!(numbers.len() >= least, "{file} expects {} numbers", numbers.len());
        for (line, number) in numbers {
            let value: f64 = number.parse().unwrap();
            let ratio = (value - fx / fz).abs() < 5e-5;
            assert!(
                ratio || known.iter().any(|k| (k - value).abs() < 1e-9 * k.abs()),
                "{file}: {number} in {line}"
            );
        }
    }
}

/// Rows of the results that name a scene give its own run's values.
#[test]
fn rows_of_a_scene_expect_its_own_run() {
    let mut checked = 0;
    for (name, run) in references::runs().filter(|(name, _)| *name != "free") {
        for stem in &run.scenes {
            let begins = format!("| `{stem}` | ");
            for line in text("docs/results.md").lines().filter(|l| l.starts_with(&begins)) {
                let cell = line[begins.len()..].split('|').next().unwrap();
                checked += assert_columns("docs/results.md", cell, name).len();
            }
        }
    }
    assert!(checked >= 15, "{checked} numbers in rows of scenes");
}

/// Prose that cites a number.
#[test]
fn prose_cites_the_references() {
    for (file, names) in [
        ("docs/results.md", &["pressed-quadratic.road_fz", "pressed-quadratic-frictionless.road_fz"][..]),
        (
            "docs/results.md",
            &["straight-openradioss.road_fx", "straight-openradioss.road_fz", "straight-openradioss.rim_my"],
        ),
        (
            "docs/results.md",
            &["pressed-q1p0.road_fz", "pressed-q1p0-frictionless.road_fz", "pressed-full.road_fz"],
        ),
        ("docs/results.md", &["pressed-uniform-gradient.road_fz", "pressed-paper.road_fz"]),
        ("docs/convergence.md", &["straight-viscous-settled.road_fx", "free.free_rolling_radius"]),
        (
            "docs/convergence.md",
            &["free-7040.free_rolling_radius", "straight-elastic.road_fz", "slip45-elastic.road_fy"],
        ),
        ("docs/convergence.md", &["pressed-q1p0-7040.road_fz", "pressed-q1p0-23760.road_fz"]),
        ("docs/implicit.md", &["pressed-q1p0.road_fz", "pressed-q1p0-frictionless.road_fz"]),
    ] {
        let said = text(file);
        for name in names {
            let number = digits(reference(name));
            assert!(said.contains(number), "{file} does not state {name}: {number}");
        }
    }
}

/// Every run of the file is used by a test, a report or a scene.
#[test]
fn every_reference_is_used() {
    let files: Vec<String> = sources().iter().map(|f| std::fs::read_to_string(f).unwrap()).collect();
    for (name, run) in references::runs() {
        let used = files.iter().any(|text| text.contains(&format!("\"{name}")));
        assert!(used || !run.scenes.is_empty(), "nothing uses {name}");
    }
    assert_eq!(series("straight-elastic.road_fx_bins").len(), 6);
}

#[test]
fn numbers_are_found_in_text() {
    let found = |text| numbers(text).into_iter().map(|t| t.number.to_string()).collect::<Vec<_>>();
    assert_eq!(found("road_fy -142.7 N, 1.395e-5 s; 2-core."), ["-142.7", "1.395e-5", "2"]);
    assert_eq!(found("44x4x5 f64 (306.2) v1.2"), ["306.2"]);
    assert!(is_distinctive("119.6") && is_distinctive("-4.64"));
    assert!(!is_distinctive("300.0") && !is_distinctive("0.17"));
}
