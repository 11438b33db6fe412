//! Opens the window on whatever can draw.

use std::path::Path;
use std::sync::Arc;

use eframe::egui;
use lightloom_core::project::Project;

use super::app::App;
use super::document::Document;
use super::preview::gpu::{FEATURES, Renderer};
use super::templates::{self, TEMPLATES};

/// Opens the window, on a project or on the example. Returns when it is closed.
///
/// # Errors
/// There is no screen, or nothing that draws on it; the system's words.
pub fn run(project: Option<&Path>) -> Result<(), String> {
    let document = match project {
        Some(path) => Document::new(Project::load(path).map_err(|e| e.to_string())?, Some(path.to_owned())),
        None => Document::new(templates::load(&TEMPLATES[0]).map_err(|e| e.to_string())?, None),
    };
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Lightloom")
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([720.0, 480.0]),
        wgpu_options: egui_wgpu::WgpuConfiguration { wgpu_setup: setup().into(), ..Default::default() },
        ..Default::default()
    };
    let create = move |context: &eframe::CreationContext| {
        let by_card = context.wgpu_render_state.as_ref().is_some_and(prepare_card);
        Ok(Box::new(App::new(&context.egui_ctx, document, by_card)) as Box<dyn eframe::App>)
    };
    eframe::run_native("lightloom", options, Box::new(create)).map_err(|error| error.to_string())
}

/// The usual device, which shall blend 32-bit floats where it can.
fn setup() -> egui_wgpu::WgpuSetupCreateNew {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    let usual = setup.device_descriptor.clone();
    setup.device_descriptor = Arc::new(move |adapter| {
        let mut device = usual(adapter);
        device.required_features |= adapter.features() & FEATURES;
        device
    });
    setup
}

/// Gives the card what it needs to draw photons; false where it cannot, or is only the processor in disguise: that
/// estimates the light itself two to eighteen times as fast.
fn prepare_card(state: &egui_wgpu::RenderState) -> bool {
    if state.adapter.get_info().device_type == wgpu::DeviceType::Cpu {
        return false;
    }
    let Some(renderer) = Renderer::new(&state.device, state.target_format) else { return false };
    state.renderer.write().callback_resources.insert(renderer);
    true
}
