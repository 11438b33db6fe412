//! The picture: its size, its light, its quality, its files.

use egui::Ui;
use lightloom_core::export::{FrameFormat, FrameLayer};
use lightloom_core::project::{OutputSettings, Project};
use lightloom_core::render::view::ViewSettings;
use lightloom_core::render::{PlateSettings, RenderSettings, ViewTransform};
use lightloom_core::setting::format::number;

use super::control::Control;
use super::control::choice::preset_menu;
use super::shows::file;
use super::widgets::{aside, fold, section};
use crate::editor::action::Action;
use crate::editor::asset::AssetUse;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;

/// Sizes that are asked for often.
const SIZES: &[(&str, [u32; 2])] = &[
    ("HD 1280 x 720", [1280, 720]),
    ("Full HD 1920 x 1080", [1920, 1080]),
    ("UHD 3840 x 2160", [3840, 2160]),
    ("Square 1080 x 1080", [1080, 1080]),
    ("Portrait 1080 x 1920", [1080, 1920]),
];
/// Paces that are asked for often.
const PACES: &[(&str, [u32; 2])] =
    &[("23.976", [24_000, 1001]), ("24", [24, 1]), ("25", [25, 1]), ("30", [30, 1]), ("60", [60, 1])];

const WIDTH: Control = Control::new("Width", RenderSettings::WIDTH).without_suffix();
const HEIGHT: Control = Control::new("Height", RenderSettings::HEIGHT).without_suffix();
const EXPOSURE: Control = Control::new("Exposure", ViewSettings::EXPOSURE).slider(-6.0, 6.0);
const TRANSFORM: Control = Control::new("View", ViewSettings::TRANSFORM).labels(&["AgX", "Standard"]);
const PHOTONS: Control = Control::new("Photons", RenderSettings::PHOTONS).log_slider(1e4, 1e7);
const PASSES: Control = Control::new("Passes", RenderSettings::PASSES).log_slider(1.0, 100.0);
const RADIUS: Control = Control::new("Radius", RenderSettings::RADIUS).log_slider(0.0005, 0.05);
const TEXELS: Control = Control::new("Texels", RenderSettings::MAX_TEXELS).log_slider(64.0, 8192.0);
const CAMERA: Control = Control::new("Camera samples", RenderSettings::CAMERA_SAMPLES).log_slider(1.0, 256.0);
const BACKGROUND: Control =
    Control::new("Background", RenderSettings::BACKGROUND_SAMPLES).log_slider(1.0, 1024.0);
const KEPT: Control = Control::new("Kept in glass", RenderSettings::KEPT_IN_GLASS).slider(0.0, 1.0);
const PLATE: Control = Control::new("Behind", RenderSettings::PLATE).labels(&["The scene", "A plate"]);
const PLATE_FILE: Control = Control::new("Plate", PlateSettings::FILE);
const PLATE_EXPOSURE: Control = Control::new("Plate exposure", PlateSettings::EXPOSURE).slider(-6.0, 6.0);
const FILE: Control = Control::new("File name", OutputSettings::NAME);
const FRAMES: Control = Control::new("Frames", OutputSettings::FRAMES);
const FPS: Control = Control::new("Frames per s", OutputSettings::FPS);
const FORMATS: Control = Control::new("Formats", OutputSettings::FORMATS);
const LAYERS: Control = Control::new("Layers", OutputSettings::LAYERS);
const CONSTRAINTS: Control = Control::new("Constraints on sheets", OutputSettings::DRAWS_CONSTRAINTS);
const BITS: Control = Control::new("PNG bits", OutputSettings::PNG_BITS).labels(&["8", "16"]);
const NAME: Control = Control::new("Project", Project::NAME);
const SEED: Control = Control::new("Seed", Project::SEED).slider(0.0, 100.0);

/// The settings of this panel.
pub(super) const CONTROLS: &[Control] = &[
    WIDTH,
    HEIGHT,
    EXPOSURE,
    TRANSFORM,
    PHOTONS,
    PASSES,
    RADIUS,
    TEXELS,
    CAMERA,
    BACKGROUND,
    KEPT,
    PLATE,
    PLATE_FILE,
    PLATE_EXPOSURE,
    FILE,
    FRAMES,
    FPS,
    FORMATS,
    LAYERS,
    BITS,
    CONSTRAINTS,
    NAME,
    SEED,
];

/// The render panel.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    let mut render = project.render.clone();
    let mut output = project.output.clone();
    section(ui, "Picture");
    size(ui, &mut render);
    EXPOSURE.number(ui, &mut render.view.exposure);
    TRANSFORM.choose(ui, &mut render.view.transform, &[ViewTransform::Agx, ViewTransform::Standard]);
    KEPT.number(ui, &mut render.kept_in_glass);
    plate(ui, editor, &mut render.plate);
    section(ui, "Quality");
    quality(ui, &mut render);
    section(ui, "Files");
    files(ui, project, &mut output);
    fold(ui, "Project", |ui| whole(ui, editor));
    if render != project.render {
        editor.ask(Edit::Render(render));
    }
    if output != project.output {
        editor.ask(Edit::Output(output));
    }
}

fn size(ui: &mut Ui, render: &mut RenderSettings) {
    Control { label: "Size", ..WIDTH }.line(ui, true, |ui| {
        let width = (ui.available_width() - 46.0) / 2.0;
        WIDTH.field(ui, &mut render.width, width, WIDTH.label);
        ui.label("x");
        HEIGHT.field(ui, &mut render.height, width, HEIGHT.label);
        if let Some(taken) = preset_menu(ui, "Sizes", SIZES.iter().map(|(name, _)| *name)) {
            [render.width, render.height] = SIZES[taken].1;
        }
    });
}

/// What stands behind the caustics. A plate begins once its file is picked.
fn plate(ui: &mut Ui, editor: &mut EditorContext, plate: &mut Option<PlateSettings>) {
    match PLATE.pick(ui, usize::from(plate.is_some())) {
        Some(1) => editor.ask(Action::PickFile(AssetUse::Plate)),
        Some(_) => *plate = None,
        None => {}
    }
    let Some(plate) = plate else { return };
    if file(ui, &PLATE_FILE, &plate.file) {
        editor.ask(Action::PickFile(AssetUse::Plate));
    }
    PLATE_EXPOSURE.number(ui, &mut plate.exposure);
}

fn quality(ui: &mut Ui, render: &mut RenderSettings) {
    PHOTONS.number(ui, &mut render.photons);
    PASSES.number(ui, &mut render.passes);
    let all = render.photons.saturating_mul(u64::from(render.passes));
    aside(ui, &format!("{} photons in all", number(all as f64, true)));
    RADIUS.optional(ui, &mut render.radius, "auto", 0.005);
    BACKGROUND.number(ui, &mut render.background_samples);
    CAMERA.number(ui, &mut render.camera_samples);
    TEXELS.number(ui, &mut render.max_texels);
}

fn files(ui: &mut Ui, project: &Project, output: &mut OutputSettings) {
    if let Some(name) = FILE.text(ui, 0, &output.name) {
        output.name = name;
    }
    if let Some(frames) = FRAMES.text(ui, 0, output.frames.as_deref().unwrap_or_default()) {
        output.frames = (!frames.trim().is_empty()).then_some(frames);
    }
    if let Ok(frames) = project.frames() {
        let seconds = frames.len() as f64 * f64::from(output.fps[1]) / f64::from(output.fps[0].max(1));
        aside(
            ui,
            &format!("{} frames, {} s", frames.len(), number((seconds * 100.0).round() / 100.0, false)),
        );
    }
    FPS.line(ui, true, |ui| {
        let width = (ui.available_width() - 46.0) / 2.0;
        FPS.field(ui, &mut output.fps[0], width, "Frames per s, above");
        ui.label("/");
        FPS.field(ui, &mut output.fps[1], width, "Frames per s, below");
        if let Some(taken) = preset_menu(ui, "Paces", PACES.iter().map(|(name, _)| *name)) {
            output.fps = PACES[taken].1;
        }
    });
    FORMATS.line(ui, true, |ui| {
        for format in FrameFormat::ALL {
            let mut on = output.formats.contains(&format);
            let name = format.extension().to_uppercase();
            if ui.checkbox(&mut on, name).on_hover_text(FORMATS.setting.help).changed() {
                toggle(output, format, on);
            }
        }
    });
    LAYERS.line(ui, true, |ui| {
        ui.horizontal_wrapped(|ui| layer_boxes(ui, &mut output.layers, !project.caustics.is_empty()));
    });
    let mut bits = output.png_bits;
    if BITS.choose(ui, &mut bits, &[8, 16]) {
        output.png_bits = bits;
    }
    CONSTRAINTS.toggle(ui, &mut output.draws_constraints);
}

/// A box for each layer of EXR files. That of single caustics can be ticked where some are `named`; one that shows light
/// remains.
pub(in crate::editor) fn layer_boxes(ui: &mut Ui, layers: &mut Vec<FrameLayer>, named: bool) {
    for layer in FrameLayer::ALL {
        let mut on = layers.contains(&layer);
        let able = named || on || layer != FrameLayer::Caustics;
        let tick = ui.add_enabled(able, egui::Checkbox::new(&mut on, layer.name()));
        if tick.on_hover_text(layer.help()).changed() {
            let wanted = |other: &FrameLayer| if *other == layer { on } else { layers.contains(other) };
            let chosen: Vec<_> = FrameLayer::ALL.into_iter().filter(wanted).collect();
            if chosen.iter().any(|layer| *layer != FrameLayer::Depth) {
                *layers = chosen;
            }
        }
    }
}

/// Writes a format or not; one remains.
fn toggle(output: &mut OutputSettings, format: FrameFormat, on: bool) {
    let wanted = |other: &FrameFormat| if *other == format { on } else { output.formats.contains(other) };
    let formats: Vec<_> = FrameFormat::ALL.into_iter().filter(wanted).collect();
    if !formats.is_empty() {
        output.formats = formats;
    }
}

fn whole(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    if let Some(name) = NAME.text(ui, 0, &project.name) {
        editor.ask(Edit::Name(name));
    }
    let mut seed = project.seed;
    if SEED.number(ui, &mut seed) {
        editor.ask(Edit::Seed(seed));
    }
}
