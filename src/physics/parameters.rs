//! What a law says of its parameters by name, once: reading, checking, uploading and listing follow from it.

/// What a parameter measures; scenes know the units of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A pure number.
    Number,
    /// A modulus or a pressure [Pa].
    Stress,
    /// One over a modulus [1/Pa].
    Compressibility,
    /// A speed [m/s].
    Speed,
    /// One over a speed [s/m].
    Slowness,
}

/// Values that a parameter may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    Any,
    NotNegative,
    Positive,
}

/// A parameter of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Key in a scene file.
    pub key: &'static str,
    /// Name of the shaders' overridable constant.
    pub constant: &'static str,
    /// One line for a reader of the guide.
    pub doc: &'static str,
    pub quantity: Quantity,
    pub bound: Bound,
    /// Value where a scene says nothing; without one the key is needed.
    pub default: Option<f64>,
}

/// Another name under which a scene may give a parameter, in the constants of another convention.
#[derive(Debug, Clone, Copy)]
pub struct Alias {
    /// Key in a scene file.
    pub key: &'static str,
    /// Key of the parameter that it stands for.
    pub parameter: &'static str,
    /// One line for a reader of the guide.
    pub doc: &'static str,
    pub quantity: Quantity,
    /// The parameter's value from the alias's.
    pub value: fn(f64) -> f64,
}

/// What is wrong with the values of some parameters taken together.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Key that a reader should look at first.
    pub key: &'static str,
    pub problem: String,
    pub remedy: String,
}

/// A type that is its parameters, in SI units and double precision. Written by [`parameters!`](crate::parameters!).
pub trait Parameters: Copy + std::fmt::Debug + PartialEq + Send + Sync + 'static {
    /// Name in a scene file; with `_` for `-` the stem of its shader.
    const NAME: &'static str;
    const PARAMETERS: &'static [Parameter];
    /// Other names of some of them.
    const ALIASES: &'static [Alias];

    /// Values in the order of [`Parameters::PARAMETERS`].
    fn values(&self) -> Vec<f64>;

    /// The reverse; as many values as there are parameters.
    fn from_values(values: &[f64]) -> Self;

    /// Values by the shaders' names.
    fn constants(&self) -> Vec<(&'static str, f64)> {
        Self::PARAMETERS.iter().map(|p| p.constant).zip(self.values()).collect()
    }
}

/// Declares a struct of named parameters and its [`Parameters`].
///
/// ```text
/// parameters! {
///     /// What the law says.
///     pub struct Stribeck("stribeck", constants "friction_") {
///         /// mu at rest.
///         still "static": Number, Positive;
///         /// Slope at high speed [s/m].
///         slope "slope": Slowness, NotNegative, or 0.0;
///     } also {
///         /// What another program calls the slope's reciprocal.
///         "d" for "slope": Speed, |d| 1.0 / d;
///     }
/// }
/// ```
#[macro_export]
#[doc(hidden)]
macro_rules! parameters_of_a_law {
    (
        $(#[$meta:meta])*
        pub struct $type:ident($name:literal, constants $prefix:literal) {
            $($(#[doc = $doc:literal])* $field:ident $key:literal: $quantity:ident, $bound:ident $(, or $default:literal)?;)*
        } $(also {
            $($(#[doc = $alias_doc:literal])* $alias:literal for $of:literal: $alias_quantity:ident, |$given:ident| $value:expr;)*
        })?
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $type {
            $($(#[doc = $doc])* pub $field: f64,)*
        }

        impl $crate::parameters::Parameters for $type {
            const NAME: &'static str = $name;
            const PARAMETERS: &'static [$crate::parameters::Parameter] = &[$(
                $crate::parameters::Parameter {
                    key: $key,
                    constant: concat!($prefix, stringify!($field)),
                    doc: concat!($($doc),*).trim_ascii(),
                    quantity: $crate::parameters::Quantity::$quantity,
                    bound: $crate::parameters::Bound::$bound,
                    default: $crate::parameters_of_a_law!(@default $($default)?),
                },
            )*];

            const ALIASES: &'static [$crate::parameters::Alias] = &[$($(
                $crate::parameters::Alias {
                    key: $alias,
                    parameter: $of,
                    doc: concat!($($alias_doc),*).trim_ascii(),
                    quantity: $crate::parameters::Quantity::$alias_quantity,
                    value: |$given| $value,
                },
            )*)?];

            fn values(&self) -> Vec<f64> {
                vec![$(self.$field),*]
            }

            fn from_values(values: &[f64]) -> Self {
                let mut values = values.iter().copied();
                $(let $field = values.next().expect("a value for every parameter");)*
                $type { $($field),* }
            }
        }
    };
    (@default) => { None };
    (@default $default:literal) => { Some($default) };
}
pub use crate::parameters_of_a_law as parameters;
