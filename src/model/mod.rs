//! SI, f64 description of the discrete body: mesh, mass, shape classes.

pub mod mesh;
