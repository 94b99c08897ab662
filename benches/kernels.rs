//! Single kernels of the CPU engine, one thread: `cargo bench`. Whole steps of every engine against the machine's limits
//! are `hexroll bench`.
//!
//! `force`: the element pass and the sum at the nodes of 7,040 elements, by precision, formulation and law.
//! `step`: 64 whole steps of 880 elements pressed on the road, by precision, formulation and viscosity.
//! `critical`: the largest eigenvalue of 880 elements, from a cold start.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hexroll::cpu::{Precision, engine_at};
use hexroll::model::Model;
use hexroll::physics::lanes::Level;
use hexroll::run::stability;
use hexroll::scene::Scene;
use hexroll_lab::bench::wheel::{Roll, Wheel};
use hexroll_lab::rig::laws;
use std::time::Duration;

const PRECISIONS: [(Precision, &str); 2] = [(Precision::F64, "f64"), (Precision::F32, "f32")];
const ELEMENTS: [&str; 3] = ["q1p0", "uniform-gradient", "full"];

fn scene(elements: usize, element: &str, viscosity: Option<f64>) -> Scene {
    Wheel { elements, element, contact: true, viscosity }.scene().expect("the shipped scene reads")
}

fn force(c: &mut Criterion) {
    let mut group = c.benchmark_group("force");
    for element in ELEMENTS {
        for law in laws() {
            let mut scene = scene(7_040, element, None);
            scene.body.law = law;
            let model = Model::new(&scene).expect("the wheel meshes");
            group.throughput(Throughput::Elements(model.element_count() as u64));
            let still = vec![[0.0; 3]; model.node_count()];
            for (precision, name) in PRECISIONS {
                let mut engine =
                    engine_at(&model, &scene, precision, 1, Level::detect()).expect("the CPU has it");
                group.bench_function(BenchmarkId::new(format!("{name}/{element}"), law.name()), |b| {
                    b.iter(|| engine.force(&model.mesh.nodes, &still).expect("forces at rest"));
                });
            }
        }
    }
}

fn step(c: &mut Criterion) {
    const STEPS: usize = 64;
    let mut group = c.benchmark_group("step");
    for element in ELEMENTS {
        for viscosity in [None, Some(20.0)] {
            let scene = scene(880, element, viscosity);
            let model = Model::new(&scene).expect("the wheel meshes");
            let roll = Roll::new(&model).expect("the wheel has a critical step");
            group.throughput(Throughput::Elements((STEPS * model.element_count()) as u64));
            for (precision, name) in PRECISIONS {
                let mut engine =
                    engine_at(&model, &scene, precision, 1, Level::detect()).expect("the CPU has it");
                roll.start(&mut *engine, &model).expect("the wheel starts");
                let mut taken = 0;
                let kind = if viscosity.is_some() { "viscous" } else { "elastic" };
                group.bench_function(BenchmarkId::new(format!("{name}/{element}"), kind), |b| {
                    b.iter(|| {
                        let steps = roll.steps(taken, STEPS);
                        engine.advance(&steps).expect("the wheel is stable");
                        taken += STEPS as u64;
                    });
                });
            }
        }
    }
}

fn critical(c: &mut Criterion) {
    let scene = scene(880, "q1p0", None);
    let model = Model::new(&scene).expect("the wheel meshes");
    let mut engine = engine_at(&model, &scene, Precision::F64, 1, Level::detect()).expect("the CPU has f64");
    let guess = stability::element_bound(&model).expect("the wheel has a critical step");
    c.bench_function("critical/f64/q1p0", |b| {
        b.iter(|| {
            stability::assembled(&mut *engine, &model, &model.mesh.nodes, guess, None).expect("it converges")
        });
    });
}

criterion_group! {
    name = kernels;
    config = Criterion::default().warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(600)).sample_size(20);
    targets = force, step, critical
}
criterion_main!(kernels);
