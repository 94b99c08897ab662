//! Eight-node hexahedra (eqs. 11-14), total Lagrangian, in element coordinates.
//!
//! With A = dx/dxi at a point and J0 = dX/dxi, F = A J0^-1 and
//!
//! ```text
//! I1 = tr(A^T A M),  M = J0^-1 J0^-T,   J = det A / det J0
//! alpha F Grad N -> alpha A M grad_xi N,   cof(F) Grad N det J0 = cof(A) grad_xi N
//! ```
//!
//! so geometry enters through M and det J0 alone. Neither changes when an element is rotated or moved: elements
//! that share them share a [`Class`].

mod full;
pub mod hex8;
mod q1p0;
mod uniform_gradient;

pub use full::{ExtrudedFull, Full};
pub use hex8::{Class, Corners, LaneShapes, SameShape, Shape};
pub use q1p0::{ExtrudedQ1p0, Q1p0};
pub use uniform_gradient::{ExtrudedUniformGradient, UniformGradient};

use super::material::{Law, Viscosity};
use super::scalar::Scalar;
use std::ops::Range;

/// What the force pass of an element returns.
#[derive(Debug, Clone, Copy)]
pub struct Force<S> {
    /// f_int of the corners [N].
    pub f: Corners<S>,
    /// Smallest det F over the points: not positive means inverted, NaN stays NaN.
    pub min_j: S,
    /// Viscous power sigma_v : D dv [W]; zero without viscosity.
    pub viscous_power: S,
}

/// What the energy pass of an element returns.
#[derive(Debug, Clone, Copy)]
pub struct Energy<S> {
    /// Stored energy of the material [J].
    pub strain: S,
    /// Stored energy of the hourglass stiffness [J].
    pub hourglass: S,
    /// Smallest det F over the points.
    pub min_j: S,
}

/// An element formulation.
pub trait Formulation: Copy + Send + Sync + 'static {
    /// Those of [`Class::numbers`] that the force reads.
    const NUMBERS: Range<usize>;

    /// Internal force of one element (or one lane batch) from corner positions and half-step velocities.
    fn force<S: Scalar, L: Law<S>, V: Viscosity<S>, G: Shape<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
    ) -> Force<S>;

    /// Stored energy of one element, whose gradient with respect to x is the elastic part of the force.
    fn energy<S: Scalar, L: Law<S>, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S>;
}
