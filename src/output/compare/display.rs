//! A comparison as text.

use std::fmt::{Display, Formatter, Result};

use super::{Comparison, HistoryError, SnapshotError};

impl Display for Comparison {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "A: {}\nB: {}", self.a.display(), self.b.display())?;
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        if !self.settings.is_empty() {
            writeln!(f, "\n{:<16} {:<38} B", "settings", "A")?;
        }
        for setting in &self.settings {
            writeln!(f, "{:<16} {:<38} {}", setting.name, text(&setting.a), text(&setting.b))?;
        }
        write!(f, "\n{}", self.history)?;
        for snapshot in &self.snapshots {
            write!(f, "\n{snapshot}")?;
        }
        Ok(())
    }
}

/// A JSON value without the quotes of a string.
fn text(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A ratio, or a dash where there is nothing to relate to.
fn ratio(value: Option<f64>) -> String {
    value.map_or("-".into(), |v| format!("{v:.3e}"))
}

impl Display for HistoryError {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "history: {} matched rows", self.matched)?;
        if let Some(stage) = &self.means_of_stage {
            writeln!(f, "means over the last 30 % of stage {stage:?}")?;
        }
        if self.columns.is_empty() {
            return Ok(());
        }
        let [max, l2, a, b] = ["max |B-A|", "rel. L2", "mean A", "mean B"];
        writeln!(f, "{:<24} {max:>11} {l2:>11} {a:>14} {b:>14}", "column")?;
        for c in &self.columns {
            let (name, max, l2) = (c.name, c.max_difference, ratio(c.relative_l2));
            writeln!(f, "{name:<24} {max:>11.3e} {l2:>11} {:>14.6e} {:>14.6e}", c.mean_a, c.mean_b)?;
        }
        Ok(())
    }
}

impl Display for SnapshotError {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let SnapshotError { stage, time_a, time_b, .. } = self;
        writeln!(f, "snapshot of stage {stage:?}, t = {time_a:.6e} s in A, {time_b:.6e} s in B")?;
        let [max, l2] = ["max |B-A|", "rel. L2"];
        writeln!(f, "{:<24} {max:>11} {l2:>11}  at", "field")?;
        for e in &self.fields {
            let (name, max, l2) =
                (format!("{} [{}]", e.name, e.unit), e.max_difference, ratio(e.relative_l2));
            let at = if max == 0.0 { "-".into() } else { format!("{} {}", e.entity, e.worst) };
            writeln!(f, "{name:<24} {max:>11.3e} {l2:>11}  {at}")?;
        }
        Ok(())
    }
}
