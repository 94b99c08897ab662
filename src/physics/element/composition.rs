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
            Element::Q1p0 => self.any::<Q1p0, W>(work),
            Element::Full => self.any::<Full, W>(work),
            Element::UniformGradient { .. } => self.any::<UniformGradient, W>(work),
        }
    }

    /// Calls `work` with the routines of steps: those where points remember, if they do, else those for meshes whose elements are all
    /// extruded along eta, if these are and the law has such.
    pub fn visit_fastest<W: Compose>(&self, extruded: bool, work: W) -> W::Output {
        let done = match self.element {
            _ if self.relaxes => return self.remembering(work),
            _ if !extruded => Err(work),
            Element::Q1p0 => self.own::<ExtrudedQ1p0, W>(work),
            Element::Full => self.own::<ExtrudedFull, W>(work),
            Element::UniformGradient { .. } => self.own::<ExtrudedUniformGradient, W>(work),
        };
        done.unwrap_or_else(|work| self.visit(work))
    }

    /// Routines for all laws and shapes: what points remember is read from memory and written back, and takes the time.
    fn remembering<W: Compose>(&self, work: W) -> W::Output {
        let (law, viscosity) = (self.law, Viscoelastic(KelvinVoigt::new(self.viscosity.unwrap_or(0.0))));
        match self.element {
            Element::Q1p0 => work.with::<Q1p0, Law, Viscoelastic>(law, viscosity),
            Element::Full => work.with::<Full, Law, Viscoelastic>(law, viscosity),
            Element::UniformGradient { .. } => {
                work.with::<UniformGradient, Law, Viscoelastic>(law, viscosity)
            }
        }
    }

    /// The law's own routine, or one that asks at every point which law it is.
    fn any<F: Formulation, W: Compose>(&self, work: W) -> W::Output {
        self.own::<F, W>(work).unwrap_or_else(|work| match self.viscosity {
            None => work.with::<F, Law, Inviscid>(self.law, Inviscid),
            Some(eta) => work.with::<F, Law, KelvinVoigt>(self.law, KelvinVoigt::new(eta)),
        })
    }

    /// The law's own routine; the work comes back where it has none. With a viscosity only the laws of rubber that scenes ask for
    /// most have one: kernels take long to compile.
    fn own<F: Formulation, W: Compose>(&self, work: W) -> Result<W::Output, W> {
        match (self.viscosity.map(KelvinVoigt::new), self.law) {
            (None, law) => {
                law.visit_own(Elastic::<F, W> { work, kind: Default::default() }).map_err(|e| e.work)
            }
            (Some(viscosity), Law::NeoHookean(law)) => Ok(work.with::<F, _, KelvinVoigt>(law, viscosity)),
            (Some(viscosity), Law::MooneyRivlin(law)) => Ok(work.with::<F, _, KelvinVoigt>(law, viscosity)),
            (Some(_), _) => Err(work),
        }
    }
}

struct Elastic<F, W> {
    work: W,
    kind: std::marker::PhantomData<F>,
}

impl<F: Formulation, W: Compose> WithLaw for Elastic<F, W> {
    type Output = W::Output;

    fn with<L: Hyperelastic>(self, law: L) -> W::Output {
        self.work.with::<F, L, Inviscid>(law, Inviscid)
    }
}
