//! Rough roads from a seed: isotropic, periodic, with a power spectrum between two wavelengths. The same numbers on every machine.

use super::transform::{Complex, sum, turn};
use super::{Fault, Map, checked};

/// What a generated field is like, whatever its spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// Along u and v [m].
    pub extent: [f64; 2],
    /// Distance of samples, which the extent is cut into [m].
    pub spacing: f64,
    /// Waves from the one to the other, both included [m].
    pub longest: f64,
    pub shortest: f64,
    pub seed: u64,
}

/// A spectrum of waves in a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spectrum {
    /// ISO 8608: along any straight line G_d(n) = `roughness` (n / n0)^-2, n0 = 0.1 /m, one-sided, in m^3. An isotropic field has it
    /// along every line if its own spectrum falls as the cube of the wave number.
    Iso8608 { roughness: f64 },
    /// C(q) ~ q^(-2-2H), with heights of this root of the mean square [m].
    SelfAffine { hurst: f64, rms: f64 },
}

/// G_d(n0) of the geometric mean of a class, A to H [m^3]: ISO 8608, table C.1.
pub fn class(letter: char) -> Option<f64> {
    let k = "ABCDEFGH".find(letter)?;
    Some(16e-6 * 4f64.powi(k as i32))
}

const N0: f64 = 0.1;

impl Spectrum {
    /// Power per area of wave numbers at n cycles per metre, both signs, in m^4; of self-affine roughness up to a factor.
    fn power(&self, n: f64) -> f64 {
        match self {
            // Integrated across: one-sided along a line 2 x c x 2 / n^2.
            Spectrum::Iso8608 { roughness } => 0.25 * roughness * N0 * N0 / (n * n * n),
            Spectrum::SelfAffine { hurst, .. } => libm::pow(n, -2.0 - 2.0 * hurst),
        }
    }
}

/// The field with this spectrum: a cosine for every wave that fits into the extent, its amplitude given by the spectrum, its phase by
/// the seed. A finer spacing adds waves and leaves the others as they were.
///
/// # Errors
/// No wave between the two wavelengths, or waves that the samples cannot hold.
pub fn field(field: &Field, spectrum: Spectrum) -> Result<Map, Fault> {
    let Field { extent, spacing, longest, shortest, seed } = *field;
    let size = extent.map(|l| ((l / spacing).round() as usize).max(1));
    let actual = [extent[0] / size[0] as f64, extent[1] / size[1] as f64];
    if shortest < 2.0 * actual[0].max(actual[1]) * (1.0 - 1e-9) {
        let problem = format!("waves of {shortest} m in samples {} m apart", actual[0].max(actual[1]));
        return Err(Fault::of_file(problem, "write a spacing of half the shortest wave or less"));
    }
    let mut waves = vec![[0.0; 2]; size[0] * size[1]];
    let mut count = 0usize;
    // Half of the plane: a cosine stands for a wave and its opposite.
    for b in 0..=size[1] / 2 {
        let half = size[0] as i64 / 2;
        for a in -half..=half {
            let twice = a == -half && size[0] % 2 == 0;
            let n = (a as f64 / extent[0]).hypot(b as f64 / extent[1]);
            let within = n * longest >= 1.0 - 1e-9 && n * shortest <= 1.0 + 1e-9;
            if !within || twice || (b == 0 && a <= 0) {
                continue;
            }
            let amplitude = 2.0 * (spectrum.power(n) / (extent[0] * extent[1])).sqrt();
            let wave = turn(std::f64::consts::TAU * uniform(seed, a, b as i64));
            let k = b * size[0] + a.rem_euclid(size[0] as i64) as usize;
            waves[k] = wave.map(|c| amplitude * c);
            count += 1;
        }
    }
    if count == 0 {
        let problem = format!("no wave between {shortest} m and {longest} m fits into {extent:?} m");
        return Err(Fault::of_file(problem, "write a larger extent, or a shorter wave"));
    }
    let mut heights = real_sums(waves, size);
    if let Spectrum::SelfAffine { rms, .. } = spectrum {
        let square = heights.iter().map(|h| h * h).sum::<f64>() / heights.len() as f64;
        let scale = rms / square.sqrt();
        heights.iter_mut().for_each(|h| *h *= scale);
    }
    checked(Map { size, spacing: actual, origin: [0.0; 2], heights, border: None })
}

/// Real parts of the double Fourier sum.
fn real_sums(mut waves: Vec<Complex>, [columns, rows]: [usize; 2]) -> Vec<f64> {
    for row in waves.chunks_mut(columns) {
        let summed = sum(row);
        row.copy_from_slice(&summed);
    }
    let mut heights = vec![0.0; columns * rows];
    for i in 0..columns {
        let column: Vec<Complex> = (0..rows).map(|j| waves[j * columns + i]).collect();
        for (j, value) in sum(&column).into_iter().enumerate() {
            heights[j * columns + i] = value[0];
        }
    }
    heights
}

/// A number from 0 to 1 that belongs to a wave: SplitMix64 (Steele, Lea and Flood 2014) of seed and wave number.
fn uniform(seed: u64, a: i64, b: i64) -> f64 {
    let mut state = seed;
    for word in [a as u64, b as u64] {
        state = mixed(state.wrapping_add(0x9e37_79b9_7f4a_7c15) ^ word);
    }
    (mixed(state.wrapping_add(0x9e37_79b9_7f4a_7c15)) >> 11) as f64 / (1u64 << 53) as f64
}

fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
