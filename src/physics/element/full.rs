use super::hex8::{self, Class, Corners};
use super::q1p0::{points, pointwise_energy};
use super::{Energy, Force, Formulation};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::Scalar;

/// 2x2x2 points for everything: locks near incompressibility, and shows it.
#[derive(Debug, Clone, Copy)]
pub struct Full;

impl Formulation for Full {
    #[inline(always)]
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>>(
        law: &L,
        viscosity: &V,
        class: &Class<S>,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        points::<S, L, V, true>(law, viscosity, class, &hex8::gradients(x), v, S::zero())
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Law<S>>(law: &L, class: &Class<S>, x: &Corners<S>) -> Energy<S> {
        pointwise_energy::<S, L, true>(law, class, &hex8::gradients(x))
    }
}
