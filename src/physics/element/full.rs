use super::hex8::{self, Corners, Shape};
use super::q1p0::{points, pointwise_energy};
use super::{Class, Energy, Force, Formulation};
use crate::material::{Hyperelastic, Memory, Viscosity};
use crate::scalar::Scalar;
use std::ops::Range;

/// 2x2x2 points for everything: locks near incompressibility, and shows it.
pub type Full = FullOf<false>;

/// The same for elements that are all extruded along eta ([`super::Class::is_extruded`]).
pub type ExtrudedFull = FullOf<true>;

/// Either of them.
#[derive(Debug, Clone, Copy)]
pub struct FullOf<const EXTRUDED: bool>;

impl<const EXTRUDED: bool> Formulation for FullOf<EXTRUDED> {
    const NUMBERS: Range<usize> = Class::<f64>::OF_POINTS;
    const POINTS: usize = 8;

    #[inline(always)]
    fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, R: Memory<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
        memory: &mut R,
    ) -> Force<S> {
        points::<S, L, V, G, R, true, EXTRUDED>(
            law,
            viscosity,
            class,
            &hex8::gradients(x),
            v,
            S::zero(),
            memory,
        )
    }

    #[inline(always)]
    fn energy<S: Scalar, L: Hyperelastic, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S> {
        pointwise_energy::<S, L, G, true>(law, class, &hex8::gradients(x))
    }
}
