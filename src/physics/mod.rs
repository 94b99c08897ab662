//! The laws, once, generic over the scalar: f64 and f32 today, SIMD lanes or a counting scalar tomorrow.

pub mod contact;
pub mod element;
pub mod friction;
pub mod lanes;
pub mod material;
pub mod node;
pub mod parameters;
pub mod rim;
pub mod road;
pub mod scalar;
pub mod tensor;
