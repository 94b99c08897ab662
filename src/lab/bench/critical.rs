//! What the time step gains by the assembled eigenvalue, and that the safety factor is stable, by the energy balance
//! of rolling runs.

use serde::{Deserialize, Serialize};

use super::wheel::Wheel;
use crate::rig::Recorder;
use hexroll::Result;
use hexroll::cpu::{Precision, engine};
use hexroll::engine::Engine;
use hexroll::model::Model;
use hexroll::output::summary::WorstBalance;
use hexroll::record::Sample;
use hexroll::run::{run, stability};
use hexroll::scene::Scene;

/// Time steps of the paper's wheel, and rolling runs at several safeties.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CriticalReport {
    pub steps: Vec<CriticalStep>,
    pub runs: Vec<RollingRun>,
}

/// Critical steps of one state [s].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CriticalStep {
    pub element: String,
    pub elements: usize,
    pub viscosity: f64,
    /// `rest`, or `pressed` 2.2 mm.
    pub state: String,
    /// Shortest edge of any element in this state over the P-wave speed of the unstressed material.
    pub edge_over_speed: f64,
    /// Of single elements, in the reference shape.
    pub element_bound: f64,
    pub assembled: f64,
    /// Eigenvalue iterations, two force passes each.
    pub iterations: usize,
}

/// 0.1 s of rolling at one safety factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RollingRun {
    pub element: String,
    pub elements: usize,
    pub viscosity: f64,
    pub safety: f64,
    /// Mean step [s].
    pub dt: f64,
    pub steps: u64,
    /// Largest error of the balance by work done, relative to the largest term.
    pub work_error: f64,
    /// Largest error of the balance by stored energy in the first and in the second half of the rolling, relative to
    /// the largest energy or work of that half: bounded where the scheme is stable.
    pub stored_error: [f64; 2],
    /// Mean longitudinal and vertical force of the road over the last 30 ms [N].
    pub road: [f64; 2],
    /// How the run ended, if it did not get to its end.
    pub failure: Option<String>,
}

/// Safeties that are tried; the last must fail.
const SAFETIES: [f64; 5] = [0.9, 0.95, 0.97, 1.0, 1.05];

/// Larger meshes are left out: their iterations take minutes.
const LARGEST: usize = 60_000;

/// Critical steps of wheels of these sizes at rest.
pub fn at_rest(
    elements: &[&str],
    sizes: &[usize],
    viscosities: &[Option<f64>],
    note: &mut dyn FnMut(&str),
) -> Result<CriticalReport> {
    let mut report = CriticalReport::default();
    for &count in sizes.iter().filter(|n| **n <= LARGEST) {
        for &element in elements {
            for &viscosity in viscosities {
                let wheel = Wheel { elements: count, element, contact: true, viscosity };
                note(&format!("critical step of {element} {count}"));
                let scene = wheel.scene()?;
                let model = Model::new(&scene)?;
                let bound = stability::element_bound(&model)?;
                let mut engine = engine(&model, &scene, Precision::F64, 0)?;
                report.steps.push(step(&wheel, "rest", &mut *engine, &model, bound)?);
            }
        }
    }
    Ok(report)
}

/// Everything, for the paper's mesh: critical steps at rest and pressed, and rolling runs of the first of `elements`.
pub fn measure(elements: &[&str], note: &mut dyn FnMut(&str)) -> Result<CriticalReport> {
    let mut report = CriticalReport::default();
    let wheel = |element, viscosity| Wheel { elements: 880, element, contact: true, viscosity };
    let viscosities = [None, Some(20.0)];
    for &element in elements {
        for viscosity in viscosities {
            note(&format!("critical step of {element}, viscosity {} Pa s", viscosity.unwrap_or(0.0)));
            report.steps.extend(steps(&wheel(element, viscosity))?);
        }
    }
    for viscosity in viscosities {
        for safety in SAFETIES {
            note(&format!("rolling at safety {safety}, viscosity {} Pa s", viscosity.unwrap_or(0.0)));
            report.runs.push(rolling(&wheel(elements[0], viscosity), safety)?);
        }
    }
    Ok(report)
}

/// At rest, and settled with the axle 2.2 mm down.
pub fn steps(wheel: &Wheel) -> Result<[CriticalStep; 2]> {
    let mut scene = wheel.scene()?;
    scene.stages.truncate(1);
    let model = Model::new(&scene)?;
    let bound = stability::element_bound(&model)?;
    let mut engine = engine(&model, &scene, Precision::F64, 0)?;
    let rest = step(wheel, "rest", &mut *engine, &model, bound)?;
    run(&scene, &model, &mut *engine, &mut Recorder::default())?;
    let pressed = step(wheel, "pressed", &mut *engine, &model, bound)?;
    Ok([rest, pressed])
}

fn step(
    wheel: &Wheel,
    state: &str,
    engine: &mut dyn Engine,
    model: &Model,
    bound: f64,
) -> Result<CriticalStep> {
    let x = engine.state()?.x;
    let critical = stability::assembled(engine, model, &x, bound, None)?;
    Ok(CriticalStep {
        element: wheel.element.into(),
        elements: model.element_count(),
        viscosity: wheel.viscosity.unwrap_or(0.0),
        state: state.into(),
        edge_over_speed: shortest_edge(model, &x) / (model.law.wave_modulus() / model.density).sqrt(),
        element_bound: bound,
        assembled: critical.dt,
        iterations: critical.iterations,
    })
}

fn shortest_edge(model: &Model, x: &[[f64; 3]]) -> f64 {
    use hexroll::physics::element::hex8::EDGES;
    let length = |a: u32, b: u32| {
        let (a, b) = (x[a as usize], x[b as usize]);
        (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt()
    };
    let of_hex = |hex: &[u32; 8]| {
        EDGES.iter().flatten().map(|&(a, b)| length(hex[a], hex[b])).fold(f64::INFINITY, f64::min)
    };
    model.mesh.hexes.iter().map(of_hex).fold(f64::INFINITY, f64::min)
}

/// The scene's two stages, pressing and rolling, at `safety`.
pub fn rolling(wheel: &Wheel, safety: f64) -> Result<RollingRun> {
    let scene = Scene { safety, ..wheel.scene()? };
    let model = Model::new(&scene)?;
    let mut engine = engine(&model, &scene, Precision::F64, 0)?;
    let mut kept = Recorder::default();
    let outcome = run(&scene, &model, &mut *engine, &mut kept);
    let name = &scene.stages.last().expect("the scene rolls").name;
    let rolled: Vec<Sample> = kept.samples.into_iter().filter(|s| s.stage == *name).collect();
    let half = rolled.len() / 2;
    let last = &rolled[rolled.len().saturating_sub(30)..];
    let mean = |of: fn(&Sample) -> f64| last.iter().map(of).sum::<f64>() / last.len().max(1) as f64;
    let dt = mean(|s| s.dt_s);
    Ok(RollingRun {
        element: wheel.element.into(),
        elements: model.element_count(),
        viscosity: wheel.viscosity.unwrap_or(0.0),
        safety,
        dt,
        steps: if dt > 0.0 { (rolled.len() as f64 * scene.output.sample / dt).round() as u64 } else { 0 },
        work_error: WorstBalance::of(&rolled).share_of_largest_term,
        stored_error: [&rolled[..half], &rolled[half..]]
            .map(|h| WorstBalance::of_stored(h).share_of_largest_term),
        road: [mean(|s| s.road_fx_N), mean(|s| s.road_fz_N)],
        failure: outcome.err().map(|e| e.to_string()),
    })
}
