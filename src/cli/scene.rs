//! The scene that a command is about.

use std::path::PathBuf;

use clap::Args;

use hexroll::Result;
use hexroll::scene::Scene;

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
        Ok((Scene::parse(&text, &file, &self.sets)?, Scene::effective_text(&text, &file, &self.sets)?))
    }
}
