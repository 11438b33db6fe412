//! The picture: its size, its light, its quality, its files.

use egui::Ui;
use lightloom_core::export::FrameFormat;
use lightloom_core::project::{OutputSettings, Project};
use lightloom_core::render::{RenderSettings, ViewTransform};

use super::setting::{Choice, Setting, format_number, presets};
use super::{aside, fold, section};
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

const SIZE: Setting =
    Setting::part("Size", "render").help("Width and height of the picture in pixels, each 16 to 16384.");
const WIDTH: Setting = Setting::whole("Width", "render.width", [16.0, 16_384.0], &[1280.0])
    .help("Width of the picture in pixels.");
const HEIGHT: Setting = Setting::whole("Height", "render.height", [16.0, 16_384.0], &[720.0])
    .help("Height of the picture in pixels.");
const EXPOSURE: Setting = Setting::real("Exposure", "render.view.exposure", [-32.0, 32.0], &[0.0])
    .unit("EV")
    .slider(-6.0, 6.0)
    .help("Brightness of the PNG pictures and the preview: each stop doubles the light. EXR files hold it unchanged.");
const TRANSFORM: Setting = Setting::choice(
    "View",
    "render.view.transform",
    &[
        Choice::new("agx", "AgX", "filmic: bright light bleaches towards white"),
        Choice::new("standard", "Standard", "the plain sRGB curve, clipped at white"),
    ],
)
.help("How light becomes the colours of a screen.");
const PHOTONS: Setting = Setting::whole("Photons", "render.photons", [1.0, 1e8], &[1e6])
    .slider(1e4, 1e7)
    .logarithmic()
    .help("Photons in each pass. More give less noise and need more memory.");
const PASSES: Setting = Setting::whole("Passes", "render.passes", [1.0, 100_000.0], &[8.0])
    .slider(1.0, 100.0)
    .logarithmic()
    .help("Passes, each with photons of its own: with each the noise falls and the caustic sharpens. Time grows alike.");
const RADIUS: Setting = Setting::real("Radius", "render.radius", [0.0, 0.5], &[])
    .above()
    .slider(0.0005, 0.05)
    .logarithmic()
    .help("Radius of the kernel in the first pass, as a share of the plane's longer side. Larger is smoother, smaller sharper and noisier.");
const TEXELS: Setting = Setting::whole("Texels", "render.max_texels", [64.0, 8192.0], &[2048.0])
    .logarithmic()
    .help("Most texels of the light along the plane's longer side. Raise it only for large pictures of a near plane.");
const CAMERA: Setting = Setting::whole("Camera samples", "render.camera_samples", [1.0, 4096.0], &[16.0])
    .slider(1.0, 256.0)
    .logarithmic()
    .help("Samples of each pixel towards the plane. More smooth the edges of glass.");
const BACKGROUND: Setting = Setting::whole(
    "Background",
    "render.background_samples",
    [1.0, 65_536.0],
    &[16.0],
)
.slider(1.0, 1024.0)
.logarithmic()
.help("First light paths of each pixel of the picture without caustics. More give less noise around them.");
const FILE: Setting = Setting::text("File name", "output.name").help(
    "Name of the files without ending; #### or %04d stands for the number of the frame. Default frame.####",
);
const FRAMES: Setting = Setting::text("Frames", "output.frames")
    .help("Frames to render, such as 1-100x5,120. Empty for all from the first key frame to the last.");
const FPS: Setting = Setting::whole("Frames per s", "output.fps", [1.0, 1e6], &[24.0, 1.0])
    .help("Frames per second as a fraction: 24000 over 1001 is 23.976.");
const FORMATS: Setting = Setting::part("Formats", "output.formats").help(
    "EXR holds the light itself in layers, for compositing; PNG shows it as on a screen. Default both.",
);
const BITS: Setting = Setting::choice(
    "PNG bits",
    "output.png_bits",
    &[Choice::new("8", "8", "small files"), Choice::new("16", "16", "smooth dark gradients, larger files")],
)
.help("Bits of each channel of PNG files.");
const NAME: Setting = Setting::text("Project", "name").help("What the project is called.");
const SEED: Setting = Setting::whole("Seed", "seed", [0.0, 9_007_199_254_740_991.0], &[1.0])
    .slider(0.0, 100.0)
    .help("Seed of all random numbers: the same seed gives the same bytes, another one other noise.");

/// The settings of this panel.
pub(super) const SETTINGS: &[Setting] = &[
    SIZE, WIDTH, HEIGHT, EXPOSURE, TRANSFORM, PHOTONS, PASSES, RADIUS, TEXELS, CAMERA, BACKGROUND, FILE,
    FRAMES, FPS, FORMATS, BITS, NAME, SEED,
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
    SIZE.line(ui, true, |ui| {
        let width = (ui.available_width() - 46.0) / 2.0;
        WIDTH.field(ui, &mut render.width, width, WIDTH.name);
        ui.label("x");
        HEIGHT.field(ui, &mut render.height, width, HEIGHT.name);
        if let Some(taken) = presets(ui, "Sizes", SIZES.iter().map(|(name, _)| *name)) {
            [render.width, render.height] = SIZES[taken].1;
        }
    });
}

fn quality(ui: &mut Ui, render: &mut RenderSettings) {
    PHOTONS.number(ui, &mut render.photons);
    PASSES.number(ui, &mut render.passes);
    let all = render.photons.saturating_mul(u64::from(render.passes));
    aside(ui, &format!("{} photons in all", format_number(all as f64, true)));
    RADIUS.optional(ui, &mut render.radius, "auto", 0.005);
    BACKGROUND.number(ui, &mut render.background_samples);
    CAMERA.number(ui, &mut render.camera_samples);
    TEXELS.number(ui, &mut render.max_texels);
}

fn files(ui: &mut Ui, project: &Project, output: &mut OutputSettings) {
    if let Some(name) = FILE.words(ui, 0, &output.name) {
        output.name = name;
    }
    if let Some(frames) = FRAMES.words(ui, 0, output.frames.as_deref().unwrap_or_default()) {
        output.frames = (!frames.trim().is_empty()).then_some(frames);
    }
    if let Ok(frames) = project.frames() {
        let seconds = frames.len() as f64 * f64::from(output.fps[1]) / f64::from(output.fps[0].max(1));
        aside(
            ui,
            &format!(
                "{} frames, {} s",
                frames.len(),
                format_number((seconds * 100.0).round() / 100.0, false)
            ),
        );
    }
    FPS.line(ui, true, |ui| {
        let width = (ui.available_width() - 46.0) / 2.0;
        FPS.field(ui, &mut output.fps[0], width, "Frames per s, above");
        ui.label("/");
        FPS.field(ui, &mut output.fps[1], width, "Frames per s, below");
        if let Some(taken) = presets(ui, "Paces", PACES.iter().map(|(name, _)| *name)) {
            output.fps = PACES[taken].1;
        }
    });
    FORMATS.line(ui, true, |ui| {
        for format in FrameFormat::ALL {
            let mut on = output.formats.contains(&format);
            let name = format.extension().to_uppercase();
            if ui.checkbox(&mut on, name).on_hover_text(FORMATS.help).changed() {
                toggle(output, format, on);
            }
        }
    });
    let mut bits = output.png_bits;
    if BITS.choose(ui, &mut bits, &[8, 16]) {
        output.png_bits = bits;
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
    if let Some(name) = NAME.words(ui, 0, &project.name) {
        editor.ask(Edit::Name(name));
    }
    let mut seed = project.seed;
    if SEED.number(ui, &mut seed) {
        editor.ask(Edit::Seed(seed));
    }
}
