//! Friction laws: how large the tangential force of a sliding node is, as a share of its normal force.

mod coulomb;
mod lat100;
mod pressure_velocity;
mod static_kinetic;
mod stribeck;
mod viscous;

pub use coulomb::Coulomb;
pub use lat100::Lat100;
pub use pressure_velocity::PressureVelocity;
pub use static_kinetic::StaticKinetic;
pub use stribeck::Stribeck;
pub use viscous::Viscous;

use super::parameters::{Fault, Parameter, Parameters};
use super::scalar::Real;

/// The laws there are: a line for each.
macro_rules! for_every_law {
    ($macro:ident) => {
        $macro! { Coulomb, Viscous, Stribeck, PressureVelocity, StaticKinetic, Lat100 }
    };
}

/// What a law may look at.
#[derive(Debug, Clone, Copy)]
pub struct Sliding<S> {
    /// Normal force over the node's area [Pa]; zero where [`FrictionLaw::READS_PRESSURE`] is false.
    pub pressure: S,
    /// Tangential speed relative to the road [m/s].
    pub slip_speed: S,
}

/// A friction law: its parameters, and the coefficient for any number.
pub trait FrictionLaw: Parameters {
    /// Whether the coefficient is the same whatever slides.
    const CONSTANT: bool = false;
    /// Whether it depends on pressure, so that nodes need areas.
    const READS_PRESSURE: bool = false;

    /// mu >= 0.
    fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S;

    /// What is wrong with the parameters taken together.
    fn fault(&self) -> Option<Fault> {
        None
    }

    /// Whether it never makes a force: such a scene has no friction code.
    fn is_none(&self) -> bool {
        false
    }

    /// The formula with its numbers, for a person.
    fn formula(&self) -> String;

    /// A law of this kind in which every parameter matters: what tests and listings take.
    fn example() -> Self;
}

/// What is done with a law once its type is known.
pub trait WithFriction {
    type Output;
    fn with<F: FrictionLaw>(self, law: F) -> Self::Output;
}

/// A friction law before its parameters are known.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Name in a scene file.
    pub name: &'static str,
    pub parameters: &'static [Parameter],
    /// The law from values in the order of the parameters; `None` if it never makes a force.
    pub from_values: fn(&[f64]) -> Result<Option<Friction>, Fault>,
    /// See [`FrictionLaw::example`].
    pub example: fn() -> Friction,
}

macro_rules! laws {
    ($($law:ident),*) => {
        /// Any friction law.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Friction {
            $($law($law)),*
        }

        $(impl From<$law> for Friction {
            fn from(law: $law) -> Friction {
                Friction::$law(law)
            }
        })*

        impl Friction {
            /// Every kind of law, the default of scenes first.
            pub const KINDS: &'static [Kind] = &[$(kind::<$law>()),*];

            /// Calls `work` with the law's own type: the one place where an enum becomes a type.
            #[inline(always)]
            pub fn visit<W: WithFriction>(&self, work: W) -> W::Output {
                match self {
                    $(Friction::$law(law) => work.with(*law)),*
                }
            }
        }
    };
}
for_every_law!(laws);

const fn kind<F: FrictionLaw>() -> Kind
where
    Friction: From<F>,
{
    Kind {
        name: F::NAME,
        parameters: F::PARAMETERS,
        from_values: |values| {
            let law = F::from_values(values);
            match law.fault() {
                Some(fault) => Err(fault),
                None => Ok((!law.is_none()).then(|| law.into())),
            }
        },
        example: || F::example().into(),
    }
}

/// Answers of a law that are plain values.
macro_rules! answers {
    ($($(#[$doc:meta])* $name:ident: $type:ty = |$law:ident: $kind:ident| $value:expr;)*) => {
        impl Friction {
            $($(#[$doc])*
            pub fn $name(&self) -> $type {
                struct Answer;
                impl WithFriction for Answer {
                    type Output = $type;
                    fn with<$kind: FrictionLaw>(self, $law: $kind) -> $type {
                        $value
                    }
                }
                self.visit(Answer)
            })*
        }
    };
}
answers! {
    /// Name in a scene file.
    name: &'static str = |_law: F| F::NAME;
    /// Whether the coefficient is the same whatever slides.
    is_constant: bool = |_law: F| F::CONSTANT;
    /// Whether the coefficient depends on pressure, so that nodes need areas.
    needs_area: bool = |_law: F| F::READS_PRESSURE;
    /// The formula with its numbers, for a person.
    formula: String = |law: F| law.formula();
    /// Values by the shaders' names.
    constants: Vec<(&'static str, f64)> = |law: F| law.constants();
}

impl Friction {
    /// mu at a pressure [Pa] and a slip speed [m/s].
    pub fn coefficient<S: Real>(&self, sliding: Sliding<S>) -> S {
        struct At<S>(Sliding<S>);
        impl<S: Real> WithFriction for At<S> {
            type Output = S;
            fn with<F: FrictionLaw>(self, law: F) -> S {
                law.coefficient(self.0)
            }
        }
        self.visit(At(sliding))
    }
}
