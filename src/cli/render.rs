//! `hexroll render`.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::pictures::{self, FIELDS, Style, VIEWS};
use super::{animate, terminal};
use hexroll::output::read;
use hexroll::render::{DEFAULT_SIZE, View};
use hexroll::scene::{Field, Picture, Scene};
use hexroll::{Error, Result};

pub const HELP: &str = "\
Without --field and --footprint: the pictures that the scene asks for, or von Mises stress if it asks for none.
Writes body_<field>_<k>.png and footprint_<k>.png, with the view's name in them if one is given.

Examples:
  hexroll render runs/lat100_straight
  hexroll render runs/lat100_straight --view side --field pressure --field velocity --snapshot all
  hexroll render runs/lat100_straight --animate --size 960x540 --field von-mises --footprint
  hexroll render runs/lat100_straight --footprint --view iso --size 2400x1350 --out figures";

#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Folder of the run
    dir: PathBuf,
    /// Where from; with --footprint: contact forces as arrows in space, seen from there
    #[arg(long, value_parser = named(&VIEWS))]
    view: Option<View>,
    /// Field that colours the body; may be repeated
    #[arg(long = "field", value_parser = named(&FIELDS))]
    fields: Vec<Field>,
    /// Draw the contact forces
    #[arg(long)]
    footprint: bool,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1600x900")]
    size: [u32; 2],
    /// Which snapshot: its number from 0, `last` or `all`
    #[arg(long, value_name = "K|last|all", value_parser = which, default_value = "last")]
    snapshot: Which,
    /// All snapshots as frames of one animated PNG a picture (APNG, which browsers and slides play), with one colour scale
    #[arg(long, conflicts_with = "snapshot")]
    animate: bool,
    /// Frames a second of an animation
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=100))]
    fps: u16,
    /// Folder to write to; default the run's
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Snapshots of a run.
#[derive(Debug, Clone, Copy)]
enum Which {
    One(usize),
    Last,
    All,
}

/// A parser of names.
pub fn named<T: Copy + Send + Sync + 'static>(
    names: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    let value = |name: String| names.iter().find(|(n, _)| *n == name).map(|(_, v)| *v).ok_or("no such name");
    PossibleValuesParser::new(names.iter().map(|(name, _)| *name)).try_map(value)
}

fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    let [width, height] = DEFAULT_SIZE;
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.ok_or_else(|| format!("write width and height in pixels, e.g. {width}x{height}"))
}

fn which(text: &str) -> std::result::Result<Which, String> {
    match text {
        "last" => Ok(Which::Last),
        "all" => Ok(Which::All),
        k => k.parse().map(Which::One).map_err(|_| "write a number from 0, `last` or `all`".into()),
    }
}

pub fn execute(args: &RenderArgs) -> Result<()> {
    let snapshots = read::snapshots(&args.dir)?;
    let which = if args.animate { Which::All } else { args.snapshot };
    let wanted = wanted(which, snapshots.len(), &args.dir)?;
    let scene = stored_scene(&args.dir)?;
    let style = Style {
        size: args.size,
        view: args.view,
        title: scene.as_ref().map(|s| s.title.clone()).unwrap_or_default(),
        road: scene.as_ref().and_then(|s| s.road.clone()),
    };
    let out = args.out.as_deref().unwrap_or(&args.dir);
    let asked = asked(args, scene.as_ref());
    let written = match args.animate {
        true => animate::draw(&snapshots, &asked, &style, args.fps, out)?,
        false => pictures::draw(&snapshots, &wanted, &asked, &style, out)?,
    };
    let lines: String = written.iter().map(|path| format!("{}\n", path.display())).collect();
    terminal::print(&lines)
}

fn wanted(which: Which, count: usize, dir: &Path) -> Result<Vec<usize>> {
    let missing = |problem| Err(Error::Format { path: dir.into(), problem });
    match which {
        _ if count == 0 => missing("this run has no snapshots to draw".into()),
        Which::One(k) if k >= count => {
            missing(format!("there is no snapshot {k}; the last one of this run is {}", count - 1))
        }
        Which::One(k) => Ok(vec![k]),
        Which::Last => Ok(vec![count - 1]),
        Which::All => Ok((0..count).collect()),
    }
}

/// The scene that the run's folder keeps.
fn stored_scene(dir: &Path) -> Result<Option<Scene>> {
    let file = dir.join("scene.toml");
    let text = read::scene_text(dir)?;
    text.map(|text| Scene::parse(&text, &file.to_string_lossy(), &[])).transpose()
}

fn asked(args: &RenderArgs, scene: Option<&Scene>) -> Vec<Picture> {
    let mut pictures: Vec<Picture> = args.fields.iter().map(|&field| Picture::Body(field)).collect();
    pictures.extend(args.footprint.then_some(Picture::Footprint));
    if pictures.is_empty() {
        pictures.extend(scene.iter().flat_map(|s| &s.output.pictures));
    }
    if pictures.is_empty() {
        pictures.push(Picture::Body(Field::VonMises));
    }
    pictures
}
