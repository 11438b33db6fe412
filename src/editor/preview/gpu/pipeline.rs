//! Buffers, textures and pipelines on the card.

use std::sync::{Arc, Weak};

use lightloom_core::render::ViewTransform;
use wgpu::util::DeviceExt as _;

use super::drawing::{Drawing, PhotonColumns};
use super::table::{DARKEST, ENTRIES, RANGE, table};

/// What the card must be able to do beside the usual.
pub const FEATURES: wgpu::Features = wgpu::Features::FLOAT32_BLENDABLE;

const LIGHT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Draws photons.
pub struct Renderer {
    photons: wgpu::RenderPipeline,
    screen: wgpu::RenderPipeline,
    screen_layout: wgpu::BindGroupLayout,
    uniforms: wgpu::Buffer,
    photon_group: wgpu::BindGroup,
    sampler: wgpu::Sampler,
    picture: Option<Picture>,
    table: Option<(ViewTransform, wgpu::TextureView)>,
    columns: Option<Uploaded>,
}

/// The float picture of one size.
struct Picture {
    size: [u32; 2],
    view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

/// Photons on the card.
struct Uploaded {
    of: Weak<PhotonColumns>,
    buffer: wgpu::Buffer,
    count: u32,
}

/// As `View` in the shader, with its padding.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniforms {
    size: [f32; 2],
    origin: [f32; 2],
    scale: f32,
    radius: f32,
    corner: [f32; 2],
    extent: [f32; 2],
    _align: [f32; 2],
    gain: [f32; 3],
    _after_gain: f32,
    stops: [f32; 2],
    _end: [f32; 2],
}

impl Renderer {
    /// For pictures shown on targets of `format`, whose values are encoded for the screen. None where the device cannot
    /// blend 32-bit floats.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Option<Self> {
        if !device.features().contains(FEATURES) {
            return None;
        }
        let module = device.create_shader_module(wgpu::include_wgsl!("photons.wgsl"));
        let photon_layout = layout(device, "photons", &[uniform_entry()]);
        let screen_layout = layout(
            device,
            "screen",
            &[
                uniform_entry(),
                texture_entry(1, wgpu::TextureViewDimension::D2, false),
                texture_entry(2, wgpu::TextureViewDimension::D3, true),
                wgpu::BindGroupLayoutEntry {
                    binding: 3,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
            ],
        );
        let uniforms = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: size_of::<Uniforms>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let photon_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("photons"),
            layout: &photon_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Some(Self {
            photons: photon_pipeline(device, &module, &photon_layout),
            screen: screen_pipeline(device, &module, &screen_layout, format),
            screen_layout,
            uniforms,
            photon_group,
            sampler,
            picture: None,
            table: None,
            columns: None,
        })
    }

    /// Adds the photons up in the float picture.
    pub fn gather(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        drawing: &Drawing,
    ) {
        self.prepare_table(device, queue, drawing.transform());
        self.prepare_picture(device, drawing.size);
        self.upload(device, &drawing.photons);
        queue.write_buffer(&self.uniforms, 0, bytemuck::bytes_of(&uniforms(drawing)));
        let (Some(picture), Some(columns)) = (&self.picture, &self.columns) else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("photons"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &picture.view,
                resolve_target: None,
                depth_slice: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.photons);
        pass.set_bind_group(0, &self.photon_group, &[]);
        pass.set_vertex_buffer(0, columns.buffer.slice(..));
        pass.draw(0..4, 0..columns.count);
    }

    /// Maps the float picture to the screen.
    pub fn show(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(picture) = &self.picture else { return };
        pass.set_pipeline(&self.screen);
        pass.set_bind_group(0, &picture.group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn upload(&mut self, device: &wgpu::Device, columns: &Arc<PhotonColumns>) {
        if self.columns.as_ref().is_some_and(|up| std::ptr::eq(up.of.as_ptr(), Arc::as_ptr(columns))) {
            return;
        }
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("photons"),
            // A buffer of nothing cannot be bound.
            contents: if columns.columns.is_empty() {
                &[0; 20]
            } else {
                bytemuck::cast_slice(&columns.columns)
            },
            usage: wgpu::BufferUsages::VERTEX,
        });
        let count = columns.columns.len() as u32;
        self.columns = Some(Uploaded { of: Arc::downgrade(columns), buffer, count });
    }

    fn prepare_table(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, transform: ViewTransform) {
        if self.table.as_ref().is_some_and(|(of, _)| *of == transform) {
            return;
        }
        let texture = device.create_texture_with_data(
            queue,
            &wgpu::TextureDescriptor {
                label: Some("view transform"),
                size: wgpu::Extent3d { width: ENTRIES, height: ENTRIES, depth_or_array_layers: ENTRIES },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D3,
                format: wgpu::TextureFormat::Rgba16Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(&table(transform)),
        );
        self.table = Some((transform, texture.create_view(&Default::default())));
        self.picture = None;
    }

    fn prepare_picture(&mut self, device: &wgpu::Device, size: [u32; 2]) {
        let Some((_, table)) = &self.table else { return };
        if self.picture.as_ref().is_some_and(|picture| picture.size == size) {
            return;
        }
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("light"),
            size: wgpu::Extent3d { width: size[0].max(1), height: size[1].max(1), depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: LIGHT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("screen"),
            layout: &self.screen_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.uniforms.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(table) },
                wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        self.picture = Some(Picture { size, view, group });
    }
}

fn uniforms(drawing: &Drawing) -> Uniforms {
    Uniforms {
        size: drawing.size.map(|n| n as f32),
        origin: drawing.origin.to_array(),
        scale: drawing.scale,
        radius: drawing.photons.radius,
        corner: drawing.corner,
        extent: drawing.extent.to_array(),
        _align: [0.0; 2],
        gain: drawing.gain().to_array(),
        _after_gain: 0.0,
        stops: [DARKEST, RANGE],
        _end: [0.0; 2],
    }
}

fn layout(
    device: &wgpu::Device,
    label: &str,
    entries: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

fn uniform_entry() -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

fn texture_entry(
    binding: u32,
    view_dimension: wgpu::TextureViewDimension,
    filterable: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension,
            multisampled: false,
        },
        count: None,
    }
}

fn pipeline_layout(device: &wgpu::Device, groups: &wgpu::BindGroupLayout) -> wgpu::PipelineLayout {
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(groups)],
        immediate_size: 0,
    })
}

fn photon_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    groups: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("photons"),
        layout: Some(&pipeline_layout(device, groups)),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("photon_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 20,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("photon_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: LIGHT,
                blend: Some(wgpu::BlendState { color: add, alpha: add }),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn screen_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    groups: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("screen"),
        layout: Some(&pipeline_layout(device, groups)),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("screen_vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("screen_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
