//! A claim: a number, what it should be by a source, and how near it must come.

use crate::rig::Reference;
use crate::rig::references::Within;

/// How near a number must come to what is expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// |got - expected| <= t |expected|
    Relative(f64),
    /// |got - expected| <= t, in the claim's unit.
    Absolute(f64),
    /// got <= expected
    AtMost,
    /// got >= expected
    AtLeast,
}

/// One number that a case says something about.
#[derive(Debug, Clone)]
pub struct Claim {
    pub what: String,
    pub unit: &'static str,
    pub expected: f64,
    pub got: f64,
    pub tolerance: Tolerance,
    /// Why the tolerance is what it is.
    pub reason: &'static str,
}

impl Claim {
    pub fn relative(
        what: impl Into<String>,
        unit: &'static str,
        got: f64,
        expected: f64,
        tolerance: f64,
        reason: &'static str,
    ) -> Claim {
        Claim { what: what.into(), unit, expected, got, tolerance: Tolerance::Relative(tolerance), reason }
    }

    pub fn absolute(
        what: impl Into<String>,
        unit: &'static str,
        got: f64,
        expected: f64,
        tolerance: f64,
        reason: &'static str,
    ) -> Claim {
        Claim { what: what.into(), unit, expected, got, tolerance: Tolerance::Absolute(tolerance), reason }
    }

    /// What another program says of the paper's wheel; `got` in SI units.
    pub fn reference(what: impl Into<String>, got: f64, reference: &'static Reference) -> Claim {
        let tolerance = match reference.within {
            Within::Relative(t) => Tolerance::Relative(t),
            Within::Absolute(t) => Tolerance::Absolute(t),
        };
        let (unit, expected, reason) = (reference.unit, reference.value, reference.reason.as_str());
        Claim { what: what.into(), unit, expected, got, tolerance, reason }
    }

    pub fn at_most(
        what: impl Into<String>,
        unit: &'static str,
        got: f64,
        bound: f64,
        reason: &'static str,
    ) -> Claim {
        Claim { what: what.into(), unit, expected: bound, got, tolerance: Tolerance::AtMost, reason }
    }

    pub fn at_least(
        what: impl Into<String>,
        unit: &'static str,
        got: f64,
        bound: f64,
        reason: &'static str,
    ) -> Claim {
        Claim { what: what.into(), unit, expected: bound, got, tolerance: Tolerance::AtLeast, reason }
    }

    /// Whether it came near enough; never for NaN.
    pub fn holds(&self) -> bool {
        let off = (self.got - self.expected).abs();
        match self.tolerance {
            Tolerance::Relative(t) => off <= t * self.expected.abs(),
            Tolerance::Absolute(t) => off <= t,
            Tolerance::AtMost => self.got <= self.expected,
            Tolerance::AtLeast => self.got >= self.expected,
        }
    }

    /// got / expected - 1, or the difference where the expectation is zero or a difference is asked for.
    pub fn error(&self) -> f64 {
        match self.tolerance {
            Tolerance::Absolute(_) => self.got - self.expected,
            _ if self.expected == 0.0 => self.got,
            _ => self.got / self.expected - 1.0,
        }
    }

    /// Cells of a table row: claim, expected, got, error, tolerance, pass.
    pub fn cells(&self) -> [String; 6] {
        let number = |v: f64| format!("{} {}", short(v), self.unit).trim_end().to_string();
        let (expected, error, tolerance) = match self.tolerance {
            Tolerance::Relative(t) => (number(self.expected), percent(self.error()), percent(t)),
            Tolerance::Absolute(t) => (number(self.expected), number(self.error()), number(t)),
            Tolerance::AtMost => (format!("<= {}", number(self.expected)), "-".into(), "bound".into()),
            Tolerance::AtLeast => (format!(">= {}", number(self.expected)), "-".into(), "bound".into()),
        };
        let pass = if self.holds() { "yes" } else { "**no**" };
        [self.what.clone(), expected, number(self.got), error, tolerance, pass.into()]
    }
}

/// Four digits.
pub fn short(v: f64) -> String {
    match v.abs() {
        0.0 => "0".into(),
        a if !(1e-3..1e5).contains(&a) => format!("{v:.3e}"),
        a if a >= 1e3 => format!("{v:.0}"),
        a if a >= 1e2 => format!("{v:.1}"),
        a if a >= 1e1 => format!("{v:.2}"),
        a if a >= 1.0 => format!("{v:.3}"),
        _ => format!("{v:.4}"),
    }
}

fn percent(v: f64) -> String {
    match v.abs() {
        0.0 => "0".into(),
        a if a < 1e-4 => format!("{v:.1e}"),
        a if a < 1e-2 => format!("{:.2} %", 100.0 * v),
        _ => format!("{:.1} %", 100.0 * v),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_that_is_off_or_not_a_number_does_not_hold() {
        assert!(Claim::relative("", "", 1.01, 1.0, 0.02, "").holds());
        assert!(!Claim::relative("", "", 1.03, 1.0, 0.02, "").holds());
        assert!(!Claim::relative("", "", f64::NAN, 1.0, 0.02, "").holds());
        assert!(!Claim::at_most("", "", f64::NAN, 1.0, "").holds());
        assert!(!Claim::at_least("", "", 0.9, 1.0, "").holds());
        assert!(!Claim::absolute("", "", -0.3, 0.0, 0.2, "").holds());
    }
}
