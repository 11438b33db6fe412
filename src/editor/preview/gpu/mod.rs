//! The plane's light drawn by a graphics card: photons added up in a float picture, then mapped to the screen.
//!
//! The kernel is the core's quadratic B-spline, evaluated where the core filters a histogram with it; the view transform is
//! the core's own, as a table over the three channels' stops. Half floats would lose up to a fifth of the light of a
//! million photons in the sum, so the picture has 32 bits; a card that cannot blend those leaves the work to the processor.

mod pipeline;
mod table;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use lightloom_core::render::{ViewSettings, ViewTransform};

pub use pipeline::{FEATURES, Renderer};

/// Photons of one moment, ready for the card.
#[derive(Debug, Default)]
pub struct PhotonColumns {
    /// Plane x, plane y, red, green and blue flux [W] of each photon.
    pub columns: Vec<[f32; 5]>,
    /// Radius of the kernel, plane units.
    pub radius: f32,
}

/// What is drawn where.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The photons; the same pointer is uploaded once.
    pub photons: Arc<PhotonColumns>,
    /// Upper left corner of the picture in the window, and its size, pixels.
    pub corner: [f32; 2],
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Pixel of the plane's origin within the picture.
    pub origin: Vec2,
    /// Pixels per plane unit.
    pub scale: f32,
    /// Extent of the plane.
    pub extent: Vec2,
    /// Radiance [W/(sr m^2)] of one watt spread over a square of one plane unit.
    pub radiance: Vec3,
    /// PreviewExposure and view transform.
    pub view: ViewSettings,
}

impl PhotonColumns {
    /// The photons of a moment.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn new(positions: &[Vec2], flux: &[Vec3], radius: f32) -> Self {
        assert_eq!(positions.len(), flux.len(), "one flux per photon");
        let row = |(p, f): (&Vec2, &Vec3)| [p.x, p.y, f.x, f.y, f.z];
        Self { columns: positions.iter().zip(flux).map(row).collect(), radius }
    }
}

impl Drawing {
    /// What the shader multiplies watts per pixel by.
    fn gain(&self) -> Vec3 {
        // A pixel is 1 / scale plane units wide.
        self.radiance * self.scale.powi(2) * self.view.exposure.exp2()
    }

    fn transform(&self) -> ViewTransform {
        self.view.transform
    }
}

impl egui_wgpu::CallbackTrait for Drawing {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _: &egui_wgpu::ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut egui_wgpu::CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(renderer) = resources.get_mut::<Renderer>() {
            renderer.gather(device, queue, encoder, self);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &egui_wgpu::CallbackResources,
    ) {
        if let Some(renderer) = resources.get::<Renderer>() {
            renderer.show(pass);
        }
    }
}
