//! Writes the list of shader files that programs are composed of, so that a new file in `shaders/` is a part without being
//! listed anywhere.

use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Pictures have shaders of their own, which are not composed.
const APART: &str = "render";

fn main() {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("shaders");
    println!("cargo::rerun-if-changed={}", root.display());
    let mut names = Vec::new();
    for folder in sorted(&root).into_iter().filter(|f| f.is_dir() && !f.ends_with(APART)) {
        for file in sorted(&folder).into_iter().filter(|f| f.extension().is_some_and(|e| e == "wgsl")) {
            names.push(file);
        }
    }
    let mut list = String::from("pub const PARTS: &[(&str, &str)] = &[\n");
    for file in names {
        let name = file.strip_prefix(&root).expect("it is below").with_extension("");
        let name = name.components().map(|c| c.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/");
        writeln!(list, "    ({name:?}, include_str!({:?})),", file.display().to_string())
            .expect("to a string");
    }
    list += "];\n";
    let out = PathBuf::from(std::env::var("OUT_DIR").expect("cargo sets it")).join("parts.rs");
    std::fs::write(&out, list).unwrap_or_else(|e| panic!("{}: {e}", out.display()));
}

/// What is in a folder, by name.
fn sorted(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("a readable folder").path()).collect();
    paths.sort();
    paths
}
