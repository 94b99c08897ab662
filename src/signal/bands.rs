//! One-third-octave bands of IEC 61260-1: base ten, G = 10^(3/10), exact mid-band frequencies 1000 G^(x/3) Hz, edges a
//! factor G^(1/6) to either side.

/// A band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// What it is called [Hz].
    pub nominal: f64,
    /// Exact mid-band frequency and edges [Hz].
    pub middle: f64,
    pub low: f64,
    pub high: f64,
}

/// Nominal mid-band frequencies from 100 Hz on, of the bands x = -10 to 7.
const NOMINAL: [f64; 18] = [
    100.0, 125.0, 160.0, 200.0, 250.0, 315.0, 400.0, 500.0, 630.0, 800.0, 1000.0, 1250.0, 1600.0, 2000.0,
    2500.0, 3150.0, 4000.0, 5000.0,
];

/// The bands from 100 to 5000 Hz.
pub fn bands() -> Vec<Band> {
    let g = 10f64.powf(0.3);
    let band = |(k, &nominal): (usize, &f64)| {
        let middle = 1000.0 * g.powf((k as f64 - 10.0) / 3.0);
        Band { nominal, middle, low: middle * g.powf(-1.0 / 6.0), high: middle * g.powf(1.0 / 6.0) }
    };
    NOMINAL.iter().enumerate().map(band).collect()
}

impl Band {
    /// Power of a density within the band: lines `width` [Hz] apart, the first at 0 Hz, each standing for half of the width to
    /// either side. `None` where the density does not reach so far, or has fewer than two lines in the band.
    pub fn power(&self, density: &[f64], width: f64) -> Option<f64> {
        let end = (density.len() as f64 - 0.5) * width;
        if self.high > end || self.high - self.low < 2.0 * width {
            return None;
        }
        let share = |k: usize| {
            let middle = k as f64 * width;
            let (from, to) = ((middle - 0.5 * width).max(self.low), (middle + 0.5 * width).min(self.high));
            (to - from).max(0.0)
        };
        Some(density.iter().enumerate().map(|(k, d)| d * share(k)).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::spectrum::Welch;
    use std::f64::consts::PI;

    /// IEC 61260-1: the band at 1 kHz reaches from 891.25 to 1122.02 Hz; bands join.
    #[test]
    fn edges_are_the_standards() {
        let bands = bands();
        let kilo = bands.iter().find(|b| b.nominal == 1000.0).unwrap();
        assert!((kilo.low - 891.25).abs() < 5e-3 && (kilo.high - 1122.02).abs() < 5e-3, "{kilo:?}");
        for pair in bands.windows(2) {
            assert!((pair[0].high / pair[1].low - 1.0).abs() < 1e-12);
        }
        // Nominal frequencies are the exact ones, rounded.
        assert!(bands.iter().all(|b| (b.nominal / b.middle - 1.0).abs() < 0.015));
    }

    #[test]
    fn a_sine_falls_wholly_into_its_band() {
        let rate = 20e3;
        let welch = Welch { rate, segment: 4000 };
        for band in bands() {
            let signal: Vec<f64> =
                (0..20_000).map(|i| 2.0 * (2.0 * PI * band.middle * f64::from(i) / rate).sin()).collect();
            let density = welch.density(&signal);
            for other in bands() {
                let power = other.power(&density, welch.width()).unwrap();
                // Hann's window leaves 1e-3 beyond the two lines to either side that a band of 23 Hz has room for.
                let expected = if other == band { 2.0 } else { 0.0 };
                assert!((power - expected).abs() < 2e-3, "{} Hz in {}: {power}", band.nominal, other.nominal);
            }
        }
    }

    #[test]
    fn a_band_that_is_not_resolved_or_not_there_has_no_power() {
        let all = bands();
        assert_eq!(all[0].power(&[1.0; 200], 20.0), None, "23 Hz wide, lines 20 Hz apart");
        assert_eq!(all[17].power(&[1.0; 100], 50.0), None, "up to 4975 Hz");
        let flat = all[10].power(&[2.0; 1000], 5.0).unwrap();
        assert!((flat - 2.0 * (all[10].high - all[10].low)).abs() < 1e-9);
    }
}
