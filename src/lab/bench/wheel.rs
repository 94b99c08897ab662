//! What is timed: the paper's wheel at any refinement, rolling from the first step and sinking 2.2 mm into the road.

use crate::rig::given::{self, DEPTH, SPEED, SPIN};
use glam::DVec3;
use hexroll::Result;
use hexroll::engine::{Engine, StageSetup, State, Step};
use hexroll::model::Model;
use hexroll::physics::rim::{self, Coordinates};
use hexroll::run::stability;
use hexroll::scene::Scene;
use std::time::Instant;

/// The straight run, as shipped.
const SCENE: &str = include_str!("../../../scenes/lat100_straight.toml");
/// Elements of the paper's mesh along circumference, radius and width.
const COARSE: [usize; 3] = given::MESH;
/// Steps over which the wheel sinks; fixed, so that every engine takes the same steps.
const SINKING: u64 = 200;
/// Safety on the step that single elements allow: below the assembled critical step, so also stable when pressed.
const SAFETY: f64 = 0.9;

/// Which wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheel<'a> {
    /// 880 n^3 elements.
    pub elements: usize,
    /// Formulation, as scenes name it.
    pub element: &'a str,
    pub contact: bool,
    /// Shear viscosity [Pa s].
    pub viscosity: Option<f64>,
}

/// n of 880 n^3; `None` for any other number.
pub fn refinement(elements: usize) -> Option<usize> {
    let coarse = COARSE.iter().product::<usize>();
    (1..=40).find(|n| coarse * n * n * n == elements)
}

impl Wheel<'_> {
    /// Its scene. `elements` must be 880 n^3.
    pub fn scene(&self) -> Result<Scene> {
        let n = refinement(self.elements).expect("the command line asks for 880 n^3 elements");
        let [c, r, w] = given::refined(n);
        let mut set =
            vec![format!("body.mesh.elements=[{c}, {r}, {w}]"), format!("body.element={}", self.element)];
        set.extend(self.viscosity.map(|eta| format!("body.material.viscosity=\"{eta} Pa s\"")));
        let mut scene = Scene::parse(SCENE, "lat100_straight.toml (built in)", &set)?;
        if !self.contact {
            (scene.road, scene.friction) = (None, None);
        }
        Ok(scene)
    }
}

/// The motion, step by step.
#[derive(Debug, Clone)]
pub struct Roll {
    pub dt: f64,
    origin: [f64; 3],
}

impl Roll {
    pub fn new(model: &Model) -> Result<Roll> {
        Ok(Roll { dt: SAFETY * stability::element_bound(model)?, origin: model.mesh.axle })
    }

    /// Rim coordinates after `n` steps.
    pub fn rim(&self, n: u64) -> Coordinates {
        let [x, y, z] = self.origin;
        let t = n as f64 * self.dt;
        let sunk = DEPTH * (n.min(SINKING) as f64 / SINKING as f64);
        [x + SPEED * t, y, z - sunk, 0.0, 0.0, SPIN * t]
    }

    /// `count` steps after the first `taken`.
    pub fn steps(&self, taken: u64, count: usize) -> Vec<Step> {
        let step = |n: u64| Step {
            time: n as f64 * self.dt,
            dt: self.dt,
            dt_before: if n == 0 { 0.0 } else { self.dt },
            rim: self.rim(n + 1),
            load: [0.0; 6],
        };
        (taken..taken + count as u64).map(step).collect()
    }

    /// Takes `count` steps after the `taken` that have been; seconds a step.
    pub fn timed(&self, engine: &mut dyn Engine, taken: &mut u64, count: usize) -> Result<f64> {
        let steps = self.steps(*taken, count);
        let begun = Instant::now();
        engine.advance(&steps)?;
        *taken += count as u64;
        Ok(begun.elapsed().as_secs_f64() / count as f64)
    }

    /// Steps of 0.1 s, the length of the paper's run: no row is timed for longer.
    pub fn whole_run(&self) -> u64 {
        (given::ROLLING / self.dt) as u64
    }

    /// Every node with the rigid velocity of the rim's motion, sinking included.
    pub fn start(&self, engine: &mut dyn Engine, model: &Model) -> Result<()> {
        engine.begin_stage(&StageSetup::default())?;
        let sinking = DEPTH / (SINKING as f64 * self.dt);
        let rate = [SPEED, 0.0, -sinking, 0.0, 0.0, SPIN];
        let omega = rim::angular_velocity(&self.rim(0), &rate);
        let axle = DVec3::from(self.origin);
        let velocity = |x: &[f64; 3]| (rim::axle(&rate) + omega.cross(DVec3::from(*x) - axle)).to_array();
        let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(velocity).collect();
        engine.set_velocity(&v, &rate)
    }

    /// Error of `x` after `n` steps against the reference engine's positions, relative to the deformation, that is,
    /// to what is left of the displacement without the rim's rigid motion; and that deformation's root mean
    /// square [m]. L2 over all nodes.
    pub fn error(&self, model: &Model, n: u64, x: &State, reference: &State) -> (f64, f64) {
        let q = self.rim(n);
        let (rotation, axle) = (rim::rotation(&q), rim::axle(&q));
        let origin = DVec3::from(self.origin);
        let (mut difference, mut deformation) = (0.0, 0.0);
        for ((x, r), start) in x.x.iter().zip(&reference.x).zip(&model.mesh.nodes) {
            let (x, r) = (DVec3::from(*x), DVec3::from(*r));
            let rigid = axle + rotation * (DVec3::from(*start) - origin);
            difference += (x - r).length_squared();
            deformation += (r - rigid).length_squared();
        }
        ((difference / deformation).sqrt(), (deformation / x.x.len() as f64).sqrt())
    }
}
