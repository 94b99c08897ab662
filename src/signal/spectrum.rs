//! Power spectral densities by Welch's method (P. D. Welch, 1967): Hann windows that overlap by half.
//!
//! Densities are one-sided: their sum times the width of a line is the mean square of the windowed signal (Parseval), and a
//! sine of amplitude a has a^2/2 around its frequency.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::PI;

/// How a record is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Welch {
    /// Of the samples [Hz].
    pub rate: f64,
    /// Samples of a segment.
    pub segment: usize,
}

/// Fewest samples of a segment.
const SHORTEST: usize = 16;

impl Welch {
    /// Segments whose lines are about `width` [Hz] apart, of a record of `samples`; shorter ones where the record is short, so that
    /// there are two of them at least.
    pub fn with_lines(rate: f64, width: f64, samples: usize) -> Welch {
        let wanted = (rate / width).round() as usize;
        // Two that overlap by half take one and a half of their length.
        Welch { rate, segment: wanted.min(samples * 2 / 3).max(SHORTEST.min(samples)) }
    }

    /// From one line to the next [Hz].
    pub fn width(&self) -> f64 {
        self.rate / self.segment as f64
    }

    /// Frequencies of the lines [Hz].
    pub fn frequencies(&self) -> Vec<f64> {
        (0..=self.segment / 2).map(|k| k as f64 * self.width()).collect()
    }

    /// Segments of a record of so many samples.
    pub fn segments(&self, samples: usize) -> usize {
        if samples < self.segment { 0 } else { 1 + (samples - self.segment) / self.hop() }
    }

    fn hop(&self) -> usize {
        (self.segment / 2).max(1)
    }

    /// Hann's window, periodic.
    fn window(&self) -> Vec<f64> {
        let n = self.segment as f64;
        (0..self.segment).map(|i| 0.5 - 0.5 * (2.0 * PI * i as f64 / n).cos()).collect()
    }

    /// The transforms of all segments of a signal, its mean taken off.
    fn transforms(&self, signal: &[f64]) -> Vec<Vec<Complex<f64>>> {
        let fft = RealFftPlanner::<f64>::new().plan_fft_forward(self.segment);
        let (window, mean) = (self.window(), signal.iter().sum::<f64>() / signal.len().max(1) as f64);
        let one = |segment: usize| {
            let start = segment * self.hop();
            let part = &signal[start..start + self.segment];
            let mut input: Vec<f64> = part.iter().zip(&window).map(|(x, w)| (x - mean) * w).collect();
            let mut output = fft.make_output_vec();
            fft.process(&mut input, &mut output).expect("both have the lengths that the plan asks for");
            output
        };
        (0..self.segments(signal.len())).map(one).collect()
    }

    /// Cross power spectral density of two signals, [x] [y]/Hz; the power spectral density of one with itself.
    pub fn cross(&self, x: &[f64], y: &[f64]) -> Vec<Complex<f64>> {
        let (x, y) = (self.transforms(x), self.transforms(y));
        let power: f64 = self.window().iter().map(|w| w * w).sum();
        let scale = 1.0 / (self.rate * power * x.len().max(1) as f64);
        let lines = self.segment / 2 + 1;
        let mut sum = vec![Complex::default(); lines];
        for (x, y) in x.iter().zip(&y) {
            for k in 0..lines {
                sum[k] += x[k].conj() * y[k];
            }
        }
        // Zero and Nyquist's frequency have no mirror image.
        let mirrored = |k: usize| k > 0 && !(self.segment.is_multiple_of(2) && k == lines - 1);
        (0..lines).map(|k| sum[k] * scale * if mirrored(k) { 2.0 } else { 1.0 }).collect()
    }

    /// Power spectral density, [x]^2/Hz.
    pub fn density(&self, signal: &[f64]) -> Vec<f64> {
        self.cross(signal, signal).iter().map(|c| c.re).collect()
    }

    /// Coherence, 0..1: the share of y's power that is linear in x. One of a single segment, whatever the signals.
    pub fn coherence(&self, x: &[f64], y: &[f64]) -> Vec<f64> {
        let (xx, yy, xy) = (self.density(x), self.density(y), self.cross(x, y));
        let of = |k: usize| {
            let product = xx[k] * yy[k];
            if product > 0.0 { (xy[k].norm_sqr() / product).min(1.0) } else { 0.0 }
        };
        (0..xx.len()).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that look like noise, even between -1 and 1: variance 1/3.
    fn noise(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        (0..count).map(|_| next()).collect()
    }

    #[test]
    fn parseval_holds_to_round_off() {
        for segment in [64, 65, 1000] {
            let welch = Welch { rate: 20e3, segment };
            let signal = noise(segment, 7);
            let mean = signal.iter().sum::<f64>() / segment as f64;
            let window = welch.window();
            let power: f64 = window.iter().map(|w| w * w).sum();
            let square: f64 = signal.iter().zip(&window).map(|(x, w)| ((x - mean) * w).powi(2)).sum();
            let found: f64 = welch.density(&signal).iter().sum::<f64>() * welch.width();
            assert!((found / (square / power) - 1.0).abs() < 1e-12, "{segment}: {found}");
        }
    }

    #[test]
    fn a_sine_has_half_its_square_where_it_is() {
        let welch = Welch { rate: 20e3, segment: 2000 };
        let signal: Vec<f64> =
            (0..20_000).map(|i| 3.0 * (2.0 * PI * 1234.0 * i as f64 / 20e3).sin()).collect();
        let density = welch.density(&signal);
        let near: f64 = (120..=127).map(|k| density[k] * welch.width()).sum();
        // Hann's window leaves less than 1e-4 four lines away.
        assert!((near / 4.5 - 1.0).abs() < 1e-3, "{near}");
    }

    #[test]
    fn white_noise_is_level() {
        let welch = Welch { rate: 10e3, segment: 256 };
        let density = welch.density(&noise(256 * 400, 3));
        let level = (1.0 / 3.0) / 5e3;
        let mean = density[2..120].iter().sum::<f64>() / 118.0;
        // 800 segments, 118 lines: a third of a per cent; a single line: 4 %.
        assert!((mean / level - 1.0).abs() < 0.01, "{mean} for {level}");
        assert!(density[2..120].iter().all(|d| (d / level - 1.0).abs() < 0.25));
    }

    #[test]
    fn coherence_tells_what_is_linear() {
        let welch = Welch { rate: 10e3, segment: 128 };
        let (x, other) = (noise(128 * 200, 1), noise(128 * 200, 99));
        let twice: Vec<f64> = x.iter().map(|v| -2.0 * v).collect();
        let half: Vec<f64> = x.iter().zip(&other).map(|(a, b)| a + b).collect();
        let mean = |c: Vec<f64>| c[2..60].iter().sum::<f64>() / 58.0;
        assert!(mean(welch.coherence(&x, &twice)) > 1.0 - 1e-12);
        // Signal and noise of equal power: a half; independent ones: one over the number of segments.
        assert!((mean(welch.coherence(&x, &half)) - 0.5).abs() < 0.03);
        assert!(mean(welch.coherence(&x, &other)) < 0.02);
    }

    #[test]
    fn a_short_record_is_cut_into_two_at_least() {
        let welch = Welch::with_lines(20e3, 10.0, 1000);
        assert!(welch.segment == 666 && welch.segments(1000) == 2);
        assert_eq!(Welch::with_lines(20e3, 10.0, 100_000).segment, 2000);
    }
}
