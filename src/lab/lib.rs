//! The laboratory: what is measured and proved of hexroll, apart from the program that rolls wheels. Benchmarks, reports of
//! verification, stability and accuracy, and the rig that tests share with them.
#![allow(non_snake_case)] // F, J, W, N: the field's own symbols
#![allow(rustdoc::broken_intra_doc_links)] // units are written [m], [N s]

pub mod bench;
pub mod report;
pub mod rig;
