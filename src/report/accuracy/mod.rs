//! Speed against error: what an error costs, for every engine, formulation, mesh and step.
//!
//! Errors are against one reference a case: double precision, `q1p0`, the two finest meshes extrapolated (second order),
//! or d'Alembert's solution for the wave. An error is split: *discretisation* is what double precision with short steps
//! leaves, *time step* is what the step adds to it, *rounding* is what the precision adds to that.

mod cases;
mod pareto;
mod runs;
mod tables;

pub use cases::{Problem, Setting};
pub use pareto::picture;
pub use runs::{Matrix, Row, measure};
pub use tables::{advice, csv, markdown};
