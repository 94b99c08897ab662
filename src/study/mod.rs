//! Several runs of a scene and what they say together: axes of variation, mesh convergence, tables and plots of them; and what a
//! law says by itself ([`curves`]). Nothing here runs anything.

pub mod axis;
pub mod convergence;
pub mod curves;
pub mod index;
pub mod quantity;
pub mod report;
pub mod sweep;
