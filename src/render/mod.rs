//! Pictures: off-screen wgpu for what is solid, a flat canvas for what is lettered.
//!
//! [`Renderer::body`] draws the deformed body on the road, [`Renderer::footprint`] the contact forces.
//! Both take plain options, fit their camera to the body at any scale, and are the same to the byte when
//! drawn again on the same adapter.

mod body;
mod camera;
pub mod canvas;
pub mod colour;
mod contact;
mod field;
mod footprint;
mod gpu;
mod legend;
mod mesh;
mod pipeline;
mod relief;
mod road;
mod scale;
mod surface;
mod symbols;

pub use body::{BodyView, body_values};
pub use camera::{Camera, Projection, View};
pub use colour::ColourMap;
pub use footprint::{FootprintColour, FootprintStyle, FootprintView, footprint_values};
pub use mesh::MeshView;
pub use scale::{Range, Scale};

use crate::{Error, Result};

/// Width and height of a picture unless asked otherwise [pixels].
pub const DEFAULT_SIZE: [u32; 2] = [1600, 900];

/// Draws pictures on one adapter.
#[derive(Debug)]
pub struct Renderer {
    gpu: gpu::Gpu,
    fonts: canvas::Fonts,
}

impl Renderer {
    /// A renderer on any adapter, software ones included; [`Error::NoAdapter`] if there is none.
    pub fn new() -> Result<Renderer> {
        Renderer::on(None)
    }

    /// A renderer on `adapter`, or on any.
    pub fn on(adapter: Option<wgpu::Adapter>) -> Result<Renderer> {
        Ok(Renderer { gpu: gpu::Gpu::new(adapter)?, fonts: canvas::Fonts::new()? })
    }

    /// Name of the adapter that draws.
    pub fn adapter(&self) -> &str {
        self.gpu.adapter()
    }
}

/// Pixels per design unit: layouts are drawn up for 1600 x 900.
fn unit_of([width, height]: [u32; 2]) -> f64 {
    (f64::from(height) / 900.0).min(f64::from(width) / 1600.0)
}

/// Smallest picture whose legend still has room [pixels].
const SMALLEST: u32 = 160;

fn check_size([width, height]: [u32; 2], largest: u32) -> Result<()> {
    if [width, height].iter().all(|s| (SMALLEST..=largest).contains(s)) {
        return Ok(());
    }
    Err(Error::Picture {
        problem: format!("its size is {width} x {height} pixels; each side can be {SMALLEST} to {largest}"),
    })
}
