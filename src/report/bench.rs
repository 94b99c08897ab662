//! Scenes built in code, and what comes of them: the test rigs of the reports. SI units.

use crate::Result;
use crate::cpu::{self, Precision};
use crate::engine::{Engine, StageSetup, Step};
use crate::model::Model;
use crate::physics::friction::Coulomb;
use crate::physics::material::NeoHookean;
use crate::record::{Sample, Snapshot};
use crate::run::{self, Observer, Progress, Totals};
use crate::scene::*;

/// The paper's rubber: density [kg/m3], G and kappa [Pa].
pub const DENSITY: f64 = 1100.0;
pub const G: f64 = 2.64e6;
pub const KAPPA: f64 = 65.1e6;
pub const RUBBER: Law = Law::NeoHookean(NeoHookean { g0: KAPPA, g1: G });

/// A rim that stays where it is.
pub const HELD: RimMotion = RimMotion {
    x: Drive::Hold,
    y: Drive::Hold,
    z: Drive::Hold,
    steer: Drive::Hold,
    camber: Drive::Hold,
    spin: Drive::Hold,
};

/// The road z = 0 at rest.
pub use crate::scene::GROUND;

/// A body of rubber (`q1p0`) in empty space with one explicit stage of 1 ms.
pub fn scene(mesh: MeshSpec) -> Scene {
    Scene {
        file: "report".into(),
        hash: String::new(),
        title: String::new(),
        source: String::new(),
        expected: String::new(),
        body: Body {
            mesh,
            grading: Grading::default(),
            offset: [0.0; 3],
            density: DENSITY,
            law: RUBBER,
            viscosity: None,
            element: Element::Q1p0,
            lumping: Lumping::RowSum,
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
        },
        rim: None,
        holds: Vec::new(),
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
        },
    }
}

/// A box of rubber with a corner at the origin.
pub fn block(size: [f64; 3], elements: [usize; 3]) -> Scene {
    scene(MeshSpec::Block { size, elements })
}

/// An undamped explicit stage with the rim held.
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

/// The paper's wheel on the road, rim at the inner cylinder, friction `mu` (0: none), no stages.
pub fn wheel(elements: [usize; 3], mu: f64) -> Scene {
    let mut scene =
        scene(MeshSpec::Ring { outer_radius: 0.039, inner_radius: 0.017, width: 0.0175, elements });
    scene.rim = Some(Rim { nodes: "inner".into() });
    scene.road = Some(GROUND);
    scene.friction = (mu > 0.0).then_some(Friction::Coulomb(Coulomb { mu }));
    scene.stages.clear();
    scene
}

/// Quasi-static pressing by a vertical drive, relaxed to 1e-4 of the internal force.
pub fn press(z: Drive) -> Stage {
    Stage {
        method: Method::QuasiStatic { kinetic_ratio: 1e-8, residual: 1e-4 },
        mass_damping: 3000.0,
        rim: RimMotion { z, ..HELD },
        ..explicit("press", 0.2)
    }
}

/// Holds components of a node set.
pub fn hold(nodes: &str, components: &str) -> Hold {
    Hold { nodes: nodes.into(), components: ['x', 'y', 'z'].map(|c| components.contains(c)) }
}

/// What a run produced.
pub struct Outcome {
    pub model: Model,
    pub samples: Vec<Sample>,
    pub snapshots: Vec<Snapshot>,
    pub totals: Totals,
}

impl Outcome {
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has samples")
    }

    /// Samples of a stage.
    pub fn stage<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Sample> {
        self.samples.iter().filter(move |s| s.stage == name)
    }

    /// Mean of a column over the last `share` of a stage.
    pub fn mean(&self, stage: &str, share: f64, column: impl Fn(&Sample) -> f64) -> f64 {
        let rows: Vec<f64> = self.stage(stage).map(column).collect();
        let from = ((1.0 - share) * rows.len() as f64) as usize;
        rows[from..].iter().sum::<f64>() / (rows.len() - from) as f64
    }
}

#[derive(Default)]
struct Recorder(Vec<Sample>, Vec<Snapshot>);

impl Observer for Recorder {
    fn sample(&mut self, sample: &Sample, _: &Progress) -> Result<()> {
        self.0.push(sample.clone());
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Snapshot, _: &str) -> Result<()> {
        self.1.push(snapshot.clone());
        Ok(())
    }
}

/// Runs a scene on the CPU engine in double precision, on one thread.
pub fn simulate(scene: &Scene) -> Result<Outcome> {
    simulate_model(scene, Model::new(scene)?, Precision::F64)
}

/// The same with a mesh of one's own.
pub fn simulate_model(scene: &Scene, model: Model, precision: Precision) -> Result<Outcome> {
    let mut engine = cpu::engine(&model, scene, precision, 1);
    let mut recorder = Recorder::default();
    let totals = run::run(scene, &model, &mut *engine, &mut recorder)?;
    Ok(Outcome { model, samples: recorder.0, snapshots: recorder.1, totals })
}

/// An engine in double precision driven step by step.
pub struct Driver {
    pub engine: Box<dyn Engine>,
    /// Rim coordinates of the steps to come; at first those of the reference shape.
    pub rim: [f64; 6],
    pub time: f64,
    pub dt_before: f64,
}

impl Driver {
    pub fn new(model: &Model, scene: &Scene) -> Result<Driver> {
        let mut engine = cpu::engine(model, scene, Precision::F64, 1);
        engine.begin_stage(&StageSetup::default())?;
        let [x, y, z] = model.mesh.axle;
        Ok(Driver { engine, rim: [x, y, z, 0.0, 0.0, 0.0], time: 0.0, dt_before: 0.0 })
    }

    /// Takes `count` steps of `dt`.
    pub fn advance(&mut self, dt: f64, count: usize) -> Result<()> {
        let mut steps = Vec::with_capacity(count);
        for _ in 0..count {
            let (time, dt_before) = (self.time, self.dt_before);
            steps.push(Step { time, dt, dt_before, rim: self.rim, load: [0.0; 6] });
            (self.time, self.dt_before) = (time + dt, dt);
        }
        self.engine.advance(&steps)
    }
}

/// Young's modulus and Poisson's ratio of a law at small strain.
pub fn elastic_constants(law: &Law) -> [f64; 2] {
    let [g, k] = [law.shear_modulus(), law.bulk_modulus()];
    [9.0 * k * g / (3.0 * k + g), (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))]
}

/// log2(coarse / fine): the order of an error that a halved step leaves.
pub fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}
