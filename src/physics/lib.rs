//! The laws, once, generic over the scalar: f64, f32, lanes of either, a counting scalar, numbers with derivatives.
#![allow(non_snake_case)] // F, J, W, N: the field's own symbols
#![allow(rustdoc::broken_intra_doc_links)] // units are written [m], [N s]

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
