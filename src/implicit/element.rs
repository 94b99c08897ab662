//! Element forces with their consistent tangents, from the one written force routine.

use super::dual::Dual;
use crate::physics::element::{Class, Corners, Energy, Formulation, Full, Q1p0, UniformGradient};
use crate::physics::material::{
    Inviscid, KelvinVoigt, Law, MooneyRivlin, MooneyRivlinEq4, NeoHookean, Viscosity,
};
use crate::scene;
use std::marker::PhantomData;

/// Directions carried at once: the 24 columns of an element's tangent are three sweeps.
const LANES: usize = 8;
type Lane = Dual<LANES>;

/// Force of an element at a configuration.
#[derive(Debug, Clone, Copy)]
pub struct ElementForce {
    /// f_int of the corners [N].
    pub f: Corners<f64>,
    /// Smallest det F over the points.
    pub min_j: f64,
    /// Viscous power [W].
    pub viscous_power: f64,
}

/// Tangent of an element: `columns[3 b + j][a][i]` = df_a,i / dx_b,j [N/m], the change of velocity with position
/// included.
pub type Columns = [Corners<f64>; 24];

/// An element formulation with its law, for numbers and for numbers with derivatives.
pub trait Kernel: Send + Sync {
    fn force(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> ElementForce;
    /// The tangent where v depends on x by dv_a = `rate[a]` dx_a [1/s].
    fn tangent(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>, rate: &[f64; 8]) -> Box<Columns>;
    fn energy(&self, class: usize, x: &Corners<f64>) -> Energy<f64>;
}

/// A pair of a law in plain and in differentiated numbers.
struct Composed<F, L, D, V, W> {
    law: L,
    law_dual: D,
    viscosity: V,
    viscosity_dual: W,
    classes: Vec<Class<f64>>,
    classes_dual: Vec<Class<Lane>>,
    formulation: PhantomData<F>,
}

impl<F: Formulation, L: Law<f64>, D: Law<Lane>, V: Viscosity<f64>, W: Viscosity<Lane>> Kernel
    for Composed<F, L, D, V, W>
{
    fn force(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>) -> ElementForce {
        let force = F::force(&self.law, &self.viscosity, &self.classes[class], x, v);
        ElementForce { f: force.f, min_j: force.min_j, viscous_power: force.viscous_power }
    }

    fn tangent(&self, class: usize, x: &Corners<f64>, v: &Corners<f64>, rate: &[f64; 8]) -> Box<Columns> {
        let mut columns = Box::new([[[0.0; 3]; 8]; 24]);
        for first in (0..24).step_by(LANES) {
            let seeded = |base: &Corners<f64>, slope: &dyn Fn(usize) -> f64| -> Corners<Lane> {
                std::array::from_fn(|a| {
                    std::array::from_fn(|i| {
                        let mut number = Lane::constant(base[a][i]);
                        if let Some(t) = (3 * a + i).checked_sub(first).filter(|t| *t < LANES) {
                            number.tangent[t] = slope(a);
                        }
                        number
                    })
                })
            };
            let (x, v) = (seeded(x, &|_| 1.0), seeded(v, &|a| rate[a]));
            let f = F::force(&self.law_dual, &self.viscosity_dual, &self.classes_dual[class], &x, &v).f;
            for t in 0..LANES {
                columns[first + t] = f.map(|f| f.map(|c| c.tangent[t]));
            }
        }
        columns
    }

    fn energy(&self, class: usize, x: &Corners<f64>) -> Energy<f64> {
        F::energy(&self.law, &self.classes[class], x)
    }
}

/// What a composition is made of.
struct Choice<'a> {
    law: scene::Law,
    viscosity: Option<f64>,
    classes: &'a [Class<f64>],
}

/// Composes the kernel of a model.
pub fn compose(
    element: scene::Element,
    law: scene::Law,
    viscosity: Option<f64>,
    classes: &[Class<f64>],
) -> Box<dyn Kernel> {
    let choice = Choice { law, viscosity, classes };
    match element {
        scene::Element::Q1p0 => choice.with_formulation::<Q1p0>(),
        scene::Element::Full => choice.with_formulation::<Full>(),
        scene::Element::UniformGradient { .. } => choice.with_formulation::<UniformGradient>(),
    }
}

impl Choice<'_> {
    fn with_formulation<F: Formulation>(&self) -> Box<dyn Kernel> {
        match self.law {
            scene::Law::NeoHookean { .. } => self.with_law::<F, NeoHookean<f64>, NeoHookean<Lane>>(),
            scene::Law::MooneyRivlin { .. } => self.with_law::<F, MooneyRivlin<f64>, MooneyRivlin<Lane>>(),
            scene::Law::MooneyRivlinEq4 { .. } => {
                self.with_law::<F, MooneyRivlinEq4<f64>, MooneyRivlinEq4<Lane>>()
            }
        }
    }

    fn with_law<F: Formulation, L: Law<f64>, D: Law<Lane>>(&self) -> Box<dyn Kernel> {
        match self.viscosity {
            None => self.boxed::<F, L, D, Inviscid, Inviscid>(0.0),
            Some(eta) => self.boxed::<F, L, D, KelvinVoigt<f64>, KelvinVoigt<Lane>>(eta),
        }
    }

    fn boxed<F, L, D, V, W>(&self, eta: f64) -> Box<dyn Kernel>
    where
        F: Formulation,
        L: Law<f64>,
        D: Law<Lane>,
        V: Viscosity<f64>,
        W: Viscosity<Lane>,
    {
        Box::new(Composed::<F, L, D, V, W> {
            law: L::new(&self.law),
            law_dual: D::new(&self.law),
            viscosity: V::new(eta),
            viscosity_dual: W::new(eta),
            classes: self.classes.to_vec(),
            classes_dual: self.classes.iter().map(Class::cast).collect(),
            formulation: PhantomData,
        })
    }
}
