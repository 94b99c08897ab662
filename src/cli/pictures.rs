//! Pictures of the snapshots in a run's folder, for `run` and for `render`.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{ImageFormat, RgbaImage};

use hexroll::output::folder::write_whole;
use hexroll::output::read::{self, SnapshotFile};
use hexroll::render::{BodyView, DEFAULT_SIZE, FootprintStyle, FootprintView, Renderer, View};
use hexroll::scene::{Field, Picture, Road};
use hexroll::{Error, Result};

/// Fields by the names that scenes and arguments give them.
pub const FIELDS: [(&str, Field); 7] = [
    ("displacement", Field::Displacement),
    ("velocity", Field::Velocity),
    ("contact-force", Field::ContactForce),
    ("pressure", Field::Pressure),
    ("volume-ratio", Field::VolumeRatio),
    ("von-mises", Field::VonMises),
    ("friction-energy", Field::FrictionEnergy),
];

/// Views by the names that arguments give them.
pub const VIEWS: [(&str, View); 5] = [
    ("front", View::Front),
    ("side", View::Side),
    ("iso", View::Iso),
    ("behind", View::Behind),
    ("below", View::Below),
];

/// What the pictures of one command have in common.
#[derive(Debug, Clone)]
pub struct Style {
    /// Width and height [pixels].
    pub size: [u32; 2],
    /// Where from: a body from there, contact forces as arrows seen from there; `None`: the usual, and a flat footprint.
    pub view: Option<View>,
    pub title: String,
    pub road: Option<Road>,
}

impl Default for Style {
    fn default() -> Self {
        Style { size: DEFAULT_SIZE, view: None, title: String::new(), road: None }
    }
}

/// Draws `pictures` of the snapshots `wanted` into `out` as `body_<field>[_<view>]_<k>.png` and
/// `footprint[_<view>]_<k>.png`; returns what it has written.
///
/// # Errors
/// [`Error::NoAdapter`], [`Error::Device`] and [`Error::Picture`] from drawing; [`Error::Io`] and [`Error::Format`]
/// from the files.
pub fn draw(
    snapshots: &[SnapshotFile],
    wanted: &[usize],
    pictures: &[Picture],
    style: &Style,
    out: &Path,
) -> Result<Vec<PathBuf>> {
    if wanted.is_empty() || pictures.is_empty() {
        return Ok(Vec::new());
    }
    std::fs::create_dir_all(out).map_err(Error::io(out, "create this folder"))?;
    let mut renderer = Renderer::new()?;
    let mut written = Vec::new();
    for &k in wanted {
        let stored = read::snapshot(&snapshots[k].path)?;
        for picture in pictures {
            let (name, image) = match picture {
                Picture::Body(field) => {
                    let view = body_view(*field, style);
                    let image = renderer.body(&stored.mesh, &stored.snapshot, &view)?;
                    (format!("body_{}", name_of(&FIELDS, field)), image)
                }
                Picture::Footprint => {
                    let view = footprint_view(style)?;
                    ("footprint".into(), renderer.footprint(&stored.mesh, &stored.snapshot, &view)?)
                }
            };
            let view = style.view.map(|v| format!("_{}", name_of(&VIEWS, &v))).unwrap_or_default();
            let path = out.join(format!("{name}{view}_{k}.png"));
            save(&image, &path)?;
            written.push(path);
        }
    }
    Ok(written)
}

pub fn name_of<T: PartialEq>(names: &[(&'static str, T)], value: &T) -> &'static str {
    names.iter().find(|(_, v)| v == value).map_or("custom", |(name, _)| name)
}

pub fn body_view(field: Field, style: &Style) -> BodyView {
    let Style { size, view, title, road } = style.clone();
    BodyView { size, field, view: view.unwrap_or(View::Iso), title: Some(title), road, ..BodyView::default() }
}

pub fn footprint_view(style: &Style) -> Result<FootprintView> {
    let Style { size, view, title, road } = style.clone();
    let road =
        road.ok_or_else(|| Error::Picture { problem: "there is no footprint without a road".into() })?;
    let style = view.map_or(FootprintStyle::Flat, |view| FootprintStyle::Arrows { view });
    Ok(FootprintView { size, style, title: Some(title), road, ..FootprintView::default() })
}

/// Writes a picture as a whole.
pub fn save(image: &RgbaImage, path: &Path) -> Result<()> {
    let mut png = Cursor::new(Vec::new());
    image
        .write_to(&mut png, ImageFormat::Png)
        .map_err(|e| Error::Picture { problem: format!("PNG encoding failed: {e}") })?;
    write_whole(path, |out| out.write_all(png.get_ref()))
}
