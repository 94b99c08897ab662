//! Heights from a greyscale picture.

use image::DynamicImage;

use super::{Fault, Map, checked};

/// The heights of a 16-bit greyscale PNG seen from above, u to the right and v upwards: black is 0, white `height` [m]; what is wholly
/// transparent is missing. `pixel`: distance of neighbouring pixels [m].
///
/// # Errors
/// What is no such picture.
pub fn read(bytes: &[u8], pixel: f64, height: f64) -> Result<Map, Fault> {
    let picture = image::load_from_memory_with_format(bytes, image::ImageFormat::Png)
        .map_err(|e| Fault::of_file(format!("no PNG picture: {e}"), "save it as a 16-bit greyscale PNG"))?;
    let (width, rows) = (picture.width() as usize, picture.height() as usize);
    let of = |white: u16| f64::from(white) / f64::from(u16::MAX) * height;
    let from_above: Vec<f64> = match picture {
        DynamicImage::ImageLuma16(grey) => grey.pixels().map(|p| of(p.0[0])).collect(),
        DynamicImage::ImageLumaA16(grey) => {
            grey.pixels().map(|p| if p.0[1] == 0 { f64::NAN } else { of(p.0[0]) }).collect()
        }
        other => {
            return Err(Fault::of_file(
                format!("a picture of {:?}: heights need 65,536 levels of grey", other.color()),
                "save it as a 16-bit greyscale PNG",
            ));
        }
    };
    let heights = from_above.rchunks(width).flatten().copied().collect();
    checked(Map { size: [width, rows], spacing: [pixel; 2], origin: [0.0; 2], heights, border: None })
}
