//! What goes wrong comes back as an error that says what, where and when; nothing panics.

use crate::rig::{Plan, Who, drive, engine, note, on_device, safe_step, scene};
use hexroll::Error;
use hexroll::engine::Engine;
use hexroll::gpu::{Gpu, GpuEngine, Precision};
use hexroll::model::Model;
use hexroll::record::{Sample, Snapshot};
use hexroll::run::{Observer, Progress, stability};
use hexroll::scene::Scene;
use hexroll_lab::rig::{Recorder, simulate_on};

/// Step, element, and whether a value is not finite (else: inverted).
fn place(error: &Error) -> (u64, usize, bool) {
    match *error {
        Error::Inverted { step, element, time } => {
            assert!(time.is_finite());
            (step, element, false)
        }
        Error::NotFinite { step, element, time } => {
            assert!(time.is_finite());
            (step, element, true)
        }
        ref other => panic!("another error: {other}"),
    }
}

fn failure(gpu: &Gpu, who: Who, model: &Model, scene: &Scene, plan: &Plan) -> (u64, usize, bool) {
    let mut engine = engine(gpu, who, model, scene);
    let found = match drive(&mut *engine, plan) {
        Ok(_) => panic!("{who:?}: nothing went wrong"),
        Err(error) => place(&error),
    };
    // Whatever it answers now, it answers.
    let _ = (engine.state(), engine.sample(&plan.next), engine.force(&model.mesh.nodes, &model.mesh.nodes));
    note(|| format!("{who:?}: {found:?}"));
    found
}

pub fn failures(gpu: &Gpu) {
    for viscosity in ["0 Pa s", "20 Pa s"] {
        let scene = scene("spinning_block", &[&format!("body.material.viscosity=\"{viscosity}\"")]);
        let model = Model::new(&scene).unwrap();
        not_finite(gpu, &scene, &model);
        inverted(gpu, &scene, &model);
    }
}

/// A block thrown onto an edge: in either precision the run ends with the row that is beyond the limit.
pub fn hourglass(gpu: &Gpu) {
    let sets = [
        "body.element=uniform-gradient",
        "body.hourglass_limit=0.02",
        "body.mesh.elements=[3, 3, 3]",
        "road={ normal = [-1, -2, 2], point = [\"20 mm\", \"20 mm\", \"0 mm\"] }",
    ];
    let scene = scene("bouncing_block", &sets);
    let model = Model::new(&scene).unwrap();
    for who in [Who::Cpu64, Who::Gpu, Who::Plus] {
        let mut kept = Recorder::default();
        let result = simulate_on(&scene, &model, &mut *engine(gpu, who, &model, &scene), &mut kept);
        let Err(Error::Hourglass { time, share, .. }) = result else { panic!("{who:?}: no such error") };
        let last = kept.samples.last().unwrap();
        assert_eq!((last.time_s, last.hourglass_J / last.strain_J), (time, share));
    }
}

/// One node starts with a velocity that is not a number. Its position is NaN after the first step; a viscous element
/// sees the velocity itself, in the first.
fn not_finite(gpu: &Gpu, scene: &Scene, model: &Model) {
    let node = 57;
    let mut plan =
        Plan::of_first_stage(scene, model, safe_step(model), 3, 20).starting(model, |_| [1.0; 3], [0.0; 6]);
    plan.velocity.as_mut().unwrap().0[node] = [0.0, f64::NAN, 0.0];
    let seen = u64::from(model.viscosity.is_none());
    let first = model.mesh.hexes.iter().position(|h| h.contains(&(node as u32))).unwrap();
    for who in [Who::Gpu, Who::Plus] {
        assert_eq!(failure(gpu, who, model, scene, &plan), (seen, first, true), "{who:?}");
    }
    // The CPU looks at determinants alone, so it always meets the NaN in the second step, maybe with a neighbour.
    let (step, element, nan) = failure(gpu, Who::Cpu64, model, scene, &plan);
    assert!(nan && step == 1 && element <= first);
}

/// Steps 5 % too long: the highest mode grows until an element is inside out. Every engine grows it from its own
/// rounding too, so that steps may differ a little; and a whole run with safety = 1.5 ends the same way.
fn inverted(gpu: &Gpu, scene: &Scene, model: &Model) {
    let mut cpu = engine(gpu, Who::Cpu64, model, scene);
    let critical = stability::assembled(&mut *cpu, model, &model.mesh.nodes, safe_step(model), None).unwrap();
    let plan = Plan::of_first_stage(scene, model, 1.05 * critical.dt, 10, 100);
    let field = |x: [f64; 3]| [0.5 * (x[0] / 0.01).sin(), -0.5 * x[2] / 0.03, 0.3 * (x[1] / 0.02).cos()];
    let plan = plan.starting(model, field, [0.0; 6]);
    let (exact, ..) = failure(gpu, Who::Cpu64, model, scene, &plan);
    assert!(exact > 10, "the instability takes only {exact} steps");
    for who in [Who::Cpu32, Who::Gpu, Who::Plus] {
        let (step, element, _) = failure(gpu, who, model, scene, &plan);
        assert!(element < model.element_count());
        assert!(step.abs_diff(exact) <= exact / 10 + 2, "{who:?} fails at {step}, the CPU at {exact}");
    }
    let hasty = Scene { safety: 1.5, ..scene.clone() };
    for who in [Who::Cpu64, Who::Gpu, Who::Plus] {
        let mut engine = engine(gpu, who, model, &hasty);
        let Err(error) = hexroll::run::run(&hasty, model, &mut *engine, &mut Nobody) else {
            panic!("{who:?}: a run with safety 1.5 goes well")
        };
        let (step, element, _) = place(&error);
        note(|| format!("{who:?}, whole run: {error}"));
        assert!(step < 5_000 && element < model.element_count(), "{who:?}: {error}");
    }
}

/// Listens to nothing.
struct Nobody;

impl Observer for Nobody {
    fn sample(&mut self, _: &Sample, _: &Progress) -> hexroll::Result<()> {
        Ok(())
    }

    fn snapshot(&mut self, _: &Snapshot, _: &str) -> hexroll::Result<()> {
        Ok(())
    }
}

/// An adapter that binds little: the scene is refused before anything starts, with a size that fits.
pub fn limits(gpu: &Gpu) {
    let scene = scene("spinning_block", &["body.mesh.elements=[16, 16, 4]"]);
    let model = Model::new(&scene).unwrap();
    let mut small = gpu.clone();
    small.report.storage_binding = 40_000;
    let Err(Error::TooLarge { need, limit, fits, adapter, .. }) =
        GpuEngine::new(&small, &model, &scene, Precision::F32)
    else {
        panic!("1,024 elements fit into 40 kB");
    };
    assert!(need > limit && limit == 40_000 && adapter == gpu.report.name);
    assert!(fits > 0 && fits < 1024, "{fits} elements are said to fit");
    // A block of no more elements than that does fit.
    let scene = crate::rig::scene("spinning_block", &["body.mesh.elements=[8, 8, 4]"]);
    assert!(
        256 <= fits && GpuEngine::new(&small, &Model::new(&scene).unwrap(), &scene, Precision::F32).is_ok()
    );
    flat(gpu);
}

/// An adapter without double precision says so.
pub fn no_doubles(gpu: &Gpu) {
    let scene = scene("spinning_block", &[""; 0]);
    let mut single = gpu.clone();
    single.report.doubles = false;
    match GpuEngine::new(&single, &Model::new(&scene).unwrap(), &scene, Precision::F64) {
        Err(Error::Unsupported { what, instead }) => {
            assert!(what.contains(&gpu.report.name) && instead.contains("f32"), "{what}: {instead}");
        }
        Err(other) => panic!("another error: {other}"),
        Ok(_) => panic!("double precision on an adapter without it"),
    }
}

/// A flat block is mostly surface: what a sample brings back is larger than any binding.
fn flat(gpu: &Gpu) {
    let scene = scene("pressed_block", &["body.mesh.elements=[40, 40, 1]"]);
    let scene = Scene { rim: None, ..scene };
    let mut small = gpu.clone();
    small.report.buffer = 250_000;
    match GpuEngine::new(&small, &Model::new(&scene).unwrap(), &scene, Precision::F32) {
        Err(Error::TooLarge { limit: 250_000, need, fits, .. }) => assert!(need > 250_000 && fits < 1600),
        Err(other) => panic!("another error: {other}"),
        Ok(_) => panic!("3,362 nodes come back through 250 kB"),
    }
}

/// A device of the same adapter that wgpu opens with `limits`, while the report keeps saying what the adapter offers.
fn device_with(gpu: &Gpu, limits: wgpu::Limits) -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let adapter = adapters.into_iter().find(|a| a.get_info().name == gpu.report.name).unwrap();
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    Gpu::from_parts(device, queue, gpu.report.clone())
}

fn refused<T>(what: &str, result: hexroll::Result<T>) {
    match result {
        Err(Error::Device { adapter, detail }) => {
            note(|| format!("{what}: {}", detail.lines().next().unwrap_or("")));
            assert!(!adapter.is_empty() && !detail.is_empty());
        }
        Err(other) => panic!("{what}: another error: {other}"),
        Ok(_) => panic!("{what}: no error"),
    }
}

pub fn device_errors(gpu: &Gpu) {
    let scene = scene("lat100_straight", &[""; 0]);
    let model = Model::new(&scene).unwrap();
    let most = gpu.device.limits();
    let bindings = wgpu::Limits { max_storage_buffer_binding_size: 65_536, ..most.clone() };
    refused("bindings", GpuEngine::new(&device_with(gpu, bindings), &model, &scene, Precision::F32));
    let buffers =
        wgpu::Limits { max_storage_buffer_binding_size: 65_536, max_buffer_size: 65_536, ..most.clone() };
    refused("buffers", GpuEngine::new(&device_with(gpu, buffers), &model, &scene, Precision::F32));
    let few = wgpu::Limits { max_storage_buffers_per_shader_stage: 8, ..most.clone() };
    refused("storage buffers", {
        let gpu = device_with(gpu, few);
        GpuEngine::new(&gpu, &model, &scene, Precision::F32)
            .and_then(|mut e| e.begin_stage(&Default::default()))
    });
    lost(&device_with(gpu, most), &scene, &model);
}

/// A device that goes away between two windows.
fn lost(gpu: &Gpu, scene: &Scene, model: &Model) {
    let mut engine = on_device(gpu, model, scene, Precision::F32);
    let plan = Plan::of_first_stage(scene, model, safe_step(model), 2, 10);
    engine.begin_stage(&plan.setup).unwrap();
    engine.advance(&plan.windows[0]).unwrap();
    gpu.device.destroy();
    refused("advance", engine.advance(&plan.windows[1]));
    refused("sample", engine.sample(&plan.next));
    refused("state", engine.state());
    refused("force", engine.force(&model.mesh.nodes, &model.mesh.nodes));
}
