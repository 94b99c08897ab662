//! What a source file imports: paths of `use` trees and of names written out in code, resolved to files.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A file of the crate.
#[derive(Debug, Clone)]
pub struct Source {
    /// Below `src`, e.g. `run/mod.rs`.
    pub path: String,
    /// The module it is, e.g. `["run"]`.
    pub module: Vec<String>,
    /// The crate that it belongs to: `["physics"]` below `physics/lib.rs`, else the root.
    root: Vec<String>,
    /// Its text without comments, product and unit tests.
    product: String,
    tests: String,
}

/// All files of the crate by module.
pub struct Sources {
    files: BTreeMap<Vec<String>, Source>,
    /// Where the crates of this repository are, by the names that code has for them.
    crates: BTreeMap<String, Vec<String>>,
    /// Names that a module hands on from elsewhere: `pub use`.
    facades: BTreeMap<Vec<String>, BTreeMap<String, Vec<String>>>,
}

/// An import: from one file to another.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Import {
    pub from: String,
    pub to: String,
    /// Whether only unit tests have it.
    pub in_tests: bool,
}

impl Sources {
    pub fn of(root: &Path) -> Sources {
        let mut paths = Vec::new();
        walk(root, &mut paths);
        let mut files = BTreeMap::new();
        for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
            let name = path.strip_prefix(root).expect("it is below").to_string_lossy().into_owned();
            let text = without_comments(&fs::read_to_string(path).expect("it can be read"));
            let (product, tests) = match text.find("#[cfg(test)]\nmod ") {
                Some(at) => (text[..at].to_string(), text[at..].to_string()),
                None => (text, String::new()),
            };
            let module = module(&name);
            // The folder of the nearest `lib.rs` above it.
            let crates = path.ancestors().skip(1).find(|folder| folder.join("lib.rs").exists());
            let crates = crates.and_then(|folder| folder.strip_prefix(root).ok()).unwrap_or(Path::new(""));
            let root = crates.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            files.insert(module.clone(), Source { path: name, module, root, product, tests });
        }
        let manifests = paths.iter().filter(|path| path.ends_with("Cargo.toml"));
        let mut crates: BTreeMap<_, _> = manifests.map(|path| named_crate(root, path)).collect();
        // The library that the folder itself is.
        crates.insert("hexroll".into(), Vec::new());
        let mut sources = Sources { files, crates, facades: BTreeMap::new() };
        for source in sources.files.values() {
            let handed = paths_of(&source.product, "pub use ");
            let absolute =
                |(name, path): (String, Vec<String>)| (name, sources.absolute(source, &source.module, path));
            let names = handed.into_iter().filter_map(|path| Some((path.last()?.clone(), path)));
            let aliases = sources.crates.iter().filter_map(|(name, module)| {
                let (_, rest) = source.product.split_once(&format!("use {name} as "))?;
                Some((rest.split(';').next()?.trim().to_string(), module.clone()))
            });
            let facade = names.map(absolute).chain(aliases).collect();
            sources.facades.insert(source.module.clone(), facade);
        }
        sources
    }

    /// Every import of one file from another.
    pub fn imports(&self) -> BTreeSet<Import> {
        let mut imports = BTreeSet::new();
        for source in self.files.values() {
            for (text, in_tests) in [(&source.product, false), (&source.tests, true)] {
                for path in self.written(source, text, in_tests) {
                    let Some(to) = self.file(&path) else { continue };
                    if to != source.path && !(in_tests && imports.contains(&import(source, to, false))) {
                        imports.insert(import(source, to, in_tests));
                    }
                }
            }
        }
        imports
    }

    /// Paths from the crate's root that a text names. What a module hands on with `pub use` is not its own import.
    fn written(&self, source: &Source, text: &str, in_tests: bool) -> Vec<Vec<String>> {
        let mut module = source.module.clone();
        if in_tests {
            module.push("tests".into());
        }
        let mut paths = paths_of(text, "\nuse ");
        let crates = self.crates.keys().map(String::as_str);
        for root in ["crate", "super"].into_iter().chain(crates).map(|name| format!("{name}::")) {
            paths.extend(text.match_indices(&root).filter_map(|(at, _)| name_at(text, at)));
        }
        // Names of a module's own children.
        for child in self.files.keys().filter(|m| m.len() == module.len() + 1 && m.starts_with(&module)) {
            let name = child.last().expect("it has a name");
            let uses = |(at, _): (usize, &str)| !in_word(text, at) && !in_use(text, at);
            if text.match_indices(&format!("{name}::")).any(uses) {
                paths.push(vec!["self".into(), name.clone(), "*".into()]);
            }
        }
        paths.into_iter().map(|path| self.absolute(source, &module, path)).collect()
    }

    /// A path from the crate's root.
    fn absolute(&self, source: &Source, module: &[String], mut path: Vec<String>) -> Vec<String> {
        let mut at = module.to_vec();
        match path.first().map(String::as_str) {
            Some("crate") => at = source.root.clone(),
            Some("self") => {}
            Some("super") => {
                at.pop();
                while path.get(1).is_some_and(|p| p == "super") {
                    path.remove(0);
                    at.pop();
                }
            }
            Some(first) if self.crates.contains_key(first) => at = self.crates[first].clone(),
            Some(first) => {
                // A child of this module, or a crate from elsewhere.
                let mut child = at.clone();
                child.push(first.into());
                if !self.files.contains_key(&child) {
                    return path;
                }
                path.insert(0, "self".into());
            }
            None => return path,
        }
        at.extend(path.into_iter().skip(1));
        at
    }

    /// The file that a path leads to: the deepest module on its way, through what modules hand on.
    fn file(&self, path: &[String]) -> Option<&str> {
        self.followed(path, 0)
    }

    fn followed(&self, path: &[String], depth: usize) -> Option<&str> {
        let at = (0..=path.len()).rev().find(|&n| self.files.contains_key(&path[..n]))?;
        if at == 0 && path.first().is_some_and(|first| !self.handed_on(&[], first)) {
            return None;
        }
        let module = &path[..at];
        let here = Some(self.files[module].path.as_str());
        // Eight are more than names are ever handed on.
        let handed = path.get(at).and_then(|name| self.facades.get(module)?.get(name)).filter(|_| depth < 8);
        let Some(to) = handed.filter(|to| to.as_slice() != path) else { return here };
        let rest: Vec<String> = to.iter().chain(&path[at + 1..]).cloned().collect();
        self.followed(&rest, depth + 1).or(here)
    }

    fn handed_on(&self, module: &[String], name: &str) -> bool {
        self.facades.get(module).is_some_and(|names| names.contains_key(name))
    }
}

fn import(source: &Source, to: &str, in_tests: bool) -> Import {
    Import { from: source.path.clone(), to: to.into(), in_tests }
}

/// The name that code has for a crate, and its module.
fn named_crate(root: &Path, manifest: &Path) -> (String, Vec<String>) {
    let text = fs::read_to_string(manifest).expect("it can be read");
    let name = text.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
    let folder = manifest.parent().and_then(|folder| folder.strip_prefix(root).ok()).expect("it is below");
    let module = folder.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    (name.expect("a crate has a name").replace('-', "_"), module)
}

pub fn walk(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => walk(&path, paths),
            false => paths.push(path),
        }
    }
}

/// `run/mod.rs` is `run`, `lib.rs` the root.
fn module(path: &str) -> Vec<String> {
    let mut parts: Vec<String> = path.trim_end_matches(".rs").split('/').map(String::from).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib")) {
        parts.pop();
    }
    parts
}

fn without_comments(text: &str) -> String {
    let code = |line: &str| line.find("//").map_or(line.len(), |at| at);
    text.lines().map(|line| line[..code(line)].to_string() + "\n").collect()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Whether a word, or a path, goes on to the left of `at`.
fn in_word(text: &str, at: usize) -> bool {
    text[..at].chars().next_back().is_some_and(|c| is_word(c) || c == ':')
}

/// Whether `at` is within a `use`, which is read as a tree.
fn in_use(text: &str, at: usize) -> bool {
    let start = text[..at].rfind(';').map_or(0, |s| s + 1);
    let statement = text[start..at].trim_start();
    statement.starts_with("use ") || statement.starts_with("pub use ") || statement.starts_with("pub(")
}

/// The path written at `at`: names joined by `::`, without a tree.
fn name_at(text: &str, at: usize) -> Option<Vec<String>> {
    if in_word(text, at) || in_use(text, at) {
        return None;
    }
    let end = text[at..].find(|c: char| !is_word(c) && c != ':').map_or(text.len(), |n| at + n);
    Some(text[at..end].trim_end_matches(':').split("::").map(String::from).collect())
}

/// Paths of every `use` that begins with `keyword`, one a leaf of its tree.
fn paths_of(text: &str, keyword: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    // Every `use` stands on a line of its own, however far it is set in.
    let text = format!("\n{}", text.lines().map(str::trim_start).collect::<Vec<_>>().join("\n"));
    for (at, _) in text.match_indices(keyword) {
        let tree = &text[at + keyword.len()..];
        let tree: String =
            tree[..tree.find(';').unwrap_or(0)].split_whitespace().collect::<Vec<_>>().join(" ");
        leaves(&tree, &[], &mut paths);
    }
    paths
}

fn leaves(tree: &str, before: &[String], paths: &mut Vec<Vec<String>>) {
    let Some(open) = tree.find('{') else {
        let name = tree.split(" as ").next().unwrap_or(tree).trim();
        let own = name.split("::").filter(|n| !n.is_empty() && *n != "self").map(String::from);
        let first_self = before.is_empty() && name.starts_with("self");
        let start = first_self.then(|| "self".to_string());
        paths.push(before.iter().cloned().chain(start).chain(own).collect());
        return;
    };
    let head: Vec<String> =
        tree[..open].split("::").map(|s| s.trim().to_string()).filter(|s| !s.is_empty()).collect();
    let before: Vec<String> = before.iter().cloned().chain(head).collect();
    let (mut depth, mut start) = (0, open + 1);
    for (at, c) in tree.char_indices().skip_while(|(at, _)| *at <= open) {
        let ends = depth == 0 && (c == ',' || c == '}');
        if ends && !tree[start..at].trim().is_empty() {
            leaves(tree[start..at].trim(), &before, paths);
        }
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            _ => {}
        }
        if ends {
            start = at + 1;
        }
    }
}
