//! Laws before their scalar is chosen: the same law serves plain numbers and lanes.

use crate::physics::material::{
    Inviscid, KelvinVoigt, Law, MooneyRivlin, MooneyRivlinEq4, NeoHookean, Viscosity,
};
use crate::physics::scalar::Scalar;

/// A law for every scalar.
pub trait LawFamily: Send + Sync + 'static {
    type Law<S: Scalar>: Law<S>;
}

/// A viscosity for every scalar.
pub trait ViscosityFamily: Send + Sync + 'static {
    type Viscosity<S: Scalar>: Viscosity<S>;
}

pub struct NeoHookeanLaw;
impl LawFamily for NeoHookeanLaw {
    type Law<S: Scalar> = NeoHookean<S>;
}

pub struct MooneyRivlinLaw;
impl LawFamily for MooneyRivlinLaw {
    type Law<S: Scalar> = MooneyRivlin<S>;
}

pub struct MooneyRivlinEq4Law;
impl LawFamily for MooneyRivlinEq4Law {
    type Law<S: Scalar> = MooneyRivlinEq4<S>;
}

pub struct NoViscosity;
impl ViscosityFamily for NoViscosity {
    type Viscosity<S: Scalar> = Inviscid;
}

pub struct ShearViscosity;
impl ViscosityFamily for ShearViscosity {
    type Viscosity<S: Scalar> = KelvinVoigt<S>;
}
