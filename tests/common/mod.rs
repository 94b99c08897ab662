//! Scenes built in code, and drivers for them. SI units throughout.
#![allow(dead_code)] // every test binary uses its own part of this

use hexroll::cpu::{self, Precision};
use hexroll::engine::{Engine, StageSetup, Step, Window};
use hexroll::model::Model;
use hexroll::model::mesh::Mesh;
use hexroll::physics::friction::Coulomb;
use hexroll::physics::material::{MooneyRivlin, MooneyRivlinEq4, NeoHookean};
use hexroll::record::{Sample, Snapshot};
use hexroll::run::{Observer, Progress, Totals};
pub use hexroll::scene::GROUND;
use hexroll::scene::*;

/// The paper's rubber: rho [kg/m3], G and kappa [Pa].
pub const DENSITY: f64 = 1100.0;
pub const G: f64 = 2.64e6;
pub const KAPPA: f64 = 65.1e6;
pub const RUBBER: Law = Law::NeoHookean(NeoHookean { g0: KAPPA, g1: G });
/// The same moduli with two constants, and the law of the paper's eq. 4 (whose bulk modulus is KAPPA + 2/3 G).
pub const TWO_CONSTANTS: Law = Law::MooneyRivlin(MooneyRivlin { g0: KAPPA, g1: 0.7 * G, g2: 0.3 * G });
pub const EQ4: Law = Law::MooneyRivlinEq4(MooneyRivlinEq4 { g0: KAPPA, g1: 0.7 * G, g2: 0.3 * G });

/// One of each law, with the rubber's moduli.
pub fn laws() -> impl Iterator<Item = Law> {
    Law::KINDS.iter().map(|kind| (kind.example)(G, KAPPA))
}

pub const ELEMENTS: [Element; 3] =
    [Element::Q1p0, Element::Full, Element::UniformGradient { hourglass: 0.15 }];
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

/// A body of rubber (`q1p0`) in empty space with one explicit stage of 1 ms; tests set the fields they care about.
pub fn scene(mesh: MeshSpec) -> Scene {
    Scene {
        file: "in code".into(),
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
        holds: vec![],
        road: None,
        friction: None,
        gravity: [0.0; 3],
        safety: 0.9,
        stages: vec![explicit("free", 1e-3)],
        output: Output {
            sample: 1e-3,
            snapshots: Snapshots::StageEnds,
            pictures: vec![],
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

/// A wheel of the paper's size on the road, rim at the inner cylinder, coefficient of friction `mu` (0: none), no stages.
pub fn wheel(elements: [usize; 3], mu: f64) -> Scene {
    let mut scene =
        scene(MeshSpec::Ring { outer_radius: 0.039, inner_radius: 0.017, width: 0.0175, elements });
    scene.rim = Some(Rim { nodes: "inner".into() });
    scene.road = Some(GROUND);
    scene.friction = (mu > 0.0).then_some(Friction::Coulomb(Coulomb { mu }));
    scene.stages.clear();
    scene
}

/// Quasi-static pressing of a wheel by a vertical drive, relaxed to 1e-4 of the internal force.
pub fn press(z: Drive) -> Stage {
    Stage {
        method: Method::QuasiStatic { kinetic_ratio: 1e-8, residual: 1e-4 },
        mass_damping: 3000.0,
        rim: RimMotion { z, ..HELD },
        ..explicit("press", 0.2)
    }
}

/// What a run produced.
pub struct Outcome {
    pub model: Model,
    pub samples: Vec<Sample>,
    pub snapshots: Vec<Snapshot>,
    pub totals: Totals,
}

impl Outcome {
    /// Samples of the stage that ran as number `index` (stages have different names).
    pub fn stage(&self, index: usize) -> Vec<&Sample> {
        let mut names: Vec<&str> = self.samples.iter().map(|s| s.stage.as_str()).collect();
        names.dedup();
        self.samples.iter().filter(|s| s.stage == names[index]).collect()
    }

    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has samples")
    }
}

/// Mean of a column over the last `count` samples.
pub fn mean(samples: &[&Sample], count: usize, column: impl Fn(&Sample) -> f64) -> f64 {
    samples[samples.len() - count..].iter().map(|s| column(s)).sum::<f64>() / count as f64
}

#[derive(Default)]
struct Recorder(Vec<Sample>, Vec<Snapshot>);

impl Observer for Recorder {
    fn sample(&mut self, sample: &Sample, _: &Progress) -> hexroll::Result<()> {
        self.0.push(sample.clone());
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Snapshot, _: &str) -> hexroll::Result<()> {
        self.1.push(snapshot.clone());
        Ok(())
    }
}

/// Runs a scene on the CPU.
pub fn try_run(scene: &Scene, precision: Precision, threads: usize) -> hexroll::Result<Outcome> {
    let model = Model::new(scene)?;
    let mut engine = cpu::engine(&model, scene, precision, threads);
    let mut recorder = Recorder::default();
    let totals = hexroll::run::run(scene, &model, &mut *engine, &mut recorder)?;
    Ok(Outcome { model, samples: recorder.0, snapshots: recorder.1, totals })
}

/// Runs a scene in f64 on one thread; panics if it fails.
pub fn run(scene: &Scene) -> Outcome {
    try_run(scene, Precision::F64, 1).expect("the scene runs")
}

/// An f64 engine driven step by step.
pub struct Driver {
    pub engine: Box<dyn Engine>,
    /// Rim coordinates of the steps to come; at first those of the reference shape.
    pub rim: [f64; 6],
    pub time: f64,
    pub dt_before: f64,
}

impl Driver {
    pub fn new(model: &Model, scene: &Scene) -> Driver {
        let mut engine = cpu::engine(model, scene, Precision::F64, 1);
        engine.begin_stage(&StageSetup::default()).expect("a stage starts");
        let [x, y, z] = model.mesh.axle;
        Driver { engine, rim: [x, y, z, 0.0, 0.0, 0.0], time: 0.0, dt_before: 0.0 }
    }

    /// The next step of `dt`.
    pub fn step(&self, dt: f64) -> Step {
        Step { time: self.time, dt, dt_before: self.dt_before, rim: self.rim, load: [0.0; 6] }
    }

    /// Takes steps of the given lengths.
    pub fn advance(&mut self, lengths: impl IntoIterator<Item = f64>) -> hexroll::Result<()> {
        let mut steps = Vec::new();
        for dt in lengths {
            steps.push(self.step(dt));
            (self.time, self.dt_before) = (self.time + dt, dt);
        }
        self.engine.advance(&steps)
    }

    /// Closes the window; the probe looks `dt` ahead.
    pub fn sample(&mut self, dt: f64) -> Window {
        let next = self.step(dt);
        self.engine.sample(&next).expect("a sample")
    }
}

/// Random numbers that are the same everywhere (xorshift).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9))
    }

    /// Uniform in -1..1.
    pub fn signed(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.signed())
    }

    /// Identity plus up to `size` in every entry, columns.
    pub fn near_identity(&mut self, size: f64) -> [[f64; 3]; 3] {
        std::array::from_fn(|c| {
            std::array::from_fn(|r| size * self.signed() + if r == c { 1.0 } else { 0.0 })
        })
    }
}

/// A X for a matrix of columns.
pub fn times(a: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|c| a[c][i] * x[c]).sum())
}

/// Largest absolute entry.
pub fn largest<'a>(vectors: impl IntoIterator<Item = &'a [f64; 3]>) -> f64 {
    vectors.into_iter().flatten().fold(0.0, |m, v| m.max(v.abs()))
}

/// Moves every node by up to `share` of an edge `edge`, so that no element is a parallelepiped.
pub fn distort(mesh: &mut Mesh, edge: f64, share: f64) {
    let mut random = Random::new(7);
    for x in &mut mesh.nodes {
        let by = random.vector();
        (0..3).for_each(|d| x[d] += share * edge * by[d]);
    }
}

/// Asserts |value - expected| <= tolerance |expected|.
#[track_caller]
pub fn close(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance * expected.abs(),
        "{what}: {value:e}, expected {expected:e} within {tolerance:e} (off by {:e})",
        value / expected - 1.0
    );
}
