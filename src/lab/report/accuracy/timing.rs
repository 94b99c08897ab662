//! Wall times of the rows: the time of a step, measured by itself, times the steps that the row's run took.
//!
//! A whole matrix takes an hour of one core. The times of its steps take a minute, so they can be had from a machine
//! that does nothing else.

use std::collections::HashMap;
use std::time::Instant;

use super::cases::{Problem, Setting, element_name, machine_name, scene};
use super::runs::{Row, rolled, wave};
use crate::bench::kind::Kind;
use crate::bench::wheel::Roll;
use hexroll::Result;
use hexroll::gpu::Gpu;
use hexroll::model::Model;
use hexroll::scene::Element;

/// Batches of steps that are timed; the median counts.
const BATCHES: usize = 5;
/// Shortest batch [s].
const BATCH: f64 = 0.12;
/// Steps over which the wheel of [`Roll`] sinks into the road, and some more.
const FOOTPRINT: usize = 210;

/// What an output window costs: the straight run with another `output.sample`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Its length [s].
    pub sample: f64,
    pub wall: f64,
    /// Longitudinal force, the mean of the row's own windows [N].
    pub value: f64,
}

/// Fills in the wall times of the rows, and times output windows of several lengths.
///
/// # Errors
/// A run that fails, or no adapter where rows of the GPU are to be timed.
pub fn time(rows: &mut [Row], threads: usize) -> Result<Vec<Window>> {
    let on_gpu = rows.iter().any(|r| r.setting.machine.on_gpu());
    let gpu = if on_gpu { Some(Gpu::open(None)?) } else { None };
    let mut steps: HashMap<String, f64> = HashMap::new();
    for row in rows.iter_mut() {
        let s = &row.setting;
        let viscous = matches!(row.problem, Problem::Straight | Problem::Slip5);
        let what = if row.problem == Problem::Wave {
            "wave"
        } else if viscous {
            "viscous"
        } else {
            "elastic"
        };
        let key = format!("{what} {} {} {}", machine_name(s.machine), element_name(s.element), s.mesh);
        let each = match steps.get(&key) {
            Some(&each) => each,
            None => {
                let each = match row.problem {
                    Problem::Wave => wave_step(s, threads, gpu.as_ref())?,
                    problem => step(problem, s, threads, gpu.as_ref())?,
                };
                steps.insert(key, each);
                each
            }
        };
        // An iteration for the eigenvalue is two force passes, each no dearer than a step.
        row.wall = each * (row.steps + 2 * row.eigenvalue) as f64;
        row.updates_per_s = row.elements as f64 / each;
    }
    windows(threads)
}

/// Seconds a step of the problem's wheel, rolling on its footprint.
fn step(problem: Problem, setting: &Setting, threads: usize, gpu: Option<&Gpu>) -> Result<f64> {
    let scene = scene(problem, setting);
    let model = Model::new(&scene)?;
    let mut engine = setting.machine.engine(&model, &scene, threads, gpu)?;
    let roll = Roll::new(&model)?;
    roll.start(&mut *engine, &model)?;
    let mut taken = 0;
    let mut advance = |count: usize| roll.timed(&mut *engine, &mut taken, count);
    let each = advance(FOOTPRINT)?;
    let count = ((BATCH / each) as usize).clamp(3, roll.whole_run() as usize / BATCHES);
    Ok(median((0..BATCHES).map(|_| advance(count)).collect::<Result<Vec<f64>>>()?))
}

/// Seconds a step of the wave.
fn wave_step(setting: &Setting, threads: usize, gpu: Option<&Gpu>) -> Result<f64> {
    let once = || wave(setting, threads, gpu).map(|(run, wall)| wall / run.steps as f64);
    Ok(median((0..BATCHES).map(|_| once()).collect::<Result<Vec<f64>>>()?))
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The straight run of the coarse wheel with windows of 0.1, 1 and 5 ms.
fn windows(threads: usize) -> Result<Vec<Window>> {
    let setting = Setting { machine: Kind::CpuF64, element: Element::Q1p0, mesh: 1, safety: 0.9 };
    [1e-4, 1e-3, 5e-3]
        .into_iter()
        .map(|sample| {
            let begun = Instant::now();
            let run = rolled(Problem::Straight, &setting, sample, threads, None)?;
            Ok(Window { sample, wall: begun.elapsed().as_secs_f64(), value: run.value })
        })
        .collect()
}
