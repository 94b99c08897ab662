//! What WGSL has no double-precision function for, by itself: shaders/real/double.wgsl.

use crate::rig::note;
use hexroll::gpu::Gpu;
use hexroll::gpu::compose::PARTS;
use wgpu::util::DeviceExt;

const MAIN: &str = "
@group(0) @binding(0) var<storage, read> arguments: array<real>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4r>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&arguments) {
        let x = arguments[id.x];
        let positive = exponential(0.08 * x);
        let t = turn(x);
        results[2u * id.x] = vec4r(t.s, t.c, exponential(x), positive);
        results[2u * id.x + 1u] = vec4r(logarithm(positive), recip_cbrt(positive), 0.0, 0.0);
    }
}";

/// Eight numbers for each argument, as the shader computes them.
fn computed(gpu: &Gpu, arguments: &[f64]) -> Vec<[f64; 8]> {
    let (_, double) = PARTS.iter().find(|(name, _)| *name == "real/double").unwrap();
    let text = [double, MAIN].concat();
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let input = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(arguments),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let buffer = |usage| {
        let size = 64 * arguments.len() as u64;
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let output = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let staging = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
        ],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(arguments.len().div_ceil(64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &staging, 0, staging.size());
    gpu.queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    gpu.wait().unwrap();
    let bytes = staging.get_mapped_range(..).unwrap().to_vec();
    bytemuck::cast_slice(&bytes).to_vec()
}

/// Against those of the host, which are good to a unit in the last place, from -60 to 60: eight turns either way. A sum of a
/// dozen terms is good to about four units; a turn is reduced by a product of up to 38 and a quarter turn in two parts (86
/// bits), and what it rounds to near a zero of its sine is measured against one.
pub fn doubles(gpu: &Gpu) {
    let arguments: Vec<f64> = (0..6000).map(|k| -60.0 + 0.02 * f64::from(k) + 1e-3).collect();
    let mut worst = [0.0f64; 6];
    for (x, got) in arguments.iter().zip(computed(gpu, &arguments)) {
        // The arguments of the last two are what the shader computed.
        let positive = got[3];
        let errors = [
            got[0] - x.sin(),
            got[1] - x.cos(),
            got[2] / x.exp() - 1.0,
            got[3] / (0.08 * x).exp() - 1.0,
            (got[4] - positive.ln()) / positive.ln().abs().max(1.0),
            got[5] * positive.cbrt() - 1.0,
        ];
        worst.iter_mut().zip(errors).for_each(|(worst, e)| *worst = worst.max(e.abs()));
    }
    note(|| format!("sin, cos, exp, exp, ln, 1/cbrt: {worst:?}"));
    assert!(worst.iter().all(|e| *e < 1.5e-15), "sin, cos, exp, exp, ln, 1/cbrt: {worst:?}");
}
