//! Structs that host and shader share, each from one declaration.

use bytemuck::{Pod, Zeroable};

/// A type with a WGSL spelling.
pub trait Wgsl {
    fn spelling() -> String;
}

macro_rules! spelled {
    ($($type:ty => $name:literal),*) => {
        $(impl Wgsl for $type { fn spelling() -> String { $name.into() } })*
    };
}
spelled!(f32 => "f32", u32 => "u32", [f32; 3] => "vec3f", [f32; 4] => "vec4f");

impl<const N: usize> Wgsl for [[f32; 4]; N] {
    fn spelling() -> String {
        format!("array<vec4f, {N}>")
    }
}

/// A shared struct: its WGSL text and the offsets of its fields.
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
            #[repr(C)]
            #[derive(Debug, Clone, Copy, Pod, Zeroable)]
            pub struct $name { $($(#[$field_doc])* pub $field: $type),* }

            impl Wgsl for $name { fn spelling() -> String { stringify!($name).into() } }
            impl<const N: usize> Wgsl for [$name; N] {
                fn spelling() -> String { format!("array<{}, {N}>", stringify!($name)) }
            }
        )*
        /// Every shared struct.
        pub fn all() -> Vec<Shared> {
            vec![$({
                let mut text = format!("struct {} {{\n", stringify!($name));
                $(text += &format!("    {}: {},\n", stringify!($field), <$type as Wgsl>::spelling());)*
                text += "}\n";
                Shared {
                    name: stringify!($name),
                    text,
                    size: size_of::<$name>(),
                    offsets: vec![$((stringify!($field), std::mem::offset_of!($name, $field))),*],
                }
            }),*]
        }
    };
}

shared! {
    /// A step of the plan. With a free rim `axle` holds the moves of prescribed components since the window began,
    /// and `rotation` steer and camber alone.
    Step {
        dt: f32,
        dtm: f32,
        weight_before: f32,
        weight_after: f32,
        index: u32,
        viscous_weight: f32,
        spin: f32,
        /// 0.
        pad: u32,
        axle: [f32; 4],
        axle_velocity: [f32; 4],
        axle_before: [f32; 4],
        rotation0: [f32; 4],
        rotation1: [f32; 4],
        rotation2: [f32; 4],
        rate0: [f32; 4],
        rate1: [f32; 4],
        rate2: [f32; 4],
        /// Loads on x, y, z [N] and spin [N m].
        load: [f32; 4],
        /// Its place in the submission.
        slot: u32,
        pad1: u32,
        pad2: u32,
        pad3: u32,
    }

    /// Reference geometry at a Gauss point: M = J0^-1 J0^-T (diagonal; xy, xz, yz) and det J0.
    PointGeometry { metric: [f32; 3], det_j0: f32, metric_off: [f32; 3], inverse_det_j0: f32 }

    /// Shape class of the elements with points.
    PointClass { points: [PointGeometry; 8], volume: f32, inverse_volume: f32, pad0: u32, pad1: u32 }

    /// Shape class of the uniform-gradient element: b_a, Gamma_h . X, hourglass stiffness and viscosity.
    MeanClass {
        gradient: [[f32; 4]; 8],
        gamma_x: [[f32; 4]; 4],
        volume: f32,
        inverse_volume: f32,
        hourglass_stiffness: f32,
        hourglass_viscosity: f32,
    }

    /// Sums of a rim node over a window: impulse [N s] and rim work [J]; moment impulse [N m s].
    RimSum { impulse: [f32; 4], moment: [f32; 4] }

    /// Sums of a surface node over a window.
    SurfaceRecord {
        impulse: [f32; 4],
        normal_work: f32,
        friction_work: f32,
        touching: u32,
        sticking: u32,
    }

    /// State of a rim with free components: moves since the window began (x, y, z, spin), their rates, and the pose.
    RimState {
        at: [f32; 4],
        velocity: [f32; 4],
        origin: [f32; 4],
        start0: [f32; 4],
        start1: [f32; 4],
        start2: [f32; 4],
        direction: [f32; 4],
        axle: [f32; 4],
        axle_velocity: [f32; 4],
        axle_before: [f32; 4],
        rotation0: [f32; 4],
        rotation1: [f32; 4],
        rotation2: [f32; 4],
        rate0: [f32; 4],
        rate1: [f32; 4],
        rate2: [f32; 4],
    }

    /// A body's part in a dispatch of several: the steps it takes, and where its entries begin in arrays by node, surface node,
    /// rim node and chain, in the plan, in the contact of steps, and among the flags.
    Member { steps: u32, nodes: u32, surface: u32, rim: u32, chains: u32, plan: u32, contact: u32, flags: u32 }

    /// A move of the frame's origin [m].
    Shift { by: [f32; 4] }
}
