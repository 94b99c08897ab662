//! Paths that ARCHITECTURE.md names.

use std::fs;
use std::path::{Path, PathBuf};

use super::source::walk;

/// Endings of files that are part of the repository; others are files that the program writes.
const ENDINGS: [&str; 5] = [".rs", ".wgsl", ".md", ".toml", ".sh"];

/// Names in backticks that look like paths of the repository and lead nowhere.
///
/// A path may begin at the root, in `src` or in `shaders`; a name without a folder is a file in any of them, and in a row
/// of the table of folders it is below the folder of that row.
pub fn missing(root: &Path) -> Vec<String> {
    let text = fs::read_to_string(root.join("ARCHITECTURE.md")).expect("it can be read");
    let mut all = Vec::new();
    ["src", "shaders", "tests", "docs", "benches"].iter().for_each(|f| walk(&root.join(f), &mut all));
    let mut missing = Vec::new();
    let mut in_code = false;
    for (n, line) in text.lines().enumerate() {
        in_code ^= line.starts_with("```");
        if in_code {
            continue;
        }
        let quoted: Vec<&str> = line.split('`').skip(1).step_by(2).flat_map(str::split_whitespace).collect();
        let row = quoted.first().filter(|q| line.starts_with("| `") && q.ends_with('/')).copied();
        for name in quoted {
            let name = name.trim_end_matches(',');
            let path = ENDINGS.iter().any(|e| name.ends_with(e)) || name.ends_with('/');
            let pattern = name.contains(['<', '*', '{', '(', '=', ':']);
            if path && !pattern && !exists(root, row, name, &all) {
                missing.push(format!("line {}: {name}", n + 1));
            }
        }
    }
    missing
}

fn exists(root: &Path, row: Option<&str>, name: &str, all: &[PathBuf]) -> bool {
    let anywhere =
        ["", "src", "shaders", "src/physics"].iter().any(|base| root.join(base).join(name).exists());
    if let Some(row) = row {
        // The folders of a row come first, then its files.
        return anywhere || root.join(row).join(name).exists() || below(&root.join(row), name, all);
    }
    anywhere || below(root, name, all)
}

/// Whether a file below a folder has a path that ends so.
fn below(folder: &Path, name: &str, all: &[PathBuf]) -> bool {
    let name = name.trim_end_matches('/');
    let ends = |path: &PathBuf| path.starts_with(folder) && (path.ends_with(name) || has_folder(path, name));
    all.iter().any(ends)
}

/// Whether a path goes through a folder.
fn has_folder(path: &Path, name: &str) -> bool {
    path.ancestors().skip(1).any(|folder| folder.ends_with(name))
}
