//! Bodies and simulations the tests share.

use hexroll::implicit::contact::Surface;
use hexroll::implicit::direct::Direct;
use hexroll::implicit::problem::Problem;
use hexroll::implicit::{Inner, Limits, Newton, Scheme, Simulation, Target};
use hexroll::model::Model;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::NeoHookean;
use hexroll::scene::{Body, Element, GROUND, Law, Lumping, MeshSpec};

pub const WHEEL_LAW: Law = Law::NeoHookean(NeoHookean { g0: 65.1e6, g1: 2.64e6 });

pub fn body(mesh: MeshSpec, law: Law, element: Element) -> Body {
    Body {
        mesh,
        grading: Default::default(),
        offset: [0.0; 3],
        density: 1100.0,
        law,
        viscosity: None,
        element,
        lumping: Lumping::RowSum,
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    }
}

/// The paper's wheel on a mesh.
pub fn wheel(elements: [usize; 3], element: Element) -> Model {
    let mesh = MeshSpec::Ring { outer_radius: 0.039, inner_radius: 0.017, width: 0.0175, elements };
    model(&body(mesh, WHEEL_LAW, element), Some("inner"))
}

pub fn model(body: &Body, rim: Option<&str>) -> Model {
    let mut mesh = hexroll::model::mesh::Mesh::generate(&body.mesh).moved(body.offset);
    if let Some(rim) = rim {
        mesh = mesh.with_rim(rim).expect("generated meshes have the sets that tests ask for");
    }
    Model::from_mesh(mesh, body).expect("generated meshes have positive volumes")
}

pub fn road(mu: f64) -> Surface {
    Surface {
        road: GROUND,
        friction: (mu > 0.0).then_some(Coulomb { mu }.into()),
        inverse_area: Vec::new(),
        dt: 1.0,
        touch: 1e-13,
    }
}

pub const TIGHT: Limits = Limits { tolerance: 1e-10, iterations: 25 };

pub fn simulation(model: &Model, scheme: Scheme, surface: Option<Surface>) -> Simulation<'_> {
    simulation_with(model, scheme, surface, Inner::ActiveSet(Box::new(Direct::default())), TIGHT)
}

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
    (sum, s.status.iter().filter(|s| **s != hexroll::implicit::contact::Status::Free).count())
}
