//! What an iteration of Newton's method asks of its inner solver, and gets.

use super::matrix::BlockMatrix;
use super::problem::{Increment, Problem, Residual};
use crate::physics::rim::Coordinates;
use crate::physics::tensor::Vec3;

/// The linearised equations of an iterate: K d = -r + contact forces.
#[derive(Clone, Copy)]
pub struct Linearised<'a> {
    pub problem: &'a Problem<'a>,
    pub inc: &'a Increment,
    pub residual: &'a Residual,
    pub matrix: &'a BlockMatrix,
    /// Force scale [N].
    pub scale: f64,
}

/// A Newton correction.
#[derive(Debug, Clone)]
pub struct Correction {
    /// Of every node that is not the rim's [m].
    pub dx: Vec<Vec3<f64>>,
    pub q: Coordinates,
    /// Iterations of the linear solver.
    pub iterations: usize,
}

/// Why an increment did not converge.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    #[error("element {element} inverts on the way")]
    Inverted { element: usize },
    #[error(
        "no convergence in {iterations} iterations: relative residual {residual:.1e} (asked: {asked:.1e}), {changes} contact states still changing"
    )]
    TooMany { iterations: usize, residual: f64, asked: f64, changes: usize },
    #[error("the linear equations have no solution: the body can move freely, or is at a limit point")]
    Singular,
    #[error(
        "the relaxation did not converge in {sweeps} sweeps: residual {residual:.1e} N (asked: {asked:.1e} N)"
    )]
    Relaxation { sweeps: usize, residual: f64, asked: f64 },
    #[error("interrupted between two iterations")]
    Interrupted,
}
