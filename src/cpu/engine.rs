//! The CPU engine: a program, the arrays it works on, and the reports of [`Engine`].

use super::course::Course;
use super::driven;
use super::energies::Stored;
use super::plan::Plan;
use super::program::Program;
use super::rim::RimState;
use super::steps::{Stopped, Taken};
use super::sums::total;
use super::watch::Watch;
use super::world::World;
use crate::engine::{
    Engine, EngineInfo, NodeState, StageSetup, State, Step, StepContact, SurfaceSum, Watched, Window,
};
use crate::error::{Error, Result};
use crate::instructions::{Compilable, compiled};
use crate::kernels::Field;
use crate::kernels::Item;
use crate::kernels::LineSums;
use crate::kernels::memory::vectors;
use crate::kernels::{Aligned, Arrays};
use crate::model::mesh::{Driven, Mesh};
use crate::model::{Model, areas, frame};
use crate::physics::lanes::{Level, WIDEST};
use crate::physics::material::Pace;
use crate::physics::rim::Coordinates;
use crate::physics::tensor::vec3;
use crate::scene::{Element, Friction, Scene};

/// Elements below which another thread costs more in waiting than it saves: a few microseconds of a step. With one point an
/// element two threads took 29 us for the wheel's 880 on one machine, where one took 25, and 18 to 22 us on another, both.
fn elements_a_thread(element: Element) -> usize {
    match element {
        Element::UniformGradient { .. } => 1000,
        Element::Q1p0 | Element::Full => 200,
    }
}

/// As many threads as a model keeps busy, at most one a core.
fn threads_for(model: &Model) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    cores.min(model.element_count().div_ceil(elements_a_thread(model.element)))
}

/// The CPU engine in precision `T`.
pub struct CpuEngine<T> {
    program: Program<T>,
    arrays: Arrays<T>,
    world: World<T>,
    stored: Stored,
    level: Level,
    /// Whether forces depend on velocities.
    viscous: bool,
    /// For the areas of surface nodes, where friction looks at pressure.
    mesh: Option<Mesh>,
    driven: Vec<Driven>,
    setup: StageSetup,
    rim: RimState,
    grain: f64,
    /// Positions and velocities that a step which fails is taken back to.
    before: [Field<T>; 2],
    /// What their points remembered; empty where they remember nothing.
    memory_before: Aligned<T>,
    /// Whether everything has relaxed at these positions, where another solver has put the body.
    rested: bool,
    surface_nodes: Vec<u32>,
    step_contact: Vec<StepContact>,
    /// Nodes that touched in the last step.
    touching: u32,
    steps: u64,
    window_steps: u64,
    watch: Watch,
    /// What has been kept of the watched nodes.
    watched: Vec<NodeState>,
}

impl<T: Compilable> CpuEngine<T> {
    /// An engine at rest in the reference shape, with the best instructions of this machine. `threads` = 0: as many as
    /// the mesh keeps busy, at most one a core.
    pub fn new(model: &Model, scene: &Scene, threads: usize) -> Self {
        CpuEngine::with_level(model, scene, threads, Level::detect())
    }

    /// The same with chosen instructions.
    pub fn with_level(model: &Model, scene: &Scene, threads: usize, level: Level) -> Self {
        let threads = if threads == 0 { threads_for(model) } else { threads };
        let mesh = &model.mesh;
        let road = scene.road.clone();
        let compiled = compiled(level);
        let passes = T::passes(&*compiled, &model.composition(), model.is_extruded());
        let width = passes.width;
        let plan = Plan::new(model, road.is_some(), width, threads);
        let surface_nodes = if road.is_some() { mesh.surface.clone() } else { Vec::new() };
        let terms = model.relaxation.terms.len();
        let remembered = vectors(passes.elements.points(), terms) * width;
        let mut arrays = Arrays::new(&plan.sizes(surface_nodes.len(), remembered));
        let memory_before = if remembered > 0 { arrays.memory.clone() } else { Aligned::zeros(0) };
        let before = [Field::zeros(plan.places), Field::zeros(plan.places)];
        let grain = frame::grain(mesh);
        let frame = frame::shift(grain, mesh.axle, [0.0; 3], road.as_ref());
        let stored = Stored::new(model, &plan, compiled.energies(&model.composition()), width);
        let program = Program::new(model, plan, &surface_nodes, passes);
        program.fill(&mut arrays.x, &mesh.nodes, frame);
        let mut engine = CpuEngine {
            program,
            arrays,
            world: World {
                road,
                friction: scene.friction,
                gravity: vec3(scene.gravity),
                mass_damping: 0.0,
                frame,
                relaxation: model.relaxation.clone(),
                shear_modulus: model.law.shear_modulus(),
                driven: mesh.driven.len(),
                planned_from: 0,
            },
            stored,
            level,
            viscous: model.viscosity.is_some(),
            mesh: scene.friction.filter(Friction::needs_area).map(|_| mesh.clone()),
            driven: mesh.driven.clone(),
            setup: StageSetup::default(),
            rim: RimState::new(model),
            grain,
            before,
            memory_before,
            rested: true,
            surface_nodes,
            step_contact: Vec::new(),
            touching: 0,
            steps: 0,
            window_steps: 0,
            watch: Watch::default(),
            watched: Vec::new(),
        };
        engine.program.nodes.inverse_area = engine.inverse_areas(|n| mesh.nodes[n as usize]);
        engine
    }

    /// Takes steps; on failure the state is that of the failing step.
    fn take(&mut self, steps: &[Step]) -> std::result::Result<Taken, Stopped> {
        self.plan_driven(steps);
        let [x, v] = &mut self.before;
        x.copy_from(&self.arrays.x);
        v.copy_from(&self.arrays.v);
        if self.remembers() {
            self.memory_before.slice_mut().copy_from_slice(self.arrays.memory.slice());
        }
        let course = Course::new(&self.world, &self.setup, self.steps, steps, self.rim, self.rested);
        let taken = self.program.take(&mut self.arrays, &course, self.touching, &self.watch);
        if let Err(stopped) = &taken {
            // Some nodes of the failing step have moved already: take the steps before it again.
            let [x, v] = &self.before;
            self.arrays.x.copy_from(x);
            self.arrays.v.copy_from(v);
            if self.remembers() {
                self.arrays.memory.slice_mut().copy_from_slice(self.memory_before.slice());
            }
            self.program.clear_loose(&mut self.arrays.f);
            let again = self.program.take(
                &mut self.arrays,
                &course.cut(stopped.step),
                self.touching,
                &Watch::default(),
            );
            self.rim = again.expect("these steps have been taken before").rim;
        }
        taken
    }

    /// Whether points remember.
    fn remembers(&self) -> bool {
        !self.world.relaxation.terms.is_empty()
    }

    /// Poses of driven sets for the steps that come.
    fn plan_driven(&mut self, steps: &[Step]) {
        if !self.driven.is_empty() {
            self.world.planned_from = self.steps;
            self.program.nodes.driven.poses = driven::poses(&self.driven, steps, self.world.frame);
        }
    }

    /// Lets the frame follow the axle, when single precision would otherwise run out of digits.
    fn follow(&mut self) {
        if T::EPSILON < 1e-10 || self.program.rim_nodes.is_empty() {
            return;
        }
        let axle = [self.rim.q[0], self.rim.q[1], self.rim.q[2]];
        let frame = &mut self.world.frame;
        let shift = frame::shift(self.grain, axle, *frame, self.world.road.as_ref());
        for d in (0..3).filter(|&d| shift[d] != 0.0) {
            frame[d] += shift[d];
            self.arrays.x.component_mut(d).iter_mut().for_each(|x| *x -= T::from_f64(shift[d]));
        }
    }

    /// One over the areas of the surface nodes [1/m2] with nodes at these positions; none unless friction looks at pressure.
    fn inverse_areas(&self, x: impl Fn(u32) -> [f64; 3]) -> Vec<T> {
        let (Some(mesh), Some(road)) = (&self.mesh, &self.world.road) else { return Vec::new() };
        areas::inverse_areas(mesh, x, road).into_iter().map(T::from_f64).collect()
    }

    /// Position of a node [m].
    fn absolute(&self, n: usize) -> [f64; 3] {
        let x = self.arrays.x.get(self.program.place[n] as usize);
        std::array::from_fn(|d| x[d] + self.world.frame[d])
    }

    /// Half-step velocity of a node [m/s].
    fn velocity(&self, n: usize) -> [f64; 3] {
        self.arrays.v.get(self.program.place[n] as usize)
    }

    fn failure(&self, element: usize, time: f64) -> Error {
        let finite = |n: &u32| self.arrays.x.get(*n as usize).iter().all(|c| c.is_finite());
        let step = self.steps;
        let corners = |item: &Item| {
            let k = item.elements().iter().position(|e| *e as usize == element)?;
            Some(item.corners()[k])
        };
        let corners =
            self.program.elements.items.iter().find_map(corners).expect("every element is in an item");
        match corners.iter().all(finite) {
            true => Error::Inverted { step, time, element },
            false => Error::NotFinite { step, time, element },
        }
    }

    /// sum 1/2 m v^2 [J].
    fn kinetic(&self) -> f64 {
        let square = |p: usize| self.arrays.v.get(p).iter().map(|c| c * c).sum::<f64>();
        let mass = self.program.nodes.mass.slice();
        self.program.place.iter().map(|p| 0.5 * mass[*p as usize].to_f64() * square(*p as usize)).sum()
    }

    /// The surface nodes' sums of the window, which begin again.
    fn take_surface(&mut self) -> Vec<SurfaceSum> {
        let fresh = vec![SurfaceSum::default(); self.surface_nodes.len()];
        let mut surface = std::mem::replace(&mut self.arrays.surface, fresh);
        for (k, (sum, &n)) in surface.iter_mut().zip(&self.surface_nodes).enumerate() {
            sum.x = self.absolute(n as usize);
            sum.v = self.velocity(n as usize);
            sum.touches = self.steps > 0 && self.arrays.last_touch[k] == self.steps;
            sum.sticks &= sum.touches;
            // The next step's changes are told from this one's states.
            self.arrays.surface[k].sticks = sum.sticks;
        }
        surface
    }
}

impl<T: Compilable> Engine for CpuEngine<T> {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            engine: "cpu".into(),
            precision: super::precision_of::<T>(),
            device: format!("{} processor, {:?} lanes", std::env::consts::ARCH, self.level),
            driver: String::new(),
            threads: self.program.shares.len(),
        }
    }

    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        // The rates stay: a component that is let go keeps the speed it was driven with.
        self.setup = *setup;
        self.world.mass_damping = setup.mass_damping;
        Ok(())
    }

    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        match self.take(steps) {
            Ok(taken) => {
                self.rim = taken.rim;
                self.step_contact.extend(taken.contact);
                self.touching = taken.touching;
                self.rested = false;
                let frame = self.world.frame;
                let absolute = |s: &NodeState| NodeState { x: [0, 1, 2].map(|d| s.x[d] + frame[d]), ..*s };
                self.watched.extend(taken.watched.iter().map(absolute));
                self.steps += steps.len() as u64;
                self.window_steps += steps.len() as u64;
                Ok(())
            }
            Err(Stopped { step, element }) => {
                self.steps += step as u64;
                Err(self.failure(element, steps[step].time))
            }
        }
    }

    fn sample(&mut self, next: &Step) -> Result<Window> {
        let viscous = -self.arrays.viscous.iter().sum::<f64>();
        self.arrays.viscous.fill(0.0);
        let dissipated = self.arrays.loss.iter().sum::<f64>();
        self.arrays.loss.fill(0.0);
        let committed = total(&self.arrays.sums);
        self.arrays.sums.fill(LineSums::default());
        let mut works = committed.works;
        works.viscous = viscous;
        works.internal -= viscous;
        let surface = self.take_surface();
        let x = [0, 1, 2].map(|d| self.arrays.x.component(d));
        let energies = self.stored.totals(&self.program.elements.items, x);
        let kinetic = self.kinetic();
        let next = std::slice::from_ref(next);
        self.plan_driven(next);
        let course = Course::new(&self.world, &self.setup, self.steps, next, self.rim, self.rested);
        let probe = self.program.probe(&mut self.arrays, &course);
        let window = Window {
            steps: std::mem::take(&mut self.window_steps),
            works,
            rim_impulse: committed.rim_impulse,
            rim_moment_impulse: committed.rim_moment_impulse,
            reactions: driven::reactions(&self.program, self.driven.len(), &self.arrays.reactions),
            surface,
            step_contact: std::mem::take(&mut self.step_contact),
            rim: self.rim.q,
            rim_rate: self.rim.rate,
            kinetic,
            probe,
            strain: energies.strain,
            hourglass: energies.hourglass,
            min_jacobian: energies.min_jacobian,
            dissipated,
        };
        self.arrays.reactions.fill([[0.0; WIDEST]; 3]);
        self.follow();
        self.program.nodes.inverse_area = self.inverse_areas(|n| self.absolute(n as usize));
        Ok(window)
    }

    fn state(&mut self) -> Result<State> {
        let nodes = 0..self.program.place.len();
        Ok(State {
            x: nodes.clone().map(|n| self.absolute(n)).collect(),
            v: nodes.map(|n| self.velocity(n)).collect(),
        })
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.program.fill(&mut self.arrays.v, v, [0.0; 3]);
        for component in 0..6 {
            if self.setup.free[component].is_some() {
                self.rim.rate[component] = rim_rate[component];
            }
        }
        Ok(())
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        self.program.fill(&mut self.arrays.x, &state.x, self.world.frame);
        self.rim.q = *rim;
        self.rested = true;
        self.follow();
        self.set_velocity(&state.v, rim_rate)
    }

    fn watch(&mut self, nodes: &[Watched]) -> Result<()> {
        self.watch = Watch::new(&self.program, nodes, self.world.road.is_some());
        Ok(())
    }

    fn watched(&mut self) -> Vec<NodeState> {
        std::mem::take(&mut self.watched)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        let [x_before, v_before] = &mut self.before;
        x_before.copy_from(&self.arrays.x);
        self.program.fill(&mut self.arrays.x, x, self.world.frame);
        v_before.copy_from(&self.arrays.v);
        if self.viscous {
            self.program.fill(&mut self.arrays.v, v, [0.0; 3]);
        }
        let sums = (self.arrays.viscous.clone(), self.arrays.loss.clone());
        // A change of shape without time: terms resist it with all of their modulus.
        let terms = self.world.relaxation.fading(self.world.shear_modulus, 0.0, 0.0, Pace::Timed);
        self.program.internal_forces(&mut self.arrays, &terms);
        (self.arrays.viscous, self.arrays.loss) = sums;
        let forces = self.program.place.iter().map(|p| self.arrays.x.get(*p as usize)).collect();
        std::mem::swap(&mut self.arrays.x, x_before);
        std::mem::swap(&mut self.arrays.v, v_before);
        self.program.clear_loose(&mut self.arrays.f);
        Ok(forces)
    }
}
