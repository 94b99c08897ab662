//! The implicit scheme (paper section 3.2, eqs. 15-25, fig. 2): Newton's method with consistent tangents, contact
//! without multipliers or parameters, static or in time.

pub mod assembly;
pub mod booking;
pub mod contact;
pub mod direct;
pub mod dual;
pub mod element;
pub mod increments;
pub mod krylov;
pub mod matrix;
pub mod newton;
pub mod problem;
pub mod relax;
pub mod rim;
pub mod simulation;
pub mod system;

pub use newton::{Failure, Inner, Iteration, Limits, Newton};
pub use simulation::{Scheme, Simulation, Target};

use crate::error::Result;
use crate::model::Model;
use crate::scene::{ImplicitSolver, Linear, MeshSpec};

/// Nodes up to which a direct solution is the faster one.
const DIRECT_NODES: usize = 6_000;

/// What a scene's choice of solver amounts to on its mesh.
///
/// # Errors
/// [`crate::Error::Unsupported`] where the mesh cannot be coarsened and multigrid is asked for.
pub fn inner(_mesh: &MeshSpec, model: &Model, choice: ImplicitSolver) -> Result<Inner> {
    let krylov = |tolerance| krylov::Krylov { preconditioner: krylov::BlockJacobi::default(), tolerance, most: 20_000 };
    Ok(match choice {
        ImplicitSolver::Relaxation { omega, tolerance, sweeps } => {
            Inner::Relaxation(relax::Relaxation { omega, tolerance, sweeps })
        }
        ImplicitSolver::ActiveSet(linear) => Inner::ActiveSet(match linear {
            Linear::Auto if model.node_count() <= DIRECT_NODES => Box::new(direct::Direct::default()),
            Linear::Direct => Box::new(direct::Direct::default()),
            Linear::BlockJacobi => Box::new(krylov(1e-10)),
            Linear::Auto | Linear::Multigrid => {
                return Err(crate::Error::Unsupported {
                    what: "multigrid".into(),
                    instead: "use linear = \"direct\" or \"block-jacobi\"".into(),
                });
            }
        }),
    })
}
