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

mod arruda_boyce;
mod hencky;
mod mooney_rivlin;
mod mooney_rivlin_eq4;
mod neo_hookean;
mod ogden;
mod relaxation;
mod viscosity;
mod yeoh;

pub use arruda_boyce::ArrudaBoyce;
pub use mooney_rivlin::MooneyRivlin;
pub use mooney_rivlin_eq4::MooneyRivlinEq4;
pub use neo_hookean::NeoHookean;
pub use ogden::Ogden;
pub use relaxation::{
    Deformed, Fading, Forgetful, Memory, Overstress, Pace, Relaxation, Term, change, overstress,
};
pub use viscosity::{Inviscid, KelvinVoigt, Viscoelastic, Viscosity, velocity_gradient};
pub use yeoh::Yeoh;

use super::parameters::{Alias, Fault, Parameter, Parameters};
use super::scalar::Scalar;

/// The laws there are. Those of the first list have kernels of their own; the others share one that asks at every point which law it
/// is, for elements of any shape: kernels take long to compile.
macro_rules! for_every_law {
    ($macro:ident) => {
        $macro! { [MooneyRivlin, NeoHookean, MooneyRivlinEq4, Yeoh] [ArrudaBoyce, Ogden] }
    };
}

/// Partial derivatives of the pointwise energy [Pa].
#[derive(Debug, Clone, Copy)]
pub struct Derivatives<S> {
    /// dW/dI1
    pub w1: S,
    /// dW/dI2; not read where `Hyperelastic::HAS_I2` is false.
    pub w2: S,
    /// dW/dJ
    pub wj: S,
}

/// A hyperelastic energy: formulas for any scalar.
pub trait Hyperelastic: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// Whether the energy depends on I2 (its code is left out otherwise).
    const HAS_I2: bool;
    /// Whether loops over points may be unrolled in lanes: not where a law has so much code that copies of it take long to
    /// compile and gain nothing.
    const UNROLLED: bool = true;

    /// Pointwise energy per reference volume [Pa].
    fn psi<S: Scalar>(&self, i1: S, i2: S, j: S) -> S;
    /// Its derivatives.
    fn derivatives<S: Scalar>(&self, i1: S, i2: S, j: S) -> Derivatives<S>;
    /// Volumetric energy U(J) [Pa] and its first two derivatives.
    fn U<S: Scalar>(&self, j: S) -> S;
    fn dU<S: Scalar>(&self, j: S) -> S;
    fn ddU<S: Scalar>(&self, j: S) -> S;
}

/// A hyperelastic law with its parameters and its moduli at small strain.
pub trait Moduli: Hyperelastic + Parameters {
    /// Initial shear modulus G [Pa].
    fn shear_modulus(&self) -> f64;
    /// Initial bulk modulus kappa [Pa].
    fn bulk_modulus(&self) -> f64;
    /// The simplest law of its kind with these moduli [Pa].
    fn from_moduli(shear: f64, bulk: f64) -> Self;
    /// A law of this kind with these moduli [Pa] in which every parameter matters: what tests and listings take.
    fn example(shear: f64, bulk: f64) -> Self;
    /// Whether W depends on shape alone, and U on volume alone.
    const IS_ISOCHORIC: bool = true;
    /// The law with `factor` times its W.
    fn with_shear_scaled(self, factor: f64) -> Self;
    /// Which parameters to look at where a modulus is not positive: for the shear, and for the bulk modulus.
    const KEYS_OF_MODULI: [&'static str; 2];

    /// What is wrong with the parameters taken together, beside moduli that are not positive.
    fn fault(&self) -> Option<Fault> {
        None
    }

    /// The cheapest law with the same energy.
    fn simplified(self) -> Law
    where
        Law: From<Self>,
    {
        self.into()
    }
}

/// What is done with a law once its type is known.
pub trait WithLaw {
    type Output;
    fn with<L: Moduli>(self, law: L) -> Self::Output
    where
        Law: From<L>;
}

/// A law before its parameters are known.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Name in a scene file.
    pub name: &'static str,
    pub parameters: &'static [Parameter],
    /// Other names of these parameters.
    pub aliases: &'static [Alias],
    /// The law from values in the order of the parameters; moduli are positive.
    pub from_values: fn(&[f64]) -> Result<Law, Fault>,
    /// The same from shear and bulk modulus [Pa].
    pub from_moduli: fn(f64, f64) -> Result<Law, Fault>,
    /// See [`Hyperelastic::example`].
    pub example: fn(f64, f64) -> Law,
}

macro_rules! laws {
    ([$($fast:ident),*] [$($law:ident),*]) => {
        /// Any hyperelastic law.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Law {
            $($fast($fast),)*
            $($law($law)),*
        }

        $(impl From<$fast> for Law {
            fn from(law: $fast) -> Law {
                Law::$fast(law)
            }
        })*
        $(impl From<$law> for Law {
            fn from(law: $law) -> Law {
                Law::$law(law)
            }
        })*

        impl Law {
            /// Every kind of law, the default of scenes first.
            pub const KINDS: &'static [Kind] = &[$(kind::<$fast>(),)* $(kind::<$law>()),*];

            /// Calls `work` with the law's own type: the one place where an enum becomes a type.
            #[inline(always)]
            pub fn visit<W: WithLaw>(&self, work: W) -> W::Output {
                match self {
                    $(Law::$fast(law) => work.with(*law),)*
                    $(Law::$law(law) => work.with(*law)),*
                }
            }

            /// [`Law::visit`] of the laws that have routines of their own; the others give the work back.
            #[inline(always)]
            pub fn visit_own<W: WithLaw>(&self, work: W) -> Result<W::Output, W> {
                match self {
                    $(Law::$fast(law) => Ok(work.with(*law)),)*
                    $(Law::$law(_))|* => Err(work),
                }
            }
        }

        /// Code for all laws, which asks at every point which one it is: for work that is not done in every step.
        impl Hyperelastic for Law {
            const HAS_I2: bool = true;
            const UNROLLED: bool = false;

            #[inline(always)]
            fn psi<S: Scalar>(&self, i1: S, i2: S, j: S) -> S {
                match self {
                    $(Law::$fast(law) => law.psi(i1, i2, j),)*
                    $(Law::$law(law) => law.psi(i1, i2, j)),*
                }
            }

            #[inline(always)]
            fn derivatives<S: Scalar>(&self, i1: S, i2: S, j: S) -> Derivatives<S> {
                match self {
                    $(Law::$fast(law) => law.derivatives(i1, i2, j),)*
                    $(Law::$law(law) => law.derivatives(i1, i2, j)),*
                }
            }

            #[inline(always)]
            fn U<S: Scalar>(&self, j: S) -> S {
                match self {
                    $(Law::$fast(law) => law.U(j),)*
                    $(Law::$law(law) => law.U(j)),*
                }
            }

            #[inline(always)]
            fn dU<S: Scalar>(&self, j: S) -> S {
                match self {
                    $(Law::$fast(law) => law.dU(j),)*
                    $(Law::$law(law) => law.dU(j)),*
                }
            }

            #[inline(always)]
            fn ddU<S: Scalar>(&self, j: S) -> S {
                match self {
                    $(Law::$fast(law) => law.ddU(j),)*
                    $(Law::$law(law) => law.ddU(j)),*
                }
            }
        }
    };
}
for_every_law!(laws);

const fn kind<L: Moduli>() -> Kind
where
    Law: From<L>,
{
    Kind {
        name: L::NAME,
        parameters: L::PARAMETERS,
        aliases: L::ALIASES,
        from_values: |values| checked(L::from_values(values)),
        from_moduli: |shear, bulk| checked(L::from_moduli(shear, bulk)),
        example: |shear, bulk| L::example(shear, bulk).into(),
    }
}

/// A law without faults whose moduli are positive.
fn checked<L: Moduli>(law: L) -> Result<Law, Fault>
where
    Law: From<L>,
{
    if let Some(fault) = law.fault() {
        return Err(fault);
    }
    let moduli = [("shear", law.shear_modulus()), ("bulk", law.bulk_modulus())];
    for ((name, modulus), key) in moduli.into_iter().zip(L::KEYS_OF_MODULI) {
        if modulus <= 0.0 {
            return Err(Fault {
                key,
                problem: format!("the {name} modulus {modulus} Pa is not positive"),
                remedy: format!("write a larger {key}"),
            });
        }
    }
    Ok(law.simplified())
}

/// Answers of a law that are plain values.
macro_rules! answers {
    ($($(#[$doc:meta])* $name:ident: $type:ty = |$law:ident: $kind:ident| $value:expr;)*) => {
        impl Law {
            $($(#[$doc])*
            pub fn $name(&self) -> $type {
                struct Answer;
                impl WithLaw for Answer {
                    type Output = $type;
                    fn with<$kind: Moduli>(self, $law: $kind) -> $type {
                        $value
                    }
                }
                self.visit(Answer)
            })*
        }
    };
}
answers! {
    /// Initial shear modulus G [Pa].
    shear_modulus: f64 = |law: L| law.shear_modulus();
    /// Initial bulk modulus kappa [Pa].
    bulk_modulus: f64 = |law: L| law.bulk_modulus();
    /// P-wave modulus kappa + 4/3 G of the unstressed material [Pa].
    wave_modulus: f64 = |law: L| law.bulk_modulus() + 4.0 / 3.0 * law.shear_modulus();
    /// Name in a scene file.
    name: &'static str = |_law: L| L::NAME;
    /// Whether W depends on shape alone, and U on volume alone.
    is_isochoric: bool = |_law: L| L::IS_ISOCHORIC;
    /// Whether the energy depends on I2.
    has_i2: bool = |_law: L| L::HAS_I2;
    /// Its parameters, and their values in that order.
    parameters: (&'static [Parameter], Vec<f64>) = |law: L| (L::PARAMETERS, law.values());
    /// Values by the shaders' names.
    constants: Vec<(&'static str, f64)> = |law: L| law.constants();
}

impl Law {
    /// The law with `factor` times its W.
    pub fn with_shear_scaled(&self, factor: f64) -> Law {
        struct Scaled(f64);
        impl WithLaw for Scaled {
            type Output = Law;
            fn with<L: Moduli>(self, law: L) -> Law
            where
                Law: From<L>,
            {
                law.with_shear_scaled(self.0).into()
            }
        }
        self.visit(Scaled(factor))
    }

    /// Its kind.
    pub fn kind(&self) -> &'static Kind {
        Law::KINDS.iter().find(|kind| kind.name == self.name()).expect("every law is of a kind")
    }
}
