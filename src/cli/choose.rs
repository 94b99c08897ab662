//! Which engine runs a scene, in which precision, and why.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};

use super::estimate::{self, Steps};
use super::format::{duration, updates};
use hexroll::cpu;
use hexroll::engine::Engine;
use hexroll::gpu::{AdapterReport, Gpu, GpuEngine, adapters};
use hexroll::memory::{self, Need};
use hexroll::model::Model;
use hexroll::run::stability;
use hexroll::scene::{Method, Scene};
use hexroll::{Error, Precision, Result};

/// Engines a user can ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum EngineChoice {
    /// The faster of the CPU and the best adapter, tried on the scene; large meshes take a real GPU at once
    #[default]
    Auto,
    /// The GPU engine, on a software adapter if there is no other
    Gpu,
    /// The multi-threaded CPU engine
    Cpu,
}

/// Reads `--precision`, with what `--help` says of each.
fn precision_parser() -> impl TypedValueParser<Value = Precision> {
    let value = |precision: Precision| {
        PossibleValue::new(precision.name()).help(match precision {
            Precision::F64 => "Double (the default on the CPU; on a GPU only if its shaders have it)",
            Precision::F32 => "Single (the default on a GPU)",
            Precision::F32Plus => "Single with positions as pairs (GPU only)",
        })
    };
    PossibleValuesParser::new(Precision::ALL.map(value)).try_map(|name| name.parse::<Precision>())
}

/// How the engine is asked for.
#[derive(Debug, Clone, Args)]
pub struct EngineArgs {
    /// Who computes
    #[arg(long, value_enum, default_value_t)]
    pub engine: EngineChoice,
    /// Arithmetic; default f64 on the CPU, f32 on a GPU
    #[arg(long, value_parser = precision_parser())]
    pub precision: Option<Precision>,
    /// Threads of the CPU engine; 0: one a core. Results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Take the GPU adapter whose name contains this
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

impl EngineArgs {
    /// Arguments that exclude each other.
    pub fn conflict(&self) -> Option<&'static str> {
        let conflict = self.engine == EngineChoice::Cpu && self.adapter.is_some();
        conflict.then_some("--adapter names a GPU adapter, but --engine cpu uses none")
    }
}

/// The precision of each engine that may run a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidates {
    pub cpu: Option<Precision>,
    pub gpu: Option<Precision>,
}

/// Who may run a scene.
///
/// # Errors
/// [`Error::Unsupported`] for an engine that does not have the precision on any machine.
pub fn candidates(engine: EngineChoice, precision: Option<Precision>) -> Result<Candidates> {
    use Precision::{F32, F64};
    let cpu = Some(precision.unwrap_or(F64)).filter(|p| cpu::PRECISIONS.contains(p));
    let gpu = Some(precision.unwrap_or(F32));
    match engine {
        EngineChoice::Auto => Ok(Candidates { cpu, gpu }),
        EngineChoice::Cpu if cpu.is_none() => Err(Error::Unsupported {
            what: format!("--precision {} on the CPU engine", precision.unwrap_or(F64)),
            instead: "use f64 or f32 there, or --engine gpu".into(),
        }),
        EngineChoice::Cpu => Ok(Candidates { cpu, gpu: None }),
        EngineChoice::Gpu => Ok(Candidates { cpu: None, gpu }),
    }
}

/// The adapter that is taken: the first that can be used and whose name contains `name`, in the order of
/// [`adapters`].
pub fn usable<'a>(reports: &'a [AdapterReport], name: Option<&str>) -> Option<&'a AdapterReport> {
    let named = |r: &AdapterReport| name.is_none_or(|n| r.name.to_lowercase().contains(&n.to_lowercase()));
    reports.iter().find(|r| r.unusable.is_none() && named(r))
}

/// What a body needs in memory, and, in a precision, its run on the CPU engine.
pub fn need(scene: &Scene, engine: Option<Precision>) -> Need {
    let body = hexroll::model::memory::body(scene);
    let Some(precision) = engine else { return body.into() };
    // Implicit stages have no critical step.
    let explicit = scene.stages.iter().any(|s| !matches!(s.method, Method::Implicit(_)));
    let search = explicit.then(|| stability::search(scene));
    Need { parts: [body, cpu::memory::engine(scene, precision)].into_iter().chain(search).collect() }
}

/// Meshes a scene for an engine, unless the two cannot fit in memory. Where a GPU may run it, the body alone has to.
///
/// # Errors
/// [`Error::Memory`], before anything is made; as [`Model::new`].
pub fn model(args: &EngineArgs, scene: &Scene) -> Result<Model> {
    let candidates = candidates(args.engine, args.precision)?;
    let engine = if candidates.gpu.is_none() { candidates.cpu } else { None };
    memory::ensure(scene, |scene| need(scene, engine))?;
    Model::new(scene)
}

/// An engine at rest, ready to run.
pub struct Chosen {
    pub engine: Box<dyn Engine>,
    /// Why this one, in words.
    pub reason: String,
    /// Its element updates per second on the scene, where they have been measured.
    pub rate: Option<f64>,
}

/// Builds the engine that runs a scene.
///
/// # Errors
/// [`Error::Unsupported`] for a precision the engine does not have; [`Error::NoAdapter`], [`Error::TooLarge`],
/// [`Error::Device`] if a GPU was asked for and cannot be had.
pub fn choose(args: &EngineArgs, model: &Model, scene: &Scene) -> Result<Chosen> {
    let asked = |what: &str| format!("asked for with {what}");
    match candidates(args.engine, args.precision)? {
        Candidates { cpu: Some(precision), gpu: None } => {
            let reason = asked("--engine cpu");
            let build = || cpu::engine(model, scene, precision, args.threads);
            let rate = rate_of_a_long_run(model, scene, fastest_cpu(), build)?;
            Ok(Chosen { engine: build()?, reason, rate })
        }
        Candidates { cpu: None, gpu: Some(precision) } => {
            let reason = match args.engine {
                EngineChoice::Auto => "only the GPU engine has f32+".into(),
                _ => asked("--engine gpu"),
            };
            let gpu = Gpu::open(args.adapter.as_deref())?;
            let build = || on_gpu(&gpu, precision, model, scene);
            let rate = rate_of_a_long_run(model, scene, FASTEST_GPU, build)?;
            Ok(Chosen { engine: build()?, reason, rate })
        }
        Candidates { cpu: Some(on_cpu), gpu: Some(on_gpu) } => {
            Competition { args, model, scene, on_cpu, on_gpu }.decide()
        }
        Candidates { cpu: None, gpu: None } => unreachable!("every precision has an engine"),
    }
}

/// More element updates and steps per second than a GPU of today takes.
const FASTEST_GPU: [f64; 2] = [2e10, 2e5];

/// The same of this machine's cores.
fn fastest_cpu() -> [f64; 2] {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    [1e8 * cores as f64, 1e6]
}

/// A run that takes longer than this [s] at that pace is tried before it starts, so that its duration can be said: the try
/// takes a second, of a run of minutes.
const LONG: f64 = 20.0;

/// Element updates per second of an engine that `build` makes for it, if the run is certain to be long.
fn rate_of_a_long_run(
    model: &Model,
    scene: &Scene,
    [updates, steps]: [f64; 2],
    build: impl Fn() -> Result<Box<dyn Engine>>,
) -> Result<Option<f64>> {
    let planned = Steps::of(scene, model)?;
    let least = planned.explicit as f64 * (model.element_count() as f64 / updates + 1.0 / steps);
    if least < LONG {
        return Ok(None);
    }
    estimate::rate(&mut *build()?, model, scene, planned.element_bound_s).map(Some)
}

/// The GPU engine on the best adapter, or on the one called `name`.
pub(super) fn gpu(
    name: Option<&str>,
    precision: Precision,
    model: &Model,
    scene: &Scene,
) -> Result<Box<dyn Engine>> {
    on_gpu(&Gpu::open(name)?, precision, model, scene)
}

fn on_gpu(gpu: &Gpu, precision: Precision, model: &Model, scene: &Scene) -> Result<Box<dyn Engine>> {
    Ok(Box::new(GpuEngine::new(gpu, model, scene, precision)?))
}

/// Runs that the CPU engine ends sooner than this [s] are not worth a try: translating the kernels takes a software
/// adapter 4 to 8 s of the same cores, a real GPU's driver about one.
pub fn worth_a_try(software: bool) -> f64 {
    if software { 10.0 } else { 1.0 }
}

/// From here on a real GPU is taken without a race, which would cost more than it could save: whatever has a
/// GPU's bandwidth beats any processor on a mesh that no cache holds.
pub const LARGE: usize = 500_000;

/// Both engines may run the scene.
struct Competition<'a> {
    args: &'a EngineArgs,
    model: &'a Model,
    scene: &'a Scene,
    on_cpu: Precision,
    on_gpu: Precision,
}

impl Competition<'_> {
    fn decide(&self) -> Result<Chosen> {
        let reports = adapters();
        let name = self.args.adapter.as_deref();
        if self.scene.beyond_gpu().is_some() && name.is_none() {
            return self.cpu("moved components and reactions are the CPU engine's alone");
        }
        match usable(&reports, name) {
            Some(report) if !report.has(self.on_gpu) && name.is_none() => {
                self.cpu(&format!("{} has no {}", report.name, self.on_gpu))
            }
            // Who names a real GPU has chosen.
            Some(report) if !report.software && (name.is_some() || self.model.element_count() >= LARGE) => {
                self.gpu_or_why_not(&report.name)
            }
            Some(report) => self.measured(&report.name, report.software),
            // Who names an adapter does not want the CPU instead: the error says what there is.
            None if name.is_some() => {
                let engine = gpu(name, self.on_gpu, self.model, self.scene)?;
                Ok(Chosen { engine, reason: "named with --adapter".into(), rate: None })
            }
            None => self.cpu("no GPU adapter can be used"),
        }
    }

    fn build_cpu(&self) -> Result<Box<dyn Engine>> {
        cpu::engine(self.model, self.scene, self.on_cpu, self.args.threads)
    }

    /// The CPU engine, for a reason that did not need its rate.
    fn cpu(&self, reason: &str) -> Result<Chosen> {
        let rate = rate_of_a_long_run(self.model, self.scene, fastest_cpu(), || self.build_cpu())?;
        Ok(Chosen { engine: self.build_cpu()?, reason: reason.into(), rate })
    }

    /// The CPU engine, whose rate has been measured.
    fn measured_cpu(&self, rate: f64, reason: String) -> Result<Chosen> {
        Ok(Chosen { engine: self.build_cpu()?, reason, rate: Some(rate) })
    }

    fn open(&self, name: &str) -> Result<(Gpu, Box<dyn Engine>)> {
        let gpu = Gpu::open(Some(name))?;
        let engine = on_gpu(&gpu, self.on_gpu, self.model, self.scene)?;
        Ok((gpu, engine))
    }

    /// A real GPU without a race, unless it cannot be had.
    fn gpu_or_why_not(&self, name: &str) -> Result<Chosen> {
        let chosen = || {
            let gpu = Gpu::open(Some(name))?;
            let build = || on_gpu(&gpu, self.on_gpu, self.model, self.scene);
            let rate = rate_of_a_long_run(self.model, self.scene, FASTEST_GPU, build)?;
            Ok(Chosen { engine: build()?, reason: self.why_at_once(name), rate })
        };
        match chosen() {
            Ok(chosen) => Ok(chosen),
            Err(error) if self.args.adapter.is_some() => Err(error),
            Err(error) => self.cpu(&format!("{name} could not be used: {error}")),
        }
    }

    fn why_at_once(&self, name: &str) -> String {
        match self.args.adapter {
            Some(_) => format!("{name} is a GPU, named with --adapter"),
            None => format!("{name} is a GPU, and {LARGE} elements or more are not tried on the CPU"),
        }
    }

    /// The faster of the CPU engine and an adapter.
    fn measured(&self, name: &str, software: bool) -> Result<Chosen> {
        let steps = Steps::of(self.scene, self.model)?;
        let rate =
            |engine: &mut dyn Engine| estimate::rate(engine, self.model, self.scene, steps.element_bound_s);
        let cpu_rate = rate(&mut *self.build_cpu()?)?;
        let cpu_text = format!("cpu {}: {}", self.on_cpu, updates(cpu_rate));
        let seconds = steps.seconds(self.model, cpu_rate);
        if seconds < worth_a_try(software) {
            let time = duration(seconds);
            let reason = format!("{cpu_text}, about {time} in all: too short to try {name}");
            return self.measured_cpu(cpu_rate, reason);
        }
        let (gpu, gpu_rate) = match self.open(name).and_then(|(gpu, mut e)| Ok((gpu, rate(&mut *e)?))) {
            Ok(measured) => measured,
            Err(error) => {
                return self.measured_cpu(cpu_rate, format!("{cpu_text}; {name} could not be used: {error}"));
            }
        };
        if cpu_rate >= gpu_rate {
            let reason = format!("{cpu_text} against {} on {name}", updates(gpu_rate));
            return self.measured_cpu(cpu_rate, reason);
        }
        let engine = on_gpu(&gpu, self.on_gpu, self.model, self.scene)?;
        let reason = format!("gpu {}: {} on {name} against {cpu_text}", self.on_gpu, updates(gpu_rate));
        Ok(Chosen { engine, reason, rate: Some(gpu_rate) })
    }
}
