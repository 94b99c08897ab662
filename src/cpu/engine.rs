use super::batches::{element_batches, node_batches, share};
use super::elements::{self, Build, Composable, Elements, Kernel};
use super::nodes::{Books, CHUNK, Conditions, NO_SURFACE, NodePass, NodeSums, Nodes};
use super::reduce::total;
use super::rim::{Reaction, RimState};
use super::state::{Field, PADDING, View, slot_sizes};
use super::team::SpinBarrier;
use crate::engine::{Engine, EngineInfo, Probe, StageSetup, State, Step, SurfaceSum, Window};
use crate::error::{Error, Result};
use crate::model::mesh::Mesh;
use crate::model::{Model, areas, frame};
use crate::physics::friction::AnyFriction;
use crate::physics::lanes::Level;
use crate::physics::node::{Loads, StepSize};
use crate::physics::rim::{self, Coordinates};
use crate::physics::road::Plane;
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, vec3};
use crate::scene::{Friction, Road, Scene};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The CPU engine in precision `T`.
pub struct CpuEngine<T> {
    kernel: Box<dyn Kernel<T>>,
    elements: Elements<T>,
    nodes: Nodes<T>,
    rim_nodes: Vec<usize>,
    road: Option<Road>,
    friction: Option<AnyFriction<T>>,
    gravity: Vec3<T>,
    /// For the areas of surface nodes, where friction looks at pressure.
    mesh: Option<Mesh>,
    setup: StageSetup,
    rim: RimState,
    threads: usize,
    /// Origin of the engine's frame: positions are kept relative to it.
    frame: [f64; 3],
    grain: f64,
    x: Field<T>,
    v: Field<T>,
    slots: Vec<T>,
    stride: usize,
    /// Viscous work so far of the window, by element batch [J].
    power: Vec<f64>,
    sums: Vec<NodeSums>,
    surface_nodes: Vec<u32>,
    surface: Vec<SurfaceSum>,
    last_touch: Vec<u64>,
    steps: u64,
    window_steps: u64,
}

impl<T: NodePass> CpuEngine<T>
where
    Composable: Build<T>,
{
    /// An engine at rest in the reference shape, with the best instructions of this machine. `threads` = 0: all cores.
    pub fn new(model: &Model, scene: &Scene, threads: usize) -> Self {
        CpuEngine::with_level(model, scene, threads, Level::detect())
    }

    /// The same with chosen instructions, which the machine must have.
    pub fn with_level(model: &Model, scene: &Scene, threads: usize, level: Level) -> Self {
        assert!(level <= Level::detect(), "this machine has no {level:?}");
        let threads = match threads {
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n,
        };
        let mesh = &model.mesh;
        let surface_nodes = if scene.road.is_some() { mesh.surface.clone() } else { Vec::new() };
        let arms = mesh.rim.iter().map(|&n| sub64(mesh.nodes[n as usize], mesh.axle));
        let rim = rim_state(model, arms.clone());
        let grain = frame::grain(mesh);
        let frame = frame::shift(grain, mesh.axle, [0.0; 3], scene.road.as_ref());
        let width = elements::width(level, size_of::<T>() == 4);
        let batches = element_batches(model, width);
        let node_batches = node_batches(model, scene.road.is_some(), width);
        let (stride, slots) = slot_sizes(mesh.hexes.len());
        CpuEngine {
            kernel: elements::compose(model.element, model.law, model.viscosity, level),
            power: vec![0.0; batches.len()],
            sums: vec![NodeSums::default(); node_batches.len().div_ceil(CHUNK)],
            elements: Elements {
                hexes: mesh.hexes.clone(),
                classes: model.classes.iter().map(|c| c.cast()).collect(),
                batches,
            },
            nodes: Nodes {
                batches: node_batches,
                mass: padded(model.mass.iter().copied()),
                inverse_mass: padded(model.mass.iter().map(|m| 1.0 / m)),
                corner_start: model.corner_start.clone(),
                corners: model.corners.clone(),
                surface_of: surface_index(model.node_count(), &surface_nodes),
                rim_arms: Field::new(arms).components,
                inverse_area: match (scene.friction, &scene.road) {
                    (Some(law), Some(road)) if law.needs_area() => {
                        inverse_areas(mesh, |n| mesh.nodes[n as usize], road)
                    }
                    _ => Vec::new(),
                },
                level,
            },
            rim_nodes: mesh.rim.iter().map(|&n| n as usize).collect(),
            rim,
            road: scene.road,
            friction: scene.friction.as_ref().map(AnyFriction::new),
            mesh: scene.friction.filter(Friction::needs_area).map(|_| mesh.clone()),
            gravity: vec3(scene.gravity),
            setup: StageSetup::default(),
            threads,
            frame,
            grain,
            x: Field::new(mesh.nodes.iter().map(|&x| sub64(x, frame))),
            v: Field::new(mesh.nodes.iter().map(|_| [0.0; 3])),
            slots: vec![T::zero(); slots],
            stride,
            surface: vec![SurfaceSum::default(); surface_nodes.len()],
            last_touch: vec![0; surface_nodes.len()],
            surface_nodes,
            steps: 0,
            window_steps: 0,
        }
    }

    fn view(&mut self) -> View<T> {
        View {
            x: self.x.pointers(),
            v: self.v.pointers(),
            slots: self.slots.as_mut_ptr(),
            stride: self.stride,
        }
    }

    fn books(&mut self) -> Books {
        Books {
            surface: self.surface.as_mut_ptr(),
            last_touch: self.last_touch.as_mut_ptr(),
            sums: self.sums.as_mut_ptr(),
        }
    }

    fn local(&self, q: &Coordinates) -> [f64; 3] {
        std::array::from_fn(|d| q[d] - self.frame[d])
    }

    /// Conditions of step number `number`, which takes the rim from coordinates `before` to `q`. `probe`: works over
    /// the half step before.
    fn conditions(
        &self,
        number: u64,
        step: &Step,
        before: &Coordinates,
        q: &Coordinates,
        probe: bool,
    ) -> Conditions<T> {
        let s = T::from_f64;
        let (start, end) = (rim::rotation(before), rim::rotation(q));
        let weights = if probe { [0.5 * step.dt_before, 0.0] } else { [0.5 * step.dtm(); 2] };
        Conditions {
            step: StepSize { dt: s(step.dt), dtm: s(step.dtm()) },
            loads: Loads { gravity: self.gravity, alpha: s(self.setup.mass_damping) },
            road: self.road.map(|Road::Plane { point, normal, velocity }| {
                Plane::new(point, normal, velocity, self.frame)
            }),
            friction: self.friction,
            axle: vec3(self.local(q)),
            axle_velocity: vec3(std::array::from_fn(|d| (q[d] - before[d]) / step.dt)),
            rotation: end.to_cols_array_2d().map(vec3),
            rotation_rate: ((end - start) * (1.0 / step.dt)).to_cols_array_2d().map(vec3),
            axle_before: vec3(self.local(before)),
            weights: weights.map(s),
            number,
        }
    }

    /// Lets the frame follow the axle, when single precision would otherwise run out of digits.
    fn follow(&mut self) {
        if T::EPSILON < 1e-10 || self.rim_nodes.is_empty() {
            return;
        }
        let axle = [self.rim.q[0], self.rim.q[1], self.rim.q[2]];
        let shift = frame::shift(self.grain, axle, self.frame, self.road.as_ref());
        for d in (0..3).filter(|&d| shift[d] != 0.0) {
            self.frame[d] += shift[d];
            self.x.components[d].iter_mut().for_each(|x| *x -= T::from_f64(shift[d]));
        }
    }

    /// Areas of the surface nodes as they are now.
    fn refresh_areas(&mut self) {
        if let (Some(mesh), Some(road)) = (&self.mesh, &self.road) {
            self.nodes.inverse_area = inverse_areas(mesh, |n| self.absolute(n as usize), road);
        }
    }

    fn absolute(&self, n: usize) -> [f64; 3] {
        let x = self.x.get(n);
        std::array::from_fn(|d| x[d] + self.frame[d])
    }

    fn failure(&self, element: usize, time: f64) -> Error {
        let finite = |n: &u32| self.x.get(*n as usize).iter().all(|c| c.is_finite());
        let step = self.steps;
        match self.elements.hexes[element].iter().all(finite) {
            true => Error::Inverted { step, time, element },
            false => Error::NotFinite { step, time, element },
        }
    }

    /// Sums the reaction of the rubber (and of body forces on the rim nodes), node by node in order.
    ///
    /// # Safety
    /// No thread writes slots or positions.
    unsafe fn reaction(&self, view: &View<T>, axle: [f64; 3]) -> Reaction {
        let mut sum = Reaction::default();
        for &n in &self.rim_nodes {
            let f_int = unsafe { self.nodes.gather(n, view) };
            let weight = |i: usize| (self.nodes.mass[n] * self.gravity[i]).to_f64();
            let f: [f64; 3] = std::array::from_fn(|i| weight(i) - f_int[i].to_f64());
            let arm: [f64; 3] = std::array::from_fn(|i| unsafe { *view.x[i].add(n) }.to_f64() - axle[i]);
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sum.force[i] += f[i];
                sum.moment[i] += arm[j] * f[k] - arm[k] * f[j];
            }
        }
        sum
    }

    /// Takes the steps with all threads; `Some((step, element))` where an element failed.
    fn run_steps(
        &mut self,
        steps: &[Step],
        plan: &[Conditions<T>],
        free_rim: bool,
    ) -> Option<(usize, usize)> {
        let (view, books) = (self.view(), self.books());
        let power = Pointer(self.power.as_mut_ptr());
        let mut rim = self.rim;
        let shared_rim = Pointer(&raw mut rim);
        let failed = AtomicUsize::new(usize::MAX);
        let failed_step = AtomicUsize::new(usize::MAX);
        let members = self.threads;
        let barrier = SpinBarrier::new(members);
        let (first, engine) = (self.steps, &*self);
        let (element_batches, chunks) = (engine.elements.batches.len(), engine.sums.len());
        let work = |member: usize| {
            // SAFETY: element batches and node chunks are shared out without overlap, barriers stand between the
            // passes, and the rim's state is written by member 0 only, after all have read it.
            for (n, step) in steps.iter().enumerate() {
                let range = share(element_batches, member, members);
                let bad =
                    unsafe { engine.kernel.forces(&engine.elements, range, &view, power.get(), step.dtm()) };
                if let Some(element) = bad.0 {
                    failed.fetch_min(element, Ordering::Relaxed);
                    failed_step.store(n, Ordering::Relaxed);
                }
                barrier.wait();
                if failed.load(Ordering::Relaxed) != usize::MAX {
                    return;
                }
                let own;
                let conditions = if free_rim {
                    let state = unsafe { *shared_rim.get() };
                    let reaction = unsafe { engine.reaction(&view, engine.local(&state.q)) };
                    let (q, rate) = state.advanced(&engine.setup, step, &reaction);
                    own = engine.conditions(first + n as u64, step, &state.q, &q, false);
                    barrier.wait();
                    if member == 0 {
                        unsafe { *shared_rim.get() = RimState { q, rate, ..state } };
                    }
                    &own
                } else {
                    &plan[n]
                };
                let range = share(chunks, member, members);
                unsafe { T::node_pass(&engine.nodes, conditions, range, &view, &books, false) };
                barrier.wait();
            }
        };
        std::thread::scope(|scope| {
            for member in 1..members {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
        self.rim = rim;
        let element = failed.load(Ordering::Relaxed);
        (element != usize::MAX).then(|| (failed_step.load(Ordering::Relaxed), element))
    }

    /// The step after the window, not taken.
    fn probe(&mut self, next: &Step) -> Probe {
        let fresh = vec![NodeSums::default(); self.sums.len()];
        let window = std::mem::replace(&mut self.sums, fresh);
        let mut power = vec![0.0; self.power.len()];
        let (view, books) = (self.view(), self.books());
        let (batches, chunks) = (self.elements.batches.len(), self.sums.len());
        // SAFETY: this thread is the only one.
        unsafe {
            let weight = 0.5 * next.dt_before;
            self.kernel.forces(&self.elements, 0..batches, &view, power.as_mut_ptr(), weight);
            let reaction = self.reaction(&view, self.local(&self.rim.q));
            let (q, _) = self.rim.advanced(&self.setup, next, &reaction);
            let c = self.conditions(self.steps, next, &self.rim.q, &q, true);
            T::node_pass(&self.nodes, &c, 0..chunks, &view, &books, true);
        }
        let totals = total(&std::mem::replace(&mut self.sums, window));
        let mut half_works = totals.works;
        half_works.viscous = -power.iter().sum::<f64>();
        half_works.internal -= half_works.viscous;
        Probe {
            mixed_kinetic: totals.mixed_kinetic,
            half_works,
            net_force: totals.net_force2.sqrt(),
            internal_force: totals.internal_force2.sqrt(),
        }
    }
}

/// A pointer that threads may share under a pass's rules.
struct Pointer<T>(*mut T);
// SAFETY: dereferenced only in unsafe code that keeps threads apart.
unsafe impl<T> Send for Pointer<T> {}
unsafe impl<T> Sync for Pointer<T> {}
impl<T> Pointer<T> {
    fn get(&self) -> *mut T {
        self.0
    }
}

fn inverse_areas<T: Real>(mesh: &Mesh, x: impl Fn(u32) -> [f64; 3], road: &Road) -> Vec<T> {
    areas::inverse_areas(mesh, x, road).into_iter().map(T::from_f64).collect()
}

fn sub64(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|d| a[d] - b[d])
}

fn padded<T: Real>(values: impl Iterator<Item = f64>) -> Vec<T> {
    values.map(T::from_f64).chain(std::iter::repeat_n(T::zero(), PADDING)).collect()
}

fn surface_index(nodes: usize, surface: &[u32]) -> Vec<u32> {
    let mut index = vec![NO_SURFACE; nodes];
    for (k, &n) in surface.iter().enumerate() {
        index[n as usize] = k as u32;
    }
    index
}

fn rim_state(model: &Model, arms: impl Iterator<Item = [f64; 3]>) -> RimState {
    let mass = |n: &u32| model.mass[*n as usize];
    let [x, y, z] = model.mesh.axle;
    let rim = &model.mesh.rim;
    RimState {
        q: [x, y, z, 0.0, 0.0, 0.0],
        rate: [0.0; 6],
        node_mass: rim.iter().map(mass).sum(),
        node_inertia: rim.iter().zip(arms).map(|(n, a)| mass(n) * (a[0] * a[0] + a[2] * a[2])).sum(),
    }
}

impl<T: NodePass> Engine for CpuEngine<T>
where
    Composable: Build<T>,
{
    fn info(&self) -> EngineInfo {
        EngineInfo {
            engine: "cpu".into(),
            precision: if T::EPSILON < 1e-10 { "f64" } else { "f32" }.into(),
            device: format!("{} processor, {:?} lanes", std::env::consts::ARCH, self.nodes.level),
            driver: String::new(),
            threads: self.threads,
        }
    }

    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        // The rates stay: a component that is let go keeps the speed it was driven with.
        self.setup = *setup;
        Ok(())
    }

    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        let free_rim = RimState::is_free(&self.setup);
        // With a free rim the conditions depend on the state and are made on the way.
        let plan: Vec<Conditions<T>> = if free_rim {
            Vec::new()
        } else {
            let starts = std::iter::once(&self.rim.q).chain(steps.iter().map(|s| &s.rim));
            let numbered = (self.steps..).zip(steps).zip(starts);
            numbered.map(|((n, s), before)| self.conditions(n, s, before, &s.rim, false)).collect()
        };
        if let Some((taken, element)) = self.run_steps(steps, &plan, free_rim) {
            self.steps += taken as u64;
            return Err(self.failure(element, steps[taken].time));
        }
        self.steps += steps.len() as u64;
        self.window_steps += steps.len() as u64;
        if let (Some(last), false) = (steps.last(), free_rim) {
            let before = steps.iter().nth_back(1).map_or(self.rim.q, |s| s.rim);
            self.rim.rate = std::array::from_fn(|c| (last.rim[c] - before[c]) / last.dt);
            self.rim.q = last.rim;
        }
        Ok(())
    }

    fn sample(&mut self, next: &Step) -> Result<Window> {
        let viscous = -self.power.iter().sum::<f64>();
        self.power.fill(0.0);
        let committed = total(&self.sums);
        self.sums.fill(NodeSums::default());
        let mut works = committed.works;
        works.viscous = viscous;
        works.internal -= viscous;
        let fresh = vec![SurfaceSum::default(); self.surface_nodes.len()];
        let mut surface = std::mem::replace(&mut self.surface, fresh);
        for (k, (sum, &n)) in surface.iter_mut().zip(&self.surface_nodes).enumerate() {
            sum.x = self.absolute(n as usize);
            sum.v = self.v.get(n as usize);
            sum.touches = self.steps > 0 && self.last_touch[k] == self.steps;
            sum.sticks &= sum.touches;
        }
        let view = self.view();
        // SAFETY: no other thread runs.
        let energies = unsafe { self.kernel.energies(&self.elements, &view) };
        let square = |n: usize| self.v.get(n).iter().map(|c| c * c).sum::<f64>();
        let count = self.nodes.surface_of.len();
        let kinetic = (0..count).map(|n| 0.5 * self.nodes.mass[n].to_f64() * square(n)).sum();
        let probe = self.probe(next);
        let window = Window {
            steps: std::mem::take(&mut self.window_steps),
            works,
            rim_impulse: committed.rim_impulse,
            rim_moment_impulse: committed.rim_moment_impulse,
            surface,
            step_contact: Vec::new(),
            rim: self.rim.q,
            rim_rate: self.rim.rate,
            kinetic,
            probe,
            strain: energies.strain,
            hourglass: energies.hourglass,
            min_jacobian: energies.min_jacobian,
        };
        self.follow();
        self.refresh_areas();
        Ok(window)
    }

    fn state(&mut self) -> Result<State> {
        let nodes = 0..self.nodes.surface_of.len();
        Ok(State {
            x: nodes.clone().map(|n| self.absolute(n)).collect(),
            v: nodes.map(|n| self.v.get(n)).collect(),
        })
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.v = Field::new(v.iter().copied());
        for component in 0..6 {
            if self.setup.free[component].is_some() {
                self.rim.rate[component] = rim_rate[component];
            }
        }
        Ok(())
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        let frame = self.frame;
        self.x = Field::new(state.x.iter().map(|&x| sub64(x, frame)));
        self.rim.q = *rim;
        self.follow();
        self.set_velocity(&state.v, rim_rate)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        let frame = self.frame;
        let mut x = Field::<T>::new(x.iter().map(|&x| sub64(x, frame)));
        let mut v = Field::<T>::new(v.iter().copied());
        let mut power = vec![0.0; self.power.len()];
        let slots = self.slots.as_mut_ptr();
        let view = View { x: x.pointers(), v: v.pointers(), slots, stride: self.stride };
        let power = Pointer(power.as_mut_ptr());
        let (batches, members) = (self.elements.batches.len(), self.threads);
        let engine = &*self;
        let work = |member: usize| {
            let range = share(batches, member, members);
            // SAFETY: batches are shared out without overlap; positions are only read.
            unsafe { engine.kernel.forces(&engine.elements, range, &view, power.get(), 0.0) };
        };
        std::thread::scope(|scope| {
            for member in 1..members {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
        let nodes = 0..self.nodes.surface_of.len();
        // SAFETY: the threads have ended.
        Ok(nodes.map(|n| unsafe { self.nodes.gather(n, &view) }.map(Real::to_f64)).collect())
    }
}
