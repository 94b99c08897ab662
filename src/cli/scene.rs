//! The scene that a command is about.

use std::path::PathBuf;

use clap::Args;

use hexroll::model::mesh::import::materials;
use hexroll::scene::Scene;
use hexroll::{Error, Result};

/// A scene file with changes.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Change an entry of the scene: a dotted path, entries of arrays by index; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

impl SceneArgs {
    /// The scene, and its text with the changes in it.
    pub fn load(&self) -> Result<(Scene, String)> {
        let text = Scene::read_text(&self.scene)?;
        let file = self.scene.to_string_lossy();
        let scene = Scene::parse(&text, &file, &self.sets);
        let scene = scene.map_err(|error| with_material(error, &text, &file, &self.sets))?;
        Ok((scene, Scene::effective_text(&text, &file, &self.sets)?))
    }
}

/// The error of a scene without density or material, with what the deck of its mesh says of them.
fn with_material(error: Error, text: &str, scene: &str, sets: &[String]) -> Error {
    let Error::Scene { file, line, key, problem, remedy } = error else { return error };
    let asked = ["body.density", "body.material"].contains(&key.as_str()) && problem.starts_with("missing");
    let mesh = asked.then(|| Scene::mesh_file(text, scene, sets)).flatten();
    let said = mesh.and_then(|mesh| materials(&mesh).ok()).filter(|lines| !lines.is_empty());
    let remedy = match said {
        Some(lines) => {
            format!("{remedy}\n  the mesh's file says, in a scene's words:\n    {}", lines.join("\n    "))
        }
        None => remedy,
    };
    Error::Scene { file, line, key, problem, remedy }
}
