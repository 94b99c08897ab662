//! Colour maps that colour-blind readers can use, and the few fixed colours of the pictures.

/// A perceptually uniform, colour-blind-safe map from low (dark) to high (bright).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    #[default]
    Viridis,
    /// The same to readers with and without red-green deficiency.
    Cividis,
    Plasma,
    Inferno,
}

impl ColourMap {
    /// Colour at `place` along the map, 0 to 1 (clamped) [sRGB].
    pub fn at(self, place: f64) -> [u8; 3] {
        let gradient = match self {
            ColourMap::Viridis => colorous::VIRIDIS,
            ColourMap::Cividis => colorous::CIVIDIS,
            ColourMap::Plasma => colorous::PLASMA,
            ColourMap::Inferno => colorous::INFERNO,
        };
        gradient.eval_continuous(place.clamp(0.0, 1.0)).as_array()
    }

    /// The map as texels, lower end first.
    pub(super) fn texels(self) -> Vec<[u8; 4]> {
        const COUNT: usize = 256;
        (0..COUNT)
            .map(|i| {
                let [r, g, b] = self.at(i as f64 / (COUNT - 1) as f64);
                [r, g, b, 255]
            })
            .collect()
    }
}

/// Text and axes [sRGB].
pub const INK: [u8; 3] = [34, 38, 46];
/// Secondary text and ticks.
pub const QUIET: [u8; 3] = [98, 104, 114];
/// Rigid parts: rim.
pub(super) const RIGID: [u8; 3] = [176, 181, 189];
/// The rim's disc.
pub(super) const WEB: [u8; 3] = [203, 207, 213];
/// Slipping nodes: vermilion of Okabe and Ito's set.
pub(super) const SLIP: [u8; 3] = [213, 94, 0];
pub const WHITE: [u8; 3] = [255, 255, 255];

/// An sRGB colour as linear light, as shaders and vertices carry it.
pub(super) fn linear(colour: [u8; 3]) -> [f32; 3] {
    colour.map(|c| {
        let c = f32::from(c) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    })
}

/// `linear` with an opacity.
pub(super) fn ink(colour: [u8; 3], opacity: f64) -> [f32; 4] {
    let [r, g, b] = linear(colour);
    [r, g, b, opacity as f32]
}
