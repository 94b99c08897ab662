//! A Prony series on the device: its terms in each step, and the size of what the points remember.

use crate::model::Model;
use crate::physics::element::Element;
use crate::physics::material::{Pace, Relaxation};

/// Numbers of a symmetric matrix.
const SYMMETRIC: usize = 6;

/// A Prony series.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    relaxation: Relaxation,
    /// Of the law [Pa].
    shear_modulus: f64,
    /// Whether everything has relaxed at the present positions, where another solver has put the body.
    pub rested: bool,
}

impl Series {
    /// That of a model, if it has one.
    pub fn of(model: &Model) -> Option<Series> {
        let (relaxation, shear_modulus) = (model.relaxation.clone(), model.law.shear_modulus());
        (!relaxation.terms.is_empty()).then_some(Series { relaxation, shear_modulus, rested: true })
    }

    /// The terms as shaders/memory/prony.wgsl reads them, in a step of `after` [s] that follows one of `before` [s].
    pub fn fading(&self, before: f64, after: f64, pace: Pace) -> Vec<[f64; 4]> {
        let terms = self.relaxation.fading(self.shear_modulus, before, after, pace);
        terms.iter().map(|term| [term.ratio, term.held, term.kept, term.loss]).collect()
    }
}

/// Points of an element that remember.
fn points(element: Element) -> usize {
    match element {
        Element::Q1p0 | Element::Full => 8,
        Element::UniformGradient { .. } => 1,
    }
}

/// Numbers that the points of all elements remember, and what each element has lost; 0 without a series.
pub fn remembered(model: &Model) -> usize {
    let numbers = SYMMETRIC * points(model.element) * model.relaxation.terms.len();
    if numbers == 0 { 0 } else { (numbers + 1) * model.element_count() }
}

/// Constants of shaders/memory/prony.wgsl.
pub fn constants(model: &Model) -> [(&'static str, f64); 4] {
    [
        ("prony_terms", model.relaxation.terms.len() as f64),
        ("prony_modulus", model.law.shear_modulus()),
        ("memory_elements", model.element_count() as f64),
        ("memory_points", points(model.element) as f64),
    ]
}
