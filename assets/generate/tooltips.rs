//! Renders the small pictures of the window's tooltips and presets from the example projects:
//! `cargo run --release -p lightloom_assets --bin lightloom_tooltips`; words behind it choose those whose names hold one.
//!
//! They are pictures of the program's own light, so they change a little with the machine; what is committed is what one
//! machine made.

use std::error::Error;
use std::path::Path;

use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops;
use lightloom_core::Progress;
use lightloom_core::constraint::{Constraint, DirectedLine};
use lightloom_core::engine::Engine;
use lightloom_core::export::FrameFormat;
use lightloom_core::flow::{Fade, FitKind, GridSize, MotionMethod, TurbulenceSettings};
use lightloom_core::project::{AssetFolder, Project, Shows};
use lightloom_core::targets::{ImageTarget, Placement};

/// Pixels of a picture.
const SIZE: [u32; 2] = [160, 100];
/// The whole plane is rendered so much larger.
const LARGER: u32 = 4;
/// The part that is cut out: left, top, width, height, as shares of the plane's width and height.
const PART: [f32; 4] = [0.17, 0.19, 0.54, 0.54];
/// Frame in the middle of the way.
const MOMENT: &str = "30";
/// The file of that frame.
const FILE: &str = "tooltip.0030.png";

/// One picture: its file, and what it changes of the scene of all of them.
struct Picture {
    name: &'static str,
    change: fn(&mut Project),
}

const PICTURES: &[Picture] = &[
    Picture { name: "gamma_low", change: |p| p.flow.gamma = 0.0 },
    Picture { name: "gamma_middle", change: |p| p.flow.gamma = 0.5 },
    Picture { name: "gamma_high", change: |p| p.flow.gamma = 1.0 },
    Picture { name: "alpha_low", change: |p| p.flow.alpha = 1e-6 },
    Picture { name: "alpha_middle", change: |p| p.flow.alpha = 1e-3 },
    Picture { name: "alpha_high", change: |p| p.flow.alpha = 1.0 },
    Picture { name: "beta_low", change: |p| with_line(p, 0.0) },
    Picture { name: "beta_middle", change: |p| with_line(p, 1.0) },
    Picture { name: "beta_high", change: |p| with_line(p, 10.0) },
    Picture { name: "turbulence_low", change: |p| swirl(p, 0.0) },
    Picture { name: "turbulence_middle", change: |p| swirl(p, 20.0) },
    Picture { name: "turbulence_high", change: |p| swirl(p, 60.0) },
    Picture { name: "rho_low", change: |p| brighten(p, 0.3) },
    Picture { name: "rho_middle", change: |p| brighten(p, 1.0) },
    Picture { name: "rho_high", change: |p| brighten(p, 3.0) },
    Picture { name: "tau_low", change: |p| draw_from(p, 0.1) },
    Picture { name: "tau_middle", change: |p| draw_from(p, 0.4) },
    Picture { name: "tau_high", change: |p| draw_from(p, 0.85) },
    Picture { name: "preset_liquid", change: |p| p.flow.gamma = 0.0 },
    Picture { name: "preset_gradient", change: |p| p.flow.gamma = 1.0 },
    Picture { name: "preset_silk", change: |p| (p.flow.gamma, p.flow.alpha) = (0.5, 0.1) },
    Picture { name: "preset_storm", change: |p| swirl(p, 50.0) },
];

fn with_line(project: &mut Project, beta: f32) {
    let points = vec![[0.24, 0.42], [0.3, 0.28], [0.4, 0.2], [0.52, 0.18], [0.65, 0.24]];
    project
        .constraints
        .push(Constraint::DirectedLine(DirectedLine { width: 0.1, ..DirectedLine::new(points) }));
    project.flow.beta = beta;
}

fn swirl(project: &mut Project, strength: f32) {
    let turbulence = TurbulenceSettings { strength, grids: vec![12, 24], ..TurbulenceSettings::default() };
    project.flow.turbulence = (strength > 0.0).then_some(turbulence);
}

/// So dark that no brightness is the brightest a screen shows.
fn brighten(project: &mut Project, rho: f32) {
    project.flow.rho = rho;
    project.render.view.exposure -= 2.5;
}

/// The paper's method, whose photons are drawn to their targets from `tau` on; a field that cannot spread them shows when.
fn draw_from(project: &mut Project, tau: f32) {
    project.method = MotionMethod::Guided;
    project.flow.gamma = 0.0;
    project.flow.fade = Fade::Paper { tau };
}

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let file = root.join("projects/letters_free.json");
    let folder = root.join("assets/pictures/tooltips");
    std::fs::create_dir_all(&folder)?;
    let mut base = Project::load(&file)?;
    base.constraints.clear();
    base.flow.fit = FitKind::Separate;
    base.plane.aspect = SIZE[0] as f32 / SIZE[1] as f32;
    (base.render.width, base.render.height) = (SIZE[0] * LARGER, SIZE[1] * LARGER);
    (base.render.photons, base.render.passes) = (150_000, 3);
    // As fine as pictures of this size can show.
    (base.flow.grid, base.flow.steps, base.flow.guides) = (GridSize::Longer(64), 30, 20_000);
    base.output.formats = vec![FrameFormat::Png];
    base.output.frames = Some(MOMENT.into());
    base.output.name = "tooltip.####".into();
    // Light that has to spread and to turn: a small star becomes a large flower beside it.
    let shown = [("star", [0.3, 0.31], 0.22), ("flower", [0.58, 0.31], 0.56)];
    for (key, (name, centre, width)) in base.keys.iter_mut().zip(shown) {
        let placement = Placement { centre: Some(centre), width: Some(width), rotate: 0.0 };
        let file = format!("../assets/targets/{name}.png");
        key.shows = Shows::Image(ImageTarget { placement, ..ImageTarget::new(file) });
    }
    let engine = Engine::new(AssetFolder::new(&file, false)?);
    let only: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |name: &str| only.is_empty() || only.iter().any(|word| name.contains(word));
    for picture in PICTURES.iter().filter(|picture| wanted(picture.name)) {
        let mut project = base.clone();
        (picture.change)(&mut project);
        let out = tempfile::tempdir()?;
        engine.render(&project, out.path(), &Progress::default(), &|_| ())?;
        let frame = image::open(out.path().join(FILE))?.into_luma8();
        let share = |share: f32, whole: u32| (share * whole as f32).round() as u32;
        let [left, top, width, height] = PART;
        let (across, down) = (frame.width(), frame.height());
        let part = imageops::crop_imm(
            &frame,
            share(left, across),
            share(top, down),
            share(width, across),
            share(height, down),
        );
        let small = imageops::resize(&*part, SIZE[0], SIZE[1], imageops::FilterType::CatmullRom);
        let mut bytes = Vec::new();
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive).write_image(
            &small,
            SIZE[0],
            SIZE[1],
            image::ExtendedColorType::L8,
        )?;
        let path = folder.join(format!("{}.png", picture.name));
        std::fs::write(&path, &bytes)?;
        println!("{} ({} bytes)", path.display(), bytes.len());
    }
    Ok(())
}
