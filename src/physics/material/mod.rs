//! Hyperelastic laws as functions of the invariants I1 = tr C, I2 = (I1^2 - tr C^2)/2 and J = det F.
//!
//! A law is a pointwise energy W(I1, I2, J) and a volumetric one U(J). With dI1/dF = 2 F,
//! dI2/dF = 2 (I1 F - F C), dJ/dF = cof F the first Piola stress is
//!
//! ```text
//! P = 2 W1 F + 2 W2 (I1 F - F C) + (WJ + p) cof F,     p = U'(J) or the element's mean pressure
//! ```
//!
//! so every isotropic law is three numbers at a point: [`Derivatives`].

mod mooney_rivlin;
mod mooney_rivlin_eq4;
mod neo_hookean;
mod viscosity;

pub use mooney_rivlin::MooneyRivlin;
pub use mooney_rivlin_eq4::MooneyRivlinEq4;
pub use neo_hookean::NeoHookean;
pub use viscosity::{Inviscid, KelvinVoigt, Viscosity};

use super::scalar::Scalar;
use crate::scene::Law as Choice;

/// Partial derivatives of the pointwise energy [Pa].
#[derive(Debug, Clone, Copy)]
pub struct Derivatives<S> {
    /// dW/dI1
    pub w1: S,
    /// dW/dI2; not read where `Law::HAS_I2` is false.
    pub w2: S,
    /// dW/dJ
    pub wj: S,
}

/// A hyperelastic law; parameters in Pa.
pub trait Law<S: Scalar>: Copy + Send + Sync + 'static {
    /// Whether the energy depends on I2 (its code is left out otherwise).
    const HAS_I2: bool;
    fn new(choice: &Choice) -> Self;
    /// Pointwise energy per reference volume.
    fn psi(&self, i1: S, i2: S, j: S) -> S;
    /// Its derivatives.
    fn first_piola(&self, i1: S, i2: S, j: S) -> Derivatives<S>;
    /// Volumetric energy U(J) and its first two derivatives.
    fn U(&self, j: S) -> S;
    fn dU(&self, j: S) -> S;
    fn ddU(&self, j: S) -> S;
}

impl Choice {
    /// Initial shear modulus G [Pa].
    pub fn shear_modulus(&self) -> f64 {
        match *self {
            Choice::NeoHookean { g1, .. } => g1,
            Choice::MooneyRivlin { g1, g2, .. } | Choice::MooneyRivlinEq4 { g1, g2, .. } => g1 + g2,
        }
    }

    /// Initial bulk modulus kappa [Pa].
    pub fn bulk_modulus(&self) -> f64 {
        match *self {
            Choice::NeoHookean { g0, .. } | Choice::MooneyRivlin { g0, .. } => g0,
            Choice::MooneyRivlinEq4 { g0, g1, g2 } => g0 + 2.0 / 3.0 * (g1 + g2),
        }
    }

    /// P-wave modulus kappa + 4/3 G of the unstressed material [Pa].
    pub fn wave_modulus(&self) -> f64 {
        self.bulk_modulus() + 4.0 / 3.0 * self.shear_modulus()
    }

    /// Name in a scene file.
    pub fn name(&self) -> &'static str {
        match self {
            Choice::NeoHookean { .. } => "neo-hookean",
            Choice::MooneyRivlin { .. } => "mooney-rivlin",
            Choice::MooneyRivlinEq4 { .. } => "mooney-rivlin-eq4",
        }
    }
}
