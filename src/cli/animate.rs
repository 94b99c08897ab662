//! Animations: the pictures of all snapshots as frames of one APNG file, with one colour scale.

use std::path::{Path, PathBuf};

use image::RgbaImage;
use indicatif::{ProgressBar, ProgressStyle};

use super::pictures::{FIELDS, Style, VIEWS, body_view, footprint_view, name_of};
use hexroll::output::folder::write_whole;
use hexroll::output::read::{self, SnapshotFile};
use hexroll::render::{Range, Renderer, body_values, footprint_values};
use hexroll::scene::Picture;
use hexroll::{Error, Result};

/// Draws every picture of all snapshots into `out` as `body_<field>[_<view>].png` and `footprint[_<view>].png`, `rate` frames a
/// second; returns what it has written.
///
/// # Errors
/// As [`pictures::draw`](super::pictures::draw).
pub fn draw(
    snapshots: &[SnapshotFile],
    pictures: &[Picture],
    style: &Style,
    rate: u16,
    out: &Path,
) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(out).map_err(Error::io(out, "create this folder"))?;
    let mut renderer = Renderer::new()?;
    pictures.iter().map(|picture| one(&mut renderer, snapshots, *picture, style, rate, out)).collect()
}

fn one(
    renderer: &mut Renderer,
    snapshots: &[SnapshotFile],
    picture: Picture,
    style: &Style,
    rate: u16,
    out: &Path,
) -> Result<PathBuf> {
    let name = match picture {
        Picture::Body(field) => format!("body_{}", name_of(&FIELDS, &field)),
        Picture::Footprint => "footprint".into(),
    };
    let view = style.view.map(|v| format!("_{}", name_of(&VIEWS, &v))).unwrap_or_default();
    let path = out.join(format!("{name}{view}.png"));
    let range = range(snapshots, picture, style)?;
    let bar = ProgressBar::new(snapshots.len() as u64).with_style(
        ProgressStyle::with_template("{msg} frame {pos} of {len}, {eta} left")
            .expect("a template that indicatif knows"),
    );
    bar.set_message(name);
    // In memory: the file appears under its name when it is whole.
    let mut bytes = Vec::new();
    let mut film = Film::new(&mut bytes, style.size, snapshots.len(), rate)?;
    for file in snapshots {
        let stored = read::snapshot(&file.path)?;
        let image = match picture {
            Picture::Body(field) => {
                let view = hexroll::render::BodyView { range, ..body_view(field, style) };
                renderer.body(&stored.mesh, &stored.snapshot, &view)?
            }
            Picture::Footprint => {
                let view = hexroll::render::FootprintView { range, ..footprint_view(style)? };
                renderer.footprint(&stored.mesh, &stored.snapshot, &view)?
            }
        };
        film.frame(&image)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    film.finish()?;
    write_whole(&path, |out| out.write_all(&bytes))?;
    Ok(path)
}

/// One scale for all frames: from the least to the largest value that any of them shows.
fn range(snapshots: &[SnapshotFile], picture: Picture, style: &Style) -> Result<Range> {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for file in snapshots {
        let stored = read::snapshot(&file.path)?;
        let [low, high] = match picture {
            Picture::Body(field) => body_values(&stored.mesh, &stored.snapshot, field)?,
            Picture::Footprint => footprint_values(&stored.mesh, &stored.snapshot, &footprint_view(style)?),
        };
        ends = [ends[0].min(low), ends[1].max(high)];
    }
    Ok(if ends[0] <= ends[1] { Range::round(ends[0], ends[1]) } else { Range::Auto })
}

/// An APNG that is being made. The first frame is what viewers without animation show.
struct Film<'a> {
    writer: png::Writer<&'a mut Vec<u8>>,
}

impl<'a> Film<'a> {
    fn new(bytes: &'a mut Vec<u8>, [width, height]: [u32; 2], frames: usize, rate: u16) -> Result<Film<'a>> {
        let mut encoder = png::Encoder::new(bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(frames as u32, 0).map_err(failed)?;
        encoder.set_frame_delay(1, rate).map_err(failed)?;
        Ok(Film { writer: encoder.write_header().map_err(failed)? })
    }

    fn frame(&mut self, image: &RgbaImage) -> Result<()> {
        let opaque: Vec<u8> = image.pixels().flat_map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
        self.writer.write_image_data(&opaque).map_err(failed)
    }

    fn finish(self) -> Result<()> {
        self.writer.finish().map_err(failed)
    }
}

fn failed(error: png::EncodingError) -> Error {
    Error::Picture { problem: format!("APNG encoding failed: {error}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_animation_has_its_frames_and_their_time() {
        let mut bytes = Vec::new();
        let mut film = Film::new(&mut bytes, [4, 2], 3, 25).unwrap();
        for k in 0..3u8 {
            film.frame(&RgbaImage::from_pixel(4, 2, image::Rgba([50 * k, 0, 0, 255]))).unwrap();
        }
        film.finish().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let info = reader.info();
        let control = info.animation_control.unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0), "for ever");
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        for k in 0..3u8 {
            reader.next_frame(&mut pixels).unwrap();
            assert_eq!(pixels[0], 50 * k, "frame {k}");
            let frame = reader.info().frame_control.unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (1, 25));
        }
    }
}
