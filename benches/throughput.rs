//! Whole steps a second of the CPU engine, and of the GPU engine where there is an adapter: `cargo bench --bench throughput`.
//!
//! The paper's wheel, pressed 2.2 mm into the road and then rolled, at several mesh sizes. Every row is timed over
//! repeated batches of steps on one state (forces, assembly, integration, contact, all works booked; no samples), and
//! carries the error of the positions it ended with against the f64 engine that took the same steps: a fast wrong run
//! is a failed run. An idle machine is the caller's business; what ran beside it belongs in the record.
//!
//! Arguments: `--sizes 1,2,4` (multiples of 44 x 4 x 5 in each direction), `--seconds 1.0` a row, `--threads 1,2`,
//! `--gpu` (also the GPU engine), `--elements q1p0,uniform-gradient,full`, `--viscosity 20`.

use hexroll::cpu::{Precision, engine_at};
use hexroll::engine::{Engine, StageSetup, Step};
use hexroll::gpu::{Gpu, GpuEngine};
use hexroll::model::Model;
use hexroll::physics::lanes::Level;
use hexroll::run::stability;
use hexroll::scene::Scene;
use std::path::Path;
use std::time::Instant;

/// Batches of steps timed a row: their minimum, median and maximum are printed.
const BATCHES: usize = 7;

struct Options {
    sizes: Vec<usize>,
    seconds: f64,
    threads: Vec<usize>,
    elements: Vec<String>,
    viscosity: Option<f64>,
    gpu: bool,
}

fn options() -> Options {
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| {
        arguments.iter().position(|a| a == name).and_then(|at| arguments.get(at + 1)).map(String::as_str)
    };
    let list = |name: &str, default: &str| {
        value(name).unwrap_or(default).split(',').map(str::to_string).collect::<Vec<String>>()
    };
    let numbers = |name: &str, default: &str| {
        list(name, default)
            .iter()
            .map(|n| n.parse().unwrap_or_else(|_| panic!("{name} takes numbers")))
            .collect()
    };
    Options {
        sizes: numbers("--sizes", "1,2,4"),
        seconds: value("--seconds").map_or(1.0, |s| s.parse().expect("--seconds takes a number")),
        threads: numbers("--threads", "1,2"),
        elements: list("--elements", "q1p0,uniform-gradient,full"),
        viscosity: value("--viscosity").map(|v| v.parse().expect("--viscosity takes a number")),
        gpu: arguments.iter().any(|a| a == "--gpu"),
    }
}

/// The straight run's wheel, refined.
fn scene(size: usize, element: &str, viscosity: Option<f64>) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_straight.toml");
    let mut set = vec![
        format!("body.mesh.elements=[{}, {}, {}]", 44 * size, 4 * size, 5 * size),
        format!("body.element={element}"),
    ];
    set.extend(viscosity.map(|eta| format!("body.material.viscosity=\"{eta} Pa s\"")));
    Scene::load(&file, &set).expect("the shipped scene loads")
}

/// Steps of a wheel that is pressed while it rolls: after the first batch the footprint is there.
fn plan(model: &Model, dt: f64, first: u64, count: usize) -> Vec<Step> {
    let [x, y, z] = model.mesh.axle;
    let at = |n: u64| {
        let t = n as f64 * dt;
        let depth = 2.2e-3 * (n as f64 / 200.0).min(1.0);
        [x + 2.59 * t, y, z - depth, 0.0, 0.0, 70.0 * t]
    };
    let step = |n: u64| Step {
        time: n as f64 * dt,
        dt,
        dt_before: if n == 0 { 0.0 } else { dt },
        rim: at(n + 1),
        load: [0.0; 6],
    };
    (first..first + count as u64).map(step).collect()
}

struct Timed {
    /// Microseconds a step: least, median, most.
    us: [f64; 3],
    steps: u64,
    x: Vec<[f64; 3]>,
}

/// Times `engine`; with `steps` given, exactly that many are taken instead, untimed (the reference).
fn time(engine: &mut dyn Engine, model: &Model, dt: f64, seconds: f64, steps: Option<u64>) -> Timed {
    engine.begin_stage(&StageSetup::default()).expect("a stage begins");
    let mut taken = 0;
    let mut advance = |count: usize| {
        let begun = Instant::now();
        engine.advance(&plan(model, dt, taken, count)).expect("the bench is stable");
        taken += count as u64;
        begun.elapsed().as_secs_f64() / count as f64
    };
    let mut us = [0.0; 3];
    if let Some(steps) = steps {
        advance(steps as usize);
    } else {
        // Warm up, press, and learn how long a batch must be.
        advance(200);
        let count = ((seconds / BATCHES as f64 / advance(20)) as usize).max(5);
        let mut each: Vec<f64> = (0..BATCHES).map(|_| 1e6 * advance(count)).collect();
        each.sort_by(f64::total_cmp);
        us = [each[0], each[BATCHES / 2], each[BATCHES - 1]];
    }
    Timed { us, steps: taken, x: engine.state().expect("the state is read").x }
}

/// Relative L2 error of the displacements.
fn error(model: &Model, x: &[[f64; 3]], reference: &[[f64; 3]]) -> f64 {
    let square = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>();
    let difference: f64 = x.iter().zip(reference).map(|(a, b)| square(a, b)).sum();
    let norm: f64 = reference.iter().zip(&model.mesh.nodes).map(|(a, b)| square(a, b)).sum();
    (difference / norm).sqrt()
}

fn row(name: &str, model: &Model, dt: f64, seconds: f64, engine: &mut dyn Engine, scene: &Scene) {
    let timed = time(engine, model, dt, seconds, None);
    let mut reference = engine_at(model, scene, Precision::F64, 0, Level::detect());
    let exact = time(&mut *reference, model, dt, seconds, Some(timed.steps));
    println!(
        "{:>9} {:<17} {:<22} {:>9.1} {:>9.1} {:>9.1}  {:>10.3e}  {:>8.1e}  {}",
        model.element_count(),
        match model.element {
            hexroll::scene::Element::Q1p0 => "q1p0",
            hexroll::scene::Element::Full => "full",
            hexroll::scene::Element::UniformGradient { .. } => "uniform-gradient",
        },
        name,
        timed.us[0],
        timed.us[1],
        timed.us[2],
        1e6 * model.element_count() as f64 / timed.us[1],
        error(model, &timed.x, &exact.x),
        timed.steps
    );
}

fn main() {
    let options = options();
    println!("best lanes of this machine: {:?}; viscosity {:?} Pa s", Level::detect(), options.viscosity);
    println!(
        "{:>9} {:<17} {:<22} {:>9} {:>9} {:>9}  {:>10}  {:>8}  steps",
        "elements", "element", "engine", "us min", "median", "max", "updates/s", "error"
    );
    let gpu = if options.gpu { Gpu::open(None).ok() } else { None };
    for &size in &options.sizes {
        for element in &options.elements {
            let scene = scene(size, element, options.viscosity);
            let model = Model::new(&scene).expect("the wheel meshes");
            let dt = 0.9 * stability::element_bound(&model).expect("the wheel has a critical step");
            let levels = [Level::Portable, Level::Avx2, Level::Avx512];
            for &threads in &options.threads {
                for (precision, name) in [(Precision::F64, "f64"), (Precision::F32, "f32")] {
                    for level in levels.into_iter().filter(|l| *l <= Level::detect()) {
                        let mut engine = engine_at(&model, &scene, precision, threads, level);
                        let name = format!("cpu {name} {level:?} x{threads}");
                        row(&name, &model, dt, options.seconds, &mut *engine, &scene);
                    }
                }
            }
            for (plus, name) in [(false, "gpu f32"), (true, "gpu f32+")] {
                if let Some(gpu) = &gpu {
                    let mut engine =
                        GpuEngine::new(gpu, &model, &scene, plus).expect("the wheel fits the adapter");
                    row(name, &model, dt, options.seconds, &mut engine, &scene);
                }
            }
        }
    }
}
