//! Formulation x law x viscosity: the one place where a model's choices become types.

use super::{
    Element, ExtrudedFull, ExtrudedQ1p0, ExtrudedUniformGradient, Formulation, Full, Q1p0, UniformGradient,
};
use crate::material::{Hyperelastic, Inviscid, KelvinVoigt, Law, Viscosity, WithLaw};

/// What an element's forces are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Composition {
    pub element: Element,
    pub law: Law,
    /// Shear viscosity [Pa s]; `None`: no viscous code.
    pub viscosity: Option<f64>,
}

/// What is done with a composition once its types are known.
pub trait Compose {
    type Output;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Self::Output;
}

impl Composition {
    /// Calls `work` with the routines for elements of any shape.
    pub fn visit<W: Compose>(&self, work: W) -> W::Output {
        match self.element {
            Element::Q1p0 => self.with_formulation::<Q1p0, W>(work),
            Element::Full => self.with_formulation::<Full, W>(work),
            Element::UniformGradient { .. } => self.with_formulation::<UniformGradient, W>(work),
        }
    }

    /// The same with the routines for meshes whose elements are all extruded along eta, if these are.
    pub fn visit_fastest<W: Compose>(&self, extruded: bool, work: W) -> W::Output {
        match self.element {
            Element::Q1p0 if extruded => self.with_formulation::<ExtrudedQ1p0, W>(work),
            Element::Full if extruded => self.with_formulation::<ExtrudedFull, W>(work),
            Element::UniformGradient { .. } if extruded => {
                self.with_formulation::<ExtrudedUniformGradient, W>(work)
            }
            _ => self.visit(work),
        }
    }

    fn with_formulation<F: Formulation, W: Compose>(&self, work: W) -> W::Output {
        self.law.visit(WithFormulation::<F, W> { viscosity: self.viscosity, work, kind: Default::default() })
    }
}

struct WithFormulation<F, W> {
    viscosity: Option<f64>,
    work: W,
    kind: std::marker::PhantomData<F>,
}

impl<F: Formulation, W: Compose> WithLaw for WithFormulation<F, W> {
    type Output = W::Output;

    fn with<L: Hyperelastic>(self, law: L) -> W::Output {
        match self.viscosity {
            None => self.work.with::<F, L, Inviscid>(law, Inviscid),
            Some(eta) => self.work.with::<F, L, KelvinVoigt>(law, KelvinVoigt::new(eta)),
        }
    }
}
