//! Simulations of the implicit scheme without a run around them, and the linear system of a pressed wheel.

use super::{RUBBER, given, ring};
use hexroll::implicit::contact::{Status, Surface};
use hexroll::implicit::direct::Direct;
use hexroll::implicit::krylov::Krylov;
use hexroll::implicit::matrix::BlockMatrix;
use hexroll::implicit::multigrid::Multigrid;
use hexroll::implicit::problem::{Iterate, Problem};
use hexroll::implicit::relax::{Corrections, Relaxation};
use hexroll::implicit::system::System;
use hexroll::implicit::{Inner, Limits, Newton, Scheme, Simulation, Target};
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::scene::{Body, Element, GROUND, Law, MeshSpec};

/// A body at rest.
pub fn body(mesh: MeshSpec, law: Law, element: Element) -> Body {
    Body { law, element, ..super::body(mesh) }
}

/// The paper's wheel on a mesh.
pub fn wheel(elements: [usize; 3], element: Element) -> Model {
    model(&body(ring(elements), RUBBER, element), Some("inner"))
}

/// The model of a body in code.
///
/// # Panics
/// If an element is inside out, or the mesh has no such set.
pub fn model(body: &Body, rim: Option<&str>) -> Model {
    let mut mesh = hexroll::model::mesh::Mesh::generate(&body.mesh).moved(body.offset);
    if let Some(rim) = rim {
        mesh = mesh.with_rim(rim).expect("generated meshes have the sets that are asked for");
    }
    Model::from_mesh(mesh, body).expect("generated meshes have positive volumes")
}

/// The road z = 0 with Coulomb friction, or none.
pub fn road(mu: f64) -> Surface {
    Surface {
        road: GROUND,
        friction: (mu > 0.0).then_some(Coulomb { mu }.into()),
        inverse_area: Vec::new(),
        dt: 1.0,
        touch: 1e-13,
    }
}

/// Newton's iteration to the last digits.
pub const TIGHT: Limits = Limits { tolerance: 1e-10, iterations: 25 };

/// From rest, with active sets and a direct solver.
pub fn simulation(model: &Model, scheme: Scheme, surface: Option<Surface>) -> Simulation<'_> {
    simulation_with(model, scheme, surface, Inner::ActiveSet(Box::new(Direct::default())), TIGHT)
}

/// From rest, with any inner solver.
pub fn simulation_with(
    model: &Model,
    scheme: Scheme,
    surface: Option<Surface>,
    inner: Inner,
    limits: Limits,
) -> Simulation<'_> {
    let problem = Problem::new(model, [0.0; 3]);
    let newton = Newton::new(&problem, inner, limits);
    let state = hexroll::engine::State { x: model.mesh.nodes.clone(), v: vec![[0.0; 3]; model.node_count()] };
    let [x, y, z] = model.mesh.axle;
    Simulation::new(problem, newton, scheme, surface, state, [[x, y, z, 0.0, 0.0, 0.0], [0.0; 6]])
}

/// An increment that ends with the rim displaced by `by` (metres and radians) from the reference.
pub fn held(model: &Model, time: f64, dt: f64, by: [f64; 6]) -> Target {
    let [x, y, z] = model.mesh.axle;
    let start = [x, y, z, 0.0, 0.0, 0.0];
    Target {
        time,
        dt,
        rim: std::array::from_fn(|c| start[c] + by[c]),
        load: [0.0; 6],
        free: [None; 6],
        damping: 0.0,
    }
}

/// Road force and touching nodes.
pub fn road_force(s: &Simulation<'_>) -> ([f64; 3], usize) {
    let sum = s.contact.iter().fold([0.0; 3], |t, f| [t[0] + f[0], t[1] + f[1], t[2] + f[2]]);
    (sum, s.status.iter().filter(|s| **s != Status::Free).count())
}

/// The linear system of the first Newton iteration from a shape that is pressed at its foot: every node near the road is
/// put on it and sticks, or slides without friction.
///
/// # Panics
/// If an element is inverted.
pub fn pressed_system(model: &Model, mu: f64) -> System {
    // 0.22 mm: the first of ten increments.
    let (press, foot) = (-2.2e-4, 2.0e-4);
    let mut s = simulation(model, Scheme::Static, Some(road(mu)));
    let target = held(model, 1.0, 1.0, [0.0, 0.0, press, 0.0, 0.0, 0.0]);
    let touched = if mu > 0.0 { Status::Stick } else { Status::Slip };
    let status = |&n: &u32| if s.x[n as usize][2] < foot { touched } else { Status::default() };
    s.status = model.mesh.surface.iter().map(status).collect();
    let inc = s.increment(&target);
    let at = Iterate { x: s.x.clone(), q: s.q, status: s.status.clone() };
    let residual = s.problem.residual(&inc, &at).expect("the reference shape is not inverted");
    let mut matrix = BlockMatrix::of_mesh(model.node_count(), &model.mesh.hexes);
    s.problem.tangent(&inc, &at, &residual.v, &mut matrix);
    let stiffness = vec![1e5; s.status.len()];
    System::new(&s.problem, &inc, &at, &residual, &stiffness, matrix)
}

/// Multigrid inside the projected relaxation, as for scenes.
///
/// # Panics
/// If the mesh has no coarser one.
pub fn corrected(model: &Model) -> Inner {
    let preconditioner = Multigrid::new(&model.mesh).expect("a ring has coarser meshes");
    let cycles = Krylov { preconditioner, tolerance: 1e-2, most: 100 };
    let relaxation = Relaxation { omega: 1.0, tolerance: 1e-11, sweeps: 2_000 };
    Inner::Corrected(relaxation, Corrections::new(Box::new(cycles)))
}

/// Linear iterations of every Newton iteration of a first increment of 0.5 mm on the paper's wheel, `fineness` times
/// its mesh; and the nodes that touch.
///
/// # Panics
/// If it does not converge.
pub fn first_increment(fineness: usize, mu: f64) -> (Vec<usize>, usize) {
    let elements = given::refined(fineness);
    let model = wheel(elements, Element::Q1p0);
    let limits = Limits { tolerance: 1e-9, iterations: 30 };
    let mut s = simulation_with(&model, Scheme::Static, Some(road(mu)), corrected(&model), limits);
    let target = held(&model, 1.0, 1.0, [0.0, 0.0, -5e-4, 0.0, 0.0, 0.0]);
    let log = s.step(&target).unwrap_or_else(|e| panic!("{e}"));
    (log.iter().filter(|i| i.inner > 0).map(|i| i.inner).collect(), road_force(&s).1)
}
