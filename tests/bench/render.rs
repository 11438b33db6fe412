//! What a frame costs: `cargo bench --bench render`. One thread; frames are worked on side by side.

use divan::{Bencher, black_box};
use glam::{Vec2, Vec3, vec2};
use lightloom_core::Progress;
use lightloom_core::export::{Backdrop, Frame, FrameFormat, FrameLayer, Metadata, PngDepth, write_frame};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::render::density::KernelFilter;
use lightloom_core::render::splat::Splatter;
use lightloom_core::render::{
    GatherMatrix, Image, ProgressiveRender, ReceiverTexture, RenderSettings, TextureLayout, ViewSettings,
    Workspace,
};

const PHOTONS: usize = 1_000_000;

fn main() {
    if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(1).build_global() {
        eprintln!("{error}");
    }
    divan::main();
}

/// Half of the light on a bright ring, half everywhere: as uneven as a caustic.
fn photons() -> (Vec<Vec2>, Vec<Vec3>) {
    let rng = &mut Stream::new(1, Purpose::Trace, 0, 0);
    let positions = (0..PHOTONS)
        .map(|i| {
            let (a, b) = (rng.f32(), rng.f32());
            let ring = vec2(0.5, 0.5) + (0.3 + 0.01 * b) * Vec2::from_angle(a * std::f32::consts::TAU);
            if i % 2 == 0 { ring } else { vec2(a, b) }
        })
        .collect();
    (positions, vec![Vec3::splat(1.0 / PHOTONS as f32); PHOTONS])
}

fn layout() -> TextureLayout {
    TextureLayout::new(Vec2::ONE, 1024, 0.0)
}

fn splatted() -> ReceiverTexture {
    let (positions, flux) = photons();
    let mut texture = ReceiverTexture::new(layout());
    Splatter::default().splat(&positions, &flux, &mut texture);
    texture
}

fn flat() -> GatherMatrix {
    let settings = RenderSettings::default();
    GatherMatrix::flat(Vec2::ONE, &layout(), &settings, &Progress::new()).expect("nobody cancels")
}

#[divan::bench]
fn splat_1m_photons_1024(bencher: Bencher<'_, '_>) {
    let (positions, flux) = photons();
    let mut texture = ReceiverTexture::new(layout());
    let mut splatter = Splatter::default();
    bencher.bench_local(|| splatter.splat(black_box(&positions), &flux, &mut texture));
}

#[divan::bench(args = [0.002, 0.006, 0.05])]
fn filter_1024(bencher: Bencher<'_, '_>, radius: f32) {
    let mut texture = splatted();
    let mut smoother = KernelFilter::default();
    bencher.bench_local(|| smoother.filter(&mut texture, black_box(radius)));
}

/// Splat, filter and store: what each frame costs in each pass, apart from the advection.
#[divan::bench(sample_count = 20)]
fn frame_and_pass(bencher: Bencher<'_, '_>) {
    let (positions, flux) = photons();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let render = ProgressiveRender::new(layout(), 0.006, 1, folder.path()).expect("a scratch file");
    let mut work = Workspace::new(layout());
    bencher.bench_local(|| render.add(0, 1, &positions, &flux, &mut work).expect("room for a frame"));
}

#[divan::bench(sample_count = 20)]
fn gather_1280x720(bencher: Bencher<'_, '_>) {
    let visible = flat();
    let texture = splatted();
    bencher.bench_local(|| visible.gather(black_box(&texture)));
}

/// A background with grain, under the caustic of the photons.
fn write(bencher: Bencher<'_, '_>, format: FrameFormat) {
    let visible = flat();
    let caustic = visible.gather(&splatted());
    let mut background = Image::new(1280, 720);
    let rng = &mut Stream::new(2, Purpose::Background, 0, 0);
    background.pixels.iter_mut().for_each(|p| *p = Vec3::splat(0.2 + 0.002 * rng.f32()));
    let metadata = Metadata {
        frame: 1,
        frames_per_second: (24, 1),
        seed: 1,
        passes: 8,
        camera: None,
        settings: Vec::new(),
    };
    let backdrop = Backdrop::new(&FrameLayer::DEFAULT, &background, None);
    let frame = Frame {
        backdrop: &backdrop,
        caustic: &caustic,
        caustics: &[],
        metadata: &metadata,
        compressed: true,
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("frame.0001");
    let view = ViewSettings::default().view();
    bencher
        .bench_local(|| write_frame(&path, format, &frame, &view, PngDepth::Eight).expect("a written frame"));
}

#[divan::bench(sample_count = 10)]
fn write_exr_1280x720(bencher: Bencher<'_, '_>) {
    write(bencher, FrameFormat::Exr);
}

#[divan::bench(sample_count = 10)]
fn write_png_1280x720(bencher: Bencher<'_, '_>) {
    write(bencher, FrameFormat::Png);
}
