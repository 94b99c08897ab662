//! Scene files: TOML in, a checked [`Scene`] in SI out.
//!
//! A quantity is a string with its unit (`"39 mm"`, `"2.64 MPa"`); a number without a unit, or with the unit of
//! something else, is an error, as is every unknown key. Arrays of three are x, y, z. Keys without a default are
//! required.
//!
//! ```toml
//! title = "what it is"                # one line
//! source = "where the case is from"   # default ""
//! expected = "what should come out"   # default ""
//! gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]   # body force per mass, on the body and on the mass of a free rim; default none
//!
//! [body]
//! density = "1100 kg/m3"              # in the reference shape, > 0
//! element = "q1p0"                    # default | "full" | "uniform-gradient"
//! hourglass = 0.15                    # default; hourglass stiffness over G, > 0; only with "uniform-gradient"
//! hourglass_limit = 0.5               # default none; hourglass energy over strain energy, > 0, above which the run ends with
//!                                     # an error (a warning comes from 0.1 on); only with "uniform-gradient"
//! mass_lumping = "row-sum"            # default: rho int N_a dV | "equal": an eighth of the element to each corner
//! offset = ["0 mm", "0 mm", "0 mm"]   # moves the mesh before the start; default none
//! place = "as-meshed"                 # default | "on-road": then moved along the road's normal until it touches the road
//! velocity = ["0 m/s", "0 m/s", "0 m/s"]                  # of every node, and of a free rim, at t = 0; default none
//! angular_velocity = ["0 rad/s", "0 rad/s", "0 rad/s"]    # at t = 0, about the centroid; default none
//!
//! [body.mesh]
//! generator = "ring"                  # axle along y, touches z = 0 with a row of nodes
//! outer_radius = "39 mm"
//! inner_radius = "17 mm"
//! width = "17.5 mm"
//! elements = [44, 4, 5]               # circumference (>= 3), radius, width
//! grading = [1, 1, 1]                 # default; element size at the far end over that at the near end: top over
//!                                     # bottom, outer over inner cylinder, middle over side faces
//! fine_arc = "40 deg"                 # default 0; elements within this arc about the bottom are equal
//! # or
//! generator = "block"                 # a corner at the origin, edges along +x, +y, +z
//! size = ["40 mm", "40 mm", "20 mm"]
//! elements = [8, 8, 4]                # along x, y, z
//! grading = [1, 1, 1]                 # default; size of the last element over that of the first, along x, y, z
//!
//! [body.material]
//! law = "mooney-rivlin"               # default | "neo-hookean" (g2 = 0) | "mooney-rivlin-eq4" | "yeoh"
//! shear_modulus = "2.64 MPa"          # G > 0, with
//! bulk_modulus = "65.1 MPa"           # kappa > 0; or instead the law's own constants:
//! g0 = "65.1 MPa"                     #   kappa = g0 (eq4: g0 + 2/3 G)
//! g1 = "2.64 MPa"                     #   G = g1 + g2
//! g2 = "0 MPa"                        #   default 0
//! c10 = "1.32 MPa"                    # of "yeoh": G = 2 c10, W = sum C_i0 (I1b - 3)^i; with bulk_modulus
//! c20 = "-0.1 MPa"                    #   default 0
//! c30 = "0.02 MPa"                    #   default 0
//! viscosity = "20 Pa s"               # Kelvin-Voigt shear viscosity, >= 0; default 0: none
//!
//! [rim]                               # optional: these nodes are one rigid body
//! nodes = "inner"                     # a node set of the mesh: of a ring "inner", "outer", "y-min", "y-max"; of a block
//!                                     # "x-min", "x-max", "y-min", ... "z-max"
//!
//! [[hold]]                            # optional, any number: components of nodes that stay at rest
//! nodes = "y-min"                     # a node set of the mesh, as in [rim], or "all"
//! components = "y"                    # some of x, y, z; neither gravity nor the road may push along them
//!
//! [road]                              # optional: rigid, the body stays on the side of the normal
//! shape = "plane"                     # default
//! point = ["0 m", "0 m", "0 m"]       # default the origin
//! normal = [0, 0, 1]                  # default +z; any length but zero
//! velocity = ["0 m/s", "0 m/s", "0 m/s"]   # in the plane; default at rest
//! # or
//! shape = "drum"                      # a plane bent about an axis
//! point = ["0 m", "0 m", "0 m"]       # of its surface, default the origin
//! normal = [0, 0, 1]                  # there, default +z
//! axis = [0, 1, 0]                    # along the drum's axis, square to the normal; default +y
//! radius = "0.85 m"
//! side = "outside"                    # default | "inside": where the body is
//! angular_velocity = "30 rad/s"       # about the axis (right hand); default at rest
//!
//! [friction]                          # optional, needs a road; constant over the scene
//! law = "coulomb"                     # default
//! coefficient = 1.0                   # mu >= 0; 0: frictionless
//! # or
//! law = "static-kinetic"              # mu of what stands, and of what slides
//! static = 1.0
//! kinetic = 0.6
//! # or
//! law = "viscous"                     # mu = slope v
//! slope = "0.5 s/m"
//! # or
//! law = "stribeck"                    # mu = kinetic + (static - kinetic) exp(-(v/speed)^2) + slope v
//! static = 1.2
//! kinetic = 0.8
//! speed = "0.1 m/s"
//! slope = "0 s/m"                     # default 0
//! # or
//! law = "pressure-velocity"           # mu = a + b exp(-p/pressure) + c exp(-v/speed), >= 0 everywhere; p: a node's
//! a = 0.5                             #   normal force over its area, areas taken anew at every sample
//! b = 0.6
//! pressure = "0.3 MPa"
//! c = 0.3
//! speed = "0.5 m/s"
//!
//! [time_step]
//! safety = 0.9                        # default; fraction of the critical step, > 0 (above 1: unstable)
//!
//! [[stage]]                           # one or more, one after the other
//! name = "press"                      # default "stage 1", ...
//! method = "quasi-static"             # mass-damped relaxation | "explicit" | "implicit"
//! duration = "0.2 s"                  # > 0; the longest a quasi-static stage may take
//! mass_damping = "3000 1/s"           # Rayleigh alpha >= 0; default 0: none; needed by "quasi-static"
//! initial_velocity = "rim"            # optional: every node starts with the rim's rigid motion | "zero"
//! settle = { kinetic_ratio = 1e-8, residual = 1e-4 }   # defaults; only "quasi-static": kinetic over strain
//!                                     # energy, and out-of-balance force over the largest force
//!
//! [stage.implicit]                    # needed by method = "implicit"
//! scheme = "static"                   # equilibria along the ramps, a history row an increment | "dynamic"
//! increments = 10                     # default; over the ramps, before any is cut or grown; only "static"
//! step = "0.25 ms"                    # Newmark's step; only "dynamic", needed there
//! damping = 0.05                      # default 0; gamma - 1/2 of the modified average acceleration; only "dynamic"
//! tolerance = 1e-8                    # default; residual over internal force (eq. 23)
//! iterations = 25                     # default; Newton iterations after which an increment is cut
//! solver = "active-set"               # default: semi-smooth Newton | "relaxation": the paper's projected sweeps
//! linear = "auto"                     # default | "direct" | "multigrid" | "block-jacobi"; only "active-set"
//! omega = 1.0                         # default, 0..2; only "relaxation"
//! relaxation_tolerance = 1e-9         # default; residual over internal force (eq. 25); only "relaxation"
//! corrections = "none"                # default | "auto" | "multigrid" | "direct" | "block-jacobi": linear corrections
//!                                     # between the sweeps, truncated where nodes touch; only "relaxation"
//! sweeps = 100000                     # default; the most of one relaxation; only "relaxation"
//!
//! [stage.rim]                         # needs [rim]; a component that is not named holds where it is
//! x = { displacement = "1 mm", ramp = "20 ms" }   # from the start of the simulation; smooth ramp
//! y = { velocity = "2.59 m/s", ramp = "5 ms" }    # ramp default 0: from the first step on
//! z = { force = "-300 N", mass = "50 g", ramp = "20 ms" }  # free, with the rim's own mass > 0, which gravity pulls on
//!                                     # besides; ramp of the force, default 0
//! steer = { angle = "5 deg", ramp = "20 ms" }     # about z; or { velocity = "1 rad/s", ramp = .. }
//! camber = { angle = "2 deg", ramp = "20 ms" }    # about the new x; the same
//! spin = { velocity = "70 rad/s" }                # about the axle; or angle; or free:
//! spin = { moment = "0 N m", inertia = "1e-5 kg m2", ramp = "0 s" }
//! spin = { slip = 0.05, free_radius = "38.9 mm", ramp = "0 s" }   # longitudinal: omega = (1 + slip) v / free_radius;
//!                                     # "measured": in the last stage before that spins freely under no moment
//!
//! [output]
//! sample = "1 ms"                     # length of a history window, > 0, no longer than any stage
//! snapshots = "10 ms"                 # whole fields: default "stage-ends" | "none" | every so long
//! pictures = ["body:von-mises", "footprint"]   # of every snapshot; default none; body: displacement, velocity,
//!                                     # contact-force, pressure, volume-ratio, von-mises, friction-energy
//! chatter_limit = 0.05                # default; scatter of the contact force from step to step, over the mean normal
//!                                     # force, above which the summary names it
//! ```

mod body;
mod implicit;
mod output;
mod parameters;
mod rim_motion;
mod stage;
mod world;

use std::path::Path;

use sha2::{Digest, Sha256};

use super::document::{self, Node};
use super::reader::{Bound, Item, Later, Table};
use super::units::ACCELERATION;
use super::{Scene, overrides};
use crate::error::{Error, Result};

const SECTIONS: [&str; 12] = [
    "title",
    "source",
    "expected",
    "gravity",
    "body",
    "rim",
    "hold",
    "road",
    "friction",
    "time_step",
    "stage",
    "output",
];

const LATER: [Later; 5] = [
    ("sweep", "run hexroll sweep SCENE --over KEY=VALUES, or the scene once per value with --set"),
    ("checkpoint", "run the scene in one piece"),
    ("restart", "run the scene in one piece"),
    ("bodies", "describe one [body]"),
    ("spectrum", "analyse history.csv"),
];

impl Scene {
    /// Reads a scene file and applies `overrides` (`key=value`, dotted paths, array entries by index).
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; [`Error::Scene`] with file, line, key, problem and remedy for
    /// everything that is wrong in it; [`Error::Unsupported`] for what comes in a later version.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Scene> {
        let text = Scene::read_text(path)?;
        Scene::parse(&text, &path.to_string_lossy(), overrides)
    }

    /// The text of a scene file.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; [`Error::Scene`] with file, line and column, in bytes from 1, of the first
    /// byte that is not UTF-8.
    pub fn read_text(path: &Path) -> Result<String> {
        let bytes = std::fs::read(path).map_err(Error::io(path, "read the scene"))?;
        String::from_utf8(bytes).map_err(|error| not_utf8(error, path))
    }

    /// [`Scene::load`] of a scene that is already in memory; `file` is its name in messages.
    pub fn parse(text: &str, file: &str, overrides: &[String]) -> Result<Scene> {
        read(&effective(text, file, overrides)?, file)
    }

    /// The scene's text with its overrides, in canonical form (keys sorted, no comments): what [`Scene::hash`]
    /// is taken of. It reads back as the same scene.
    pub fn effective_text(text: &str, file: &str, overrides: &[String]) -> Result<String> {
        Ok(document::canonical(&effective(text, file, overrides)?))
    }
}

fn not_utf8(error: std::string::FromUtf8Error, path: &Path) -> Error {
    let at = error.utf8_error().valid_up_to();
    let bytes = error.as_bytes();
    let before = &bytes[..at];
    let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |n| n + 1);
    Error::Scene {
        file: path.to_string_lossy().into(),
        line: Some(1 + before.iter().filter(|&&b| b == b'\n').count()),
        key: format!("byte {}", at - line_start + 1),
        problem: format!("0x{:02X} is not UTF-8", bytes[at]),
        remedy: "save the file as UTF-8, which TOML asks for".into(),
    }
}

fn effective(text: &str, file: &str, overrides: &[String]) -> Result<Node> {
    let mut root = document::parse(text, file)?;
    overrides.iter().try_for_each(|o| overrides::apply(&mut root, o, file))?;
    Ok(root)
}

fn read(root: &Node, file: &str) -> Result<Scene> {
    let table = Item { file, key: String::new(), node: root }.table()?;
    table.only(&SECTIONS, &LATER)?;
    let text = |key| table.get(key).map_or(Ok(String::new()), |item| item.text().map(Into::into));
    let body = body::body(&table.section("body", "[body]")?, table.get("road").is_some())?;
    let rim = table.get("rim").map(|item| world::rim(&item)).transpose()?;
    let road = table.get("road").map(|item| world::road(&item)).transpose()?;
    let gravity = table.vector_or_zero("gravity", &ACCELERATION)?;
    let holds = match table.get("hold") {
        Some(item) => {
            let holds = world::holds(&item)?;
            world::check_holds(&item, &holds, gravity, road.as_ref())?;
            holds
        }
        None => Vec::new(),
    };
    let friction = table.get("friction").map(|item| world::friction(&item, road.is_some())).transpose()?;
    let section = table.section("stage", "[[stage]]")?;
    let stages = stage::stages(&section, rim.is_some(), road.as_ref(), body.offset)?;
    body::check_start(&table.section("body", "[body]")?, &body, &stages[0])?;
    let output = output::output(&table.section("output", "[output]")?, &stages, road.is_some())?;
    let implicit = stages.iter().any(|s| matches!(s.method, super::Method::Implicit(_)));
    let scene = Scene {
        file: file.into(),
        hash: hash(&document::canonical(root)),
        title: table.need("title", "\"one line that names the scene\"")?.text()?.into(),
        source: text("source")?,
        expected: text("expected")?,
        body,
        rim,
        holds,
        road,
        friction: friction.flatten(),
        gravity,
        safety: table.get("time_step").map_or(Ok(0.9), |item| safety(&item.table()?))?,
        stages,
        output,
    };
    match scene.beyond_implicit() {
        Some(gap) if implicit => Err(gap),
        _ => Ok(scene),
    }
}

fn safety(table: &Table) -> Result<f64> {
    table.only(&["safety"], &[])?;
    table.number_or("safety", 0.9, Bound::Positive)
}

fn hash(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}
