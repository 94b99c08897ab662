//! Differences between two histories, column by column.

use serde::Serialize;

use super::{Run, relative_l2};
use crate::output::stages::{self, Span};
use crate::output::summary::largest;
use crate::record::Sample;

/// Differences between two histories.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct HistoryError {
    /// Rows of A and of B, and how many have a partner.
    pub rows_a: usize,
    pub rows_b: usize,
    pub matched: usize,
    /// Stage whose last 30 % the means are taken over: the last one that both runs have.
    pub means_of_stage: Option<String>,
    pub columns: Vec<ColumnError>,
}

/// Differences in one column, over the matched rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnError {
    pub name: &'static str,
    /// Largest |B - A|, in the column's unit.
    pub max_difference: f64,
    /// Norm of B - A over the norm of A; none if A is zero in every row and B is not.
    pub relative_l2: Option<f64>,
    /// Means over the last 30 % of the stage, each over its own windows.
    pub mean_a: f64,
    pub mean_b: f64,
}

/// Compares; adds to `notes` what keeps rows from being comparable.
pub fn compare(a: &Run, b: &Run, notes: &mut Vec<String>) -> HistoryError {
    let stages = common_stages(a, b, notes);
    let pairs: Vec<_> = stages.iter().flat_map(|(one, other)| pairs(a, b, one, other)).collect();
    note_rows(a, b, &pairs, notes);
    let last = stages.last();
    // The first column is the time, by which the rows were matched.
    let columns = Sample::COLUMNS[1..].iter().filter(|_| !pairs.is_empty());
    let columns = columns.map(|&(name, value)| {
        let values = || pairs.iter().map(|&(i, j)| (value(&a.history[i]), value(&b.history[j])));
        let mean = |run: &Run, span: &Span| stages::mean(&run.history, &span.tail(), value);
        ColumnError {
            name,
            max_difference: largest(values().map(|(a, b)| b - a)),
            relative_l2: relative_l2(values()),
            mean_a: last.map_or(f64::NAN, |(one, _)| mean(a, one)),
            mean_b: last.map_or(f64::NAN, |(_, other)| mean(b, other)),
        }
    });
    HistoryError {
        rows_a: a.history.len(),
        rows_b: b.history.len(),
        matched: pairs.len(),
        columns: columns.collect(),
        means_of_stage: last.map(|(one, _)| one.stage.clone()),
    }
}

/// Stages that both runs have, in A's order.
fn common_stages(a: &Run, b: &Run, notes: &mut Vec<String>) -> Vec<(Span, Span)> {
    let (spans_a, mut spans_b) = (stages::spans(&a.history), stages::spans(&b.history));
    let mut common = Vec::new();
    for one in spans_a {
        let Some(at) = spans_b.iter().position(|other| other.stage == one.stage) else {
            notes.push(format!("only A has stage {:?}", one.stage));
            continue;
        };
        let other = spans_b.remove(at);
        for (what, s, t) in [("starts", one.start, other.start), ("ends", one.end, other.end)] {
            if (s - t).abs() > a.tolerance() {
                notes.push(format!("stage {:?} {what} at {s:.6e} s in A, {t:.6e} s in B", one.stage));
            }
        }
        common.push((one, other));
    }
    notes.extend(spans_b.iter().map(|other| format!("only B has stage {:?}", other.stage)));
    common
}

/// Rows of a stage that end at the same time since its start.
fn pairs(a: &Run, b: &Run, one: &Span, other: &Span) -> Vec<(usize, usize)> {
    let since = |run: &Run, span: &Span, i: usize| run.history[i].time_s - span.start;
    let rows: Vec<usize> = other.rows.clone().collect();
    let partner = |i: usize| {
        let time = since(a, one, i);
        let near = rows.partition_point(|&j| since(b, other, j) < time - a.tolerance());
        let &j = rows.get(near)?;
        (since(b, other, j) <= time + a.tolerance()).then_some((i, j))
    };
    one.rows.clone().filter_map(partner).collect()
}

fn note_rows(a: &Run, b: &Run, pairs: &[(usize, usize)], notes: &mut Vec<String>) {
    let rows = [a.history.len(), b.history.len()];
    if rows != [pairs.len(); 2] {
        notes.push(format!("A has {} rows and B {}; {} match", rows[0], rows[1], pairs.len()));
    }
    let window = |run: &Run, i: usize| run.history[i].time_s - stages::starts_at(&run.history, i);
    let differs = |&&(i, j): &&(usize, usize)| (window(a, i) - window(b, j)).abs() > a.tolerance();
    if let Some(&(i, j)) = pairs.iter().find(differs) {
        notes.push(format!(
            "windows differ in {} of the matched rows (row {i}: {:.3e} s in A, {:.3e} s in B), \
             so their forces are means over different times",
            pairs.iter().filter(differs).count(),
            window(a, i),
            window(b, j)
        ));
    }
}
