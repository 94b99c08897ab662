//! Runs of the matrix, and their errors.

use std::collections::HashMap;
use std::time::Instant;

use super::cases::{MEAN, Machine, Problem, Setting, element_name, scene};
use crate::cpu::{self, Precision};
use crate::engine::{Engine, Step};
use crate::gpu::{Gpu, GpuEngine};
use crate::model::Model;
use crate::record::{Sample, Snapshot};
use crate::report::bench::{block, hold};
use crate::run::{self, Observer, Progress, stability};
use crate::scene::{Element, NodeSet, Scene};
use crate::{Error, Result};

/// What is measured with what.
#[derive(Debug, Clone)]
pub struct Matrix {
    pub problems: Vec<Problem>,
    pub elements: Vec<Element>,
    /// Refinements that are measured, ascending; the reference takes one more.
    pub meshes: Vec<usize>,
    pub safeties: Vec<f64>,
    pub threads: usize,
    /// Whether the GPU engine is measured too.
    pub gpu: bool,
}

/// A measurement.
#[derive(Debug, Clone)]
pub struct Row {
    pub problem: Problem,
    pub setting: Setting,
    pub elements: usize,
    pub steps: u64,
    pub wall: f64,
    pub updates_per_s: f64,
    /// Force [N], or for the wave its rms error.
    pub value: f64,
    /// Over the reference value.
    pub error: f64,
    pub discretisation: f64,
    pub time_step: f64,
    pub rounding: f64,
    /// Contact area over the reference's, less one; NaN without contact.
    pub area: f64,
    /// Displacement from the rim's rigid motion against the reference mesh's, relative L2 over common nodes.
    pub displacement: f64,
    /// Stored-energy balance over the largest term.
    pub balance: f64,
}

/// A run.
#[derive(Debug, Clone, Default)]
struct Run {
    value: f64,
    area: f64,
    balance: f64,
    steps: u64,
    elements: usize,
    wall: f64,
    /// Reference positions and displacements from the rigid motion.
    field: Vec<([f64; 3], [f64; 3])>,
}

/// Double precision's step for errors of space alone, as a share of the critical one.
const SHORT: f64 = 0.3;

/// Measures the matrix; `done` hears of every row.
///
/// # Errors
/// A run that fails, or no adapter where the GPU is asked for.
pub fn measure(matrix: &Matrix, mut done: impl FnMut(&Row)) -> Result<Vec<Row>> {
    let gpu = if matrix.gpu { Some(Gpu::open(None)?) } else { None };
    let mut rows = Vec::new();
    for &problem in &matrix.problems {
        let mut known = Known { matrix, gpu: gpu.as_ref(), problem, runs: HashMap::new() };
        let reference = known.reference()?;
        for setting in settings(matrix) {
            let row = known.row(&setting, &reference)?;
            done(&row);
            rows.push(row);
        }
    }
    Ok(rows)
}

fn settings(matrix: &Matrix) -> Vec<Setting> {
    let mut machines = vec![Machine::Cpu64, Machine::Cpu32];
    if matrix.gpu {
        machines.extend([Machine::Gpu32, Machine::GpuPairs]);
    }
    let mut all = Vec::new();
    for &mesh in &matrix.meshes {
        for &element in &matrix.elements {
            for &machine in &machines {
                all.extend(matrix.safeties.iter().map(|&safety| Setting { machine, element, mesh, safety }));
            }
        }
    }
    all
}

/// What errors are against.
struct Reference {
    value: f64,
    area: f64,
    field: Vec<([f64; 3], [f64; 3])>,
}

struct Known<'a> {
    matrix: &'a Matrix,
    gpu: Option<&'a Gpu>,
    problem: Problem,
    runs: HashMap<String, Run>,
}

impl Known<'_> {
    /// Each cell is computed once.
    fn run(&mut self, setting: &Setting) -> Result<Run> {
        let key = format!("{setting:?}");
        if let Some(run) = self.runs.get(&key) {
            return Ok(run.clone());
        }
        let run = match self.problem {
            Problem::Wave => wave(setting, self.matrix.threads, self.gpu)?,
            problem => rolled(problem, setting, self.matrix.threads, self.gpu)?,
        };
        self.runs.insert(key, run.clone());
        Ok(run)
    }

    /// Second-order extrapolation of double precision from the two finest meshes, one finer than those measured.
    fn reference(&mut self) -> Result<Reference> {
        if self.problem == Problem::Wave {
            return Ok(Reference { value: 0.0, area: f64::NAN, field: Vec::new() });
        }
        let last = self.matrix.meshes.iter().copied().max().unwrap_or(1);
        let at = |mesh| Setting { machine: Machine::Cpu64, element: Element::Q1p0, mesh, safety: 0.9 };
        let (coarse, fine) = (self.run(&at(last))?, self.run(&at(last + 1))?);
        let ratio = ((last + 1) as f64 / last as f64).powi(2);
        let limit = |c: f64, f: f64| f + (f - c) / (ratio - 1.0);
        Ok(Reference {
            value: limit(coarse.value, fine.value),
            area: limit(coarse.area, fine.area),
            field: fine.field,
        })
    }

    fn row(&mut self, setting: &Setting, reference: &Reference) -> Result<Row> {
        let run = self.run(setting)?;
        let double = self.run(&Setting { machine: Machine::Cpu64, ..*setting })?;
        let short = self.run(&Setting { machine: Machine::Cpu64, safety: SHORT, ..*setting })?;
        // The wave's value is its error already.
        let scale = if self.problem == Problem::Wave { 1.0 } else { reference.value.abs() };
        let off = |a: f64, b: f64| (a - b).abs() / scale;
        Ok(Row {
            problem: self.problem,
            setting: *setting,
            elements: run.elements,
            steps: run.steps,
            wall: run.wall,
            updates_per_s: run.steps as f64 * run.elements as f64 / run.wall,
            value: run.value,
            error: off(run.value, reference.value),
            discretisation: off(short.value, reference.value),
            time_step: off(double.value, short.value),
            rounding: off(run.value, double.value),
            area: run.area / reference.area - 1.0,
            displacement: difference(&run.field, &reference.field),
            balance: run.balance,
        })
    }
}

/// Relative L2 difference over the nodes that both have.
fn difference(a: &[([f64; 3], [f64; 3])], b: &[([f64; 3], [f64; 3])]) -> f64 {
    // Positions on a grid of 0.1 um.
    let key = |x: &[f64; 3]| x.map(|c| (c * 1e7).round() as i64);
    let there: HashMap<[i64; 3], [f64; 3]> = b.iter().map(|(x, u)| (key(x), *u)).collect();
    let (mut off, mut all) = (0.0, 0.0);
    for (x, u) in a {
        let Some(v) = there.get(&key(x)) else { continue };
        off += (0..3).map(|d| (u[d] - v[d]).powi(2)).sum::<f64>();
        all += v.iter().map(|c| c * c).sum::<f64>();
    }
    (off / all).sqrt()
}

fn engine<'a>(
    setting: &Setting,
    model: &Model,
    scene: &Scene,
    threads: usize,
    gpu: Option<&Gpu>,
) -> Result<Box<dyn Engine + 'a>> {
    let on_gpu = |plus| -> Result<Box<dyn Engine + 'a>> {
        let gpu = gpu.ok_or_else(|| Error::NoAdapter { detail: "none was opened".into() })?;
        Ok(Box::new(GpuEngine::new(gpu, model, scene, plus)?))
    };
    match setting.machine {
        Machine::Cpu64 => Ok(cpu::engine(model, scene, Precision::F64, threads)),
        Machine::Cpu32 => Ok(cpu::engine(model, scene, Precision::F32, threads)),
        Machine::Gpu32 => on_gpu(false),
        Machine::GpuPairs => on_gpu(true),
    }
}

#[derive(Default)]
struct Recorder(Vec<Sample>, Vec<Snapshot>);

impl Observer for Recorder {
    fn sample(&mut self, sample: &Sample, _: &Progress) -> Result<()> {
        self.0.push(sample.clone());
        Ok(())
    }
    fn snapshot(&mut self, snapshot: &Snapshot, _: &str) -> Result<()> {
        self.1.push(snapshot.clone());
        Ok(())
    }
}

fn rolled(problem: Problem, setting: &Setting, threads: usize, gpu: Option<&Gpu>) -> Result<Run> {
    let scene = scene(problem, setting);
    let model = Model::new(&scene)?;
    let mut engine = engine(setting, &model, &scene, threads, gpu)?;
    let mut recorder = Recorder::default();
    let start = Instant::now();
    let totals = run::run(&scene, &model, &mut *engine, &mut recorder)?;
    let wall = start.elapsed().as_secs_f64();
    let rows = &recorder.0;
    let count = if problem == Problem::Static { 1 } else { (MEAN / scene.output.sample).round() as usize };
    let mean = |f: fn(&Sample) -> f64| rows[rows.len() - count..].iter().map(f).sum::<f64>() / count as f64;
    let value = match problem {
        Problem::Straight => mean(|s| s.road_fx_N),
        Problem::Slip5 => mean(|s| s.road_fy_N),
        Problem::Static | Problem::Wave => mean(|s| s.road_fz_N),
    };
    let field = recorder.1.last().map(|s| displacements(&model, s)).unwrap_or_default();
    Ok(Run {
        value,
        area: mean(|s| s.contact_area_m2),
        balance: totals.ledger.worst_stored_balance / totals.ledger.largest_term,
        steps: totals.steps,
        elements: model.element_count(),
        wall,
        field,
    })
}

/// Displacements from the rim's rigid motion, turned back with it.
fn displacements(model: &Model, snapshot: &Snapshot) -> Vec<([f64; 3], [f64; 3])> {
    let (axle, rotation) = snapshot.axle.unwrap_or((model.mesh.axle, [[0.0; 3]; 3]));
    let rest = model.mesh.axle;
    let turned = |x: &[f64; 3], X: &[f64; 3]| {
        let r: [f64; 3] = std::array::from_fn(|d| x[d] - axle[d]);
        let back = |c: usize| (0..3).map(|i| rotation[i][c] * r[i]).sum::<f64>();
        (*X, std::array::from_fn(|c| back(c) - (X[c] - rest[c])))
    };
    snapshot.x.iter().zip(&model.mesh.nodes).map(|(x, X)| turned(x, X)).collect()
}

/// A pulse in a bar of 1 m, 8 x 8 elements across, sides held, against d'Alembert's displacement.
fn wave(setting: &Setting, threads: usize, gpu: Option<&Gpu>) -> Result<Run> {
    const PULSE: f64 = 0.4;
    const WAY: f64 = 0.2;
    // Strain: linear, yet far above the rounding of single-precision positions.
    const STRAIN: f64 = 1e-4;
    let n = 50 * setting.mesh;
    let h = 1.0 / n as f64;
    let mut scene = block([1.0, 8.0 * h, 8.0 * h], [n, 8, 8]);
    scene.body.element = setting.element;
    scene.holds = vec![hold(NodeSet::All, "yz")];
    let model = Model::new(&scene)?;
    let mut engine = engine(setting, &model, &scene, threads, gpu)?;
    engine.begin_stage(&crate::engine::StageSetup::default())?;
    let c = (scene.body.law.wave_modulus() / scene.body.density).sqrt();
    let a = |s: f64| std::f64::consts::PI * s.clamp(-0.5 * PULSE, 0.5 * PULSE) / PULSE;
    let velocity = |x: &[f64; 3]| {
        let s = x[0] - 0.5;
        let shape = if s.abs() < 0.5 * PULSE { a(s).cos().powi(4) } else { 0.0 };
        [STRAIN * c * shape, 0.0, 0.0]
    };
    let v: Vec<[f64; 3]> = model.mesh.nodes.iter().map(velocity).collect();
    engine.set_velocity(&v, &[0.0; 6])?;
    let x = model.mesh.nodes.clone();
    let guess = stability::element_bound(&model)?;
    let critical = stability::assembled(&mut *engine, &model, &x, guess, None)?.dt;
    let count = (WAY / c / (setting.safety * critical)).ceil() as usize;
    let dt = WAY / c / count as f64;
    let steps: Vec<Step> = (0..count)
        .map(|k| Step {
            time: k as f64 * dt,
            dt,
            dt_before: if k == 0 { 0.0 } else { dt },
            rim: [0.0; 6],
            load: [0.0; 6],
        })
        .collect();
    let start = Instant::now();
    engine.advance(&steps)?;
    let wall = start.elapsed().as_secs_f64();
    let integral = |s: f64| {
        let a = a(s);
        PULSE / std::f64::consts::PI * (0.375 * a + 0.25 * (2.0 * a).sin() + (4.0 * a).sin() / 32.0)
    };
    let (mut off, mut all) = (0.0, 0.0);
    for (x, X) in engine.state()?.x.iter().zip(&model.mesh.nodes) {
        let s = X[0] - 0.5;
        let expected = 0.5 * STRAIN * (integral(s + WAY) - integral(s - WAY));
        off += (x[0] - X[0] - expected).powi(2);
        all += expected * expected;
    }
    Ok(Run {
        value: (off / all).sqrt(),
        area: f64::NAN,
        balance: f64::NAN,
        steps: count as u64,
        elements: model.element_count(),
        wall,
        field: Vec::new(),
    })
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Setting { machine, element, mesh, safety } = self.setting;
        write!(
            f,
            "{:9} {:9} {:17} x{mesh} safety {safety}: {:.3} s, error {:.2e}",
            self.problem.name(),
            machine.name(),
            element_name(element),
            self.wall,
            self.error
        )
    }
}
