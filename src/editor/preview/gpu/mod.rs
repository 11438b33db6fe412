//! The plane's light drawn by a graphics card: photons added up in a float picture, then mapped to the screen.
//!
//! The kernel is the core's quadratic B-spline, evaluated where the core filters a histogram with it; the view transform is
//! the core's own, as a table over the three channels' stops. Half floats would lose up to a fifth of the light of a
//! million photons in the sum, so the picture has 32 bits; a card that cannot blend those leaves the work to the processor.

mod drawing;
mod pipeline;
mod table;

pub use drawing::{Drawing, PhotonColumns};
pub use pipeline::{FEATURES, Renderer};

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
