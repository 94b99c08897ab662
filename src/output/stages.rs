//! Where the stages of a history begin and end, and means over parts of them.

use std::ops::Range;

use crate::record::Sample;

/// A stage as a history shows it: consecutive rows of one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Span {
    pub stage: String,
    /// Its rows.
    pub rows: Range<usize>,
    /// Start (the end of the last window before it, or 0) and end of its last window [s].
    pub start: f64,
    pub end: f64,
}

impl Span {
    /// The last 30 % of its time [s]: where this program takes its means.
    pub fn tail(&self) -> Range<f64> {
        self.end - 0.3 * (self.end - self.start)..self.end
    }
}

/// The stages of a history, in order.
pub fn spans(history: &[Sample]) -> Vec<Span> {
    let mut first = 0;
    let chunks = history.chunk_by(|a, b| a.stage == b.stage);
    chunks
        .map(|rows| {
            let start = starts_at(history, first);
            let span = Span {
                stage: rows[0].stage.clone(),
                rows: first..first + rows.len(),
                start,
                end: rows[rows.len() - 1].time_s,
            };
            first += rows.len();
            span
        })
        .collect()
}

/// Start of the window of row `i` [s].
pub fn starts_at(history: &[Sample], i: usize) -> f64 {
    if i == 0 { 0.0 } else { history[i - 1].time_s }
}

/// Mean of a column over an interval of time, each window weighted with the part of it that lies inside.
/// NaN if the history has nothing there.
pub fn mean(history: &[Sample], interval: &Range<f64>, value: fn(&Sample) -> f64) -> f64 {
    let mut sum = 0.0;
    let mut length = 0.0;
    for (i, sample) in history.iter().enumerate() {
        let inside = sample.time_s.min(interval.end) - starts_at(history, i).max(interval.start);
        if inside > 0.0 {
            sum += inside * value(sample);
            length += inside;
        }
    }
    sum / length
}
