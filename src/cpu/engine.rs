use super::elements::{self, Build, Composable, Elements, Failed, Kernel, Power};
use super::energies::Stored;
use super::layout::Layout;
use super::nodes::{Books, Conditions, LineContact, LineSums, NO_SURFACE, NodePass, Nodes};
use super::reduce::total;
use super::rim::{Reaction, RimState};
use super::schedule::{Share, Task, shares};
use super::state::{Aligned, Field, View};
use super::team::SpinBarrier;
use crate::engine::{Engine, EngineInfo, Probe, StageSetup, State, Step, StepContact, SurfaceSum, Window};
use crate::error::{Error, Result};
use crate::model::mesh::Mesh;
use crate::model::{Model, areas, frame};
use crate::physics::friction::AnyFriction;
use crate::physics::lanes::{Level, WIDEST};
use crate::physics::node::{Loads, Prediction, StepSize};
use crate::physics::rim::{self, Coordinates};
use crate::physics::road::Plane;
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, vec3};
use crate::scene::{Element, Friction, Road, Scene};
use std::sync::atomic::{AtomicUsize, Ordering};

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
    kernel: Box<dyn Kernel<T>>,
    elements: Elements<T>,
    nodes: Nodes<T>,
    /// Places of the mesh's nodes.
    place: Vec<u32>,
    stored: Stored,
    /// Whether forces depend on velocities.
    viscous: bool,
    /// Where the forces of a node are, by place: `slot_start[p]..slot_start[p + 1]` of `slot_at`.
    slot_start: Vec<u32>,
    slot_at: Vec<u32>,
    rim_nodes: Vec<usize>,
    shares: Vec<Share>,
    road: Option<Road>,
    friction: Option<AnyFriction<T>>,
    gravity: Vec3<T>,
    /// For the areas of surface nodes, where friction looks at pressure.
    mesh: Option<Mesh>,
    setup: StageSetup,
    rim: RimState,
    /// Origin of the engine's frame: positions are kept relative to it.
    frame: [f64; 3],
    grain: f64,
    x: Field<T>,
    v: Field<T>,
    f: Field<T>,
    /// Viscous work so far of the window [J], by item and lane.
    power: Vec<f64>,
    sums: Vec<LineSums>,
    surface_nodes: Vec<u32>,
    surface: Vec<SurfaceSum>,
    last_touch: Vec<u64>,
    /// By line that can touch, of even and of odd steps: one is summed up while the other is written.
    contact: [Vec<LineContact>; 2],
    step_contact: Vec<StepContact>,
    touching_before: u32,
    steps: u64,
    window_steps: u64,
}

impl<T: NodePass> CpuEngine<T>
where
    Composable: Build<T>,
{
    /// An engine at rest in the reference shape, with the best instructions of this machine. `threads` = 0: as many as
    /// the mesh keeps busy, at most one a core.
    pub fn new(model: &Model, scene: &Scene, threads: usize) -> Self {
        CpuEngine::with_level(model, scene, threads, Level::detect())
    }

    /// The same with chosen instructions, which the machine must have.
    pub fn with_level(model: &Model, scene: &Scene, threads: usize, level: Level) -> Self {
        assert!(level <= Level::detect(), "this machine has no {level:?}");
        let threads = match threads {
            0 => {
                let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
                cores.min(model.element_count().div_ceil(elements_a_thread(model.element)))
            }
            n => n,
        };
        let mesh = &model.mesh;
        let width = elements::width(level, size_of::<T>() == 4);
        let layout = Layout::new(model, scene.road.is_some(), width);
        let surface_nodes = if scene.road.is_some() { mesh.surface.clone() } else { Vec::new() };
        let grain = frame::grain(mesh);
        let frame = frame::shift(grain, mesh.axle, [0.0; 3], scene.road.as_ref());
        let (slot_start, slot_at) = slots_by_place(&layout);
        let shares = shares(&layout, threads);
        let mut engine = CpuEngine {
            kernel: elements::compose(model, level),
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
                ..nodes(model, &layout, &surface_nodes, level)
            },
            stored: stored(model, &layout, level),
            viscous: model.viscosity.is_some(),
            rim_nodes: mesh.rim.iter().map(|&n| layout.place[n as usize] as usize).collect(),
            rim: rim_state(model),
            x: Field::zeros(layout.places),
            v: Field::zeros(layout.places),
            f: Field::zeros(layout.slots),
            elements: Elements { shapes: shape_table(model, &layout, width), items: layout.items },
            place: layout.place,
            slot_start,
            slot_at,
            shares,
            road: scene.road,
            friction: scene.friction.as_ref().map(AnyFriction::new),
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
            let vectors = line.nodes.len().div_ceil(self.width()) + 1;
            for (i, &n) in line.nodes.iter().cycle().take(vectors * self.width()).enumerate() {
                field.set(line.start + i, sub64(values[n as usize], origin));
            }
        }
    }

    fn width(&self) -> usize {
        elements::width(self.nodes.level, size_of::<T>() == 4)
    }

    fn view(&mut self) -> View<T> {
        View { x: self.x.pointers(), v: self.v.pointers(), f: self.f.pointers() }
    }

    fn books(&mut self) -> [Books; 2] {
        let [even, odd] = self.contact.each_mut().map(|c| c.as_mut_ptr());
        let mut books = |contact| Books {
            surface: self.surface.as_mut_ptr(),
            last_touch: self.last_touch.as_mut_ptr(),
            sums: self.sums.as_mut_ptr(),
            contact,
        };
        [books(even), books(odd)]
    }

    /// Internal force of the node at a place: its slots, first to last.
    ///
    /// # Safety
    /// No thread writes forces.
    unsafe fn gather(&self, place: usize, view: &View<T>) -> Vec3<T> {
        let slots = self.slot_start[place] as usize..self.slot_start[place + 1] as usize;
        let mut f = [T::zero(); 3];
        for (k, &slot) in self.slot_at[slots].iter().enumerate() {
            for d in 0..3 {
                let part = unsafe { *view.f[d].add(slot as usize) };
                f[d] = if k == 0 { part } else { f[d] + part };
            }
        }
        f
    }

    /// Clears the slots that are added to lane by lane.
    fn clear_loose(&mut self) {
        let width = self.width();
        for line in self.nodes.lines.iter().filter(|l| l.loose) {
            let length = (line.nodes.len().div_ceil(width) + 1) * width;
            for &slot in &line.slots {
                for d in 0..3 {
                    self.f.component_mut(d)[slot..slot + length].fill(T::zero());
                }
            }
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
        let size = StepSize { dt: s(step.dt), dtm: s(step.dtm()) };
        let loads = Loads { gravity: self.gravity, alpha: s(self.setup.mass_damping) };
        Conditions {
            step: size,
            loads,
            prediction: Prediction::new(&loads, size),
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
            has_gravity: self.gravity.iter().any(|g| *g != T::zero()),
            has_damping: self.setup.mass_damping != 0.0,
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
        match self.stored.hexes[element].iter().all(finite) {
            true => Error::Inverted { step, time, element },
            false => Error::NotFinite { step, time, element },
        }
    }

    /// Sums the reaction of the rubber (and of body forces on the rim nodes), node by node in order.
    ///
    /// # Safety
    /// No thread writes forces or positions.
    unsafe fn reaction(&self, view: &View<T>, axle: [f64; 3]) -> Reaction {
        let mut sum = Reaction::default();
        for &n in &self.rim_nodes {
            let f_int = unsafe { self.gather(n, view) };
            let weight = |i: usize| (self.nodes.mass.slice()[n] * self.gravity[i]).to_f64();
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
        let mut step_contact = std::mem::take(&mut self.step_contact);
        let mut touching_before = self.touching_before;
        let mut rim = self.rim;
        let shared_rim = Pointer(&raw mut rim);
        let host = Pointer(&raw mut step_contact);
        let host_touching = Pointer(&raw mut touching_before);
        let failed = AtomicUsize::new(usize::MAX);
        let failed_step = AtomicUsize::new(usize::MAX);
        let members = self.shares.len();
        let barrier = SpinBarrier::new(members);
        let (first, engine) = (self.steps, &*self);
        let work = |member: usize| {
            // SAFETY: shares do not overlap, barriers stand between what one writes and another reads, and the rim's
            // state and the host's records are written by member 0 only.
            for (n, step) in steps.iter().enumerate() {
                let books = &books[n % 2];
                let early = plan.get(n);
                let bad =
                    unsafe { engine.early(member, early, &view, books, power.get(), step.dtm(), false) };
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
                unsafe { engine.late(member, conditions, &view, books, false, free_rim) };
                barrier.wait();
                if member == 0 && engine.road.is_some() {
                    let (host, touching) = unsafe { (&mut *host.get(), &mut *host_touching.get()) };
                    let lines = unsafe { std::slice::from_raw_parts(books.contact, engine.contact[0].len()) };
                    host.push(contact_of(lines, step.dtm(), touching));
                }
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
        self.step_contact = step_contact;
        self.touching_before = touching_before;
        let element = failed.load(Ordering::Relaxed);
        (element != usize::MAX).then(|| (failed_step.load(Ordering::Relaxed), element))
    }

    /// A member's forces, and the nodes that may move before the threads meet. Without conditions none do: where the
    /// rim is free they depend on its motion, and it on all forces.
    ///
    /// # Safety
    /// No other thread works on this share.
    #[allow(clippy::too_many_arguments)] // what a step needs
    unsafe fn early(
        &self,
        member: usize,
        conditions: Option<&Conditions<T>>,
        view: &View<T>,
        books: &Books,
        power: *mut f64,
        weight: f64,
        probe: bool,
    ) -> Failed {
        let mut failed = Failed(None);
        for task in &self.shares[member].early {
            match (*task, conditions) {
                (Task::Forces(item), _) => unsafe {
                    let bad = self.forces(item as usize, view, power, weight);
                    failed.0 = [failed.0, bad.0].into_iter().flatten().min();
                },
                (Task::Move(line), Some(c)) => unsafe {
                    T::node_pass(&self.nodes, c, line as usize, view, books, probe);
                },
                (Task::Move(_), None) => {}
            }
        }
        failed
    }

    /// Forces of an item.
    ///
    /// # Safety
    /// As [`Kernel::forces`].
    unsafe fn forces(&self, item: usize, view: &View<T>, power: *mut f64, weight: f64) -> Failed {
        unsafe {
            let power = Power { sums: power.add(item * WIDEST), weight };
            self.kernel.forces(&self.elements, item, view, power)
        }
    }

    /// The nodes of a member that wait for all forces, or all of its nodes.
    ///
    /// # Safety
    /// No other thread works on this share.
    unsafe fn late(
        &self,
        member: usize,
        c: &Conditions<T>,
        view: &View<T>,
        books: &Books,
        probe: bool,
        all: bool,
    ) {
        let share = &self.shares[member];
        let move_line = |line: u32| unsafe {
            T::node_pass(&self.nodes, c, line as usize, view, books, probe);
        };
        for task in share.early.iter().filter(|_| all) {
            if let Task::Move(line) = *task {
                move_line(line);
            }
        }
        share.late.iter().for_each(|line| move_line(*line));
    }

    /// The step after the window, not taken.
    fn probe(&mut self, next: &Step) -> Probe {
        let fresh = vec![LineSums::default(); self.sums.len()];
        let window = std::mem::replace(&mut self.sums, fresh);
        let mut power = vec![0.0; self.power.len()];
        let (view, [books, _]) = (self.view(), self.books());
        let shared_power = Pointer(power.as_mut_ptr());
        let members = self.shares.len();
        let barrier = SpinBarrier::new(members);
        let engine = &*self;
        let work = |member: usize| {
            // SAFETY: as in `run_steps`; nothing but forces and sums is written.
            unsafe {
                let weight = 0.5 * next.dt_before;
                engine.early(member, None, &view, &books, shared_power.get(), weight, true);
                barrier.wait();
                let reaction = engine.reaction(&view, engine.local(&engine.rim.q));
                let (q, _) = engine.rim.advanced(&engine.setup, next, &reaction);
                let c = engine.conditions(engine.steps, next, &engine.rim.q, &q, true);
                barrier.wait();
                engine.late(member, &c, &view, &books, true, true);
            }
        };
        std::thread::scope(|scope| {
            for member in 1..members {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
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

impl<T: NodePass> CpuEngine<T> {
    /// sum 1/2 m v^2 [J].
    fn kinetic(&self) -> f64 {
        let square = |p: usize| self.v.get(p).iter().map(|c| c * c).sum::<f64>();
        let one = |p: &u32| 0.5 * self.nodes.mass.slice()[*p as usize].to_f64() * square(*p as usize);
        self.place.iter().map(one).sum()
    }
}

/// A step's contact from its lines, first to last; `before`: nodes that touched in the step before.
fn contact_of(lines: &[LineContact], dtm: f64, before: &mut u32) -> StepContact {
    let mut sum = StepContact { dtm, ..StepContact::default() };
    let (mut entered, mut switched) = (0, 0);
    for line in lines {
        for d in 0..3 {
            sum.force[d] += line.force[d];
        }
        sum.touching += line.touching;
        entered += line.entered;
        switched += line.switched;
    }
    // Those of the step before that are not among the touching have left.
    let left = before.saturating_sub(sum.touching - entered);
    sum.changes = entered + switched + left;
    *before = sum.touching;
    sum
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

/// Data of the node pass by place.
fn nodes<T: NodePass>(model: &Model, layout: &Layout, surface: &[u32], level: Level) -> Nodes<T> {
    let place = |n: u32| layout.place[n as usize] as usize;
    let (mut mass, mut inverse_mass) = (Aligned::zeros(layout.places), Aligned::zeros(layout.places));
    for (n, &m) in model.mass.iter().enumerate() {
        mass.slice_mut()[place(n as u32)] = T::from_f64(m);
        inverse_mass.slice_mut()[place(n as u32)] = T::from_f64(1.0 / m);
    }
    let mut surface_of = vec![NO_SURFACE; layout.places];
    for (k, &n) in surface.iter().enumerate() {
        surface_of[place(n)] = k as u32;
    }
    let mut rim_arms = Field::zeros(layout.places);
    for &n in &model.mesh.rim {
        rim_arms.set(place(n), sub64(model.mesh.nodes[n as usize], model.mesh.axle));
    }
    Nodes {
        lines: layout.lines.clone(),
        mass,
        inverse_mass,
        surface_of,
        rim_arms,
        inverse_area: Vec::new(),
        level,
    }
}

fn stored(model: &Model, layout: &Layout, level: Level) -> Stored {
    Stored {
        element: model.element,
        law: model.law,
        level,
        classes: model.classes.clone(),
        class_of: model.class_of.clone(),
        hexes: model.mesh.hexes.iter().map(|hex| hex.map(|n| layout.place[n as usize])).collect(),
    }
}

/// Reference geometry by lanes, number by number.
fn shape_table<T: Real>(model: &Model, layout: &Layout, width: usize) -> Aligned<T> {
    let length = model.classes[0].numbers().len();
    let mut table = Aligned::zeros(layout.shapes.len() * length * width);
    for (lanes, part) in layout.shapes.iter().zip(table.slice_mut().chunks_exact_mut(length * width)) {
        for (lane, class) in lanes[..width].iter().enumerate() {
            for (i, number) in model.classes[*class as usize].numbers().iter().enumerate() {
                part[i * width + lane] = T::from_f64(*number);
            }
        }
    }
    table
}

/// Slots of every place, in the order in which they are summed.
fn slots_by_place(layout: &Layout) -> (Vec<u32>, Vec<u32>) {
    let mut of_place = vec![&[][..]; layout.places];
    let mut offset = vec![0; layout.places];
    for line in &layout.lines {
        for i in 0..line.nodes.len() {
            of_place[line.start + i] = &line.slots;
            offset[line.start + i] = i;
        }
    }
    let (mut start, mut at) = (vec![0], Vec::new());
    for (slots, offset) in of_place.iter().zip(&offset) {
        at.extend(slots.iter().map(|slot| (slot + offset) as u32));
        start.push(at.len() as u32);
    }
    (start, at)
}

fn rim_state(model: &Model) -> RimState {
    let mass = |n: &u32| model.mass[*n as usize];
    let axle = model.mesh.axle;
    let [x, y, z] = axle;
    let rim = &model.mesh.rim;
    let arm2 = |n: &u32| {
        let arm = sub64(model.mesh.nodes[*n as usize], axle);
        arm[0] * arm[0] + arm[2] * arm[2]
    };
    RimState {
        q: [x, y, z, 0.0, 0.0, 0.0],
        rate: [0.0; 6],
        node_mass: rim.iter().map(mass).sum(),
        node_inertia: rim.iter().map(|n| mass(n) * arm2(n)).sum(),
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
        let before = (self.x.clone(), self.v.clone(), self.rim);
        if let Some((taken, element)) = self.run_steps(steps, &plan, free_rim) {
            // Some nodes of the failing step have moved already: take the steps before it again.
            (self.x, self.v, self.rim) = before;
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
        let work = |member: usize| {
            for item in engine.shares[member].items.clone() {
                // SAFETY: shares do not overlap; positions are only read.
                unsafe { engine.forces(item, &view, power.get(), 0.0) };
            }
        };
        std::thread::scope(|scope| {
            for member in 1..engine.shares.len() {
                let work = &work;
                scope.spawn(move || work(member));
            }
            work(0);
        });
        // SAFETY: the threads have ended.
        let sum = |p: &u32| unsafe { self.gather(*p as usize, &view) }.map(Real::to_f64);
        let forces = self.place.iter().map(sum).collect();
        self.clear_loose();
        Ok(forces)
    }
}
