//! What a scene says: plain SI numbers and choices, nothing about meshes, buffers or devices.
//!
//! [`Scene`] is what the rest of the program reads. How it looks in a file (TOML, quantities with
//! units) is [`file`](mod@file)'s business; every value here has been checked.

mod document;
pub mod file;
pub mod heights;
pub mod history;
mod mesh_file;
mod node_set;
mod overrides;
mod reader;
mod set_motion;
mod units;

pub use crate::physics::element::{Element, Lumping};
pub use crate::physics::friction::Friction;
pub use crate::physics::material::{Law, Relaxation};
pub use crate::physics::road::Road;
pub use mesh_file::{Axis, Gaps, LengthUnit, MeshFile, Revolve};
pub use node_set::NodeSet;
pub use set_motion::{Path, Pose, SetMotion, Turn, smooth};

use crate::physics::road::Plane;
use std::path::PathBuf;

/// The road that pictures show where a scene has none: z = 0, at rest.
pub const GROUND: Road = Road::Plane(Plane { point: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [0.0; 3] });

/// A simulation as its scene file describes it, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// File it was read from.
    pub file: PathBuf,
    /// SHA-256 of the effective text (after `--set`), hexadecimal.
    pub hash: String,
    /// One line that names the scene.
    pub title: String,
    /// Where the case comes from (paper section, other code).
    pub source: String,
    /// What is expected of it, in words.
    pub expected: String,
    pub body: Body,
    pub rim: Option<Rim>,
    /// Components of nodes that stay at rest: symmetry planes, plane strain.
    pub holds: Vec<Hold>,
    /// Components of nodes that follow a motion.
    pub motions: Vec<SetMotion>,
    pub road: Option<Road>,
    /// `None`: frictionless.
    pub friction: Option<Friction>,
    /// Body force per mass [m/s2].
    pub gravity: [f64; 3],
    /// Fraction of the critical time step that is used, 0 < safety; default 0.9.
    pub safety: f64,
    pub stages: Vec<Stage>,
    pub output: Output,
}

impl Scene {
    /// What of this scene implicit stages cannot do, as an error.
    pub fn beyond_implicit(&self) -> Option<crate::Error> {
        let error = |what: &str, instead: &str| crate::Error::Unsupported {
            what: format!("{}: {what} in an implicit stage", self.file.display()),
            instead: instead.into(),
        };
        let kind = if self.motions.is_empty() { "[[hold]]" } else { "[[motion]]" };
        let fixed = !self.holds.is_empty() || !self.motions.is_empty();
        let relaxed = |stage: &Stage| {
            let Method::Implicit(settings) = stage.method else { return false };
            matches!(settings.solver, ImplicitSolver::Relaxation { .. })
        };
        if fixed && self.road.is_some() {
            return Some(error(
                &format!("{kind} beside a [road]"),
                "use explicit stages, or remove one of the two",
            ));
        }
        let dynamic = |stage: &Stage| match stage.method {
            Method::Implicit(implicit) => matches!(implicit.scheme, ImplicitScheme::Dynamic { .. }),
            Method::Explicit | Method::QuasiStatic { .. } => false,
        };
        if !self.body.relaxation.terms.is_empty() && self.stages.iter().any(dynamic) {
            let instead = "use explicit stages, or a static one, in which everything has relaxed";
            return Some(error("[body.material.relaxation] with a dynamic scheme", instead));
        }
        (!self.recorded().is_empty() && self.stages.iter().any(relaxed))
            .then(|| error("[[motion]] with a relaxation", "write solver = \"active-set\""))
    }

    /// Sets whose reaction is recorded, at rest or moving: the motions, then the holds that ask for it.
    pub fn recorded(&self) -> Vec<SetMotion> {
        let holds = self.holds.iter().filter(|hold| hold.reaction);
        let at_rest = holds.map(|hold| SetMotion::at_rest(hold.nodes.clone(), hold.components));
        self.motions.iter().cloned().chain(at_rest).collect()
    }

    /// What of this scene the GPU engine cannot do, as an error.
    pub fn beyond_gpu(&self) -> Option<crate::Error> {
        (!self.recorded().is_empty()).then(|| crate::Error::Unsupported {
            what: format!(
                "{}: [[motion]], or a reaction of [[hold]], on the GPU engine",
                self.file.display()
            ),
            instead: "use --engine cpu".into(),
        })
    }
}

/// The deformable body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub mesh: MeshSpec,
    /// How element sizes vary; the default is equal elements.
    pub grading: Grading,
    /// Translation of the whole mesh before the start [m].
    pub offset: [f64; 3],
    /// Whether the mesh is then moved along the road's normal until it touches the road.
    pub on_road: bool,
    /// Mass density in the reference shape [kg/m3], > 0.
    pub density: f64,
    pub law: Law,
    /// Kelvin-Voigt shear viscosity [Pa s]; `None`: purely elastic, and no viscous code is composed.
    pub viscosity: Option<f64>,
    /// Prony series on the isochoric part of the law, which is that of slow deformation; no terms: nothing relaxes.
    pub relaxation: Relaxation,
    pub element: Element,
    /// Hourglass energy over strain energy at which a run is ended, > 0; `None`: it goes on with a warning.
    pub hourglass_limit: Option<f64>,
    pub lumping: Lumping,
    /// Velocity of every node, and of the rim's free components, at t = 0 [m/s].
    pub velocity: [f64; 3],
    /// Angular velocity at t = 0 about the body's centroid [rad/s].
    pub angular_velocity: [f64; 3],
}

/// Where the mesh comes from: a generator, or a file.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSpec {
    /// A thick-walled cylinder, axle along y through (0, 0, outer_radius), so that it touches z = 0;
    /// a row of nodes stands at the bottom.
    Ring {
        outer_radius: f64,
        inner_radius: f64,
        width: f64,
        /// Elements along [circumference, radius, width].
        elements: [usize; 3],
    },
    /// A box with one corner at the origin, edges along +x, +y, +z.
    Block { size: [f64; 3], elements: [usize; 3] },
    /// A mesh of another program.
    File(MeshFile),
}

impl MeshSpec {
    /// Elements in each direction, in the order in which a scene gives them; none of a file.
    pub fn elements(&self) -> Option<[usize; 3]> {
        match *self {
            MeshSpec::Ring { elements, .. } | MeshSpec::Block { elements, .. } => Some(elements),
            MeshSpec::File(_) => None,
        }
    }

    /// The counts of a generator, to be changed; none of a file.
    pub fn elements_mut(&mut self) -> Option<&mut [usize; 3]> {
        match self {
            MeshSpec::Ring { elements, .. } | MeshSpec::Block { elements, .. } => Some(elements),
            MeshSpec::File(_) => None,
        }
    }
}

/// How the sizes of elements vary along each direction of a mesh.
///
/// With ratio q in a direction, node i of n stands at the share (q^s - 1)/(q - 1) of its length, s = i/n: sizes grow
/// geometrically, and the nodes of a mesh with half as many elements are every other node of this one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grading {
    /// Element size at the far end over that at the near end, in the order of `elements`, > 0. Block: from x-, y-, z-min
    /// to -max. Ring: from the bottom to the top, both ways; from the inner to the outer cylinder; from both side
    /// faces to the middle.
    pub ratio: [f64; 3],
    /// Ring: elements within this arc about the bottom are equal [rad], 0..2 pi; only outside do they grow.
    pub fine_arc: f64,
}

impl Default for Grading {
    fn default() -> Self {
        Grading { ratio: [1.0; 3], fine_arc: 0.0 }
    }
}

/// A rigid body glued to a node set.
#[derive(Debug, Clone, PartialEq)]
pub struct Rim {
    pub nodes: NodeSet,
}

/// Components of a node set that do not move. Rim nodes in the set go with the rim all the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hold {
    pub nodes: NodeSet,
    /// Whether x, y, z are held.
    pub components: [bool; 3],
    /// Whether what they take is recorded.
    pub reaction: bool,
}

/// A part of the simulation with its own rim motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    pub name: String,
    pub method: Method,
    /// Longest duration [s] (an explicit stage lasts exactly this).
    pub duration: f64,
    /// Rayleigh mass damping alpha [1/s]; 0: none, and no damping code is composed.
    pub mass_damping: f64,
    pub initial_velocity: Option<InitialVelocity>,
    pub rim: RimMotion,
    /// Spins the rim for a longitudinal slip; `rim.spin` is then `Hold`, and replaced when the stage starts.
    pub slip: Option<Slip>,
}

/// Longitudinal slip kappa: the rim spins at (1 + kappa) v / R_free, v being the axle's speed over the road along the
/// wheel's heading at the end of all ramps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    pub kappa: f64,
    /// Free-rolling radius [m]; `None`: measured in the last stage before whose rim spins freely without a moment.
    pub free_radius: Option<f64>,
    /// Ramp of the spin [s].
    pub ramp: f64,
}

impl Stage {
    /// Speed over the road that the stage's velocities come to, along the heading of a wheel at the steer angle `steer`;
    /// `axle`: where it is over the road [m].
    pub fn heading_speed(&self, road: Option<&Road>, axle: [f64; 3], steer: f64) -> f64 {
        let Some(road) = road else { return 0.0 };
        let rate = |drive: Drive| match drive {
            Drive::Velocity { to, .. } => to,
            _ => 0.0,
        };
        let ([x, y, _], (sin, cos)) = (road.velocity(axle), steer.sin_cos());
        (rate(self.rim.x) - x) * cos + (rate(self.rim.y) - y) * sin
    }

    pub fn is_quasi_static(&self) -> bool {
        matches!(self.method, Method::QuasiStatic { .. })
    }

    /// Whether the rim spins freely and without a moment.
    pub fn rolls_freely(&self) -> bool {
        matches!(self.rim.spin, Drive::Free { load: 0.0, .. })
    }
}

/// How a stage is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Central difference.
    Explicit,
    /// Mass-damped relaxation that ends when kinetic/strain energy and relative residual force are small,
    /// not before all ramps are over; not reaching them within the duration is an error.
    QuasiStatic { kinetic_ratio: f64, residual: f64 },
    /// Newton's method with consistent tangents (eqs. 15-25).
    Implicit(Implicit),
}

/// How an implicit stage is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Implicit {
    pub scheme: ImplicitScheme,
    /// Residual at which Newton's method stops, over the largest internal force so far (eq. 23).
    pub tolerance: f64,
    /// Most Newton iterations of an increment; more: the increment is cut.
    pub iterations: usize,
    pub solver: ImplicitSolver,
}

/// Statics or dynamics of an implicit stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ImplicitScheme {
    /// Equilibria along the path of the loads; `increments`: over the stage's ramps, before any is cut or grown.
    Static { increments: usize },
    /// Newmark with steps of `step` [s]; `damping` = gamma - 1/2 >= 0 (numerical).
    Dynamic { step: f64, damping: f64 },
}

/// What solves the linearised contact problem of an implicit stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ImplicitSolver {
    /// Semi-smooth Newton.
    ActiveSet(Linear),
    /// The paper's projected relaxation (eq. 24): omega, epsilon_GS relative to the force scale (eq. 25), and the most
    /// sweeps. `corrections`: what solves the linear equations between the sweeps, if anything does.
    Relaxation { omega: f64, tolerance: f64, sweeps: usize, corrections: Option<Linear> },
}

/// Solvers of linear equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Linear {
    /// Direct for small meshes, multigrid for large ones that can be coarsened.
    Auto,
    Direct,
    /// Krylov iteration with a multigrid cycle.
    Multigrid,
    /// Krylov iteration with the 3x3 diagonal blocks.
    BlockJacobi,
}

/// Velocities set at the start of a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InitialVelocity {
    /// The rigid velocity of the rim's motion at that moment: v_axle + omega x (x - axle).
    Rim,
    /// Everything at rest.
    Zero,
}

/// Rim motion by component: translation of the axle point, then steer (about z), camber (about the new x),
/// spin (about the new axle y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RimMotion {
    pub x: Drive,
    pub y: Drive,
    pub z: Drive,
    pub steer: Drive,
    pub camber: Drive,
    pub spin: Drive,
}

impl RimMotion {
    /// Components in the order of [`Coordinates`](crate::physics::rim::Coordinates).
    pub fn drives(&self) -> [Drive; 6] {
        [self.x, self.y, self.z, self.steer, self.camber, self.spin]
    }
}

/// One component of the rim's motion. Units: m or rad, and s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Drive {
    /// Stays where it is.
    #[default]
    Hold,
    /// Displacement from the start of the simulation, reached by a smooth ramp of `ramp` seconds
    /// from wherever it is at the start of the stage; ramp 0: at once is an error unless nothing moves.
    Displacement { to: f64, ramp: f64 },
    /// Velocity, reached by a smooth ramp of `ramp` seconds (0: from the first step on).
    Velocity { to: f64, ramp: f64 },
    /// Free, with the rim's own `mass` [kg] (spin: inertia about the axle [kg m2]; the rim nodes' is added)
    /// and an applied `load` [N] or [N m], reached by a smooth ramp from the last stage's load. The scene's body force pulls
    /// on the mass of a translation, without a ramp.
    /// Translations and spin can be free; steer and camber cannot.
    Free { mass: f64, load: f64, ramp: f64 },
}

/// What is written, and how often.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Length of a history window [s]: one row of `history.csv` each.
    pub sample: f64,
    pub snapshots: Snapshots,
    pub pictures: Vec<Picture>,
    /// Scatter of the contact force from step to step, over the mean normal force, above which it is named; default
    /// 0.05.
    pub chatter_limit: f64,
    /// Nodes and points that are taken down at a high rate.
    pub histories: Vec<history::History>,
}

/// When whole fields are written (`.vtu`, `contact_<k>.csv`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Snapshots {
    None,
    /// At the end of every stage.
    StageEnds,
    /// Every so many seconds (rounded to whole samples), and at the end of every stage.
    Every(f64),
}

/// A picture of every snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Picture {
    /// The deformed body on the road, coloured by a field.
    Body(Field),
    /// Contact forces from below.
    Footprint,
}

/// Fields a picture or a viewer can colour by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    Displacement,
    Velocity,
    ContactForce,
    Pressure,
    VolumeRatio,
    VonMises,
    /// Energy that friction has dissipated since the start, per undeformed area [J/m2].
    FrictionEnergy,
}
