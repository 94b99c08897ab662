//! The source keeps to what ARCHITECTURE.md says: folders import one way, circles of files are small and within one
//! folder, and every path that it names exists.

mod graph;
mod page;
mod rules;
mod source;

use std::collections::BTreeSet;
use std::path::Path;

use graph::circles;
use source::{Import, Sources};

fn imports() -> BTreeSet<Import> {
    Sources::of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src")).imports()
}

/// The folder at the top that a file is in: `run` of `run/mod.rs`, `engine` of `engine.rs`.
fn top(path: &str) -> &str {
    path.split('/').next().unwrap_or(path).trim_end_matches(".rs")
}

/// The folder that a file is in: `model/mesh` of `model/mesh/ring.rs`.
fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

#[test]
fn folders_import_one_way() {
    let imports = imports();
    let allowed = |i: &&Import| match i.in_tests {
        true => rules::RIGS.iter().any(|(to, _)| *to == i.to),
        false => rules::FOLDERS.iter().any(|(from, to, _)| (top(&i.from), top(&i.to)) == (*from, *to)),
    };
    let edges = imports.iter().filter(|i| !allowed(i)).map(|i| (top(&i.from), top(&i.to)));
    let found = circles(&edges.filter(|(a, b)| a != b).collect());
    let within = |i: &&Import| {
        let both = |group: &BTreeSet<&str>| group.contains(top(&i.from)) && group.contains(top(&i.to));
        top(&i.from) != top(&i.to) && found.iter().any(both)
    };
    let list: Vec<_> = imports.iter().filter(within).map(|i| format!("{} -> {}", i.from, i.to)).collect();
    assert!(found.is_empty(), "folders in a circle: {found:?}\n{}", list.join("\n"));
}

#[test]
fn circles_of_files_are_small_and_within_one_folder() {
    let imports = imports();
    let edges = imports.iter().filter(|i| !i.in_tests).map(|i| (i.from.as_str(), i.to.as_str())).collect();
    for circle in circles(&edges) {
        if rules::CIRCLES.iter().any(|(place, _)| circle.iter().all(|file| file.starts_with(place))) {
            continue;
        }
        let folders: BTreeSet<&str> = circle.iter().map(|file| folder(file)).collect();
        assert!(folders.len() == 1, "a circle of files across folders: {circle:?}");
        assert!(circle.len() <= rules::LARGEST_CIRCLE, "a circle of {} files: {circle:?}", circle.len());
    }
}

#[test]
fn every_path_that_the_architecture_names_exists() {
    let missing = page::missing(Path::new(env!("CARGO_MANIFEST_DIR")));
    assert!(missing.is_empty(), "ARCHITECTURE.md names what is not there: {missing:#?}");
}

/// The reader of imports sees them where they are, in every form that the source uses.
#[test]
fn imports_are_found_in_every_form() {
    let imports = imports();
    let has = |from: &str, to: &str| imports.iter().any(|i| i.from == from && i.to == to && !i.in_tests);
    assert!(has("run/stages.rs", "run/state.rs"), "use super::state::Run");
    assert!(has("run/explicit.rs", "run/footprint.rs"), "use super::footprint::{{self, ..}}");
    assert!(has("output/rolling.rs", "model/areas.rs"), "use crate::model::areas::..");
    assert!(has("cli/lib.rs", "cli/run.rs"), "run::execute without a use");
    assert!(has("cli/run.rs", "output/writer.rs"), "use hexroll::output::RunWriter, handed on by output");
    assert!(imports.iter().any(|i| i.from.starts_with("cli/") && i.to.starts_with("lab/")), "hexroll_lab");
    assert!(imports.iter().any(|i| i.from.starts_with("cpu/") && i.to.starts_with("kernels/")), "crates");
    assert!(has("physics/element/hex8.rs", "physics/element/mod.rs"), "super::SIGNS in an expression");
    assert!(has("render/body.rs", "model/mesh/mod.rs"), "through a folder's mod.rs");
    assert!(!has("run/mod.rs", "run/stages.rs"), "pub use hands on and imports nothing");
    assert!(imports.len() > 500, "{} imports", imports.len());
}

#[test]
fn circles_are_found() {
    let edges =
        [("a", "b"), ("b", "c"), ("c", "a"), ("c", "d"), ("d", "e"), ("f", "a")].into_iter().collect();
    assert_eq!(circles(&edges), [BTreeSet::from(["a", "b", "c"])]);
}
