//! Runs of the matrix, and their errors.

use std::collections::HashMap;
use std::time::Instant;

use super::cases::{MEAN, Problem, Setting, element_name, machine_name, scene};
use super::reference::Reference;
use crate::bench::kind::Kind;
use crate::rig::{Recorder, block, hold, simulate_on};
use hexroll::Result;
use hexroll::engine::Step;
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::record::{Sample, Snapshot};
use hexroll::run::stability;
use hexroll::scene::Element;

/// What is measured with what.
#[derive(Debug, Clone)]
pub struct Matrix {
    pub problems: Vec<Problem>,
    pub elements: Vec<Element>,
    /// Refinements, ascending.
    pub meshes: Vec<usize>,
    /// Finest refinement of the reference; that of the meshes if it is coarser.
    pub reference: usize,
    pub safeties: Vec<f64>,
    /// Finest refinement with every safety factor, and with the short steps that split an error; beyond it the first safety
    /// factor alone.
    pub split: usize,
    /// Finest refinement that the GPU engine is measured on, with the first safety factor; 0: none.
    pub gpu: usize,
    pub threads: usize,
}

/// A measurement.
#[derive(Debug, Clone)]
pub struct Row {
    pub problem: Problem,
    pub setting: Setting,
    pub elements: usize,
    pub steps: u64,
    /// Pairs of force passes that the critical step took.
    pub eigenvalue: u64,
    /// Of the run [s], on a machine that does nothing else; NaN until timed.
    pub wall: f64,
    /// Element-updates a second of its steps; NaN until timed.
    pub updates_per_s: f64,
    /// Force [N], or for the wave its rms error.
    pub value: f64,
    /// Over the reference value.
    pub error: f64,
    /// The parts of the error; NaN where no run with short steps was made.
    pub discretisation: f64,
    pub time_step: f64,
    pub rounding: f64,
    /// Contact area over the reference's, less one; NaN without contact.
    pub area: f64,
    /// Displacement from the rim's rigid motion against the finest mesh's, relative L2 over common nodes; NaN without one.
    pub displacement: f64,
    /// Stored-energy balance over the largest term.
    pub balance: f64,
}

/// Rows, and what their errors are against.
#[derive(Debug, Clone, Default)]
pub struct Measured {
    pub rows: Vec<Row>,
    pub references: Vec<Reference>,
    /// Command, machine and commit that times were measured with.
    pub times_from: String,
}

impl Measured {
    /// Takes over what `before` has of other problems, in the order of [`Problem::ALL`].
    pub fn keep(&mut self, before: Measured) {
        let anew: Vec<Problem> = self.references.iter().map(|r| r.problem).collect();
        self.rows.extend(before.rows.into_iter().filter(|r| !anew.contains(&r.problem)));
        self.references.extend(before.references.into_iter().filter(|r| !anew.contains(&r.problem)));
        self.rows.sort_by_key(|r| r.problem);
        self.references.sort_by_key(|r| r.problem);
    }
}

/// A run.
#[derive(Debug, Clone, Default)]
pub(super) struct Run {
    pub value: f64,
    pub area: f64,
    pub balance: f64,
    pub steps: u64,
    pub eigenvalue: u64,
    pub elements: usize,
    /// Reference positions and displacements from the rigid motion.
    pub field: Field,
}

/// Positions in the reference shape, and displacements.
pub(super) type Field = Vec<([f64; 3], [f64; 3])>;

/// Double precision's step for errors of space alone, as a share of the critical one.
const SHORT: f64 = 0.3;
/// Output window of the runs [s].
const WINDOW: f64 = 1e-3;

/// Measures the errors of the matrix; `done` hears of every row, with those before it, and of every run of a reference.
///
/// # Errors
/// A run that fails, no adapter where the GPU is asked for, or what `done` answers.
pub fn measure(
    matrix: &Matrix,
    mut done: impl FnMut(&Measured, &dyn std::fmt::Display) -> Result<()>,
) -> Result<Measured> {
    let gpu = if matrix.gpu > 0 { Some(Gpu::open(None)?) } else { None };
    let mut measured = Measured::default();
    for &problem in &matrix.problems {
        let mut known = Known { matrix, gpu: gpu.as_ref(), problem, runs: HashMap::new() };
        let finest = matrix.meshes.iter().copied().fold(matrix.reference, usize::max);
        let reference = Reference::find(problem, finest, |setting| {
            let begun = Instant::now();
            let run = known.run(setting)?;
            let (mesh, value, seconds) = (setting.mesh, run.value, begun.elapsed().as_secs_f64());
            let name = problem.name();
            let line = format_args!("{name:9} reference x{mesh}: {value:.6e} in {seconds:.0} s");
            done(&measured, &line)?;
            Ok(run)
        })?;
        measured.references.push(reference.clone());
        let has = |s: &Setting| {
            !s.machine.on_gpu() || gpu.as_ref().is_none_or(|gpu| gpu.report.has(s.machine.precision()))
        };
        for setting in matrix.settings().into_iter().filter(has) {
            let row = known.row(&setting, &reference)?;
            let line = row.to_string();
            measured.rows.push(row);
            done(&measured, &line)?;
        }
    }
    Ok(measured)
}

impl Matrix {
    fn settings(&self) -> Vec<Setting> {
        let mut all = Vec::new();
        for &mesh in &self.meshes {
            for &element in &self.elements {
                for machine in Kind::ALL {
                    let safeties = match machine.on_gpu() {
                        true if mesh > self.gpu => &[],
                        true => &self.safeties[..1],
                        false if mesh > self.split => &self.safeties[..1],
                        false => &self.safeties[..],
                    };
                    all.extend(safeties.iter().map(|&safety| Setting { machine, element, mesh, safety }));
                }
            }
        }
        all
    }
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
            Problem::Wave => wave(setting, self.matrix.threads, self.gpu)?.0,
            problem => rolled(problem, setting, WINDOW, self.matrix.threads, self.gpu)?,
        };
        self.runs.insert(key, run.clone());
        Ok(run)
    }

    fn row(&mut self, setting: &Setting, reference: &Reference) -> Result<Row> {
        let run = self.run(setting)?;
        let double = self.run(&Setting { machine: Kind::CpuF64, ..*setting })?;
        let short = match setting.mesh <= self.matrix.split {
            true => self.run(&Setting { machine: Kind::CpuF64, safety: SHORT, ..*setting })?.value,
            false => f64::NAN,
        };
        // The wave's value is its error already.
        let scale = if self.problem == Problem::Wave { 1.0 } else { reference.value.abs() };
        let off = |a: f64, b: f64| (a - b).abs() / scale;
        Ok(Row {
            problem: self.problem,
            setting: *setting,
            elements: run.elements,
            steps: run.steps,
            eigenvalue: run.eigenvalue,
            wall: f64::NAN,
            updates_per_s: f64::NAN,
            value: run.value,
            error: off(run.value, reference.value),
            discretisation: off(short, reference.value),
            time_step: off(double.value, short),
            rounding: if setting.machine == Kind::CpuF64 { f64::NAN } else { off(run.value, double.value) },
            area: run.area / reference.area - 1.0,
            displacement: difference(&run.field, &reference.field),
            balance: run.balance,
        })
    }
}

/// Relative L2 difference over the nodes that both have.
fn difference(a: &Field, b: &Field) -> f64 {
    // Positions on a grid of 0.1 um.
    let key = |x: &[f64; 3]| x.map(|c| (c * 1e7).round() as i64);
    let there: HashMap<[i64; 3], [f64; 3]> = b.iter().map(|(x, u)| (key(x), *u)).collect();
    let (mut off, mut all) = (0.0, 0.0);
    for (x, u) in a {
        let Some(v) = there.get(&key(x)) else { continue };
        off += (0..3).map(|d| (u[d] - v[d]).powi(2)).sum::<f64>();
        all += v.iter().map(|c| c * c).sum::<f64>();
    }
    // The reference's own run is off by nothing.
    if off > 0.0 { (off / all).sqrt() } else { f64::NAN }
}

/// Runs the problem's wheel with output windows of `sample` [s].
pub(super) fn rolled(
    problem: Problem,
    setting: &Setting,
    sample: f64,
    threads: usize,
    gpu: Option<&Gpu>,
) -> Result<Run> {
    let mut scene = scene(problem, setting);
    scene.output.sample = sample;
    let model = Model::new(&scene)?;
    let mut engine = setting.machine.engine(&model, &scene, threads, gpu)?;
    let mut recorder = Recorder::default();
    let totals = simulate_on(&scene, &model, &mut *engine, &mut recorder)?;
    let rows = &recorder.samples;
    let count = if problem == Problem::Static { 1 } else { (MEAN / scene.output.sample).round() as usize };
    let mean = |f: fn(&Sample) -> f64| rows[rows.len() - count..].iter().map(f).sum::<f64>() / count as f64;
    let value = match problem {
        Problem::Straight => mean(|s| s.road_fx_N),
        Problem::Slip5 => mean(|s| s.road_fy_N),
        Problem::Static | Problem::Wave => mean(|s| s.road_fz_N),
    };
    let field = recorder.snapshots.last().map(|s| displacements(&model, s)).unwrap_or_default();
    Ok(Run {
        value,
        area: mean(|s| s.contact_area_m2),
        balance: totals.ledger.worst_stored_balance / totals.ledger.largest_term,
        steps: totals.steps,
        eigenvalue: totals.lanczos_iterations as u64,
        elements: model.element_count(),
        field,
    })
}

/// Displacements from the rim's rigid motion, turned back with it.
fn displacements(model: &Model, snapshot: &Snapshot) -> Field {
    let (axle, rotation) = snapshot.axle.unwrap_or((model.mesh.axle, [[0.0; 3]; 3]));
    let rest = model.mesh.axle;
    let turned = |x: &[f64; 3], X: &[f64; 3]| {
        let r: [f64; 3] = std::array::from_fn(|d| x[d] - axle[d]);
        let back = |c: usize| (0..3).map(|i| rotation[i][c] * r[i]).sum::<f64>();
        (*X, std::array::from_fn(|c| back(c) - (X[c] - rest[c])))
    };
    snapshot.x.iter().zip(&model.mesh.nodes).map(|(x, X)| turned(x, X)).collect()
}

/// A pulse in a bar of 1 m, 8 x 8 elements across, sides held, against d'Alembert's displacement; and the wall time of its
/// steps [s].
/// In one piece: a scene, its closed form, and the distance of the two.
pub(super) fn wave(setting: &Setting, threads: usize, gpu: Option<&Gpu>) -> Result<(Run, f64)> {
    const PULSE: f64 = 0.4;
    const WAY: f64 = 0.2;
    // Strain: linear, yet far above the rounding of single-precision positions.
    const STRAIN: f64 = 1e-4;
    let n = 50 * setting.mesh;
    let h = 1.0 / n as f64;
    let mut scene = block([1.0, 8.0 * h, 8.0 * h], [n, 8, 8]);
    scene.body.element = setting.element;
    scene.holds = vec![hold("all", "yz")];
    let model = Model::new(&scene)?;
    let mut engine = setting.machine.engine(&model, &scene, threads, gpu)?;
    engine.begin_stage(&hexroll::engine::StageSetup::default())?;
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
    let critical = stability::assembled(&mut *engine, &model, &x, guess, None)?;
    let count = (WAY / c / (setting.safety * critical.dt)).ceil() as usize;
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
    let run = Run {
        value: (off / all).sqrt(),
        area: f64::NAN,
        balance: f64::NAN,
        steps: count as u64,
        eigenvalue: critical.iterations as u64,
        elements: model.element_count(),
        field: Vec::new(),
    };
    Ok((run, wall))
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Setting { machine, element, mesh, safety } = self.setting;
        let (problem, machine, element) = (self.problem.name(), machine_name(machine), element_name(element));
        write!(f, "{problem:9} {machine:9} {element:17} x{mesh} safety {safety}: error {:.2e}", self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexroll::Error;

    /// The wave on its coarsest mesh.
    fn matrix() -> Matrix {
        Matrix {
            problems: vec![Problem::Wave],
            elements: vec![Element::Q1p0],
            meshes: vec![1],
            reference: 1,
            safeties: vec![0.9],
            split: 0,
            gpu: 0,
            threads: 1,
        }
    }

    #[test]
    fn rows_are_handed_out_as_they_come() {
        let mut seen = Vec::new();
        let note = |so_far: &Measured, _: &dyn std::fmt::Display| {
            seen.push((so_far.references.len(), so_far.rows.len()));
            Ok(())
        };
        let measured = measure(&matrix(), note).unwrap();
        assert_eq!(seen, [(1, 1), (1, 2)], "double and single precision");
        assert_eq!(measured.rows.len(), 2);
    }

    #[test]
    fn whoever_cannot_keep_a_row_ends_the_measurement() {
        let full = |_: &Measured, _: &dyn std::fmt::Display| Err(Error::NoAdapter { detail: "full".into() });
        assert!(measure(&matrix(), full).is_err_and(|e| e.to_string().contains("full")));
    }
}
