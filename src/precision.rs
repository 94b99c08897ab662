//! The arithmetic of an engine: one type from the command line to `summary.json`.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Numbers that an engine computes with. Which of them an engine has, it says itself (`cpu::PRECISIONS`,
/// `AdapterReport::has`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "&'static str")]
pub enum Precision {
    /// Double.
    #[default]
    F64,
    /// Single.
    F32,
    /// Single, with positions as unevaluated sums of two numbers.
    F32Plus,
}

impl Precision {
    pub const ALL: [Precision; 3] = [Precision::F64, Precision::F32, Precision::F32Plus];

    /// Its name in arguments, scenes' results and tables.
    pub fn name(self) -> &'static str {
        match self {
            Precision::F64 => "f64",
            Precision::F32 => "f32",
            Precision::F32Plus => "f32+",
        }
    }

    /// Whether forces and velocities are single numbers.
    pub fn is_single(self) -> bool {
        self != Precision::F64
    }

    /// Whether positions are pairs of numbers.
    pub fn has_pairs(self) -> bool {
        self == Precision::F32Plus
    }

    /// Distance from 1 to the next number: twice the unit round-off of one operation.
    pub fn epsilon(self) -> f64 {
        if self.is_single() { f64::from(f32::EPSILON) } else { f64::EPSILON }
    }

    /// The same of positions: a pair of singles has the digits of both, 48 bits.
    pub fn position_epsilon(self) -> f64 {
        if self.has_pairs() { self.epsilon().powi(2) } else { self.epsilon() }
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.pad(self.name())
    }
}

impl From<Precision> for &'static str {
    fn from(precision: Precision) -> &'static str {
        precision.name()
    }
}

impl FromStr for Precision {
    type Err = String;

    /// The precision with this name; an error names all there are.
    fn from_str(name: &str) -> Result<Precision, String> {
        Precision::ALL.into_iter().find(|p| p.name() == name).ok_or_else(|| {
            format!("{name:?} is no precision: write {}", Precision::ALL.map(Precision::name).join(", "))
        })
    }
}

impl TryFrom<String> for Precision {
    type Error = String;

    fn try_from(name: String) -> Result<Precision, String> {
        name.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_in_text_and_json() {
        for precision in Precision::ALL {
            assert_eq!(precision.name().parse(), Ok(precision));
            let json = serde_json::to_string(&precision).unwrap();
            assert_eq!(json, format!("\"{precision}\""));
            assert_eq!(serde_json::from_str::<Precision>(&json).unwrap(), precision);
        }
        let problem = "f16".parse::<Precision>().unwrap_err();
        assert!(problem.contains("f64, f32, f32+"), "{problem}");
    }

    /// 1 + epsilon differs from 1 and 1 + epsilon / 4 does not, in the type that the precision stands for.
    #[test]
    fn epsilons_are_the_last_digits() {
        assert!(1.0 + Precision::F64.epsilon() > 1.0 && 1.0 + Precision::F64.epsilon() / 4.0 == 1.0);
        let single = Precision::F32.epsilon() as f32;
        assert!(1.0 + single > 1.0 && 1.0 + single / 4.0 == 1.0);
        let [plain, pairs] = [Precision::F32, Precision::F32Plus].map(Precision::position_epsilon);
        assert_eq!((plain, pairs), (single.into(), f64::from(single) * f64::from(single)));
    }
}
