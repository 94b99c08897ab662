//! `hexroll mesh`.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::ValueEnum;

use super::pictures::{VIEWS, save};
use super::scene::SceneArgs;
use super::terminal;
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::output::folder::write_whole;
use hexroll::output::mesh::{Msh, write_inp, write_msh, write_vtu};
use hexroll::render::{MeshView, Renderer, View};
use hexroll::{Error, Result};

pub const HELP: &str = "\
Writes mesh.png (node sets in colours), mesh.vtu, mesh.inp and mesh.msh: the reference shape where the scene puts it, in metres,
with its node sets. Read back with file = \"mesh.inp\", unit = \"m\" it is the same mesh to the last bit. Nothing runs.

Examples:
  hexroll mesh scenes/lat100_straight.toml
  hexroll mesh scenes/lat100_straight.toml --only inp --out export
  hexroll mesh scenes/lat100_straight.toml --only png --view side
  hexroll mesh scenes/lat100_straight.toml --only msh --msh 2.2 --binary";

#[derive(Debug, Args)]
pub struct MeshArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder to write to; default runs/NAME-mesh
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What to write; may be repeated; default all (without a GPU adapter: all but the picture)
    #[arg(long, value_enum)]
    only: Vec<What>,
    /// Version of mesh.msh
    #[arg(long, value_name = "VERSION", value_parser = ["2.2", "4.1"], default_value = "4.1")]
    msh: String,
    /// Write mesh.msh in binary
    #[arg(long)]
    binary: bool,
    /// Where the picture is taken from
    #[arg(long, value_parser = super::render::named(&VIEWS), default_value = "iso")]
    view: View,
}

/// Files of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum What {
    Png,
    Vtu,
    Inp,
    Msh,
}

pub fn execute(args: &MeshArgs) -> Result<()> {
    let (scene, _) = args.scene.load()?;
    let mesh = Model::new(&scene)?.mesh;
    let name = scene.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let out = args.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{name}-mesh")));
    std::fs::create_dir_all(&out).map_err(Error::io(&out, "create this folder"))?;
    let mut lines = format!("{}\n", mesh.description);
    for note in &mesh.notes {
        lines += &format!("note: {note}\n");
    }
    let wanted = |what: What| args.only.is_empty() || args.only.contains(&what);
    for what in [What::Png, What::Vtu, What::Inp, What::Msh].into_iter().filter(|w| wanted(*w)) {
        let ending = what.to_possible_value().expect("no file is hidden");
        let path = out.join(format!("mesh.{}", ending.get_name()));
        match one(what, &mesh, args, &scene.title, &path) {
            // Meshes are exported on machines without adapters too.
            Err(error @ Error::NoAdapter { .. }) if args.only.is_empty() => {
                eprintln!("warning: no picture: {error}")
            }
            Err(error) => return Err(error),
            Ok(()) => lines += &format!("{}\n", path.display()),
        }
    }
    terminal::print(&lines)
}

fn one(what: What, mesh: &Mesh, args: &MeshArgs, title: &str, path: &Path) -> Result<()> {
    match what {
        What::Png => {
            let view = MeshView { view: args.view, title: title.into(), ..MeshView::default() };
            save(&Renderer::new()?.mesh(mesh, &view)?, path)
        }
        What::Vtu => write_whole(path, |out| write_vtu(out, mesh)),
        What::Inp => write_whole(path, |out| write_inp(out, mesh)),
        What::Msh => {
            let how = Msh { old: args.msh == "2.2", binary: args.binary };
            write_whole(path, |out| write_msh(out, mesh, how))
        }
    }
}
