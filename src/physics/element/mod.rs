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

mod composition;
mod full;
pub mod hex8;
mod q1p0;
pub mod textbook;
mod uniform_gradient;

pub use composition::{Compose, Composition};
pub use full::{ExtrudedFull, Full};
pub use hex8::{Class, Corners, LaneShapes, SameShape, Shape};
pub use q1p0::{ExtrudedQ1p0, Q1p0};
pub use uniform_gradient::{ExtrudedUniformGradient, UniformGradient};

use super::material::{Hyperelastic, Memory, Viscosity};
use super::scalar::Scalar;
use std::ops::Range;

/// Element formulations (eqs. 11-14).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Element {
    /// 2x2x2 points for the isochoric part, one mean-dilatation pressure (Simo-Taylor-Pister).
    Q1p0,
    /// 2x2x2 points for everything.
    Full,
    /// Volume-averaged gradients (Flanagan-Belytschko) with hourglass stiffness `hourglass` times G.
    UniformGradient { hourglass: f64 },
}

/// How an element's mass is given to its corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lumping {
    /// Row sums of the consistent mass matrix, rho int N_a dV: keeps the centre of mass. The default.
    #[default]
    RowSum,
    /// An eighth to each corner, as OpenRadioss and others do; the same on parallelepipeds.
    Equal,
}

/// What the force pass of an element returns.
#[derive(Debug, Clone, Copy)]
pub struct Force<S> {
    /// f_int of the corners [N].
    pub f: Corners<S>,
    /// Smallest det F over the points: not positive means inverted, NaN stays NaN.
    pub min_j: S,
    /// Viscous power sigma_v : D dv [W]; zero without viscosity.
    pub viscous_power: S,
    /// Of a Prony series, zero without one: work of its stresses since the positions before [J], and power that its terms lose [W].
    pub memory_work: S,
    pub memory_loss: S,
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

    /// Points with a memory of their own.
    const POINTS: usize;

    /// Internal force of one element (or one lane batch) from corner positions and half-step velocities, and from what its points
    /// remember.
    fn force<S: Scalar, L: Hyperelastic, V: Viscosity, G: Shape<S>, R: Memory<S>>(
        law: &L,
        viscosity: &V,
        class: &G,
        x: &Corners<S>,
        v: &Corners<S>,
        memory: &mut R,
    ) -> Force<S>;

    /// Stored energy of one element, whose gradient with respect to x is the elastic part of the force.
    fn energy<S: Scalar, L: Hyperelastic, G: Shape<S>>(law: &L, class: &G, x: &Corners<S>) -> Energy<S>;
}
