//! Spectra of a run's histories: what `hexroll spectrum` computes of [`Stored`](super::history::Stored).

use crate::output::history::Stored;
use crate::signal::bands::{Band, bands};
use crate::signal::spectrum::Welch;

/// A signal's spectrum with its name and unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Column of the CSV files.
    pub name: &'static str,
    pub title: &'static str,
    /// Of its square.
    pub unit: &'static str,
    /// Power spectral density, [unit]/Hz.
    pub density: Vec<f64>,
    /// What levels in dB are relative to, squared, and how that is written.
    pub reference: f64,
    pub reference_text: &'static str,
}

/// Spectra of a history.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectra {
    pub welch: Welch,
    /// What they are computed from [s].
    pub from: f64,
    pub to: f64,
    pub segments: usize,
    pub lines: Vec<Line>,
    /// Of the road's normal force (along z) and the mean velocity of the places along their normals, 0..1; none where one of the two
    /// is missing.
    pub coherence: Option<Vec<f64>>,
}

/// References of levels, squared: 1 N, and 5e-8 m/s, the velocity of a plane wave in air at 20 uPa.
const FORCE: f64 = 1.0;
const VELOCITY: f64 = 25e-16;

impl Spectra {
    /// Of the last stretch of a history without a gap, from `from` to `to` [s], with lines about `width` [Hz] apart. `None`: fewer
    /// than 32 values, or neither forces nor velocities.
    pub fn of(stored: &Stored, [from, to]: [f64; 2], width: f64) -> Option<Spectra> {
        let rows = rows(stored, from, to);
        if rows.len() < 32 {
            return None;
        }
        let welch = Welch::with_lines(stored.rate, width, rows.len());
        let force = stored.road_force.as_ref().map(|f| [0, 1, 2].map(|d| column(f, 3, d, &rows)));
        let mut lines = Vec::new();
        for (force, (name, title)) in force.iter().flatten().zip([
            ("road_fx_N2_per_Hz", "road force, x"),
            ("road_fy_N2_per_Hz", "road force, y"),
            ("road_fz_N2_per_Hz", "road force, z"),
        ]) {
            let density = welch.density(force);
            lines.push(Line { name, title, unit: "N2", density, reference: FORCE, reference_text: "1 N" });
        }
        let moving = stored.velocity.as_ref().map(|v| Surface { stored, velocity: v, rows: &rows });
        lines.extend(moving.as_ref().map(|surface| surface.line(&welch)));
        if lines.is_empty() {
            return None;
        }
        let mean = moving.as_ref().map(Surface::mean_normal);
        let coherence = force.zip(mean).map(|(force, mean)| welch.coherence(&force[2], &mean));
        let segments = welch.segments(rows.len());
        let [from, to] = [rows.start, rows.end - 1].map(|i| stored.times[i]);
        Some(Spectra { welch, from, to, segments, lines, coherence })
    }

    /// Level of every line in every band [dB], as far as there is one.
    pub fn bands(&self) -> Vec<(Band, Vec<Option<f64>>)> {
        let level = |line: &Line, band: &Band| {
            let power = band.power(&line.density, self.welch.width())?;
            Some(10.0 * (power / line.reference).log10()).filter(|level| level.is_finite())
        };
        bands().into_iter().map(|band| (band, self.lines.iter().map(|l| level(l, &band)).collect())).collect()
    }
}

/// Rows of the last stretch without a gap within an interval of time.
fn rows(stored: &Stored, from: f64, to: f64) -> std::ops::Range<usize> {
    let inside = |t: &f64| (from..=to).contains(t);
    let end = stored.times.iter().rposition(inside).map_or(0, |i| i + 1);
    let joined = |i: &usize| stored.times[*i] - stored.times[i - 1] < 1.5 / stored.rate;
    let start = (1..end).rev().take_while(|i| joined(i) && inside(&stored.times[i - 1])).last();
    start.map_or(end.saturating_sub(1), |i| i - 1)..end
}

fn column(values: &[f32], width: usize, at: usize, rows: &std::ops::Range<usize>) -> Vec<f64> {
    rows.clone().map(|t| f64::from(values[t * width + at])).collect()
}

/// A surface with its velocities.
struct Surface<'a> {
    stored: &'a Stored,
    velocity: &'a [f32],
    rows: &'a std::ops::Range<usize>,
}

impl Surface<'_> {
    /// Weight of a place: its area, or the same for all where none has one.
    fn weights(&self) -> Vec<f64> {
        let total: f64 = self.stored.areas.iter().sum();
        let all = self.stored.areas.len() as f64;
        self.stored.areas.iter().map(|a| if total > 0.0 { a / total } else { 1.0 / all }).collect()
    }

    fn component(&self, place: usize, d: usize) -> Vec<f64> {
        column(self.velocity, 3 * self.stored.areas.len(), 3 * place + d, self.rows)
    }

    fn normal(&self, place: usize) -> Vec<f64> {
        let n = self.stored.normals[place];
        let [x, y, z] = [0, 1, 2].map(|d| self.component(place, d));
        (0..x.len()).map(|t| n[0] * x[t] + n[1] * y[t] + n[2] * z[t]).collect()
    }

    /// Mean square over the surface: along the normals where places stay, of all components where they turn with the body and the
    /// normals of the reference shape do not.
    fn line(&self, welch: &Welch) -> Line {
        let mut density = vec![0.0; welch.segment / 2 + 1];
        let mut add = |weight: f64, signal: Vec<f64>| {
            density.iter_mut().zip(welch.density(&signal)).for_each(|(sum, d)| *sum += weight * d);
        };
        for (place, weight) in self.weights().into_iter().enumerate() {
            match self.stored.turning {
                true => (0..3).for_each(|d| add(weight, self.component(place, d))),
                false => add(weight, self.normal(place)),
            }
        }
        let (name, title) = match self.stored.turning {
            true => ("velocity_m2_s2_per_Hz", "mean-square velocity of the surface"),
            false => ("normal_velocity_m2_s2_per_Hz", "mean-square normal velocity of the surface"),
        };
        Line { name, title, unit: "m2/s2", density, reference: VELOCITY, reference_text: "5e-8 m/s" }
    }

    /// Mean over the surface of the velocity along the normals: its volume velocity over its area.
    fn mean_normal(&self) -> Vec<f64> {
        let mut mean = vec![0.0; self.rows.len()];
        for (place, weight) in self.weights().into_iter().enumerate() {
            mean.iter_mut().zip(self.normal(place)).for_each(|(sum, v)| *sum += weight * v);
        }
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Two places, one of three times the area; the first moves along its normal with 2 m/s at 500 Hz. A gap after 100 values.
    fn stored() -> Stored {
        let rate = 10e3;
        let time = |i: usize| (i + if i < 100 { 0 } else { 50 }) as f64 / rate;
        let times: Vec<f64> = (0..8100).map(time).collect();
        let wave = |t: &f64| (2.0 * PI * 500.0 * t).sin();
        let velocity = times.iter().flat_map(|t| [2.0 * wave(t), 0.0, 0.0, 7.0, 0.0, 0.0].map(|v| v as f32));
        let force = times.iter().flat_map(|t| [0.0, 0.0, 5.0 * wave(t)].map(|v| v as f32));
        Stored {
            rate,
            turning: false,
            normals: vec![[1.0, 0.0, 0.0]; 2],
            areas: vec![1e-4, 3e-4],
            velocity: Some(velocity.collect()),
            road_force: Some(force.collect()),
            times,
        }
    }

    #[test]
    fn levels_are_of_the_mean_square_over_the_surface() {
        let spectra = Spectra::of(&stored(), [0.0, 9.0], 10.0).unwrap();
        assert!((spectra.from - 0.015).abs() < 1e-9, "the stretch after the gap: {}", spectra.from);
        assert_eq!(spectra.lines.len(), 4);
        let bands = spectra.bands();
        let at = |line: usize| bands.iter().find(|(b, _)| b.nominal == 500.0).unwrap().1[line].unwrap();
        // A quarter of the area with a mean square of 2 m2/s2; a force of 12.5 N2. Hann's window keeps all but 1e-3.
        assert!((at(3) - 10.0 * (0.5 / 25e-16_f64).log10()).abs() < 0.01, "{}", at(3));
        assert!((at(2) - 10.0 * 12.5_f64.log10()).abs() < 0.01, "{}", at(2));
        // One moves with the other.
        let line = (500.0 / spectra.welch.width()).round() as usize;
        assert!(spectra.coherence.unwrap()[line] > 0.999_99);
    }

    #[test]
    fn an_interval_without_values_has_no_spectrum() {
        assert!(Spectra::of(&stored(), [3.0, 9.0], 10.0).is_none());
        let bare = Stored { velocity: None, road_force: None, ..stored() };
        assert!(Spectra::of(&bare, [0.0, 9.0], 10.0).is_none());
    }
}
