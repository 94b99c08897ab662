//! The rows: every engine asked for on every wheel asked for, timed, and then compared with the reference engine.

use super::clock::{Clock, together};
use super::cpu_limits::CpuLimits;
use super::fleet::Fleet;
use super::floor::{self, Bound, Limits};
use super::gpu_limits::GpuLimits;
use super::kind::Kind;
use super::machine::{available_memory, resident_memory};
use super::report::{Missing, Report, Row, Spread};
use super::wheel::{Roll, Wheel};
use super::work::{self, Pass};
use hexroll::cpu::engine_at;
use hexroll::engine::{Engine, State};
use hexroll::gpu::{Gpu, GpuEngine, PassTime, PassTimes};
use hexroll::model::Model;
use hexroll::model::shuffle::{distorted, shuffled};
use hexroll::physics::lanes::Level;
use hexroll::scene::Scene;
use hexroll::{Error, Precision, Result};

/// What the table covers.
#[derive(Debug, Clone)]
pub struct Options {
    pub engines: Vec<Kind>,
    /// Formulations, as scenes name them.
    pub elements: Vec<String>,
    pub sizes: Vec<usize>,
    pub contact: Vec<bool>,
    /// Shear viscosities [Pa s].
    pub viscosity: Vec<Option<f64>>,
    /// Threads of CPU engines, not 0.
    pub threads: Vec<usize>,
    pub lanes: Vec<Level>,
    /// Also meshes in random order.
    pub meshes: Vec<Order>,
    /// Independent one-thread engines at a time, in place of threads.
    pub copies: usize,
    /// Time spent measuring a row [s].
    pub seconds: f64,
}

/// What becomes of the generator's mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Order {
    /// As it came.
    Structured,
    /// Elements and nodes in random order.
    Shuffled,
    /// Every element of a shape of its own.
    Distorted,
}

impl Order {
    pub fn name(self) -> &'static str {
        match self {
            Order::Structured => "structured",
            Order::Shuffled => "shuffled",
            Order::Distorted => "distorted",
        }
    }
}

/// One engine's run, still without its error.
pub(super) struct Timed {
    pub kind: Kind,
    pub level: Level,
    pub threads: usize,
    pub copies: usize,
    pub us: Spread,
    pub steps: u64,
    pub batch: usize,
    pub memory: Option<f64>,
    pub state: State,
    /// On a GPU: time and bytes by pass, and how steps are submitted.
    pub by_pass: Option<PassTimes>,
}

/// Fills the table of `report`; `done` sees it after every wheel.
///
/// # Errors
/// Only what makes the whole table impossible; a row that fails is noted.
pub fn fill(
    report: &mut Report,
    options: &Options,
    gpu: Option<&Gpu>,
    done: &mut dyn FnMut(&Report) -> Result<()>,
) -> Result<()> {
    if let Some(gpu) = gpu {
        report.limits.gpu = Some(GpuLimits::measure(gpu)?);
    }
    for &elements in &options.sizes {
        for &viscosity in &options.viscosity {
            for &contact in &options.contact {
                for element in &options.elements {
                    for &order in &options.meshes {
                        let wheel = Wheel { elements, element, contact, viscosity };
                        Bench { report, options, gpu, wheel, order }.run()?;
                        done(report)?;
                    }
                }
            }
        }
    }
    Ok(())
}

struct Bench<'a> {
    report: &'a mut Report,
    options: &'a Options,
    gpu: Option<&'a Gpu>,
    wheel: Wheel<'a>,
    order: Order,
}

impl Bench<'_> {
    fn run(&mut self) -> Result<()> {
        if let Some(reason) = self.does_not_fit() {
            self.options.engines.iter().for_each(|&kind| self.miss(kind, false, reason.clone()));
            return Ok(());
        }
        let scene = self.wheel.scene()?;
        let mut model = Model::new(&scene)?;
        match self.order {
            Order::Structured => {}
            Order::Shuffled => model = shuffled(&model, &scene.body),
            Order::Distorted => model = distorted(&model, &scene.body),
        }
        let roll = Roll::new(&model)?;
        let mut timed = Vec::new();
        for &kind in &self.options.engines {
            for (level, threads) in self.variants(kind) {
                match self.time(kind, level, threads, &model, &scene, &roll) {
                    Ok(row) => timed.push(row),
                    Err(e @ (Error::TooLarge { .. } | Error::Unsupported { .. })) => {
                        self.miss(kind, false, e.to_string());
                    }
                    Err(e) => self.miss(kind, true, e.to_string()),
                }
            }
        }
        let references = references(&model, &scene, &roll, &timed)?;
        for (timed, reference) in timed.iter().zip(&references) {
            let row = self.row(&model, &roll, timed, reference);
            self.report.rows.push(row);
        }
        Ok(())
    }

    /// Lanes and threads of an engine's rows.
    fn variants(&self, kind: Kind) -> Vec<(Level, usize)> {
        let Options { lanes, threads, copies, .. } = self.options;
        if kind.on_gpu() {
            return vec![(Level::detect(), 0)];
        }
        let threads = if *copies > 1 { &[1][..] } else { threads };
        lanes.iter().flat_map(|&level| threads.iter().map(move |&n| (level, n))).collect()
    }

    /// Model, engine, copies of the state for the comparison: about 800 bytes an element, twice that to be safe
    /// against other processes.
    fn does_not_fit(&self) -> Option<String> {
        const PER_ELEMENT: u64 = 1600;
        let need = PER_ELEMENT * self.wheel.elements as u64 * self.options.copies as u64;
        let available = available_memory()?;
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        (need > available).then(|| {
            format!("needs about {:.1} GiB of memory, {:.1} GiB are free", gib(need), gib(available))
        })
    }

    fn miss(&mut self, kind: Kind, failed: bool, reason: String) {
        self.report.missing.push(Missing {
            engine: kind,
            element: self.wheel.element.into(),
            elements: self.wheel.elements,
            failed,
            reason,
        });
    }

    fn time(
        &self,
        kind: Kind,
        level: Level,
        threads: usize,
        model: &Model,
        scene: &Scene,
        roll: &Roll,
    ) -> Result<Timed> {
        let seconds = self.options.seconds;
        if kind.on_gpu() {
            return self.time_gpu(kind, model, scene, roll, seconds);
        }
        let make = || engine_at(model, scene, kind.precision(), threads, level);
        let copies = self.options.copies;
        let before = resident_memory();
        let (clock, state, after) = if copies == 1 {
            let mut engine = make()?;
            let clock = Clock::run(&mut *engine, model, roll, seconds)?;
            // Before the state is copied, which is not the engine's.
            let after = resident_memory();
            (clock, engine.state()?, after)
        } else {
            together(copies, &make, model, roll, seconds)?
        };
        // Less than this is lost among the process's other allocations.
        let large = model.element_count() >= 50_000;
        let grown = before.zip(after).map(|(b, a)| a.saturating_sub(b) as f64);
        let memory = grown.filter(|_| large).map(|bytes| bytes / (copies * model.element_count()) as f64);
        let Clock { us, steps, batch } = clock;
        Ok(Timed { kind, level, threads, copies, us, steps, batch, memory, state, by_pass: None })
    }

    /// The same on the adapter; the passes are timed one by one afterwards, since that costs time itself.
    fn time_gpu(&self, kind: Kind, model: &Model, scene: &Scene, roll: &Roll, seconds: f64) -> Result<Timed> {
        let gpu = self.gpu.ok_or(Error::NoAdapter { detail: "none is open".into() })?;
        let copies = self.options.copies;
        if copies > 1 && kind == Kind::GpuF32 {
            return Fleet::time(gpu, model, scene, roll, copies, seconds);
        }
        if copies > 1 {
            return Err(Error::Unsupported {
                what: format!("{copies} wheels at once in {}", kind.name()),
                instead: "take gpu-f32, or --copies 1".into(),
            });
        }
        let mut engine = GpuEngine::new(gpu, model, scene, kind.precision())?;
        let Clock { us, steps, batch } = Clock::run(&mut engine, model, roll, seconds)?;
        let by_pass = engine.timed_advance(&roll.steps(steps, batch.min(512)))?;
        let steps = steps + by_pass.steps;
        let state = engine.state()?;
        let level = Level::detect();
        let memory = Some(engine.bytes_per_element());
        let by_pass = Some(by_pass);
        Ok(Timed { kind, level, threads: 0, copies: 1, us, steps, batch, memory, state, by_pass })
    }

    fn row(&mut self, model: &Model, roll: &Roll, timed: &Timed, reference: &State) -> Row {
        let &Timed { kind, level, threads, copies, .. } = timed;
        let (elements, count) = (model.element_count() as f64, copies as f64);
        let (mut passes, mix) = cost(kind, model);
        let mut pass_us = Vec::new();
        if let Some(times) = &timed.by_pass {
            passes = gpu_passes(kind, times, model);
            let each = |p: &PassTime| p.seconds.map(|s| 1e6 * s / times.steps as f64);
            pass_us = times.passes.iter().filter_map(each).collect();
        }
        let (bytes, flops) = totals(&passes);
        let limits = match (kind.on_gpu(), &self.report.limits.gpu) {
            (true, Some(gpu)) => gpu.at(4.0 / 3.0 * arrays(kind, model), kind.precision()),
            _ => self.limits(kind, level, threads * copies, count * arrays(kind, model)),
        };
        // Rates of the limits are of all copies together: a copy has its share.
        let each = Limits { bandwidth: limits.bandwidth / count, flops: limits.flops / count, ..limits };
        let floor = floor::floor(&passes, &each);
        let fraction = 1e6 * floor.seconds / timed.us.median;
        let (error, deformation) = roll.error(model, timed.steps, &timed.state, reference);
        Row {
            engine: kind,
            lanes: if kind.on_gpu() { String::new() } else { level.name().into() },
            threads,
            copies,
            element: self.wheel.element.into(),
            elements: model.element_count(),
            nodes: model.node_count(),
            mesh: self.order.name().into(),
            contact: self.wheel.contact,
            viscosity: self.wheel.viscosity.unwrap_or(0.0),
            dt: roll.dt,
            steps: timed.steps,
            batch: timed.batch,
            us_per_step: timed.us,
            updates_per_s: count * 1e6 * elements / timed.us.median,
            floor_us: 1e6 * floor.seconds,
            fraction,
            bound_by: floor.bound_by,
            bytes_per_update: bytes / elements,
            flops_per_update: flops / elements,
            mix,
            reason: (fraction < 0.5).then(|| {
                reason(floor.bound_by, fraction, mix, &passes, &each)
                    + &dominant(&passes, &pass_us, timed.us.median)
            }),
            passes,
            pass_us,
            steps_per_submit: timed.by_pass.as_ref().map(|t| t.steps_per_submit),
            memory_per_element: timed.memory,
            error: error.is_finite().then_some(error),
            error_limit: kind.error_limit(timed.steps, deformation),
        }
    }

    /// The limits of an engine, measured when the first row needs them.
    fn limits(&mut self, kind: Kind, level: Level, threads: usize, bytes: f64) -> Limits {
        let precision = kind.precision();
        let known = &mut self.report.limits.cpu;
        let same =
            |l: &CpuLimits| (l.precision, l.lanes.as_str(), l.threads) == (precision, level.name(), threads);
        let at = known.iter().position(same).unwrap_or_else(|| {
            known.push(CpuLimits::measure(precision, level, threads));
            known.len() - 1
        });
        known[at].at(bytes)
    }
}

/// Passes of a step, and the largest share of the multiply-add rate that the force routine's operations can reach.
fn cost(kind: Kind, model: &Model) -> (Vec<Pass>, f64) {
    let (passes, operations) = match kind.precision().is_single() {
        true => (work::cpu_passes::<f32>(model), work::element_operations::<f32>(model)),
        false => (work::cpu_passes::<f64>(model), work::element_operations::<f64>(model)),
    };
    (passes, operations.flops() as f64 / (2.0 * operations.places() as f64))
}

/// Passes of a GPU engine: the bytes of their bindings, and their arithmetic. That of all nodes is booked in the pass of
/// most of them.
fn gpu_passes(kind: Kind, times: &PassTimes, model: &Model) -> Vec<Pass> {
    let [elements, nodes] = match kind.precision().is_single() {
        true => work::step_operations::<f32>(model),
        false => work::step_operations::<f64>(model),
    };
    let flops = |kernel: &str| match kernel {
        "element_force" => elements,
        "node" => nodes,
        "resident" => elements + nodes,
        _ => 0.0,
    };
    let pass = |p: &PassTime| Pass { name: p.kernel.clone(), bytes: p.bytes as f64, flops: flops(&p.kernel) };
    times.passes.iter().map(pass).collect()
}

/// Size of an engine's arrays [bytes].
fn arrays(kind: Kind, model: &Model) -> f64 {
    match kind.precision().is_single() {
        true => work::cpu_arrays::<f32>(model),
        false => work::cpu_arrays::<f64>(model),
    }
}

fn totals(passes: &[Pass]) -> (f64, f64) {
    (passes.iter().map(|p| p.bytes).sum(), passes.iter().map(|p| p.flops).sum())
}

fn reason(bound: Bound, fraction: f64, mix: f64, passes: &[Pass], limits: &Limits) -> String {
    let (bytes, flops) = totals(passes);
    let percent = |share: f64| (100.0 * share).round();
    match bound {
        Bound::Compute => format!(
            "compute: {} % of the multiply-add rate, of which the mix of sums, products and fused operations allows \
             {} %; moving the data takes {} % as long as the arithmetic at the limits",
            percent(fraction),
            percent(mix),
            percent(bytes / limits.bandwidth / (flops / limits.flops))
        ),
        Bound::Bandwidth => {
            let most = passes.iter().max_by(|a, b| a.bytes.total_cmp(&b.bytes));
            let share = most.map_or(0.0, |p| p.bytes / bytes);
            format!(
                "bandwidth: {} % of a copy's; the {} pass moves {} % of the bytes; arithmetic takes {} % as long at \
                 the limits",
                percent(fraction),
                most.map_or("", |p| &p.name),
                percent(share),
                percent(flops / limits.flops / (bytes / limits.bandwidth))
            )
        }
        Bound::Latency => {
            format!("latency: {} passes a step of at least {:.2} us each", passes.len(), 1e6 * limits.latency)
        }
    }
}

/// Which pass takes most of a step of `step_us`, where the device says.
fn dominant(passes: &[Pass], pass_us: &[f64], step_us: f64) -> String {
    let most = passes.iter().zip(pass_us).max_by(|a, b| a.1.total_cmp(b.1));
    let Some((pass, us)) = most else { return String::new() };
    let all: f64 = pass_us.iter().sum();
    format!(
        "; {} takes {:.0} % of the time on the device, which is {:.0} % of the step",
        pass.name,
        100.0 * us / all,
        100.0 * all / step_us
    )
}

/// States of the f64 engine after as many steps as each of `timed` took, in one run.
fn references(model: &Model, scene: &Scene, roll: &Roll, timed: &[Timed]) -> Result<Vec<State>> {
    let mut order: Vec<usize> = (0..timed.len()).collect();
    order.sort_by_key(|&k| timed[k].steps);
    let mut states = vec![State::default(); timed.len()];
    if order.is_empty() {
        return Ok(states);
    }
    let mut engine = engine_at(model, scene, Precision::F64, 0, Level::detect())?;
    roll.start(&mut *engine, model)?;
    let mut taken = 0;
    for k in order {
        engine.advance(&roll.steps(taken, (timed[k].steps - taken) as usize))?;
        taken = timed[k].steps;
        states[k] = engine.state()?;
    }
    Ok(states)
}
