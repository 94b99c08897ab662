//! Structs and arrays that host and shader share, each from one declaration: in double precision on the host, and in the
//! shaders' own on the device, laid out as WGSL says.

/// Precision of the shaders' real numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Real {
    Single,
    Double,
}

impl Real {
    /// Bytes of one number.
    pub fn bytes(self) -> usize {
        match self {
            Real::Single => 4,
            Real::Double => 8,
        }
    }
}

/// A type with a place in WGSL's memory (alignment and sizes in bytes, WGSL 14.4.1).
pub trait Wgsl: Sized {
    fn spelling() -> String;
    fn align(real: Real) -> usize;
    fn size(real: Real) -> usize;
    /// Appends exactly [`size`](Wgsl::size) bytes; padding is zero.
    fn put(&self, real: Real, out: &mut Vec<u8>);
    /// From the first [`size`](Wgsl::size) bytes.
    fn take(real: Real, bytes: &[u8]) -> Self;

    /// From one entry of an array to the next.
    fn stride(real: Real) -> usize {
        Self::size(real).next_multiple_of(Self::align(real))
    }
}

/// Bytes of an array.
pub fn encode<T: Wgsl>(real: Real, values: &[T]) -> Vec<u8> {
    let mut out = Vec::with_capacity(values.len() * T::stride(real));
    for value in values {
        value.put(real, &mut out);
        out.resize(out.len().next_multiple_of(T::align(real)), 0);
    }
    out
}

/// The entries of an array.
pub fn decode<T: Wgsl>(real: Real, bytes: &[u8]) -> Vec<T> {
    bytes.chunks_exact(T::stride(real)).map(|entry| T::take(real, entry)).collect()
}

impl Wgsl for f64 {
    fn spelling() -> String {
        "real".into()
    }

    fn align(real: Real) -> usize {
        real.bytes()
    }

    fn size(real: Real) -> usize {
        real.bytes()
    }

    fn put(&self, real: Real, out: &mut Vec<u8>) {
        match real {
            Real::Single => out.extend((*self as f32).to_ne_bytes()),
            Real::Double => out.extend(self.to_ne_bytes()),
        }
    }

    fn take(real: Real, bytes: &[u8]) -> f64 {
        match real {
            Real::Single => f64::from(f32::from_ne_bytes(first(bytes))),
            Real::Double => f64::from_ne_bytes(first(bytes)),
        }
    }
}

impl Wgsl for u32 {
    fn spelling() -> String {
        "u32".into()
    }

    fn align(_: Real) -> usize {
        4
    }

    fn size(_: Real) -> usize {
        4
    }

    fn put(&self, _: Real, out: &mut Vec<u8>) {
        out.extend(self.to_ne_bytes());
    }

    fn take(_: Real, bytes: &[u8]) -> u32 {
        u32::from_ne_bytes(first(bytes))
    }
}

fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
    *bytes.first_chunk().expect("a value has all of its bytes")
}

/// Vectors are aligned to the next power of two numbers.
impl<const N: usize> Wgsl for [f64; N] {
    fn spelling() -> String {
        format!("vec{N}r")
    }

    fn align(real: Real) -> usize {
        N.next_power_of_two() * real.bytes()
    }

    fn size(real: Real) -> usize {
        N * real.bytes()
    }

    fn put(&self, real: Real, out: &mut Vec<u8>) {
        self.iter().for_each(|number| number.put(real, out));
    }

    fn take(real: Real, bytes: &[u8]) -> Self {
        std::array::from_fn(|i| f64::take(real, &bytes[i * real.bytes()..]))
    }
}

macro_rules! fixed_arrays {
    ($($type:ty),* $(,)?) => {$(
        impl<const N: usize> Wgsl for [$type; N] {
            fn spelling() -> String {
                format!("array<{}, {N}>", <$type as Wgsl>::spelling())
            }

            fn align(real: Real) -> usize {
                <$type as Wgsl>::align(real)
            }

            fn size(real: Real) -> usize {
                N * <$type as Wgsl>::stride(real)
            }

            fn put(&self, real: Real, out: &mut Vec<u8>) {
                out.extend(encode(real, self));
            }

            fn take(real: Real, bytes: &[u8]) -> Self {
                std::array::from_fn(|i| <$type as Wgsl>::take(real, &bytes[i * <$type as Wgsl>::stride(real)..]))
            }
        }
    )*};
}
fixed_arrays!([f64; 4], PointGeometry);

/// A shared struct: its WGSL text, its size and the offsets of its fields.
pub struct Shared {
    pub name: &'static str,
    pub text: String,
    pub size: usize,
    pub offsets: Vec<(&'static str, usize)>,
}

macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty),* $(,)? })*) => {
        $(
            $(#[$doc])*
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct $name { $($(#[$field_doc])* pub $field: $type),* }

            impl Wgsl for $name {
                fn spelling() -> String {
                    stringify!($name).into()
                }

                fn align(real: Real) -> usize {
                    [$(<$type as Wgsl>::align(real)),*].into_iter().fold(1, usize::max)
                }

                fn size(real: Real) -> usize {
                    let mut at = 0;
                    $(at = after::<$type>(real, at);)*
                    at.next_multiple_of(Self::align(real))
                }

                fn put(&self, real: Real, out: &mut Vec<u8>) {
                    let start = out.len();
                    $(
                        out.resize(start + place::<$type>(real, out.len() - start), 0);
                        self.$field.put(real, out);
                    )*
                    out.resize(start + Self::size(real), 0);
                }

                fn take(real: Real, bytes: &[u8]) -> Self {
                    let mut at = 0;
                    $(
                        let $field = <$type as Wgsl>::take(real, &bytes[place::<$type>(real, at)..]);
                        at = after::<$type>(real, at);
                    )*
                    debug_assert!(at <= Self::size(real));
                    $name { $($field),* }
                }
            }
        )*
        /// Every shared struct.
        pub fn all(real: Real) -> Vec<Shared> {
            vec![$({
                let mut text = format!("struct {} {{\n", stringify!($name));
                $(text += &format!("    {}: {},\n", stringify!($field), <$type as Wgsl>::spelling());)*
                text += "}\n";
                let (mut at, mut offsets) = (0, Vec::new());
                $(
                    offsets.push((stringify!($field), place::<$type>(real, at)));
                    at = after::<$type>(real, at);
                )*
                debug_assert!(at <= <$name as Wgsl>::size(real));
                Shared { name: stringify!($name), text, size: <$name as Wgsl>::size(real), offsets }
            }),*]
        }
    };
}

/// Where a field of type `T` is whose predecessor ends at `at`, and where it ends.
fn place<T: Wgsl>(real: Real, at: usize) -> usize {
    at.next_multiple_of(T::align(real))
}

fn after<T: Wgsl>(real: Real, at: usize) -> usize {
    place::<T>(real, at) + T::size(real)
}

shared! {
    /// A step of the plan. With a free rim `axle` holds the moves of prescribed components since the window began,
    /// and `rotation` steer and camber alone.
    Step {
        dt: f64,
        dtm: f64,
        weight_before: f64,
        weight_after: f64,
        index: u32,
        viscous_weight: f64,
        spin: f64,
        /// 0, but only at run time.
        zero: u32,
        axle: [f64; 4],
        axle_velocity: [f64; 4],
        axle_before: [f64; 4],
        rotation0: [f64; 4],
        rotation1: [f64; 4],
        rotation2: [f64; 4],
        rate0: [f64; 4],
        rate1: [f64; 4],
        rate2: [f64; 4],
        /// Loads on x, y, z [N] and spin [N m].
        load: [f64; 4],
        /// Its place in the submission.
        slot: u32,
        /// Time before that of the positions over which the velocities are means [s].
        dt_before: f64,
        /// Whether what relaxes in the step is kept.
        keeps: u32,
    }

    /// Reference geometry at a Gauss point: M = J0^-1 J0^-T (diagonal; xy, xz, yz), its volume and 1 / det J0.
    PointGeometry { metric: [f64; 3], volume: f64, metric_off: [f64; 3], inverse_det_j0: f64 }

    /// Shape class of the elements with points.
    PointClass { points: [PointGeometry; 8], volume: f64, inverse_volume: f64 }

    /// Shape class of the uniform-gradient element: b_a, Gamma_h . X, hourglass stiffness and viscosity; of an extruded one
    /// (`hex8::Class::extruded`) b . e1 and b . e3 by pattern (xi: 1, 3; zeta: 1, 3), b . e2 (eta, xi eta, eta zeta), and
    /// Gamma . X of the pattern xi zeta (1, 3).
    MeanClass {
        gradient: [[f64; 4]; 8],
        gamma_x: [[f64; 4]; 4],
        in_plane: [f64; 4],
        along: [f64; 4],
        bend: [f64; 4],
        volume: f64,
        inverse_volume: f64,
        hourglass_stiffness: f64,
        hourglass_viscosity: f64,
    }

    /// Sums of a rim node over a window: impulse [N s] and rim work [J]; moment impulse [N m s].
    RimSum { impulse: [f64; 4], moment: [f64; 4] }

    /// Sums of a surface node over a window.
    SurfaceRecord {
        impulse: [f64; 4],
        normal_work: f64,
        friction_work: f64,
        touching: u32,
        sticking: u32,
    }

    /// State of a rim with free components: moves since the window began (x, y, z, spin), their rates, and the pose.
    RimState {
        at: [f64; 4],
        velocity: [f64; 4],
        origin: [f64; 4],
        start0: [f64; 4],
        start1: [f64; 4],
        start2: [f64; 4],
        direction: [f64; 4],
        axle: [f64; 4],
        axle_velocity: [f64; 4],
        axle_before: [f64; 4],
        rotation0: [f64; 4],
        rotation1: [f64; 4],
        rotation2: [f64; 4],
        rate0: [f64; 4],
        rate1: [f64; 4],
        rate2: [f64; 4],
    }

    /// A body's part in a dispatch of several: the steps it takes, and where its entries begin in arrays by node, surface node,
    /// rim node and chain, in the plan, in the contact of steps, and among the flags.
    Member { steps: u32, nodes: u32, surface: u32, rim: u32, chains: u32, plan: u32, contact: u32, flags: u32 }

    /// A move of the frame's origin [m].
    Shift { by: [f64; 4] }
}
