//! Histories at a high rate: the GPU's are the CPU's.

use hexroll::cpu::{self, Precision as CpuPrecision};
use hexroll::gpu::{Gpu, GpuEngine, Precision};
use hexroll::model::Model;
use hexroll::record::History;
use hexroll::run;
use hexroll::scene::Scene;
use hexroll_lab::rig::Recorder;

/// A small wheel that rolls on a road with friction; its tread is taken down at nodes, and at places that do not turn.
const WHEEL: &str = r#"
title = "wheel"
[body]
density = "1100 kg/m3"
[body.mesh]
generator = "ring"
outer_radius = "39 mm"
inner_radius = "17 mm"
width = "17.5 mm"
elements = [16, 2, 2]
[body.material]
law = "mooney-rivlin"
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
viscosity = "20 Pa s"
[rim]
nodes = "inner"
[road]
shape = "plane"
[friction]
coefficient = 0.5
[[stage]]
name = "roll"
method = "explicit"
duration = "4 ms"
initial_velocity = "rim"
[stage.rim]
x = { velocity = "2.59 m/s" }
z = { displacement = "-1 mm", ramp = "4 ms" }
spin = { velocity = "70 rad/s" }
[output]
sample = "1 ms"
[[output.history]]
name = "nodes"
nodes = "outer"
quantities = ["displacement", "velocity", "contact-force"]
[[output.history]]
name = "places"
nodes = "outer"
turning = false
quantities = ["velocity", "displacement"]
"#;

pub fn as_the_cpus(gpu: &Gpu) {
    let scene = Scene::parse(WHEEL, "wheel.toml", &[]).unwrap();
    let model = Model::new(&scene).unwrap();
    let mut on_cpu = Recorder::default();
    let mut engine = cpu::engine(&model, &scene, CpuPrecision::F64, 1).unwrap();
    run::run(&scene, &model, &mut *engine, &mut on_cpu).unwrap();
    let mut on_gpu = Recorder::default();
    let mut engine = GpuEngine::new(gpu, &model, &scene, Precision::F32).unwrap();
    run::run(&scene, &model, &mut engine, &mut on_gpu).unwrap();
    for (cpu, gpu) in on_cpu.histories.iter().zip(&on_gpu.histories) {
        let still = |h: &History| History { values: Vec::new(), road_force: None, ..h.clone() };
        assert_eq!(still(cpu), still(gpu));
        assert!(cpu.times.len() > 70);
        for (a, b) in cpu.values.iter().zip(&gpu.values) {
            let largest = a.values.iter().map(|v| v.abs()).fold(0.0, f32::max);
            let off = a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            // Single precision over 300 steps; nodes land within a step of each other, which moves a node's force by a
            // share of what it is in a step, filtered over seven of them.
            let allowed = if a.name == "contact-force" { 2e-2 } else { 1e-3 };
            assert!(largest > 0.0 && off < allowed * largest, "{} {}: {off} of {largest}", cpu.name, a.name);
        }
    }
    // Forces of nodes add up to those of the road, which the device sums by itself.
    let history = &on_gpu.histories[0];
    let (force, road) = (&history.values[2], history.road_force.as_ref().unwrap());
    let largest = road.iter().map(|f| f.abs()).fold(0.0, f32::max);
    for (row, total) in force.values.chunks_exact(3 * history.nodes.len()).zip(road.chunks_exact(3)) {
        for d in 0..3 {
            let sum: f32 = row.iter().skip(d).step_by(3).sum();
            // Differences of sums of a window, in single precision.
            assert!((sum - total[d]).abs() < 1e-3 * largest, "{sum} {}", total[d]);
        }
    }
}
