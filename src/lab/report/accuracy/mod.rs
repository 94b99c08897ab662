//! Speed against error: what an error costs, for every engine, formulation, mesh and step.
//!
//! Errors are against one reference a problem: double precision, `q1p0`, on the finest meshes, extrapolated where they
//! converge monotonically and with an error bar of its own ([`hexroll::study::convergence`]), or d'Alembert's solution for the
//! wave. An error is split: *discretisation* is what double precision with short steps leaves, *time step* is what the
//! step adds to it, *rounding* is what the precision adds to that.
//!
//! Errors take long and do not care what else the machine does; times are short to take and do. So they are taken
//! apart: a row's time is its number of steps times the time of a step, measured by itself ([`time`]).

mod cases;
mod pareto;
mod reference;
mod runs;
mod tables;
mod timing;

pub use cases::{ELEMENTS, Problem, Setting};
pub use pareto::picture;
pub use reference::Reference;
pub use runs::{Matrix, Measured, Row, measure};
pub use tables::{advice, csv, markdown, parse, references, windows};
pub use timing::{Window, time};
