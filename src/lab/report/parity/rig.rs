//! What the cases share: the adapter, scenes, steps, and how far two states are apart.

use crate::bench::kind::Kind;
use hexroll::engine::{Engine, State, Step, Window};
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::run::{Motion, stability};
use hexroll::scene::Scene;
use hexroll::{Error, Result};

pub const BLOCK: &str = include_str!("../../../../scenes/spinning_block.toml");
pub const PRESSED: &str = include_str!("../../../../scenes/lat100_static_height.toml");
pub const VISCOUS: &str = include_str!("../../../../scenes/lat100_straight_viscous.toml");

/// A shipped scene with changes.
pub fn scene(text: &str, sets: &[&str]) -> Result<Scene> {
    Scene::parse(text, "a scene that is built in", &sets.iter().map(ToString::to_string).collect::<Vec<_>>())
}

/// The GPU engines that an adapter has.
pub fn kinds(gpu: &Gpu) -> Vec<Kind> {
    Kind::ALL.into_iter().filter(|k| k.on_gpu() && gpu.report.has(k.precision())).collect()
}

/// Where bodies start and what is done to them: every engine gets the same.
pub struct Plan {
    pub model: Model,
    pub scene: Scene,
    pub velocity: Vec<[f64; 3]>,
    pub steps: Vec<Step>,
    /// The step after the last.
    pub next: Step,
}

impl Plan {
    /// Steps of the scene's first stage, from velocities given at the reference positions.
    pub fn new(scene: Scene, count: usize, velocity: impl Fn([f64; 3]) -> [f64; 3]) -> Result<Plan> {
        let model = Model::new(&scene)?;
        let [x, y, z] = model.mesh.axle;
        let rim = [x, y, z, 0.0, 0.0, 0.0];
        let dt = 0.9 * stability::element_bound(&model)?;
        let motion = Motion::at_rest(rim, scene.gravity).next(&scene.stages[0], 0.0, rim, [0.0; 6]);
        let mut steps = motion.plan(0.0, dt, 0.0, count + 1);
        let next = steps.pop().expect("one more than was asked for");
        let velocity = model.mesh.nodes.iter().copied().map(velocity).collect();
        Ok(Plan { model, scene, velocity, steps, next })
    }

    pub fn start(&self, engine: &mut dyn Engine) -> Result<()> {
        let stage = &self.scene.stages[0];
        let at_rest = Motion::at_rest([0.0; 6], self.scene.gravity);
        engine.begin_stage(&at_rest.next(stage, 0.0, [0.0; 6], [0.0; 6]).setup(stage.mass_damping))?;
        engine.set_velocity(&self.velocity, &[0.0; 6])
    }

    pub fn drive(&self, engine: &mut dyn Engine) -> Result<(State, Window)> {
        self.start(engine)?;
        engine.advance(&self.steps)?;
        let window = engine.sample(&self.next)?;
        Ok((engine.state()?, window))
    }

    /// The plan on an engine of its own.
    pub fn on(&self, kind: Kind, gpu: &Gpu) -> Result<(State, Window)> {
        self.drive(&mut *kind.engine(&self.model, &self.scene, 0, Some(gpu))?)
    }

    /// |a - b| over the displacement of b, L2 over all nodes.
    pub fn displacement_error(&self, a: &State, b: &State) -> f64 {
        let moved: Vec<[f64; 3]> =
            std::iter::zip(&b.x, &self.model.mesh.nodes).map(|(x, X)| apart(x, X)).collect();
        let off: Vec<[f64; 3]> = std::iter::zip(&a.x, &b.x).map(|(a, b)| apart(a, b)).collect();
        norm(&off) / norm(&moved)
    }
}

fn apart(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}

pub fn norm(v: &[[f64; 3]]) -> f64 {
    v.iter().flatten().map(|c| c * c).sum::<f64>().sqrt()
}

/// |a - b| / |b| in the L2 norm.
pub fn relative(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let off: Vec<[f64; 3]> = std::iter::zip(a, b).map(|(a, b)| apart(a, b)).collect();
    norm(&off) / norm(b)
}

/// The adapter that every case runs on: the first usable one, which `hexroll adapters` names.
pub fn adapter() -> Result<Gpu> {
    Gpu::open(None)
}

/// A model of a mesh whose elements are not inside out.
pub fn model(mesh: hexroll::model::mesh::Mesh, body: &hexroll::scene::Body) -> Result<Model> {
    Model::from_mesh(mesh, body).map_err(|element| Error::Scene {
        file: "a mesh that is built in".into(),
        line: None,
        key: "body.mesh".into(),
        problem: format!("element {element} is inside out"),
        remedy: "report it".into(),
    })
}
