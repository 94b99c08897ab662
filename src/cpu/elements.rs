//! The element passes: forces into per-corner slots, and stored energies.

use super::team::Shared;
use crate::physics::element::{Class, Corners, Energy, Formulation};
use crate::physics::element::{Full, Q1p0, UniformGradient};
use crate::physics::material::{
    Inviscid, KelvinVoigt, Law, MooneyRivlin, MooneyRivlinEq4, NeoHookean, Viscosity,
};
use crate::physics::scalar::Real;
use crate::physics::tensor::Vec3;
use crate::scene;
use std::marker::PhantomData;
use std::ops::Range;

/// Elements whose sums are kept together, so that totals do not depend on the number of threads.
pub const CHUNK: usize = 64;

/// Constant data of the element passes.
pub struct Elements<S> {
    pub hexes: Vec<[u32; 8]>,
    pub class_of: Vec<u32>,
    pub classes: Vec<Class<S>>,
}

/// An element pass over a range, composed for one formulation, law and viscosity.
pub trait Kernel<S>: Send + Sync {
    /// Corner forces of the elements into `slots`, viscous power [W] added to `power[element / CHUNK]` times `weight`.
    /// Returns the first element whose det F is not positive.
    fn forces(
        &self,
        elements: &Elements<S>,
        range: Range<usize>,
        x: &Shared<'_, Vec3<S>>,
        v: &Shared<'_, Vec3<S>>,
        slots: &Shared<'_, Corners<S>>,
        power: &Shared<'_, f64>,
        weight: f64,
    ) -> Option<usize>;

    /// Stored energy of one element.
    fn energy(&self, elements: &Elements<S>, element: usize, x: &[Vec3<S>]) -> Energy<S>;
}

struct Composed<S, F, L, V> {
    law: L,
    viscosity: V,
    formulation: PhantomData<(S, F)>,
}

impl<S: Real, F: Formulation, L: Law<S>, V: Viscosity<S>> Kernel<S> for Composed<S, F, L, V> {
    fn forces(
        &self,
        elements: &Elements<S>,
        range: Range<usize>,
        x: &Shared<'_, Vec3<S>>,
        v: &Shared<'_, Vec3<S>>,
        slots: &Shared<'_, Corners<S>>,
        power: &Shared<'_, f64>,
        weight: f64,
    ) -> Option<usize> {
        let mut failed = None;
        for element in range {
            let hex = &elements.hexes[element];
            // SAFETY: positions and velocities are only read in this pass.
            let corners = hex.map(|n| unsafe { *x.get(n as usize) });
            let rates = if V::ON { hex.map(|n| unsafe { *v.get(n as usize) }) } else { [[S::zero(); 3]; 8] };
            let class = &elements.classes[elements.class_of[element] as usize];
            let force = F::force(&self.law, &self.viscosity, class, &corners, &rates);
            if force.min_j.partial_cmp(&S::zero()) != Some(std::cmp::Ordering::Greater) && failed.is_none() {
                failed = Some(element);
            }
            // SAFETY: slots and chunks of this range belong to this member.
            unsafe {
                *slots.get_mut(element) = force.f;
                if V::ON {
                    *power.get_mut(element / CHUNK) += weight * force.viscous_power.to_f64();
                }
            }
        }
        failed
    }

    fn energy(&self, elements: &Elements<S>, element: usize, x: &[Vec3<S>]) -> Energy<S> {
        let corners = elements.hexes[element].map(|n| x[n as usize]);
        F::energy(&self.law, &elements.classes[elements.class_of[element] as usize], &corners)
    }
}

/// Composes the kernel a model needs.
pub fn compose<S: Real>(
    element: scene::Element,
    law: scene::Law,
    viscosity: Option<f64>,
) -> Box<dyn Kernel<S>> {
    match element {
        scene::Element::Q1p0 => with_formulation::<S, Q1p0>(law, viscosity),
        scene::Element::Full => with_formulation::<S, Full>(law, viscosity),
        scene::Element::UniformGradient { .. } => with_formulation::<S, UniformGradient>(law, viscosity),
    }
}

fn with_formulation<S: Real, F: Formulation>(law: scene::Law, viscosity: Option<f64>) -> Box<dyn Kernel<S>> {
    match law {
        scene::Law::NeoHookean { .. } => with_law::<S, F, NeoHookean<S>>(law, viscosity),
        scene::Law::MooneyRivlin { .. } => with_law::<S, F, MooneyRivlin<S>>(law, viscosity),
        scene::Law::MooneyRivlinEq4 { .. } => with_law::<S, F, MooneyRivlinEq4<S>>(law, viscosity),
    }
}

fn with_law<S: Real, F: Formulation, L: Law<S>>(
    law: scene::Law,
    viscosity: Option<f64>,
) -> Box<dyn Kernel<S>> {
    match viscosity {
        None => boxed::<S, F, L, Inviscid>(law, 0.0),
        Some(eta) => boxed::<S, F, L, KelvinVoigt<S>>(law, eta),
    }
}

fn boxed<S: Real, F: Formulation, L: Law<S>, V: Viscosity<S>>(
    law: scene::Law,
    eta: f64,
) -> Box<dyn Kernel<S>> {
    Box::new(Composed::<S, F, L, V> { law: L::new(&law), viscosity: V::new(eta), formulation: PhantomData })
}

/// Internal force of one element of a shape class in f64, at any corner positions and velocities.
pub fn element_forces(
    model: &crate::model::Model,
    class: usize,
    x: &Corners<f64>,
    v: &Corners<f64>,
) -> Corners<f64> {
    let elements = Elements {
        hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]],
        class_of: vec![0],
        classes: vec![model.classes[class]],
    };
    let (mut x, mut v) = (*x, *v);
    let mut slots = [[[0.0; 3]; 8]];
    compose::<f64>(model.element, model.law, model.viscosity).forces(
        &elements,
        0..1,
        &Shared::new(&mut x),
        &Shared::new(&mut v),
        &Shared::new(&mut slots),
        &Shared::new(&mut [0.0]),
        0.0,
    );
    slots[0]
}
