//! The off-screen part: one device, three pipelines, one picture at a time.

use bytemuck::{Pod, Zeroable};
use image::RgbaImage;
use wgpu::util::DeviceExt;

use super::pipeline::{COLOUR, DEPTH, SAMPLES, bind_group_layout, buffer_layout, pipeline};
use crate::{Error, Result};

/// A corner of a triangle; `paint` is a linear colour, or (place on the colour bar, 0, 0).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub paint: [f32; 3],
}

/// A segment with a linear colour (and opacity) and a width [pixels].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Segment {
    pub from: [f32; 3],
    pub to: [f32; 3],
    pub colour: [f32; 4],
    pub width: f32,
}

/// `View` of `view.wgsl`, field by field.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ViewUniform {
    pub clip: [[f32; 4]; 4],
    pub eye: [f32; 4],
    pub light: [f32; 4],
    pub size: [f32; 2],
    pub lift: f32,
    pub unused: f32,
}

/// Everything a picture shows in three dimensions, in the picture's own frame.
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    pub plain: Vec<Vertex>,
    pub mapped: Vec<Vertex>,
    pub segments: Vec<Segment>,
}

/// A part of the picture, in pixels from the top left: the only part that is drawn to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// A device with the pipelines of all pictures.
#[derive(Debug)]
pub struct Gpu {
    adapter: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    plain: wgpu::RenderPipeline,
    mapped: wgpu::RenderPipeline,
    line: wgpu::RenderPipeline,
}

impl Gpu {
    /// Opens `adapter`, or whichever the system puts first.
    pub fn new(adapter: Option<wgpu::Adapter>) -> Result<Gpu> {
        let adapter = adapter.map_or_else(any_adapter, Ok)?;
        let name = adapter.get_info().name;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("pictures"),
            required_limits: wgpu::Limits {
                max_buffer_size: adapter.limits().max_buffer_size,
                ..wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits())
            },
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| Error::Device { adapter: name.clone(), detail: e.to_string() })?;
        let layout = bind_group_layout(&device);
        let view = include_str!("../../shaders/render/view.wgsl");
        let surface = include_str!("../../shaders/render/surface.wgsl");
        let mapped = include_str!("../../shaders/render/mapped.wgsl");
        let line = include_str!("../../shaders/render/line.wgsl");
        let vertex = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3];
        let triangles = buffer_layout::<Vertex>(wgpu::VertexStepMode::Vertex, &vertex);
        let segment = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32];
        let lines = buffer_layout::<Segment>(wgpu::VertexStepMode::Instance, &segment);
        let make = |code: &[&str], entries, buffers, strip| {
            pipeline(&device, &layout, &code.concat(), entries, buffers, strip)
        };
        Ok(Gpu {
            plain: make(&[view, surface], ["place", "plain"], triangles.clone(), false),
            mapped: make(&[view, surface, mapped], ["place", "mapped"], triangles, false),
            line: make(&[view, line], ["stretch", "ink"], lines, true),
            adapter: name,
            device,
            queue,
            layout,
        })
    }

    /// Name of the adapter that draws.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Longest side of a picture [pixels].
    pub fn largest(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Draws `geometry` on white; `map` is the colour bar from its lower to its upper end (sRGB).
    pub fn draw(
        &self,
        [width, height]: [u32; 2],
        frame: Frame,
        view: &ViewUniform,
        map: &[[u8; 4]],
        geometry: &Geometry,
    ) -> Result<RgbaImage> {
        self.check_memory(geometry)?;
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let target = |format, samples, usage| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("picture"),
                size,
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let samples = target(COLOUR, SAMPLES, wgpu::TextureUsages::empty());
        let depth = target(DEPTH, SAMPLES, wgpu::TextureUsages::empty());
        let picture = target(COLOUR, 1, wgpu::TextureUsages::COPY_SRC);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.record(&mut encoder, [&samples, &depth, &picture], frame, view, map, geometry);
        self.read(encoder, &picture, size)
    }

    /// Whether the adapter can hold the geometry; wgpu would end the program over a buffer too large.
    fn check_memory(&self, geometry: &Geometry) -> Result<()> {
        let need = size_of_val(&geometry.plain[..])
            .max(size_of_val(&geometry.mapped[..]))
            .max(size_of_val(&geometry.segments[..])) as u64;
        let limit = self.device.limits().max_buffer_size;
        if need <= limit {
            return Ok(());
        }
        let problem = format!("it needs a buffer of {need} bytes, {} offers {limit}", self.adapter);
        Err(Error::Picture { problem })
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: [&wgpu::Texture; 3],
        frame: Frame,
        view: &ViewUniform,
        map: &[[u8; 4]],
        geometry: &Geometry,
    ) {
        let bindings = self.bindings(view, map);
        let plain = self.vertices(bytemuck::cast_slice(&geometry.plain));
        let mapped = self.vertices(bytemuck::cast_slice(&geometry.mapped));
        let segments = self.vertices(bytemuck::cast_slice(&geometry.segments));
        let [samples, depth, picture] = targets.map(|t| t.create_view(&Default::default()));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &samples,
                depth_slice: None,
                resolve_target: Some(&picture),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_scissor_rect(frame.x, frame.y, frame.width, frame.height);
        pass.set_bind_group(0, &bindings, &[]);
        for (pipeline, buffer, corners) in
            [(&self.plain, &plain, geometry.plain.len()), (&self.mapped, &mapped, geometry.mapped.len())]
        {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..corners as u32, 0..1);
        }
        pass.set_pipeline(&self.line);
        pass.set_vertex_buffer(0, segments.slice(..));
        pass.draw(0..4, 0..geometry.segments.len() as u32);
    }

    /// A vertex buffer; never empty, since an empty one cannot be bound.
    fn vertices(&self, bytes: &[u8]) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("vertices"),
            contents: if bytes.is_empty() { &[0; 64] } else { bytes },
            usage: wgpu::BufferUsages::VERTEX,
        })
    }

    fn bindings(&self, view: &ViewUniform, map: &[[u8; 4]]) -> wgpu::BindGroup {
        let uniform = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("view"),
            contents: bytemuck::bytes_of(view),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let texture = self.device.create_texture_with_data(
            &self.queue,
            &wgpu::TextureDescriptor {
                label: Some("colour map"),
                size: wgpu::Extent3d { width: map.len() as u32, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: COLOUR,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(map),
        );
        let sampler = self.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let texture = texture.create_view(&Default::default());
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.layout,
            entries: &[
                entry(0, uniform.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&texture)),
                entry(2, wgpu::BindingResource::Sampler(&sampler)),
            ],
        })
    }

    /// Copies the finished picture to the host; rows on the device are padded to 256 bytes.
    fn read(
        &self,
        mut encoder: wgpu::CommandEncoder,
        picture: &wgpu::Texture,
        size: wgpu::Extent3d,
    ) -> Result<RgbaImage> {
        let row = 4 * size.width;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture on the host"),
            size: u64::from(padded) * u64::from(size.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded),
            rows_per_image: Some(size.height),
        };
        encoder.copy_texture_to_buffer(
            picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            size,
        );
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only when this function has already failed.
            let _ = sender.send(result);
        });
        let failed = |detail: String| Error::Device { adapter: self.adapter.clone(), detail };
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(e.to_string()))?;
        receiver.recv().map_err(|e| failed(e.to_string()))?.map_err(|e| failed(e.to_string()))?;
        let mapped = buffer.get_mapped_range(..).map_err(|e| failed(e.to_string()))?;
        let rows = mapped.chunks_exact(padded as usize).flat_map(|r| &r[..row as usize]);
        RgbaImage::from_raw(size.width, size.height, rows.copied().collect())
            .ok_or_else(|| failed("the picture came back incomplete".into()))
    }
}

/// The adapter the system prefers, else any software one.
fn any_adapter() -> Result<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    }))
    .map_err(|e| Error::NoAdapter { detail: e.to_string() })
}
