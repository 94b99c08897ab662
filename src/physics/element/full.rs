use super::hex8::{self, Corners, Shape};
use super::q1p0::{points, pointwise_energy};
use super::{Energy, Force, Formulation};
use crate::physics::material::{Law, Viscosity};
use crate::physics::scalar::Scalar;

/// 2x2x2 points for everything: locks near incompressibility, and shows it.
#[derive(Debug, Clone, Copy)]
pub struct Full;

impl Formulation for Full {
    #[inline(always)]
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        points::<S, L, V, G, true, false>(law, viscosity, class, &hex8::gradients(x), v, S::zero())
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Law<S>, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        pointwise_energy::<S, L, G, true>(law, class, &hex8::gradients(x))
    }
}

/// The same for elements that are all extruded along eta ([`super::Class::is_extruded`]).
#[derive(Debug, Clone, Copy)]
pub struct ExtrudedFull;

impl Formulation for ExtrudedFull {
    #[inline(always)]
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S> {
        points::<S, L, V, G, true, true>(law, viscosity, class, &hex8::gradients(x), v, S::zero())
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Law<S>, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        Full::energy(law, class, x)
    }
}
