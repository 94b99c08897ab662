//! Scene files: TOML in, a checked [`Scene`] in SI out.
//!
//! What follows is the page of the guide.
#![doc = include_str!("../../../docs/guide/scene.md")]

mod body;
mod history;
mod implicit;
mod material;
mod mesh_file;
mod output;
mod parameters;
mod relaxation;
mod rim_motion;
mod road;
mod rough;
mod set_motion;
mod stage;
mod world;

use std::path::Path;

use sha2::{Digest, Sha256};

use super::document::{self, Node};
use super::reader::{Bound, Item, Later, Table};
use super::units::ACCELERATION;
use super::{MeshFile, Scene, overrides};
use crate::error::{Error, Result};

const SECTIONS: [&str; 13] = [
    "title",
    "source",
    "expected",
    "gravity",
    "body",
    "rim",
    "hold",
    "motion",
    "road",
    "friction",
    "time_step",
    "stage",
    "output",
];

const LATER: [Later; 5] = [
    ("sweep", "run hexroll sweep SCENE --over KEY=VALUES, or the scene once per value with --set"),
    ("checkpoint", "run the scene in one piece"),
    ("restart", "run the scene in one piece"),
    ("bodies", "describe one [body]"),
    ("spectrum", "write [[output.history]], run the scene, and then hexroll spectrum on its folder"),
];

impl Scene {
    /// Reads a scene file and applies `overrides` (`key=value`, dotted paths, array entries by index).
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; [`Error::Scene`] with file, line, key, problem and remedy for
    /// everything that is wrong in it; [`Error::Unsupported`] for what comes in a later version.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Scene> {
        let text = Scene::read_text(path)?;
        Scene::parse(&text, &path.to_string_lossy(), overrides)
    }

    /// The text of a scene file.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; [`Error::Scene`] with file, line and column, in bytes from 1, of the first
    /// byte that is not UTF-8.
    pub fn read_text(path: &Path) -> Result<String> {
        let bytes = std::fs::read(path).map_err(Error::io(path, "read the scene"))?;
        String::from_utf8(bytes).map_err(|error| not_utf8(error, path))
    }

    /// [`Scene::load`] of a scene that is already in memory; `file` is its name in messages.
    pub fn parse(text: &str, file: &str, overrides: &[String]) -> Result<Scene> {
        read(&effective(text, file, overrides)?, file)
    }

    /// The file of the mesh that a scene names, whatever else is missing or wrong in it: who mends a scene asks what that says.
    pub fn mesh_file(text: &str, file: &str, overrides: &[String]) -> Option<MeshFile> {
        let root = effective(text, file, overrides).ok()?;
        let table = Item { file, key: String::new(), node: &root }.table().ok()?;
        let mesh = table.get("body")?.table().ok()?.get("mesh")?.table().ok()?;
        mesh_file::read(&mesh, &mesh.get("file")?).ok()
    }

    /// The scene's text with its overrides, in canonical form (keys sorted, no comments): what [`Scene::hash`]
    /// is taken of. It reads back as the same scene.
    pub fn effective_text(text: &str, file: &str, overrides: &[String]) -> Result<String> {
        Ok(document::canonical(&rough::from_anywhere(effective(text, file, overrides)?, file)))
    }
}

fn not_utf8(error: std::string::FromUtf8Error, path: &Path) -> Error {
    let at = error.utf8_error().valid_up_to();
    let bytes = error.as_bytes();
    let before = &bytes[..at];
    let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |n| n + 1);
    Error::Scene {
        file: path.to_string_lossy().into(),
        line: Some(1 + before.iter().filter(|&&b| b == b'\n').count()),
        key: format!("byte {}", at - line_start + 1),
        problem: format!("0x{:02X} is not UTF-8", bytes[at]),
        remedy: "save the file as UTF-8, which TOML asks for".into(),
    }
}

fn effective(text: &str, file: &str, overrides: &[String]) -> Result<Node> {
    let mut root = document::parse(text, file)?;
    overrides.iter().try_for_each(|o| overrides::apply(&mut root, o, file))?;
    Ok(root)
}

fn read(root: &Node, file: &str) -> Result<Scene> {
    let table = Item { file, key: String::new(), node: root }.table()?;
    table.only(&SECTIONS, &LATER)?;
    let text = |key| table.get(key).map_or(Ok(String::new()), |item| item.text().map(Into::into));
    let body = body::body(&table.section("body", "[body]")?, table.get("road").is_some())?;
    let rim = table.get("rim").map(|item| world::rim(&item)).transpose()?;
    let road = table.get("road").map(|item| road::road(&item)).transpose()?;
    let gravity = table.vector_or_zero("gravity", &ACCELERATION)?;
    let holds = match table.get("hold") {
        Some(item) => {
            let holds = world::holds(&item)?;
            world::check_holds(&item, &holds, road.as_ref())?;
            holds
        }
        None => Vec::new(),
    };
    let motions = match table.get("motion") {
        Some(item) => {
            let motions = set_motion::motions(&item)?;
            world::check_motions(&item, &motions, road.as_ref())?;
            motions
        }
        None => Vec::new(),
    };
    let friction = table.get("friction").map(|item| world::friction(&item, road.is_some())).transpose()?;
    let section = table.section("stage", "[[stage]]")?;
    let stages = stage::stages(&section, rim.is_some(), road.as_ref(), body.offset)?;
    stage::check_motions(&section, &stages, &motions)?;
    body::check_start(&table.section("body", "[body]")?, &body, &stages[0])?;
    let output = output::output(&table.section("output", "[output]")?, &stages, road.is_some())?;
    let implicit = stages.iter().any(|s| matches!(s.method, super::Method::Implicit(_)));
    let scene = Scene {
        file: file.into(),
        hash: hash(document::canonical(&rough::by_content(root, file)?)),
        title: table.need("title", "\"one line that names the scene\"")?.text()?.into(),
        source: text("source")?,
        expected: text("expected")?,
        body,
        rim,
        holds,
        motions,
        road,
        friction: friction.flatten(),
        gravity,
        safety: table.get("time_step").map_or(Ok(0.9), |item| safety(&item.table()?))?,
        stages,
        output,
    };
    match scene.beyond_implicit() {
        Some(gap) if implicit => Err(gap),
        _ => Ok(scene),
    }
}

fn safety(table: &Table) -> Result<f64> {
    table.only(&["safety"], &[])?;
    table.number_or("safety", 0.9, Bound::Positive)
}

fn hash(text: impl AsRef<[u8]>) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}
