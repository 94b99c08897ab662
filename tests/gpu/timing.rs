//! What is measured of the adapter and of the passes: that timing changes nothing, and that every pass is there.

use crate::rig::{Plan, on_device, safe_step, scene};
use hexroll::engine::Engine;
use hexroll::gpu::limits::Limits;
use hexroll::gpu::{Gpu, Precision};
use hexroll::model::Model;

/// Timed steps are the steps: the same state and window, to the bit; every pass of the step is listed with its bytes,
/// and the passes take no longer than the host waited.
pub fn passes(gpu: &Gpu) {
    let scene = scene("lat100_straight_viscous", &["body.mesh.elements=[20, 3, 3]"]);
    let model = Model::new(&scene).unwrap();
    let mut plan = Plan::of_first_stage(&scene, &model, safe_step(&model), 1, 60);
    let each: &[&str] = &["element_force", "node", "boundary"];
    let with_rim: &[&str] = &["element_force", "rim", "node", "boundary"];
    for (free, resident, expected) in
        [(None, true, &["resident"][..]), (None, false, each), (Some(0.2), true, with_rim)]
    {
        plan.setup.free[2] = free;
        let [mut plain, mut timed] = [0, 1].map(|_| on_device(gpu, &model, &scene, Precision::F32));
        for engine in [&mut plain, &mut timed] {
            engine.begin_stage(&plan.setup).unwrap();
            engine.set_resident(resident).unwrap();
        }
        plain.advance(&plan.windows[0]).unwrap();
        let times = timed.timed_advance(&plan.windows[0]).unwrap();
        assert!(plain.state().unwrap() == timed.state().unwrap(), "timing changes the state");
        assert_eq!(plain.sample(&plan.next).unwrap(), timed.sample(&plan.next).unwrap());
        let names: Vec<&str> = times.passes.iter().map(|p| p.kernel.as_str()).collect();
        assert_eq!(names, expected);
        assert_eq!(times.steps, 60);
        assert!(times.steps_per_submit >= 1);
        let stamps = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        assert!(times.passes.iter().all(|p| p.seconds.is_some() == stamps && p.bytes > 0));
        let sum: f64 = times.passes.iter().filter_map(|p| p.seconds).sum();
        assert!(sum <= times.wall, "passes take {sum} s of {} s", times.wall);
        if stamps {
            assert!(times.passes[0].seconds > Some(0.0), "the element pass takes no time: {times:?}");
        }
    }
}

/// Every limit is a number one can divide by.
pub fn limits(gpu: &Gpu) {
    let limits = Limits::measure(gpu).unwrap();
    crate::rig::note(|| format!("{limits:?}"));
    for value in [limits.copy_bandwidth, limits.flops, limits.dispatch, limits.submit] {
        assert!(value.is_finite() && value > 0.0, "{limits:?}");
    }
    assert!(limits.copied > 0);
}
