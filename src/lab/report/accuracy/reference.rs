//! What errors are against: double precision, `q1p0`, on the three finest meshes.

use super::cases::{Problem, Setting};
use super::runs::{Field, Run};
use crate::bench::kind::Kind;
use hexroll::Result;
use hexroll::scene::Element;
use hexroll::study::convergence::{Convergence, FORMAL_ORDER, Level, judge};

/// The reference of a problem.
#[derive(Debug, Clone)]
pub struct Reference {
    pub problem: Problem,
    /// Force [N]; 0 for the wave, whose values are errors against d'Alembert's solution.
    pub value: f64,
    /// How well it is known [N]: the grid convergence index, or the spread of the three finest meshes.
    pub within: f64,
    /// How it was found.
    pub how: String,
    /// Command, machine and commit that it and the errors against it were measured with.
    pub from: String,
    /// Contact area [m2].
    pub area: f64,
    /// The finest mesh's displacements.
    pub(super) field: Field,
}

impl Reference {
    /// From the finest mesh m, one between it and the next, and the next: m, 3 m / 4, m / 2. Extrapolated
    /// where they converge monotonically; otherwise the finest, known no better than the three agree.
    pub(super) fn find(
        problem: Problem,
        finest: usize,
        mut run: impl FnMut(&Setting) -> Result<Run>,
    ) -> Result<Reference> {
        if problem == Problem::Wave {
            let how = "d'Alembert's solution".into();
            return Ok(Reference {
                problem,
                value: 0.0,
                within: 0.0,
                how,
                from: String::new(),
                area: f64::NAN,
                field: Vec::new(),
            });
        }
        let last = finest.max(3);
        let chosen = [last, (3 * last).div_ceil(4).min(last - 1), last / 2];
        let at = |mesh| Setting { machine: Kind::CpuF64, element: Element::Q1p0, mesh, safety: 0.9 };
        let runs = chosen.iter().map(|&m| run(&at(m))).collect::<Result<Vec<Run>>>()?;
        let levels: Vec<Level> =
            (chosen.iter().zip(&runs)).map(|(&m, r)| Level { h: 1.0 / m as f64, value: r.value }).collect();
        let (value, within, how) = judged(&levels);
        let names: Vec<String> = chosen.iter().rev().map(|m| format!("x{m}")).collect();
        let how = format!("{how} ({})", names.join(", "));
        let ratio = (chosen[0] as f64 / chosen[1] as f64).powf(FORMAL_ORDER);
        let area = runs[0].area + (runs[0].area - runs[1].area) / (ratio - 1.0);
        let [finest, ..] = <[Run; 3]>::try_from(runs).expect("three meshes were run");
        Ok(Reference { problem, value, within, how, from: String::new(), area, field: finest.field })
    }

    /// How well the value is known, relative to it.
    pub fn uncertainty(&self) -> f64 {
        if self.value == 0.0 { 0.0 } else { self.within / self.value.abs() }
    }
}

fn judged(levels: &[Level]) -> (f64, f64, String) {
    match judge(levels) {
        Convergence::Monotone { value, order, error } => {
            (value, error, format!("extrapolated, observed order {order:.1}"))
        }
        Convergence::Constant { value, within } => (value, within * value.abs(), "the same on all".into()),
        Convergence::NotMonotone { finest, spread } => (finest, spread, "the finest, not monotone".into()),
        Convergence::Diverging { finest, spread } => {
            (finest, spread, "the finest, differences do not shrink".into())
        }
        Convergence::TooFew => (f64::NAN, f64::NAN, "no finite values".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values that follow 100 + c / m^2 or go to and fro.
    fn found(value: impl Fn(usize) -> f64) -> Reference {
        let run = |s: &Setting| {
            Ok(Run { value: value(s.mesh), area: 1.0 + 1.0 / (s.mesh * s.mesh) as f64, ..Run::default() })
        };
        Reference::find(Problem::Straight, 4, run).unwrap()
    }

    #[test]
    fn a_second_order_sequence_is_extrapolated_and_another_is_taken_as_it_is() {
        let smooth = found(|m| 100.0 + 8.0 / (m * m) as f64);
        // Three meshes of an exact power law: round-off of differences of 0.1 in 100.
        assert!((smooth.value - 100.0).abs() < 1e-8 && (smooth.area - 1.0).abs() < 1e-12, "{smooth:?}");
        // 1.25 times the distance of the finest, 8 / 16.
        assert!((smooth.within - 0.625).abs() < 1e-6, "{smooth:?}");
        let folded = found(|m| if m == 3 { 101.0 } else { 100.0 });
        assert_eq!((folded.value, folded.within, folded.uncertainty()), (100.0, 1.0, 0.01), "{folded:?}");
    }
}
