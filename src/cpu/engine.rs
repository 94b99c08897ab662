use super::elements::{self, Elements, Kernel};
use super::nodes::{self, Conditions, NodeSums, Nodes, Role};
use super::reduce::total;
use super::rim::{Reaction, RimState};
use super::team::{Shared, SpinBarrier, share};
use crate::engine::{Engine, EngineInfo, Probe, StageSetup, State, Step, SurfaceSum, Window};
use crate::error::{Error, Result};
use crate::model::{Model, frame};
use crate::physics::element::Corners;
use crate::physics::friction::Coulomb;
use crate::physics::node::{Loads, StepSize};
use crate::physics::rim::{self, Coordinates};
use crate::physics::road::Plane;
use crate::physics::scalar::Real;
use crate::physics::tensor::{Vec3, sub, vec3};
use crate::scene::{Friction, Road, Scene};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The CPU engine in scalar `S`.
pub struct CpuEngine<S> {
    kernel: Box<dyn Kernel<S>>,
    elements: Elements<S>,
    nodes: Nodes<S>,
    road: Option<Road>,
    friction: Option<Coulomb<S>>,
    gravity: Vec3<S>,
    setup: StageSetup,
    rim: RimState,
    threads: usize,
    /// Origin of the engine's frame: positions are kept relative to it.
    frame: [f64; 3],
    grain: f64,
    x: Vec<Vec3<S>>,
    v: Vec<Vec3<S>>,
    slots: Vec<Corners<S>>,
    /// Viscous work so far of the window, by element chunk [J].
    power: Vec<f64>,
    sums: Vec<NodeSums>,
    surface_nodes: Vec<u32>,
    surface: Vec<SurfaceSum>,
    steps: u64,
    window_steps: u64,
}

impl<S: Real> CpuEngine<S> {
    /// An engine at rest in the reference shape. `threads` = 0: all cores.
    pub fn new(model: &Model, scene: &Scene, threads: usize) -> Self {
        let threads = match threads {
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n,
        };
        let mesh = &model.mesh;
        let grain = frame::grain(mesh);
        let frame = frame::shift(grain, mesh.axle, [0.0; 3], scene.road.as_ref());
        let roles = roles(model, scene.road.is_some());
        let surface_nodes = if scene.road.is_some() { mesh.surface.clone() } else { Vec::new() };
        let rim_arms: Vec<[f64; 3]> = mesh
            .rim
            .iter()
            .map(|&n| std::array::from_fn(|d| mesh.nodes[n as usize][d] - mesh.axle[d]))
            .collect();
        CpuEngine {
            kernel: elements::compose(model.element, model.law, model.viscosity),
            elements: Elements {
                hexes: mesh.hexes.clone(),
                class_of: model.class_of.clone(),
                classes: model.classes.iter().map(|c| c.cast()).collect(),
            },
            rim: rim_state(model, &rim_arms),
            nodes: Nodes {
                mass: model.mass.iter().map(|&m| S::from_f64(m)).collect(),
                corner_start: model.corner_start.clone(),
                corners: model.corners.clone(),
                roles,
                rim_arms,
            },
            road: scene.road,
            friction: scene.friction.map(|Friction::Coulomb { mu }| Coulomb { mu: S::from_f64(mu) }),
            gravity: vec3(scene.gravity),
            setup: StageSetup::default(),
            threads,
            frame,
            grain,
            x: mesh.nodes.iter().map(|x| vec3(std::array::from_fn(|d| x[d] - frame[d]))).collect(),
            v: vec![[S::zero(); 3]; mesh.nodes.len()],
            slots: vec![[[S::zero(); 3]; 8]; mesh.hexes.len()],
            power: vec![0.0; mesh.hexes.len().div_ceil(elements::CHUNK)],
            sums: vec![NodeSums::default(); mesh.nodes.len().div_ceil(nodes::CHUNK)],
            surface: vec![SurfaceSum::default(); surface_nodes.len()],
            surface_nodes,
            steps: 0,
            window_steps: 0,
        }
    }

    /// Conditions of a step that takes the rim from coordinates `before` to `q`. `probe`: works over the half step
    /// before.
    fn conditions(&self, step: &Step, before: &Coordinates, q: &Coordinates, probe: bool) -> Conditions<S> {
        let s = S::from_f64;
        let r = rim::rotation(q);
        let local = |q: &Coordinates| std::array::from_fn(|d| q[d] - self.frame[d]);
        let weights = if probe { [0.5 * step.dt_before, 0.0] } else { [0.5 * step.dtm(); 2] };
        Conditions {
            step: StepSize { dt: s(step.dt), dtm: s(step.dtm()) },
            loads: Loads { gravity: self.gravity, alpha: s(self.setup.mass_damping) },
            road: self.road.map(|Road::Plane { point, normal, velocity }| {
                Plane::new(point, normal, velocity, self.frame)
            }),
            friction: self.friction,
            axle: vec3(local(q)),
            axle_before: local(before),
            rotation: r.to_cols_array_2d(),
            weights: weights.map(s),
        }
    }

    /// Lets the frame follow the axle, when single precision would otherwise run out of digits.
    fn follow(&mut self) {
        if S::EPSILON < 1e-10 || self.nodes.rim_arms.is_empty() {
            return;
        }
        let axle = [self.rim.q[0], self.rim.q[1], self.rim.q[2]];
        let shift = frame::shift(self.grain, axle, self.frame, self.road.as_ref());
        if shift == [0.0; 3] {
            return;
        }
        for d in 0..3 {
            self.frame[d] += shift[d];
        }
        let shift = vec3::<S>(shift);
        self.x.iter_mut().for_each(|x| *x = sub(*x, shift));
    }

    fn absolute(&self, x: Vec3<S>) -> [f64; 3] {
        std::array::from_fn(|d| x[d].to_f64() + self.frame[d])
    }

    fn failure(&self, element: usize, time: f64) -> Error {
        let finite = self.elements.hexes[element]
            .iter()
            .all(|&n| self.x[n as usize].iter().all(|c| c.to_f64().is_finite()));
        let step = self.steps;
        if finite {
            Error::Inverted { step, time, element }
        } else {
            Error::NotFinite { step, time, element }
        }
    }
}

fn roles(model: &Model, road: bool) -> Vec<Role> {
    let mut roles = vec![Role::Interior; model.node_count()];
    if road {
        for (k, &n) in model.mesh.surface.iter().enumerate() {
            roles[n as usize] = Role::Surface(k as u32);
        }
    }
    for (k, &n) in model.mesh.rim.iter().enumerate() {
        roles[n as usize] = Role::Rim(k as u32);
    }
    roles
}

fn rim_state(model: &Model, arms: &[[f64; 3]]) -> RimState {
    let mass = |n: &u32| model.mass[*n as usize];
    let [x, y, z] = model.mesh.axle;
    RimState {
        q: [x, y, z, 0.0, 0.0, 0.0],
        rate: [0.0; 6],
        node_mass: model.mesh.rim.iter().map(mass).sum(),
        node_inertia: model
            .mesh
            .rim
            .iter()
            .zip(arms)
            .map(|(n, a)| mass(n) * (a[0] * a[0] + a[2] * a[2]))
            .sum(),
    }
}

/// Sums the reaction of the rubber on the rim, node by node in order.
fn reaction<S: Real>(
    nodes: &Nodes<S>,
    rim_nodes: &[(usize, usize)],
    slots: &Shared<'_, Corners<S>>,
    x: &Shared<'_, Vec3<S>>,
    axle: [f64; 3],
    gravity: Vec3<S>,
) -> Reaction {
    let mut sum = Reaction::default();
    for &(n, _) in rim_nodes {
        let f_int = nodes.gather(n, slots);
        let f: [f64; 3] = std::array::from_fn(|i| (nodes.mass[n] * gravity[i]).to_f64() - f_int[i].to_f64());
        // SAFETY: positions are only read between the two passes.
        let here = unsafe { *x.get(n) };
        let arm: [f64; 3] = std::array::from_fn(|i| here[i].to_f64() - axle[i]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sum.force[i] += f[i];
            sum.moment[i] += arm[j] * f[k] - arm[k] * f[j];
        }
    }
    sum
}

impl<S: Real> Engine for CpuEngine<S> {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            engine: "cpu".into(),
            precision: if S::EPSILON < 1e-10 { "f64" } else { "f32" }.into(),
            device: format!("{} processor", std::env::consts::ARCH),
            driver: String::new(),
            threads: self.threads,
        }
    }

    fn begin_stage(&mut self, setup: &StageSetup) -> Result<()> {
        for component in 0..6 {
            if setup.free[component].is_none() {
                self.rim.rate[component] = 0.0;
            }
        }
        self.setup = *setup;
        Ok(())
    }

    fn advance(&mut self, steps: &[Step]) -> Result<()> {
        let rim_nodes = rim_nodes(&self.nodes.roles);
        let free_rim = RimState::is_free(&self.setup);
        // One plan of conditions a step; with a free rim they depend on the state and are made on the way.
        let plan: Vec<Conditions<S>> = if free_rim {
            Vec::new()
        } else {
            let starts = std::iter::once(&self.rim.q).chain(steps.iter().map(|s| &s.rim));
            steps.iter().zip(starts).map(|(s, before)| self.conditions(s, before, &s.rim, false)).collect()
        };
        let failed_at = run_steps(self, steps, &plan, &rim_nodes, free_rim);
        if let Some((taken, element)) = failed_at {
            self.steps += taken as u64;
            return Err(self.failure(element, steps[taken].time));
        }
        self.steps += steps.len() as u64;
        self.window_steps += steps.len() as u64;
        if let (Some(last), false) = (steps.last(), free_rim) {
            self.rim.q = last.rim;
        }
        Ok(())
    }

    fn sample(&mut self, next: &Step) -> Result<Window> {
        let viscous = -std::mem::take(&mut self.power).iter().sum::<f64>();
        self.power = vec![0.0; self.elements.hexes.len().div_ceil(elements::CHUNK)];
        let committed = total(&self.sums);
        let probe = self.probe(next)?;
        let mut works = committed.works;
        works.viscous = viscous;
        works.internal -= viscous;
        let mut surface =
            std::mem::replace(&mut self.surface, vec![SurfaceSum::default(); self.surface_nodes.len()]);
        for (sum, &n) in surface.iter_mut().zip(&self.surface_nodes) {
            sum.x = self.absolute(self.x[n as usize]);
            sum.v = self.v[n as usize].map(Real::to_f64);
        }
        let (mut strain, mut hourglass, mut min_jacobian) = (0.0, 0.0, f64::INFINITY);
        for element in 0..self.elements.hexes.len() {
            let e = self.kernel.energy(&self.elements, element, &self.x);
            strain += e.strain.to_f64();
            hourglass += e.hourglass.to_f64();
            min_jacobian = min_jacobian.min(e.min_j.to_f64());
        }
        let kinetic = self
            .v
            .iter()
            .zip(&self.nodes.mass)
            .map(|(v, m)| 0.5 * m.to_f64() * v.iter().map(|c| c.to_f64() * c.to_f64()).sum::<f64>());
        let window = Window {
            steps: std::mem::take(&mut self.window_steps),
            works,
            rim_impulse: committed.rim_impulse,
            rim_moment_impulse: committed.rim_moment_impulse,
            surface,
            rim: self.rim.q,
            rim_rate: self.rim.rate,
            kinetic: kinetic.sum(),
            probe,
            strain,
            hourglass,
            min_jacobian,
        };
        self.sums.fill(NodeSums::default());
        self.follow();
        Ok(window)
    }

    fn state(&mut self) -> Result<State> {
        Ok(State {
            x: self.x.iter().map(|&x| self.absolute(x)).collect(),
            v: self.v.iter().map(|v| v.map(Real::to_f64)).collect(),
        })
    }

    fn set_velocity(&mut self, v: &[[f64; 3]], rim_rate: &Coordinates) -> Result<()> {
        self.v = v.iter().map(|&v| vec3(v)).collect();
        for component in 0..6 {
            if self.setup.free[component].is_some() {
                self.rim.rate[component] = rim_rate[component];
            }
        }
        Ok(())
    }

    fn set_state(&mut self, state: &State, rim: &Coordinates, rim_rate: &Coordinates) -> Result<()> {
        let frame = self.frame;
        self.x = state.x.iter().map(|x| vec3(std::array::from_fn(|d| x[d] - frame[d]))).collect();
        self.rim.q = *rim;
        self.follow();
        self.set_velocity(&state.v, rim_rate)
    }

    fn force(&mut self, x: &[[f64; 3]], v: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
        let frame = self.frame;
        let mut x: Vec<Vec3<S>> = x.iter().map(|x| vec3(std::array::from_fn(|d| x[d] - frame[d]))).collect();
        let mut v: Vec<Vec3<S>> = v.iter().map(|&v| vec3(v)).collect();
        let mut power = self.power.clone();
        let (x, v) = (Shared::new(&mut x), Shared::new(&mut v));
        let (slots, power) = (Shared::new(&mut self.slots), Shared::new(&mut power));
        let barrier = SpinBarrier::new(self.threads);
        let (kernel, elements) = (&*self.kernel, &self.elements);
        std::thread::scope(|scope| {
            for member in 1..self.threads {
                let (x, v, slots, power, barrier) = (&x, &v, &slots, &power, &barrier);
                let range = share(elements.hexes.len(), elements::CHUNK, member, self.threads);
                scope.spawn(move || {
                    kernel.forces(elements, range, x, v, slots, power, 0.0);
                    barrier.wait();
                });
            }
            let range = share(elements.hexes.len(), elements::CHUNK, 0, self.threads);
            kernel.forces(elements, range, &x, &v, &slots, &power, 0.0);
            barrier.wait();
        });
        Ok((0..x.len()).map(|n| self.nodes.gather(n, &slots).map(Real::to_f64)).collect())
    }
}

/// (node, rim index) of every rim node, ascending.
fn rim_nodes(roles: &[Role]) -> Vec<(usize, usize)> {
    let rim = |(n, role): (usize, &Role)| match role {
        Role::Rim(k) => Some((n, *k as usize)),
        _ => None,
    };
    roles.iter().enumerate().filter_map(rim).collect()
}

impl<S: Real> CpuEngine<S> {
    /// The step after the window, not taken.
    fn probe(&mut self, next: &Step) -> Result<Probe> {
        let rim_nodes = rim_nodes(&self.nodes.roles);
        let mut probe_sums = vec![NodeSums::default(); self.sums.len()];
        let mut power = vec![0.0; self.power.len()];
        let all = 0..self.elements.hexes.len();
        let weight = 0.5 * next.dt_before;
        let mut works;
        let totals;
        {
            let frame = self.frame;
            let mut x = std::mem::take(&mut self.x);
            let mut v = std::mem::take(&mut self.v);
            let mut slots = std::mem::take(&mut self.slots);
            let mut surface = std::mem::take(&mut self.surface);
            {
                let (sx, sv) = (Shared::new(&mut x), Shared::new(&mut v));
                let (ss, sp) = (Shared::new(&mut slots), Shared::new(&mut power));
                self.kernel.forces(&self.elements, all, &sx, &sv, &ss, &sp, weight);
                let axle = std::array::from_fn(|d| self.rim.q[d] - frame[d]);
                let r = reaction(&self.nodes, &rim_nodes, &ss, &sx, axle, self.gravity);
                let (q, _) = self.rim.advanced(&self.setup, next, &r);
                let c = self.conditions(next, &self.rim.q, &q, true);
                let (surface, sums) = (Shared::new(&mut surface), Shared::new(&mut probe_sums));
                nodes::pass(&self.nodes, &c, 0..sx.len(), false, &ss, &sx, &sv, &surface, &sums);
            }
            (self.x, self.v, self.slots, self.surface) = (x, v, slots, surface);
            totals = total(&probe_sums);
            works = totals.works;
        }
        works.viscous = -power.iter().sum::<f64>();
        works.internal -= works.viscous;
        Ok(Probe {
            mixed_kinetic: totals.mixed_kinetic,
            half_works: works,
            net_force: totals.net_force2.sqrt(),
            internal_force: totals.internal_force2.sqrt(),
        })
    }
}

/// Takes the steps with all threads; `Some((step, element))` where an element failed.
fn run_steps<S: Real>(
    engine: &mut CpuEngine<S>,
    steps: &[Step],
    plan: &[Conditions<S>],
    rim_nodes: &[(usize, usize)],
    free_rim: bool,
) -> Option<(usize, usize)> {
    let mut x = std::mem::take(&mut engine.x);
    let mut v = std::mem::take(&mut engine.v);
    let mut slots = std::mem::take(&mut engine.slots);
    let mut power = std::mem::take(&mut engine.power);
    let mut sums = std::mem::take(&mut engine.sums);
    let mut surface = std::mem::take(&mut engine.surface);
    let mut rim = [engine.rim];
    let failed = AtomicUsize::new(usize::MAX);
    let failed_step = AtomicUsize::new(usize::MAX);
    {
        let members = engine.threads;
        let barrier = SpinBarrier::new(members);
        let (x, v, slots) = (Shared::new(&mut x), Shared::new(&mut v), Shared::new(&mut slots));
        let (power, sums) = (Shared::new(&mut power), Shared::new(&mut sums));
        let (surface, rim) = (Shared::new(&mut surface), Shared::new(&mut rim));
        let engine = &*engine;
        let work = |member: usize| {
            let element_range = share(engine.elements.hexes.len(), elements::CHUNK, member, members);
            let node_range = share(x.len(), nodes::CHUNK, member, members);
            for (n, step) in steps.iter().enumerate() {
                let range = element_range.clone();
                let bad = engine.kernel.forces(&engine.elements, range, &x, &v, &slots, &power, step.dtm());
                if let Some(element) = bad {
                    failed.fetch_min(element, Ordering::Relaxed);
                    failed_step.store(n, Ordering::Relaxed);
                }
                barrier.wait();
                if failed.load(Ordering::Relaxed) != usize::MAX {
                    return;
                }
                let own;
                let conditions = if free_rim {
                    // Every member computes the same rim from the same slots; member 0 keeps it after the pass.
                    // SAFETY: the rim is only read until the barrier after the node pass.
                    let state = unsafe { *rim.get(0) };
                    let axle = std::array::from_fn(|d| state.q[d] - engine.frame[d]);
                    let r = reaction(&engine.nodes, rim_nodes, &slots, &x, axle, engine.gravity);
                    let (q, rate) = state.advanced(&engine.setup, step, &r);
                    let c = engine.conditions(step, &state.q, &q, false);
                    barrier.wait(); // all have read the rim nodes' positions
                    if member == 0 {
                        // SAFETY: the others read it again only after the next barrier.
                        unsafe { *rim.get_mut(0) = RimState { q, rate, ..state } };
                    }
                    own = c;
                    &own
                } else {
                    &plan[n]
                };
                let range = node_range.clone();
                nodes::pass(&engine.nodes, conditions, range, true, &slots, &x, &v, &surface, &sums);
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
    }
    (engine.x, engine.v, engine.slots, engine.power) = (x, v, slots, power);
    (engine.sums, engine.surface, engine.rim) = (sums, surface, rim[0]);
    let element = failed.load(Ordering::Relaxed);
    (element != usize::MAX).then(|| (failed_step.load(Ordering::Relaxed), element))
}
