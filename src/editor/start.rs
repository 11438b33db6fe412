//! Opens the window.

use std::path::Path;
use std::sync::Arc;

use eframe::egui;
use lightloom_core::project::ProjectFile;
use lightloom_core::{Result, files};

use super::app::{App, Gpu, Setup};
use super::device::{self, Device};
use super::dialogs::Native;
use super::document::Document;
use super::preview::gpu::{FEATURES, Renderer};
use super::store::{Fingerprint, Folders, Preferences};
use super::templates::{self, TEMPLATES};

/// Maximum size of a project file.
const MOST_BYTES: u64 = 64 << 20;

/// Opens the window with a project or the first example. Returns when it is closed. Where the graphics device is lost
/// meanwhile, the program starts anew; what was not saved is offered for recovery there. In `safe_mode` the stored
/// preferences are neither read nor changed.
///
/// # Errors
/// There is no display, or no graphics device; the system's message.
pub fn run(project: Option<&Path>, safe_mode: bool) -> Result<(), String> {
    if !has_screen() {
        return Err("no screen: neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned());
    }
    let device = Arc::new(Device::default());
    let told = (device::lost_before() > 0).then(|| {
        let text = "The window was opened anew. What was not saved is offered for recovery, and exports that were under way, too.";
        ("The graphics device was lost".to_owned(), text.to_owned())
    });
    let folders = Folders::of_user();
    let stored = folders.as_ref().filter(|_| !safe_mode);
    let (preferences, note) =
        stored.map_or_else(Default::default, |folders| Preferences::load(&folders.config));
    let keeps_preferences = !safe_mode;
    let (document, problem) = first_document(project)?;
    let message =
        problem.or(told).or_else(|| note.map(|note| ("The preferences are reset".to_owned(), note)));
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Lightloom")
            .with_app_id("lightloom")
            .with_icon(icon())
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([720.0, 480.0]),
        wgpu_options: egui_wgpu::WgpuConfiguration { wgpu_setup: wgpu_setup().into(), ..Default::default() },
        ..Default::default()
    };
    let create = move |context: &eframe::CreationContext| {
        let card = context.wgpu_render_state.as_ref();
        let graphics = card.map_or_else(|| "none".to_owned(), described);
        tracing::info!("graphics: {graphics}");
        let gpu = card.map_or(Gpu::None, |card| prepare_gpu(card, &device, &context.egui_ctx));
        let dialogs = Arc::new(Native::over(context));
        let setup = Setup {
            document,
            message,
            folders,
            preferences,
            keeps_preferences,
            dialogs,
            gpu,
            graphics,
            device,
        };
        Ok(Box::new(App::new(&context.egui_ctx, setup)) as Box<dyn eframe::App>)
    };
    eframe::run_native("lightloom", options, Box::new(create)).map_err(|error| in_words(&error))
}

/// Whether a window can be asked for. Only Unix desktops say so in the environment.
fn has_screen() -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos")))
        || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(is_set)
}

/// The cause of a window that does not open, without places in other people's sources.
fn in_words(error: &eframe::Error) -> String {
    match error {
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => {
            "the screen that DISPLAY or WAYLAND_DISPLAY names does not answer".to_owned()
        }
        eframe::Error::Wgpu(_) => {
            "nothing here draws: no graphics device was found (on Linux, Mesa's lavapipe is one: package mesa-vulkan-drivers)"
                .to_owned()
        }
        other => other.to_string(),
    }
}

/// The requested project; where it cannot be read, the first example and a message.
fn first_document(project: Option<&Path>) -> Result<(Document, Option<(String, String)>), String> {
    let problem = match project.map(opened) {
        Some(Ok(document)) => return Ok((document, None)),
        Some(Err(error)) => Some(("The project cannot be opened".to_owned(), error.to_string())),
        None => None,
    };
    let example = templates::folder().map(|folder| ProjectFile::open(&folder.join(TEMPLATES[0].file)));
    match example {
        Some(Ok((file, _))) => Ok((Document::opened(Arc::new(file), None), problem)),
        Some(Err(error)) => Err(error.to_string()),
        None => Err(format!("{}; name a project file", templates::MISSING)),
    }
}

fn opened(path: &Path) -> Result<Document> {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let bytes = files::read_regular_file(&path, MOST_BYTES)?;
    let (file, _) = ProjectFile::parse(&bytes, &path)?;
    Ok(Document::opened(Arc::new(file), Some((path, Fingerprint::of(&bytes)))))
}

fn icon() -> egui::IconData {
    let decoded = image::load_from_memory(include_bytes!("../../assets/icon.png"));
    let picture = decoded.map(image::DynamicImage::into_rgba8).unwrap_or_default();
    egui::IconData { width: picture.width(), height: picture.height(), rgba: picture.into_raw() }
}

/// The default device, with blending of 32-bit floats where supported.
fn wgpu_setup() -> egui_wgpu::WgpuSetupCreateNew {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    let usual = setup.device_descriptor.clone();
    setup.device_descriptor = Arc::new(move |adapter| {
        let mut device = usual(adapter);
        device.required_features |= adapter.features() & FEATURES;
        device
    });
    setup
}

/// Name, kind and driver of a graphics card.
fn described(state: &egui_wgpu::RenderState) -> String {
    let card = state.adapter.get_info();
    let kind = format!("{:?}, {:?}", card.device_type, card.backend);
    format!("{} ({kind}), driver {} {}", card.name, card.driver, card.driver_info)
}

/// Installs the photon renderer, and returns the kind of device.
fn prepare_gpu(state: &egui_wgpu::RenderState, device: &Arc<Device>, ctx: &egui::Context) -> Gpu {
    let (lost, ctx) = (device.clone(), ctx.clone());
    state.device.set_device_lost_callback(move |reason, why| {
        if lost.is_gone(reason) {
            tracing::error!("the graphics device is lost ({reason:?}): {why}");
            ctx.request_repaint();
        }
    });
    let Some(renderer) = Renderer::new(&state.device, state.target_format) else { return Gpu::None };
    state.renderer.write().callback_resources.insert(renderer);
    match state.adapter.get_info().device_type {
        wgpu::DeviceType::Cpu => Gpu::Software,
        _ => Gpu::Hardware,
    }
}

#[cfg(test)]
mod tests {
    use egui_kittest::wgpu::{create_render_state, default_wgpu_setup};

    use super::*;

    #[test]
    fn a_device_that_goes_is_lost_unless_the_window_is_closed() {
        for closed in [false, true] {
            let (state, device) = (
                create_render_state(default_wgpu_setup(), egui_wgpu::RendererOptions::default()),
                Arc::new(Device::default()),
            );
            prepare_gpu(&state, &device, &egui::Context::default());
            assert!(!device.is_lost());
            if closed {
                device.close();
            }
            state.device.destroy();
            // The library tells of it when it looks after its devices.
            let _ = state.device.poll(wgpu::PollType::Poll);
            assert_eq!(device.is_lost(), !closed);
        }
    }
}
