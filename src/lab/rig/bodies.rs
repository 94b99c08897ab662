//! Scenes built in code.

use std::path::Path;

use super::given::{self, BULK_MODULUS as KAPPA, SHEAR_MODULUS as G};
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::{MooneyRivlin, MooneyRivlinEq4, NeoHookean};
use hexroll::scene::*;

/// The paper's rubber.
pub const RUBBER: Law = Law::NeoHookean(NeoHookean { g0: KAPPA, g1: G });
/// The same moduli with two constants.
pub const TWO_CONSTANTS: Law = Law::MooneyRivlin(MooneyRivlin { g0: KAPPA, g1: 0.7 * G, g2: 0.3 * G });
/// The law of the paper's eq. 4, whose bulk modulus is KAPPA + 2/3 G.
pub const EQ4: Law = Law::MooneyRivlinEq4(MooneyRivlinEq4 { g0: KAPPA, g1: 0.7 * G, g2: 0.3 * G });

/// One of each law, with the rubber's moduli.
pub fn laws() -> impl Iterator<Item = Law> {
    laws_of(G, KAPPA)
}

/// One of each law, with a shear and a bulk modulus [Pa].
pub fn laws_of(g: f64, kappa: f64) -> impl Iterator<Item = Law> {
    Law::KINDS.iter().map(move |kind| (kind.example)(g, kappa))
}

/// Every formulation.
pub const ELEMENTS: [Element; 3] =
    [Element::Q1p0, Element::Full, Element::UniformGradient { hourglass: given::HOURGLASS }];

/// A rim that stays where it is.
pub const HELD: RimMotion = RimMotion {
    x: Drive::Hold,
    y: Drive::Hold,
    z: Drive::Hold,
    steer: Drive::Hold,
    camber: Drive::Hold,
    spin: Drive::Hold,
};

/// A body of rubber (`q1p0`) at rest.
pub fn body(mesh: MeshSpec) -> Body {
    Body {
        mesh,
        grading: Grading::default(),
        offset: [0.0; 3],
        on_road: false,
        density: given::DENSITY,
        law: RUBBER,
        viscosity: None,
        relaxation: Relaxation::default(),
        element: Element::Q1p0,
        hourglass_limit: None,
        lumping: Lumping::RowSum,
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    }
}

/// That body in empty space with one explicit stage of 1 ms; callers set the fields they care about.
pub fn scene(mesh: MeshSpec) -> Scene {
    Scene {
        file: "in code".into(),
        hash: String::new(),
        title: String::new(),
        source: String::new(),
        expected: String::new(),
        body: body(mesh),
        rim: None,
        holds: Vec::new(),
        motions: Vec::new(),
        road: None,
        friction: None,
        gravity: [0.0; 3],
        safety: 0.9,
        stages: vec![explicit("free", 1e-3)],
        output: Output {
            sample: 1e-3,
            snapshots: Snapshots::StageEnds,
            pictures: Vec::new(),
            chatter_limit: 0.05,
            histories: Vec::new(),
        },
    }
}

/// A box of rubber with a corner at the origin.
pub fn block(size: [f64; 3], elements: [usize; 3]) -> Scene {
    scene(MeshSpec::Block { size, elements })
}

/// The shape of the paper's wheel.
pub fn ring(elements: [usize; 3]) -> MeshSpec {
    MeshSpec::Ring {
        outer_radius: given::OUTER_RADIUS,
        inner_radius: given::INNER_RADIUS,
        width: given::WIDTH,
        elements,
    }
}

/// The paper's wheel on the road, rim at the inner cylinder, coefficient of friction `mu` (0: none), no stages.
pub fn wheel(elements: [usize; 3], mu: f64) -> Scene {
    let mut scene = scene(ring(elements));
    scene.rim = Some(Rim { nodes: "inner".into() });
    scene.road = Some(GROUND);
    scene.friction = (mu > 0.0).then_some(Friction::Coulomb(Coulomb { mu }));
    scene.stages.clear();
    scene
}

/// An undamped explicit stage of `duration` [s] with the rim held.
pub fn explicit(name: &str, duration: f64) -> Stage {
    Stage {
        name: name.into(),
        method: Method::Explicit,
        duration,
        mass_damping: 0.0,
        initial_velocity: None,
        rim: HELD,
        slip: None,
    }
}

/// Stage "press": quasi-static, by a vertical drive, relaxed to 1e-4 of the internal force.
pub fn press(z: Drive) -> Stage {
    Stage {
        method: Method::QuasiStatic { kinetic_ratio: 1e-8, residual: 1e-4 },
        mass_damping: 3000.0,
        rim: RimMotion { z, ..HELD },
        ..explicit("press", 0.2)
    }
}

/// The axle goes down by `depth` [m] in the pressing time of the scenes.
pub fn down(depth: f64) -> Drive {
    Drive::Displacement { to: -depth, ramp: given::PRESSING }
}

/// A velocity [m/s, rad/s] from the first step on.
pub fn at_once(to: f64) -> Drive {
    Drive::Velocity { to, ramp: 0.0 }
}

/// Stage "roll": every node starts with the rim's motion, `velocity` along x and y [m/s] and `spin` [rad/s].
pub fn rolling(velocity: [f64; 2], spin: f64, duration: f64) -> Stage {
    let [x, y] = velocity.map(at_once);
    let rim = RimMotion { x, y, spin: at_once(spin), ..HELD };
    Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", duration) }
}

/// Holds components of a node set, named as in `"xz"`.
pub fn hold(nodes: &str, components: &str) -> Hold {
    let components = ['x', 'y', 'z'].map(|c| components.contains(c));
    Hold { nodes: nodes.into(), components, reaction: false }
}

/// Young's modulus [Pa] and Poisson's ratio of a law at small strain.
pub fn elastic_constants(law: &Law) -> [f64; 2] {
    let [g, k] = [law.shear_modulus(), law.bulk_modulus()];
    [9.0 * k * g / (3.0 * k + g), (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))]
}

/// A scene of the folder `scenes` with changes as `--set` takes them.
///
/// # Panics
/// If there is none, or a change is wrong.
pub fn shipped<S: AsRef<str>>(stem: &str, changes: &[S]) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(format!("{stem}.toml"));
    let changes: Vec<String> = changes.iter().map(|c| c.as_ref().to_string()).collect();
    Scene::load(&file, &changes).unwrap_or_else(|e| panic!("{e}"))
}
