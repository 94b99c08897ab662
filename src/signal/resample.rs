//! From samples at uneven times to an even grid, low-pass filtered: a sinc with a Kaiser window.
//!
//! With r the rate of the grid, the filter passes up to 0.375 r and stops from 0.5 r on, the grid's Nyquist frequency, so
//! that nothing is folded back that has not been attenuated. Its response is designed after J. F. Kaiser (*Nonrecursive
//! digital filter design using the I0-sinh window function*, 1974): attenuation A = 70 dB gives beta = 0.1102 (A - 8.7) and
//! a length of (A - 7.95)/(14.36 * 0.125) = 34.6 periods of the grid.
//!
//! Times are uneven, so the convolution is a quadrature: each sample stands for half of the time to both its neighbours.
//! Two small corrections, of the window's shape, make the weights add up to one and their first moment vanish: a constant and
//! a straight line come out as they went in, whatever the times, at the ends of a record too.

use std::f64::consts::PI;

/// Attenuation of what lies beyond the grid's Nyquist frequency [dB], at least.
pub const ATTENUATION: f64 = 70.0;
/// End of the pass band and beginning of the stop band, over the grid's rate.
pub const PASS: f64 = 0.375;
pub const STOP: f64 = 0.5;

/// Half the filter's length in periods of the grid.
pub const REACH: f64 = 0.5 * (ATTENUATION - 7.95) / (14.36 * (STOP - PASS));

/// Entries of the filter's table in a period of the grid; linear in between it is 1e-6 off.
const FINENESS: f64 = 512.0;

/// The filter: its response and its window by the distance in periods of the grid.
#[derive(Debug, Clone)]
pub struct Filter {
    table: Vec<[f64; 2]>,
}

impl Default for Filter {
    fn default() -> Filter {
        let beta = 0.1102 * (ATTENUATION - 8.7);
        let cutoff = PASS + STOP;
        let entry = |i: usize| {
            let u = i as f64 / FINENESS;
            let inside = (1.0 - (u / REACH).powi(2)).max(0.0);
            let window = if u <= REACH { bessel(beta * inside.sqrt()) / bessel(beta) } else { 0.0 };
            let sinc = if u == 0.0 { 1.0 } else { (PI * cutoff * u).sin() / (PI * cutoff * u) };
            [cutoff * sinc * window, window]
        };
        Filter { table: (0..(REACH * FINENESS) as usize + 3).map(entry).collect() }
    }
}

impl Filter {
    /// Response and window at a distance of `u` >= 0 periods.
    fn at(&self, u: f64) -> [f64; 2] {
        let place = u * FINENESS;
        let i = place as usize;
        match (self.table.get(i), self.table.get(i + 1)) {
            (Some(a), Some(b)) => [0, 1].map(|k| a[k] + (place - i as f64) * (b[k] - a[k])),
            _ => [0.0; 2],
        }
    }

    /// Weights of samples at `times` [s], ascending, in the value at `t` of a grid of `rate` [Hz].
    pub fn weights(&self, times: &[f64], t: f64, rate: f64) -> Vec<f64> {
        let last = times.len().saturating_sub(1);
        // Response times quadrature, window times quadrature, distance in periods.
        let part = |i: usize| {
            let width = 0.5 * rate * (times[(i + 1).min(last)] - times[i.saturating_sub(1)]);
            let u = rate * (times[i] - t);
            let [response, window] = self.at(u.abs());
            [width * response, width * window, u]
        };
        let parts: Vec<[f64; 3]> = (0..times.len()).map(part).collect();
        let sum = |of: fn(&[f64; 3]) -> f64| parts.iter().map(of).sum::<f64>();
        let [m0, m1] = [sum(|p| p[0]), sum(|p| p[0] * p[2])];
        let [s0, s1, s2] = [sum(|p| p[1]), sum(|p| p[1] * p[2]), sum(|p| p[1] * p[2] * p[2])];
        let determinant = s0 * s2 - s1 * s1;
        if times.len() < 2 || determinant <= 0.0 {
            // One sample, or all at one time: their mean.
            return vec![1.0 / times.len() as f64; times.len()];
        }
        let level = ((1.0 - m0) * s2 + m1 * s1) / determinant;
        let slope = (-m1 * s0 - (1.0 - m0) * s1) / determinant;
        parts.iter().map(|[response, window, u]| response + (level + slope * u) * window).collect()
    }
}

/// I0, the modified Bessel function of the first kind: its power series, which ends for arguments of a Kaiser window
/// after some 30 terms.
fn bessel(x: f64) -> f64 {
    let (mut term, mut sum, mut k) = (1.0, 1.0, 0.0);
    while term > 1e-17 * sum {
        k += 1.0;
        term *= (0.5 * x / k).powi(2);
        sum += term;
    }
    sum
}

/// Many values that are sampled at the same times, on their way to the grid.
#[derive(Debug, Clone)]
pub struct Resampler {
    filter: Filter,
    /// Of the grid [Hz].
    rate: f64,
    /// Values a sample.
    width: usize,
    times: Vec<f64>,
    /// Row by row: a sample after the other.
    values: Vec<f32>,
}

impl Resampler {
    /// Towards a grid of `rate` [Hz], for samples of `width` values.
    pub fn new(rate: f64, width: usize) -> Resampler {
        Resampler { filter: Filter::default(), rate, width, times: Vec::new(), values: Vec::new() }
    }

    /// Takes a sample at `time` [s], later than the one before.
    ///
    /// # Panics
    /// If it does not have `width` values.
    pub fn push(&mut self, time: f64, values: impl IntoIterator<Item = f32>) {
        let before = self.values.len();
        self.times.push(time);
        self.values.extend(values);
        assert_eq!(self.values.len() - before, self.width, "another number of values");
    }

    /// First and last time of the samples that are held [s].
    pub fn span(&self) -> Option<[f64; 2]> {
        Some([*self.times.first()?, *self.times.last()?])
    }

    /// Whether the value at `t` depends on no sample that is still to come.
    pub fn knows(&self, t: f64) -> bool {
        // One sample more: the last one's quadrature needs its neighbour.
        let reach = t + REACH / self.rate;
        self.times.len() >= 2 && self.times[self.times.len() - 2] > reach
    }

    /// The values at `t` [s] of the samples that are held.
    pub fn value(&self, t: f64) -> Vec<f32> {
        let reach = REACH / self.rate;
        // A sample more at either end, for the quadrature.
        let first = self.times.partition_point(|time| *time < t - reach).saturating_sub(1);
        let end = (self.times.partition_point(|time| *time <= t + reach) + 1).min(self.times.len());
        let weights = self.filter.weights(&self.times[first..end], t, self.rate);
        let mut sum = vec![0.0_f32; self.width];
        let rows = self.values[first * self.width..end * self.width].chunks_exact(self.width.max(1));
        for (weight, row) in weights.iter().zip(rows) {
            let weight = *weight as f32;
            sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
        }
        sum
    }

    /// Forgets the samples that no value at `t` or later needs.
    pub fn forget_before(&mut self, t: f64) {
        let reach = REACH / self.rate;
        let gone = self.times.partition_point(|time| *time < t - reach).saturating_sub(2);
        self.times.drain(..gone);
        self.values.drain(..gone * self.width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 20e3;

    /// Times of steps of about 11 us that change from window to window, by up to 5 %.
    fn times(count: usize) -> Vec<f64> {
        let step = |i: usize| 11e-6 * (1.0 + 0.05 * (0.7 * (i / 90) as f64).sin());
        (0..count)
            .scan(0.0, |t, i| {
                *t += step(i);
                Some(*t)
            })
            .collect()
    }

    /// What comes out of a signal, away from the ends: times and values.
    fn filtered(signal: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut resampler = Resampler::new(RATE, 1);
        times(9_000).into_iter().for_each(|t| resampler.push(t, [signal(t) as f32]));
        let grid = (0..).map(|k| f64::from(k) / RATE).skip(40).take_while(|t| resampler.knows(*t));
        grid.map(|t| [t, f64::from(resampler.value(t)[0])]).collect()
    }

    /// Amplitude of a sine of `frequency` in what comes out of one of amplitude 1, in dB; `heard`: the frequency it is heard at.
    fn gain(frequency: f64, heard: f64) -> f64 {
        let out = filtered(|t| (2.0 * PI * frequency * t).sin());
        let part = |of: fn(f64) -> f64| {
            2.0 * out.iter().map(|[t, v]| v * of(2.0 * PI * heard * t)).sum::<f64>() / out.len() as f64
        };
        20.0 * part(f64::sin).hypot(part(f64::cos)).log10()
    }

    #[test]
    fn what_lies_above_nyquist_is_attenuated_by_more_than_60_db_and_what_lies_below_passes() {
        for frequency in [10_100.0, 11_000.0, 13_700.0, 17_000.0, 21_500.0, 33_300.0] {
            // A frequency above Nyquist folds back to its distance from a multiple of the rate.
            let heard = (frequency - RATE * (frequency / RATE).round()).abs();
            let found = gain(frequency, heard);
            assert!(found < -60.0, "{frequency} Hz: {found:.1} dB at {heard} Hz");
        }
        // Half a per cent in the pass band: ripple of 70 dB, quadrature of uneven steps.
        for frequency in [120.0, 1_000.0, 5_000.0, 7_400.0] {
            let found = gain(frequency, frequency);
            assert!(found.abs() < 0.04, "{frequency} Hz: {found:.4} dB");
        }
    }

    #[test]
    fn constants_and_straight_lines_have_no_ripple() {
        // f32 has 1.2e-7; a weighted sum of some 160 of them a few times that.
        for out in filtered(|_| 3.0) {
            assert!((out[1] - 3.0).abs() < 3e-6, "{out:?}");
        }
        for [t, v] in filtered(|t| 50.0 * t - 1.0) {
            assert!((v - (50.0 * t - 1.0)).abs() < 1e-5, "{t}: {v}");
        }
        // At the ends too, where half of the filter has no samples.
        let mut resampler = Resampler::new(RATE, 1);
        let all = times(400);
        all.iter().for_each(|t| resampler.push(*t, [(50.0 * t - 1.0) as f32]));
        for t in [all[0], all[0] + 1e-4, all[399]] {
            let v = f64::from(resampler.value(t)[0]);
            assert!((v - (50.0 * t - 1.0)).abs() < 1e-5, "{t}: {v}");
        }
    }

    #[test]
    fn forgetting_changes_nothing() {
        let mut resampler = Resampler::new(RATE, 2);
        for t in times(3_000) {
            resampler.push(t, [(3e3 * t).sin() as f32, t as f32]);
        }
        let before = resampler.value(0.02);
        resampler.forget_before(0.02);
        assert_eq!(resampler.value(0.02), before);
        assert!(resampler.times.len() < 1_500);
    }

    /// Abramowitz and Stegun, table 9.8: e^-x I0(x) at 5 is 0.18354 08126.
    #[test]
    fn the_bessel_function_is_the_tables() {
        assert!((bessel(5.0) * (-5f64).exp() - 0.183_540_812_6).abs() < 1e-10);
        assert_eq!(bessel(0.0), 1.0);
    }
}
