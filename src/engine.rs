//! What every engine offers: the CPU's and the GPU's are interchangeable behind [`Engine`].

use crate::error::Result;
pub use crate::kernels::SurfaceSum;
use crate::physics::rim::Coordinates;
use crate::precision::Precision;

/// One step, planned by the host: everything that depends on time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Time at the start of the step, t(n) [s].
    pub time: f64,
    /// dt(n+1/2) [s].
    pub dt: f64,
    /// dt(n-1/2) [s]: the step before, 0 where the velocities are those at t(n).
    pub dt_before: f64,
    /// Rim coordinates at t(n+1); those of free components are not read.
    pub rim: Coordinates,
    /// Applied loads on the free components at t(n) [N, N m].
    pub load: Coordinates,
}

impl Step {
    /// Mean step, over which a force at t(n) acts.
    pub fn dtm(&self) -> f64 {
        0.5 * (self.dt_before + self.dt)
    }
}

/// What changes from stage to stage.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StageSetup {
    /// Mass damping [1/s]; 0: none.
    pub mass_damping: f64,
    /// The rim's own mass or inertia for every free component [kg, kg m2], `None` where prescribed.
    pub free: [Option<f64>; 6],
    /// Whether stresses that relax have relaxed already: the stage is as slow as its loads need.
    pub relaxed: bool,
}

/// Work done on the body, by kind [J]; losses are negative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Works {
    /// By the elastic internal force.
    pub internal: f64,
    /// By the stresses of viscosity and relaxation, of which a Prony series gives a part back.
    pub viscous: f64,
    pub damping: f64,
    pub body_force: f64,
    /// By the rim on its nodes, their inertia included.
    pub rim: f64,
    /// By the normal contact force.
    pub normal: f64,
    pub friction: f64,
}

impl Works {
    pub fn accumulate(&mut self, other: &Works) {
        self.internal += other.internal;
        self.viscous += other.viscous;
        self.damping += other.damping;
        self.body_force += other.body_force;
        self.rim += other.rim;
        self.normal += other.normal;
        self.friction += other.friction;
    }

    /// Everything but the elastic internal work.
    pub fn without_internal(&self) -> f64 {
        self.viscous + self.damping + self.body_force + self.rim + self.normal + self.friction
    }
}

/// Contact over the whole body in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StepContact {
    /// Mean step over which the force acts [s].
    pub dtm: f64,
    /// Force of the road on the body [N].
    pub force: [f64; 3],
    /// Touching nodes, and nodes whose state (free, stick, slip) is not that of the step before.
    pub touching: u32,
    pub changes: u32,
}

/// What an engine reports of the steps since the last report.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Window {
    pub steps: u64,
    /// Sums over the window's steps of work, of impulses [N s] and impulse moments about the axle [N m s].
    pub works: Works,
    pub rim_impulse: [f64; 3],
    pub rim_moment_impulse: [f64; 3],
    /// Impulse on the body of what drives each set of `Mesh::driven` along its prescribed components [N s].
    pub reactions: Vec<[f64; 3]>,
    /// Every surface node (empty without a road).
    pub surface: Vec<SurfaceSum>,
    /// One entry a step of the window, in order (empty without a road).
    pub step_contact: Vec<StepContact>,
    /// Rim coordinates at the end of the window, and their half-step rates.
    pub rim: Coordinates,
    pub rim_rate: Coordinates,
    /// sum 1/2 m v(n-1/2)^2 [J].
    pub kinetic: f64,
    pub probe: Probe,
    /// Stored energies at x(n) [J] and the smallest det F.
    pub strain: f64,
    pub hourglass: f64,
    pub min_jacobian: f64,
    /// Energy that viscosity and relaxation have turned into heat in the window's steps [J].
    pub dissipated: f64,
}

impl Window {
    /// Adds the window that follows: sums over both, states and energies as they are after the second.
    pub fn extend(&mut self, later: Window) {
        let mut sums = std::mem::take(self);
        sums.works.accumulate(&later.works);
        for d in 0..3 {
            sums.rim_impulse[d] += later.rim_impulse[d];
            sums.rim_moment_impulse[d] += later.rim_moment_impulse[d];
        }
        for (sum, more) in sums.reactions.iter_mut().zip(&later.reactions) {
            (0..3).for_each(|d| sum[d] += more[d]);
        }
        sums.step_contact.extend(&later.step_contact);
        let node = |(sum, node): (&SurfaceSum, &SurfaceSum)| SurfaceSum {
            impulse: std::array::from_fn(|d| sum.impulse[d] + node.impulse[d]),
            friction_work: sum.friction_work + node.friction_work,
            road_work: sum.road_work + node.road_work,
            touching: sum.touching + node.touching,
            sticking: sum.sticking + node.sticking,
            ..*node
        };
        *self = Window {
            steps: sums.steps + later.steps,
            works: sums.works,
            rim_impulse: sums.rim_impulse,
            rim_moment_impulse: sums.rim_moment_impulse,
            reactions: sums.reactions,
            surface: sums.surface.iter().zip(&later.surface).map(node).collect(),
            step_contact: sums.step_contact,
            dissipated: sums.dissipated + later.dissipated,
            ..later
        };
    }
}

/// The step after the window, computed but not taken: what the stored energy pairs with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Probe {
    /// sum 1/2 m v(n-1/2) . v(n+1/2) [J].
    pub mixed_kinetic: f64,
    /// Work of the forces at t(n) over the half step before t(n): f(n) . v(n-1/2) dt(n-1/2)/2 [J].
    pub half_works: Works,
    /// L2 norms over the nodes that are not the rim's: net force (contact included) and internal force [N].
    pub net_force: f64,
    pub internal_force: f64,
}

/// Stored energies [J] and the smallest det F over all points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyTotals {
    pub strain: f64,
    pub hourglass: f64,
    pub min_jacobian: f64,
}

impl Default for EnergyTotals {
    fn default() -> Self {
        EnergyTotals { strain: 0.0, hourglass: 0.0, min_jacobian: f64::INFINITY }
    }
}

/// Positions and half-step velocities of all nodes, absolute, SI, f64.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    pub x: Vec<[f64; 3]>,
    pub v: Vec<[f64; 3]>,
}

/// A node whose state is kept after every step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Watched {
    pub node: u32,
    /// Its number among the mesh's surface nodes, if it can touch a road.
    pub surface: Option<u32>,
}

/// A watched node after a step: absolute, SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeState {
    pub x: [f64; 3],
    /// Half a step before.
    pub v: [f64; 3],
    /// Of the road on the node, summed since the last sample [N s].
    pub impulse: [f64; 3],
}

/// Who computes.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct EngineInfo {
    /// "cpu" or "gpu"
    pub engine: String,
    pub precision: Precision,
    /// Adapter or processor, and its driver.
    pub device: String,
    pub driver: String,
    pub threads: usize,
}

/// An explicit engine. Steps are taken exactly as planned; sums are kept from every step.
pub trait Engine {
    fn info(&self) -> EngineInfo;
    /// Starts a stage: damping and which rim components are free. A component that becomes free keeps its last rate.
    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()>;
    /// Takes the steps. On failure the state is that of the failing step and the error names it.
    fn advance(&mut self, steps: &[Step]) -> Result<()>;
    /// Reports and clears the sums; `next` is the step that would come (for the probe), it is not taken.
    fn sample(&mut self, next: &Step) -> Result<Window>;
    /// The whole state.
    fn state(&mut self) -> Result<State>;
    /// Sets every velocity, and the rates of free rim components.
    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()>;
    /// Puts everything where another solver has taken it: positions, velocities, rim coordinates and the rates of the
    /// free ones.
    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()>;
    /// From now on keeps the state of these nodes after every step; none: nothing is kept, which is so at first.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported) from an engine that cannot.
    fn watch(&mut self, nodes: &[Watched]) -> Result<()> {
        if nodes.is_empty() {
            return Ok(());
        }
        let engine = self.info().engine;
        Err(crate::Error::Unsupported {
            what: format!("[[output.history]] on this {engine} engine"),
            instead: "take another engine, or leave the histories out".into(),
        })
    }
    /// The states that were kept since the last call, shape `[steps, watched nodes]`.
    fn watched(&mut self) -> Vec<NodeState> {
        Vec::new()
    }
    /// Internal force [N] at any positions and velocities, by the engine's own force pass; the state is not touched.
    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>>;
}
