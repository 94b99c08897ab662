//! The loop over an [`Engine`]: stages, windows, steps; histories, fields and the critical step on the way.

mod chatter;
pub mod estimate;
mod fields;
mod follow;
mod footprint;
mod implicit;
mod lanczos;
mod ledger;
mod motion;
mod settle;
pub mod stability;

pub use estimate::Estimate;
pub use footprint::road_axes;
pub use implicit::ImplicitCounts;
pub use ledger::Ledger;
pub use motion::Motion;

pub use crate::model::areas::contact_areas;

use crate::engine::{Engine, Step, Window};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::rim;
use crate::record::{ContactNoise, NewtonRow, Sample, Snapshot};
use crate::scene::{Drive, InitialVelocity, MeshSpec, Method, Scene, Snapshots, Stage};
use chatter::Chatter;
use footprint::Footprint;
use glam::DVec3;
use ledger::WindowEnd;
use stability::Critical;

/// Where a simulation stands.
#[derive(Debug, Clone, Copy)]
pub struct Progress<'a> {
    pub stage: &'a str,
    pub time: f64,
    /// Latest possible end of the simulation [s]; a quasi-static stage may end sooner.
    pub end: f64,
    pub steps: u64,
    /// What would be returned if the simulation ended here.
    pub totals: &'a Totals,
}

/// Who listens to a simulation.
pub trait Observer {
    /// A window has ended.
    fn sample(&mut self, sample: &Sample, progress: &Progress) -> Result<()>;
    /// Whole fields, as often as the scene asks.
    fn snapshot(&mut self, snapshot: &Snapshot, stage: &str) -> Result<()>;
    /// A line for the log: iterations of an implicit increment, and the like.
    fn note(&mut self, _line: &str) -> Result<()> {
        Ok(())
    }
    /// The iterations of an implicit increment, converged or not.
    fn increment(&mut self, _iterations: &[NewtonRow]) -> Result<()> {
        Ok(())
    }
    /// Asked after every window: end here, keeping everything.
    fn interrupted(&self) -> bool {
        false
    }
}

/// What a finished simulation knows of itself.
#[derive(Debug, Clone, Default)]
pub struct Totals {
    pub steps: u64,
    pub time: f64,
    pub dt_min: f64,
    pub dt_max: f64,
    /// First and smallest critical step found [s], and the bound from single elements at rest.
    pub critical_first: f64,
    pub critical_min: f64,
    pub element_bound: f64,
    /// Eigenvalue iterations spent on it (two force passes each).
    pub lanczos_iterations: usize,
    /// Of implicit stages: increments, cuts, Newton iterations, iterations or sweeps of the inner solver.
    pub implicit: ImplicitCounts,
    pub ledger: Ledger,
    /// Scatter of the road's force in every stage that has ended; none in implicit stages, and without a road.
    pub noise: Vec<Option<ContactNoise>>,
    /// Free-rolling radius that the last longitudinal slip was related to, or that was measured since [m].
    pub free_radius: Option<f64>,
    /// Classes of its own errors, as the last stage that has ended leaves them.
    pub estimate: Estimate,
    /// Whether an observer ended it.
    pub interrupted: bool,
}

/// Runs every stage of a scene.
pub fn run(
    scene: &Scene,
    model: &Model,
    engine: &mut dyn Engine,
    observer: &mut dyn Observer,
) -> Result<Totals> {
    let mut run = Run::new(scene, model, engine, observer)?;
    for (k, stage) in scene.stages.iter().enumerate() {
        run.end = run.totals.time + scene.stages[k..].iter().map(|s| s.duration).sum::<f64>();
        run.stage(stage)?;
        run.totals.noise.push(run.chatter.noise());
        run.measure_free_radius(stage);
        run.totals.estimate = run.estimate(stage)?;
        if run.totals.interrupted {
            break;
        }
    }
    Ok(run.totals)
}

/// Elements round the circumference of a ring.
fn sides(mesh: &MeshSpec) -> Option<usize> {
    match mesh {
        MeshSpec::Ring { elements, .. } => Some(elements[0]),
        MeshSpec::Block { .. } => None,
    }
}

/// Error of the stored-energy balance, over the largest term, at which a run is ended. Hard impacts leave some per cent.
pub const GARBAGE: f64 = 0.25;

/// Stored energy that cannot change the critical step much, over shear modulus times volume: strains of half a per cent all
/// over, or of a fifth in a thousandth of the volume.
const NEGLIGIBLE: f64 = 1e-5;

/// Index of the steer angle among the rim's coordinates.
const STEER: usize = 3;

struct Run<'a> {
    scene: &'a Scene,
    model: &'a Model,
    engine: &'a mut dyn Engine,
    observer: &'a mut dyn Observer,
    totals: Totals,
    motion: Motion,
    rim: rim::Coordinates,
    rim_rate: rim::Coordinates,
    dt_before: f64,
    critical: Critical,
    /// Step count at which the critical step is looked at again, and how long the last answer held.
    refresh_at: u64,
    refresh_interval: u64,
    /// Stored energy [J] and smallest det F at which it was looked at out of turn, or up to which it need not be.
    strained: f64,
    squeezed: f64,
    /// Error of the stored-energy balance that implicit stages left, and one that is too small to speak of [J].
    unbalanced: f64,
    negligible: f64,
    next_snapshot: f64,
    chatter: Chatter,
    end: f64,
    /// Time over which the forces of the window acted: its length, but for the half step after velocities were set.
    force_time: f64,
    /// Kinetic over strain energy and relative net force at the last window.
    last_ratios: [f64; 2],
}

impl<'a> Run<'a> {
    fn new(
        scene: &'a Scene,
        model: &'a Model,
        engine: &'a mut dyn Engine,
        observer: &'a mut dyn Observer,
    ) -> Result<Self> {
        let [x, y, z] = model.mesh.axle;
        let rim = [x, y, z, 0.0, 0.0, 0.0];
        let implicit = scene.stages.iter().any(|s| matches!(s.method, Method::Implicit(_)));
        let mut totals = Totals { element_bound: stability::element_bound(model)?, ..Totals::default() };
        totals.dt_min = f64::INFINITY;
        totals.critical_min = f64::INFINITY;
        // The mesh generators' reference shape stores nothing.
        totals.ledger.start(0.0);
        if let (true, Some(gap)) = (implicit, scene.beyond_implicit()) {
            return Err(gap);
        }
        let volume = model.mass.iter().sum::<f64>() / scene.body.density;
        let negligible = NEGLIGIBLE * scene.body.law.shear_modulus() * volume;
        let mut run = Run {
            scene,
            model,
            engine,
            observer,
            totals,
            motion: Motion::at_rest(rim),
            rim,
            rim_rate: [0.0; 6],
            dt_before: 0.0,
            critical: Critical::default(),
            refresh_at: 0,
            refresh_interval: 0,
            strained: negligible,
            squeezed: 1.0,
            unbalanced: 0.0,
            negligible,
            next_snapshot: 0.0,
            chatter: Chatter::new(None, 0.0, 1.0),
            end: 0.0,
            force_time: 0.0,
            last_ratios: [f64::INFINITY; 2],
        };
        run.start_body()?;
        Ok(run)
    }

    /// The body's own initial velocity: v + omega x (x - centroid).
    fn start_body(&mut self) -> Result<()> {
        let body = &self.scene.body;
        let (model, total) = (self.model, self.model.mass.iter().sum::<f64>());
        let position = |n: usize| DVec3::from(model.mesh.nodes[n]);
        let moment: DVec3 = (0..model.node_count()).map(|n| position(n) * model.mass[n]).sum();
        let centroid = moment / total;
        let (v, omega) = (DVec3::from(body.velocity), DVec3::from(body.angular_velocity));
        if v == DVec3::ZERO && omega == DVec3::ZERO {
            return Ok(());
        }
        self.set_velocities(|x| v + omega.cross(x - centroid))
    }

    fn set_velocities(&mut self, field: impl Fn(DVec3) -> DVec3) -> Result<()> {
        let x = self.engine.state()?.x;
        let held = &self.model.mesh.held;
        let free = |n: usize, d: usize| held.get(n).is_none_or(|bits| bits >> d & 1 == 0);
        let velocity = |(n, &x): (usize, &[f64; 3])| {
            let v = field(DVec3::from(x)).to_array();
            std::array::from_fn(|d| if free(n, d) { v[d] } else { 0.0 })
        };
        let v: Vec<[f64; 3]> = x.iter().enumerate().map(velocity).collect();
        self.engine.set_velocity(&v, &self.rim_rate)?;
        let square = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>();
        let kinetic = v.iter().zip(&self.model.mass).map(|(v, m)| 0.5 * m * square(v)).sum();
        self.totals.ledger.velocities_set(kinetic);
        self.dt_before = 0.0;
        Ok(())
    }

    fn stage(&mut self, stage: &Stage) -> Result<()> {
        let start = self.totals.time;
        let stage = &self.spun(stage)?;
        self.motion = self.motion.next(stage, start, self.rim);
        self.engine.begin_stage(&self.motion.setup(stage.mass_damping))?;
        match stage.initial_velocity {
            Some(InitialVelocity::Rim) => self.start_with_rim(start)?,
            Some(InitialVelocity::Zero) => {
                self.rim_rate = [0.0; 6];
                self.set_velocities(|_| DVec3::ZERO)?;
            }
            None => {}
        }
        self.next_snapshot = match self.scene.output.snapshots {
            Snapshots::Every(interval) => start + interval,
            _ => f64::INFINITY,
        };
        self.chatter = Chatter::new(sides(&self.scene.body.mesh), start, stage.duration);
        if let Method::Implicit(settings) = stage.method {
            return self.implicit_stage(stage, &settings);
        }
        // Whole windows, the last one cut at the end of the stage.
        let end = start + stage.duration;
        let sample = self.scene.output.sample;
        let count = (stage.duration / sample - 1e-9).ceil().max(1.0) as u64;
        for n in 1..=count {
            let window_end = if n == count { end } else { start + n as f64 * sample };
            let window = self.window(stage, window_end)?;
            let settled = self.has_settled(stage, &window)?;
            let last = n == count || settled;
            let written = self.snapshots(stage, &window, last)?;
            if self.observer.interrupted() {
                if !written {
                    self.snapshots(stage, &window, true)?;
                }
                self.totals.interrupted = true;
                return Ok(());
            }
            if settled {
                return Ok(());
            }
        }
        match stage.method {
            Method::Explicit | Method::Implicit(_) => Ok(()),
            Method::QuasiStatic { kinetic_ratio, residual } => Err(Error::NotSettled {
                stage: stage.name.clone(),
                detail: format!(
                    "kinetic/strain energy {:.2e} (asked: {kinetic_ratio:.1e}), relative residual force {:.2e} \
                     (asked: {residual:.1e}) after {} s; a longer duration or another mass_damping may help",
                    self.last_ratios[0], self.last_ratios[1], stage.duration
                ),
            }),
        }
    }

    /// The stage with the spin that its longitudinal slip asks for.
    fn spun(&mut self, stage: &Stage) -> Result<Stage> {
        let mut stage = stage.clone();
        let Some(slip) = stage.slip else { return Ok(stage) };
        let steer = match stage.rim.steer {
            Drive::Displacement { to, .. } => to,
            _ => self.rim[STEER],
        };
        let speed = stage.heading_speed(self.scene.road.as_ref(), rim::axle(&self.rim).into(), steer);
        let radius = slip.free_radius.or(self.totals.free_radius).ok_or_else(|| Error::NotSettled {
            stage: stage.name.clone(),
            detail:
                "no stage before it has rolled freely, so its longitudinal slip has no free-rolling radius"
                    .into(),
        })?;
        self.totals.free_radius = Some(radius);
        stage.rim.spin = Drive::Velocity { to: (1.0 + slip.kappa) * speed / radius, ramp: slip.ramp };
        Ok(stage)
    }

    /// Classes of the run's errors after a stage.
    fn estimate(&mut self, stage: &Stage) -> Result<Estimate> {
        if let Method::Implicit(_) = stage.method {
            return Ok(Estimate::default());
        }
        let precision = self.engine.info().precision;
        let x = self.engine.state()?.x;
        let rounding = estimate::rounding(self.model, &precision, &x, self.totals.steps);
        if let Method::QuasiStatic { .. } = stage.method {
            return Ok(Estimate { rounding, residual: Some(self.last_ratios[1]), time_step: None });
        }
        let ledger = &self.totals.ledger;
        let stored =
            if ledger.largest_term > 0.0 { ledger.worst_stored_balance / ledger.largest_term } else { 0.0 };
        let changing = self.chatter.noise().map_or(0.0, |noise| noise.changing_share);
        Ok(Estimate { rounding, residual: None, time_step: Some(estimate::time_step(stored, changing)) })
    }

    /// Keeps the free-rolling radius of a stage whose rim has spun freely without a moment.
    fn measure_free_radius(&mut self, stage: &Stage) {
        let speed =
            stage.heading_speed(self.scene.road.as_ref(), rim::axle(&self.rim).into(), self.rim[STEER]);
        if let Some(rate) = self.chatter.spin_rate().filter(|w| *w * speed > 0.0 && stage.rolls_freely()) {
            self.totals.free_radius = Some(speed / rate);
        }
    }

    /// The rigid velocity of the rim's motion for every node, and for the rim's free components.
    fn start_with_rim(&mut self, time: f64) -> Result<()> {
        let mut rate = self.motion.rate_at(time);
        for (component, free) in self.motion.setup(0.0).free.iter().enumerate() {
            if free.is_some() {
                rate[component] = self.rim_rate[component];
            }
        }
        let omega = rim::angular_velocity(&self.rim, &rate);
        let (axle, velocity) = (rim::axle(&self.rim), rim::axle(&rate));
        self.rim_rate = rate;
        self.set_velocities(|x| velocity + omega.cross(x - axle))
    }

    /// Steps to `end` and books the window.
    fn window(&mut self, stage: &Stage, end: f64) -> Result<Window> {
        self.force_time = 0.0;
        let (start, spin) = (self.totals.time, self.rim[rim::SPIN]);
        let road = self.scene.road.as_ref();
        let (mut whole, mut footprint) = (None, Footprint::default());
        while self.totals.time < end {
            let before = self.force_time;
            let part = self.part(end)?;
            footprint.add(self.model, road, self.force_time - before, &part);
            match &mut whole {
                None => whole = Some(part),
                Some(whole) => whole.extend(part),
            }
        }
        let window = whole.expect("a window has a step");
        if road.is_some() {
            self.chatter.add(start, end, [spin, window.rim[rim::SPIN]], &window);
        }
        let at =
            WindowEnd { time: end, length: self.force_time, dt: self.dt_before, stage: stage.name.clone() };
        let row = self.totals.ledger.row(road, &at, &window, &footprint);
        let totals = &self.totals;
        let progress = Progress { stage: &stage.name, time: end, end: self.end, steps: totals.steps, totals };
        self.observer.sample(&row, &progress)?;
        self.balanced(&row)?;
        Ok(window)
    }

    /// Ends a run whose energies do not add up: a step beyond the critical one need not turn an element inside out.
    fn balanced(&self, row: &Sample) -> Result<()> {
        let error = (row.stored_balance_error_J - self.unbalanced).abs();
        let share = error / self.totals.ledger.largest_term;
        match error > self.negligible && share > GARBAGE {
            true => Err(Error::Unbalanced { step: self.totals.steps, time: row.time_s, share }),
            false => Ok(()),
        }
    }

    /// Steps on within a window that ends at `end`: to its end, or for as long as a footprint is one.
    fn part(&mut self, end: f64) -> Result<Window> {
        let start = self.totals.time;
        let spin = self.rim_rate[rim::SPIN].abs().max(self.motion.rate_at(end)[rim::SPIN].abs());
        let parts = match self.scene.road {
            Some(_) => ((end - start) / footprint::part(&self.scene.body.mesh, spin) - 1e-9).ceil().max(1.0),
            None => 1.0,
        };
        let until = if parts > 1.0 { start + (end - start) / parts } else { end };
        while self.totals.time < until {
            self.advance_towards(end, until)?;
        }
        let next = self.motion.plan(self.totals.time, self.dt_before, self.dt_before, 1)[0];
        let window = self.engine.sample(&next)?;
        (self.rim, self.rim_rate) = (window.rim, window.rim_rate);
        self.watch(&window);
        Ok(window)
    }

    /// Takes equal steps that would end at `end`, as many as reach `until`, at most until the critical step is due to be
    /// looked at again.
    fn advance_towards(&mut self, end: f64, until: f64) -> Result<()> {
        if self.totals.steps >= self.refresh_at {
            self.refresh()?;
        }
        let start = self.totals.time;
        let length = end - start;
        let count = (length / (self.scene.safety * self.critical.dt)).ceil().max(1.0) as usize;
        let dt = length / count as f64;
        let wanted = ((until - start) / dt - 1e-6).ceil().max(1.0) as usize;
        let taken = count.min(wanted).min((self.refresh_at - self.totals.steps) as usize);
        let steps = self.motion.plan(start, dt, self.dt_before, taken);
        self.engine.advance(&steps)?;
        self.force_time += steps.iter().map(Step::dtm).sum::<f64>();
        self.dt_before = dt;
        self.totals.time = if taken == count { end } else { start + taken as f64 * dt };
        self.totals.steps += taken as u64;
        self.totals.dt_min = self.totals.dt_min.min(dt);
        self.totals.dt_max = self.totals.dt_max.max(dt);
        Ok(())
    }

    /// Hands out a snapshot if one is due; whether it was.
    fn snapshots(&mut self, stage: &Stage, window: &Window, last: bool) -> Result<bool> {
        // Half a window of slack: snapshot times are whole windows.
        let time = self.totals.time;
        let due = time >= self.next_snapshot - 0.5 * self.scene.output.sample;
        if self.scene.output.snapshots == Snapshots::None || !(due || last) {
            return Ok(false);
        }
        if let (true, Snapshots::Every(interval)) = (due, self.scene.output.snapshots) {
            self.next_snapshot += interval;
        }
        let state = self.engine.state()?;
        let length = self.force_time;
        let road = self.scene.road.as_ref();
        let worn = &self.totals.ledger.friction_energy;
        let steps = self.totals.steps;
        let snapshot = fields::snapshot(self.model, road, time, steps, length, state, window, worn);
        self.observer.snapshot(&snapshot, &stage.name)?;
        Ok(true)
    }
}
