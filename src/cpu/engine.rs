use super::build::{inverse_areas, nodes, rim_nodes, rim_state, shape_table, stored, sub64};
use super::elements::{self, Elements, Kernel};
use super::energies::Stored;
use super::layout::{Item, Layout};
use super::nodes::{Books, Conditions, LineContact, LineSums, Nodes};
use super::reduce::total;
use super::rim::RimState;
use super::schedule::{Share, Task, shares};
use super::slots;
use super::state::{Field, View};
use super::steps::Pointer;
use crate::engine::{Engine, EngineInfo, StageSetup, State, Step, StepContact, SurfaceSum, Window};
use crate::error::{Error, Result};
use crate::model::mesh::Mesh;
use crate::model::{Model, frame};
use crate::physics::lanes::{Level, WIDEST};
use crate::physics::rim::Coordinates;
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, vec3};
use crate::scene::{Element, Friction, Road, Scene};

/// Elements below which another thread costs more in waiting than it saves: a few microseconds of a step. With one point an
/// element two threads took 29 us for the wheel's 880 on one machine, where one took 25, and 18 to 22 us on another, both.
fn elements_a_thread(element: Element) -> usize {
    match element {
        Element::UniformGradient { .. } => 1000,
        Element::Q1p0 | Element::Full => 200,
    }
}

/// The CPU engine in precision `T`.
pub struct CpuEngine<T> {
    pub(super) kernel: Box<dyn Kernel<T>>,
    pub(super) elements: Elements<T>,
    pub(super) nodes: Nodes<T>,
    /// Places of the mesh's nodes.
    pub(super) place: Vec<u32>,
    pub(super) stored: Stored,
    /// Whether forces depend on velocities.
    pub(super) viscous: bool,
    /// Line of each rim node, and its index in it.
    pub(super) rim_nodes: Vec<(usize, usize)>,
    pub(super) shares: Vec<Share>,
    pub(super) road: Option<Road>,
    pub(super) friction: Option<Friction>,
    pub(super) gravity: Vec3<T>,
    /// For the areas of surface nodes, where friction looks at pressure.
    pub(super) mesh: Option<Mesh>,
    pub(super) setup: StageSetup,
    pub(super) rim: RimState,
    /// Origin of the engine's frame: positions are kept relative to it.
    pub(super) frame: [f64; 3],
    pub(super) grain: f64,
    pub(super) x: Field<T>,
    pub(super) v: Field<T>,
    pub(super) f: Field<T>,
    /// Positions and velocities that a step which fails is taken back to.
    pub(super) before: [Field<T>; 2],
    /// Viscous work so far of the window [J], by item and lane.
    pub(super) power: Vec<f64>,
    pub(super) sums: Vec<LineSums>,
    pub(super) surface_nodes: Vec<u32>,
    pub(super) surface: Vec<SurfaceSum>,
    pub(super) last_touch: Vec<u64>,
    /// By line that can touch, of even and of odd steps: one is summed up while the other is written.
    pub(super) contact: [Vec<LineContact>; 2],
    pub(super) step_contact: Vec<StepContact>,
    pub(super) touching_before: u32,
    pub(super) steps: u64,
    pub(super) window_steps: u64,
}

impl<T: Real> CpuEngine<T> {
    /// An engine at rest in the reference shape, with the best instructions of this machine. `threads` = 0: as many as
    /// the mesh keeps busy, at most one a core.
    pub fn new(model: &Model, scene: &Scene, threads: usize) -> Self {
        CpuEngine::with_level(model, scene, threads, Level::detect())
    }

    /// The same with chosen instructions.
    pub fn with_level(model: &Model, scene: &Scene, threads: usize, level: Level) -> Self {
        let threads = match threads {
            0 => {
                let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
                cores.min(model.element_count().div_ceil(elements_a_thread(model.element)))
            }
            n => n,
        };
        let mesh = &model.mesh;
        let width = level.width::<T>();
        let mut layout = Layout::new(model, scene.road.is_some(), width);
        let surface_nodes = if scene.road.is_some() { mesh.surface.clone() } else { Vec::new() };
        let grain = frame::grain(mesh);
        let frame = frame::shift(grain, mesh.axle, [0.0; 3], scene.road.as_ref());
        let shares = shares(&layout, threads);
        let Layout { items, lines, groups, .. } = &mut layout;
        let lengths: Vec<usize> = lines.iter().map(|line| line.length(width)).collect();
        let slots = slots::lay(items, lines, groups, &shares, &lengths);
        let kernel = elements::compose(model, level);
        let shapes = shape_table(model, &layout, width, kernel.numbers());
        let mut engine = CpuEngine {
            kernel,
            power: vec![0.0; layout.items.len() * WIDEST],
            sums: vec![LineSums::default(); layout.lines.len()],
            contact: [0, 1].map(|_| vec![LineContact::default(); layout.surface_lines]),
            nodes: Nodes {
                inverse_area: match (scene.friction, &scene.road) {
                    (Some(law), Some(road)) if law.needs_area() => {
                        inverse_areas(mesh, |n| mesh.nodes[n as usize], road)
                    }
                    _ => Vec::new(),
                },
                ..nodes(model, &layout, &surface_nodes, level, width)
            },
            stored: stored(model, &layout, level, width),
            viscous: model.viscosity.is_some(),
            rim_nodes: rim_nodes(model, &layout),
            rim: rim_state(model),
            x: Field::zeros(layout.places),
            v: Field::zeros(layout.places),
            f: Field::zeros(slots),
            before: [Field::zeros(layout.places), Field::zeros(layout.places)],
            elements: Elements { shapes, items: layout.items },
            place: layout.place,
            shares,
            road: scene.road,
            friction: scene.friction,
            mesh: scene.friction.filter(Friction::needs_area).map(|_| mesh.clone()),
            gravity: vec3(scene.gravity),
            setup: StageSetup::default(),
            frame,
            grain,
            surface: vec![SurfaceSum::default(); surface_nodes.len()],
            last_touch: vec![0; surface_nodes.len()],
            surface_nodes,
            step_contact: Vec::new(),
            touching_before: 0,
            steps: 0,
            window_steps: 0,
        };
        let mut x = Field::zeros(layout.places);
        engine.fill(&mut x, &mesh.nodes, frame);
        engine.x = x;
        engine
    }

    /// Puts values by node at their places, and on the lanes beyond the end of a line its nodes over again, so that
    /// no lane computes with anything but a body's numbers.
    fn fill(&self, field: &mut Field<T>, values: &[[f64; 3]], origin: [f64; 3]) {
        for line in &self.nodes.lines {
            for (i, &n) in line.nodes.iter().cycle().take(line.length(self.width())).enumerate() {
                field.set(line.start + i, sub64(values[n as usize], origin));
            }
        }
    }

    fn width(&self) -> usize {
        self.nodes.level.width::<T>()
    }

    pub(super) fn view(&mut self) -> View<T> {
        View { x: self.x.pointers(), v: self.v.pointers(), f: self.f.pointers() }
    }

    pub(super) fn books(&mut self) -> [Books; 2] {
        let [even, odd] = self.contact.each_mut().map(|c| c.as_mut_ptr());
        let mut books = |contact| Books {
            surface: self.surface.as_mut_ptr(),
            last_touch: self.last_touch.as_mut_ptr(),
            sums: self.sums.as_mut_ptr(),
            contact,
        };
        [books(even), books(odd)]
    }

    /// Clears the slots that are added to lane by lane.
    fn clear_loose(&mut self) {
        let width = self.width();
        for line in self.nodes.lines.iter().filter(|l| l.loose) {
            let length = line.length(width);
            for &slot in &line.slots {
                for d in 0..3 {
                    self.f.component_mut(d)[slot..slot + length].fill(T::zero());
                }
            }
        }
    }

    pub(super) fn local(&self, q: &Coordinates) -> [f64; 3] {
        std::array::from_fn(|d| q[d] - self.frame[d])
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
            self.x.component_mut(d).iter_mut().for_each(|x| *x -= T::from_f64(shift[d]));
        }
    }

    /// Areas of the surface nodes as they are now.
    fn refresh_areas(&mut self) {
        if let (Some(mesh), Some(road)) = (&self.mesh, &self.road) {
            self.nodes.inverse_area = inverse_areas(mesh, |n| self.absolute(n as usize), road);
        }
    }

    fn absolute(&self, n: usize) -> [f64; 3] {
        let x = self.x.get(self.place[n] as usize);
        std::array::from_fn(|d| x[d] + self.frame[d])
    }

    fn failure(&self, element: usize, time: f64) -> Error {
        let finite = |n: &u32| self.x.get(*n as usize).iter().all(|c| c.is_finite());
        let step = self.steps;
        let corners = |item: &Item| {
            let k = item.elements().iter().position(|e| *e as usize == element)?;
            Some(item.corners()[k])
        };
        let corners = self.elements.items.iter().find_map(corners).expect("every element is in an item");
        match corners.iter().all(finite) {
            true => Error::Inverted { step, time, element },
            false => Error::NotFinite { step, time, element },
        }
    }
}

impl<T: Real> CpuEngine<T> {
    /// sum 1/2 m v^2 [J].
    fn kinetic(&self) -> f64 {
        let square = |p: usize| self.v.get(p).iter().map(|c| c * c).sum::<f64>();
        let one = |p: &u32| 0.5 * self.nodes.mass.slice()[*p as usize].to_f64() * square(*p as usize);
        self.place.iter().map(one).sum()
    }
}

impl<T: Real> Engine for CpuEngine<T> {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            engine: "cpu".into(),
            precision: if T::EPSILON < 1e-10 { "f64" } else { "f32" }.into(),
            device: format!("{} processor, {:?} lanes", std::env::consts::ARCH, self.nodes.level),
            driver: String::new(),
            threads: self.shares.len(),
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
        let [x, v] = &mut self.before;
        x.copy_from(&self.x);
        v.copy_from(&self.v);
        let rim = self.rim;
        if let Some((taken, element)) = self.run_steps(steps, &plan, free_rim) {
            // Some nodes of the failing step have moved already: take the steps before it again.
            let [x, v] = &self.before;
            self.x.copy_from(x);
            self.v.copy_from(v);
            self.rim = rim;
            self.clear_loose();
            self.run_steps(&steps[..taken], &plan, free_rim);
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
        self.sums.fill(LineSums::default());
        let mut works = committed.works;
        works.viscous = viscous;
        works.internal -= viscous;
        let fresh = vec![SurfaceSum::default(); self.surface_nodes.len()];
        let mut surface = std::mem::replace(&mut self.surface, fresh);
        for (k, (sum, &n)) in surface.iter_mut().zip(&self.surface_nodes).enumerate() {
            sum.x = self.absolute(n as usize);
            sum.v = self.v.get(self.place[n as usize] as usize);
            sum.touches = self.steps > 0 && self.last_touch[k] == self.steps;
            sum.sticks &= sum.touches;
            // The next step's changes are told from this one's states.
            self.surface[k].sticks = sum.sticks;
        }
        let x = [0, 1, 2].map(|d| self.x.component(d));
        let energies = self.stored.totals(&self.elements.items, x);
        let kinetic = self.kinetic();
        let probe = self.probe(next);
        let window = Window {
            steps: std::mem::take(&mut self.window_steps),
            works,
            rim_impulse: committed.rim_impulse,
            rim_moment_impulse: committed.rim_moment_impulse,
            surface,
            step_contact: std::mem::take(&mut self.step_contact),
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
        let nodes = 0..self.place.len();
        Ok(State {
            x: nodes.clone().map(|n| self.absolute(n)).collect(),
            v: nodes.map(|n| self.v.get(self.place[n] as usize)).collect(),
        })
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        let mut field = self.v.clone();
        self.fill(&mut field, v, [0.0; 3]);
        self.v = field;
        for component in 0..6 {
            if self.setup.free[component].is_some() {
                self.rim.rate[component] = rim_rate[component];
            }
        }
        Ok(())
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        let mut field = self.x.clone();
        self.fill(&mut field, &state.x, self.frame);
        self.x = field;
        self.rim.q = *rim;
        self.follow();
        self.set_velocity(&state.v, rim_rate)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        let mut at = self.x.clone();
        self.fill(&mut at, x, self.frame);
        let mut rate = self.viscous.then(|| self.v.clone());
        if let Some(rate) = &mut rate {
            self.fill(rate, v, [0.0; 3]);
        }
        let rate = rate.as_mut().unwrap_or(&mut self.v).pointers();
        let view = View { x: at.pointers(), v: rate, f: self.f.pointers() };
        let mut power = vec![0.0; self.power.len()];
        let power = Pointer(power.as_mut_ptr());
        let engine = &*self;
        let mut forces = vec![[0.0; 3]; self.place.len()];
        let out = Pointer(forces.as_mut_ptr());
        let gather = |line: u32| {
            let line = &engine.nodes.lines[line as usize];
            for (i, &n) in line.nodes.iter().enumerate() {
                // SAFETY: the line's forces are complete, and its nodes are no other's.
                unsafe { *out.get().add(n as usize) = Self::gather(line, i, &view).map(Real::to_f64) };
            }
        };
        let work = |member: usize| {
            for task in &engine.shares[member].early {
                match *task {
                    // SAFETY: shares do not overlap; positions are only read.
                    Task::Forces(item) => unsafe {
                        engine.forces(item as usize, &view, power.get(), 0.0);
                    },
                    Task::Move(line) => gather(line),
                }
            }
        };
        std::thread::scope(|scope| {
            for member in 1..engine.shares.len() {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
        engine.shares.iter().flat_map(|share| &share.late).for_each(|line| gather(*line));
        self.clear_loose();
        Ok(forces)
    }
}
