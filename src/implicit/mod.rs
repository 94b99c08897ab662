//! The implicit scheme (paper section 3.2, eqs. 15-25, fig. 2): Newton's method with consistent tangents, contact
//! without multipliers or parameters, static or in time.

#![allow(clippy::needless_range_loop)] // one index for several arrays reads best

pub mod assembly;
pub mod booking;
pub mod contact;
pub mod direct;
pub mod increments;
pub mod krylov;
pub mod linearised;
pub mod matrix;
pub mod multigrid;
pub mod newton;
pub mod problem;
pub mod relax;
pub mod rim;
pub mod simulation;
pub mod system;

pub use linearised::Failure;
pub use newton::{Inner, Iteration, Limits, Newton};
pub use simulation::{Scheme, Simulation, Target};

use crate::error::Result;
use crate::model::Model;
use crate::scene::{ImplicitSolver, Linear};

/// Nodes up to which a direct solution is the faster one.
const DIRECT_NODES: usize = 6_000;
/// Residual of the linear systems, relative: below what Newton's method is asked for, so that it stays quadratic.
const LINEAR: f64 = 1e-9;

/// Residual of a correction between sweeps, relative: the sweeps change the active set in between, so that more is
/// lost. And the most iterations it may take.
const CORRECTION: f64 = 1e-2;

/// What a scene's choice of solver amounts to on its mesh.
///
/// # Errors
/// [`crate::Error::Unsupported`] where the mesh cannot be coarsened and multigrid is asked for.
pub fn inner(model: &Model, choice: ImplicitSolver) -> Result<Inner> {
    Ok(match choice {
        ImplicitSolver::ActiveSet(choice) => Inner::ActiveSet(linear(model, choice, LINEAR)?),
        ImplicitSolver::Relaxation { omega, tolerance, sweeps, corrections } => {
            let relaxation = relax::Relaxation { omega, tolerance, sweeps };
            match corrections {
                None => Inner::Relaxation(relaxation),
                Some(choice) => {
                    let solver = linear(model, choice, CORRECTION)?;
                    Inner::Corrected(relaxation, relax::Corrections::new(solver))
                }
            }
        }
    })
}

/// A linear solver that goes down to a relative residual of `tolerance` if it is iterative.
fn linear(model: &Model, choice: Linear, tolerance: f64) -> Result<Box<dyn krylov::LinearSolver>> {
    let small = model.node_count() <= DIRECT_NODES;
    Ok(match choice {
        Linear::Direct => Box::new(direct::Direct::default()),
        Linear::Auto if small => Box::new(direct::Direct::default()),
        Linear::BlockJacobi => {
            let preconditioner = krylov::BlockJacobi::default();
            Box::new(krylov::Krylov { preconditioner, tolerance, most: 20_000 })
        }
        Linear::Auto | Linear::Multigrid => {
            let preconditioner = multigrid::Multigrid::new(&model.mesh)?;
            Box::new(krylov::Krylov { preconditioner, tolerance, most: 500 })
        }
    })
}
