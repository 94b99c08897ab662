//! Rough fields from a seed: their spectra, and that they are the same everywhere.

use std::f64::consts::TAU;

use hexroll::scene::heights::Map;
use hexroll::scene::heights::generate::{Field, Spectrum, class, field};

use crate::near;

const FIELD: Field = Field { extent: [0.064, 0.048], spacing: 1e-3, longest: 0.064, shortest: 4e-3, seed: 5 };
const ROUGH: Spectrum = Spectrum::SelfAffine { hurst: 0.8, rms: 1e-4 };

fn made(with: Field, spectrum: Spectrum) -> Map {
    field(&with, spectrum).unwrap_or_else(|fault| panic!("{fault:?}"))
}

/// Coefficient of the wave with a and b periods along the two sides.
fn coefficient(map: &Map, a: i64, b: i64) -> [f64; 2] {
    let [columns, rows] = map.size;
    let mut sum = [0.0; 2];
    for (k, h) in map.heights.iter().enumerate() {
        let (i, j) = ((k % columns) as f64, (k / columns) as f64);
        let (sin, cos) = (-TAU * (a as f64 * i / columns as f64 + b as f64 * j / rows as f64)).sin_cos();
        sum = [sum[0] + h * cos, sum[1] + h * sin];
    }
    sum.map(|c| c / map.heights.len() as f64)
}

fn power(map: &Map, a: i64, b: i64) -> f64 {
    let [re, im] = coefficient(map, a, b);
    re * re + im * im
}

#[test]
fn self_affine_roughness_has_its_exponent_its_cut_offs_and_its_rms() {
    let map = made(FIELD, ROUGH);
    assert_eq!(map.size, [64, 48]);
    let square = map.heights.iter().map(|h| h * h).sum::<f64>() / map.heights.len() as f64;
    near("rms", square.sqrt(), 1e-4, 1e-17);
    let wave_number = |a: i64, b: i64| (a as f64 / 0.064).hypot(b as f64 / 0.048);
    let reference = power(&map, 3, 0);
    for (a, b) in [(1, 0), (0, 1), (5, 4), (-5, 4), (-3, 9), (16, 0), (0, 12)] {
        let expected = reference * (wave_number(a, b) / wave_number(3, 0)).powf(-2.0 - 1.6);
        near("power", power(&map, a, b), expected, 1e-10 * expected);
    }
    for (a, b) in [(0, 0), (17, 0), (12, 9), (0, 13), (30, 20)] {
        assert!(power(&map, a, b) < 1e-24 * reference, "{a} {b} is beyond the cut-offs");
    }
}

/// Along every line the mean spectrum is ISO's: exactly that of the waves that are there, and the law's where few are cut off.
#[test]
fn a_class_of_iso_8608_has_its_spectrum_along_lines() {
    assert_eq!([class('A'), class('C'), class('I'), class('c')], [Some(16e-6), Some(256e-6), None, None]);
    let roughness = class('C').unwrap();
    let with =
        Field { extent: [2.0, 1.0], spacing: 1.0 / 128.0, longest: 4.0, shortest: 1.0 / 32.0, seed: 9 };
    let map = made(with, Spectrum::Iso8608 { roughness });
    let [columns, rows] = map.size;
    // One-sided density of a line: 2 |h|^2 over the width of a wave number, 1/2 m; mean over all lines.
    let density = |a: usize| {
        let mut sum = 0.0;
        for row in map.heights.chunks(columns) {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, h) in row.iter().enumerate() {
                let (sin, cos) = (TAU * ((a * i) % columns) as f64 / columns as f64).sin_cos();
                (re, im) = (re + h * cos, im + h * sin);
            }
            sum += (re * re + im * im) / (columns * columns) as f64;
        }
        2.0 * sum / rows as f64 * 2.0
    };
    for a in [8, 12, 16] {
        let n = a as f64 / 2.0;
        let law = roughness * (n / 0.1f64).powi(-2);
        // Waves up to 32 /m: beyond, (n/32)^2 / 2 is missing; lines of waves 1 /m apart instead of all.
        near("density", density(a), law, (0.5 * (n / 32.0).powi(2) + 0.02) * law);
    }
}

/// A finer spacing and another cut-off leave the waves that both have as they are.
#[test]
fn finer_samples_are_of_the_same_road() {
    let spectrum = Spectrum::Iso8608 { roughness: 1e-6 };
    let (coarse, fine) =
        (made(FIELD, spectrum), made(Field { spacing: 5e-4, shortest: 2e-3, ..FIELD }, spectrum));
    for (a, b) in [(1, 0), (4, 3), (-7, 5), (0, 9)] {
        let (x, y) = (coefficient(&coarse, a, b), coefficient(&fine, a, b));
        assert!((x[0] - y[0]).hypot(x[1] - y[1]) < 1e-13, "{a} {b}: {x:?} {y:?}");
    }
    let other = made(Field { seed: 6, ..FIELD }, spectrum);
    assert_ne!(other.heights, coarse.heights);
}
