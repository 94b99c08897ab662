//! Formulation x law x viscosity: the one place where a model's choices become types.

use super::{
    Element, ExtrudedFull, ExtrudedQ1p0, ExtrudedUniformGradient, Formulation, Full, Q1p0, UniformGradient,
};
use crate::material::{Hyperelastic, Inviscid, KelvinVoigt, Law, Viscoelastic, Viscosity, WithLaw};

/// What an element's forces are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Composition {
    pub element: Element,
    pub law: Law,
    /// Shear viscosity [Pa s]; `None`: no viscous code.
    pub viscosity: Option<f64>,
    /// Whether points remember, by a Prony series.
    pub relaxes: bool,
}

/// What is done with a composition once its types are known.
pub trait Compose {
    type Output;
    fn with<F: Formulation, L: Hyperelastic, V: Viscosity>(self, law: L, viscosity: V) -> Self::Output;
}

impl Composition {
    /// Calls `work` with the routines for elements of any shape, which remember nothing: the law is that of slow deformation.
    pub fn visit<W: Compose>(&self, work: W) -> W::Output {
        match self.element {
            Element::Q1p0 => self.with_formulation::<Q1p0, W>(work),
            Element::Full => self.with_formulation::<Full, W>(work),
            Element::UniformGradient { .. } => self.with_formulation::<UniformGradient, W>(work),
        }
    }

    /// Calls `work` with the routines of steps: those for meshes whose elements are all extruded along eta, if these are, and
    /// points remember, if they do.
    pub fn visit_fastest<W: Compose>(&self, extruded: bool, work: W) -> W::Output {
        match self.element {
            Element::Q1p0 if extruded => self.with_memory::<ExtrudedQ1p0, W>(work),
            Element::Full if extruded => self.with_memory::<ExtrudedFull, W>(work),
            Element::UniformGradient { .. } if extruded => {
                self.with_memory::<ExtrudedUniformGradient, W>(work)
            }
            Element::Q1p0 => self.with_memory::<Q1p0, W>(work),
            Element::Full => self.with_memory::<Full, W>(work),
            Element::UniformGradient { .. } => self.with_memory::<UniformGradient, W>(work),
        }
    }

    /// One routine for all laws where points remember: what they remember is read from memory and written back, and takes the time.
    fn with_memory<F: Formulation, W: Compose>(&self, work: W) -> W::Output {
        match self.relaxes {
            true => {
                let viscosity = Viscoelastic(KelvinVoigt::new(self.viscosity.unwrap_or(0.0)));
                work.with::<F, Law, Viscoelastic>(self.law, viscosity)
            }
            false => self.with_formulation::<F, W>(work),
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
