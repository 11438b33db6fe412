//! The live preview: from an edit to the first picture of the frame under the playhead, and to all frames.
//! Budget: 100 ms to the first picture at `Quality::Draft`; 1 s for all 60 frames at `Quality::Preview`. Two cores.

use std::path::Path;
use std::sync::Arc;

use divan::Bencher;
use lightloom_core::Progress;
use lightloom_core::constraint::{Constraint, Wall};
use lightloom_core::engine::{Engine, Preview, PreviewExposure, Quality};
use lightloom_core::project::{AssetFolder, Project};

fn main() {
    divan::main();
}

const PROJECTS: [&str; 3] = ["letters_free", "dark_glass", "bottles"];
/// Texels along the receiver of the first picture.
const TEXELS: usize = 384;

fn open(name: &str) -> (Project, Engine) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../projects").join(format!("{name}.json"));
    let project = Project::load(&path).expect("an example project");
    (project, Engine::new(AssetFolder::new(&path, false).expect("its folder")))
}

/// A project that an edit was made to, over and over, each time another.
struct Editing {
    project: Project,
    engine: Engine,
    exposure: PreviewExposure,
    playhead: i32,
    /// Constraints that the project came with.
    drawn: usize,
}

impl Editing {
    fn new(name: &str) -> Self {
        let (project, engine) = open(name);
        let playhead = (project.keys[0].frame + project.keys[project.keys.len() - 1].frame) / 2;
        let drawn = project.constraints.len();
        let mut editing = Self { project, engine, exposure: PreviewExposure::default(), playhead, drawn };
        editing.all_frames(Quality::Draft);
        editing
    }

    /// Until the frame under the playhead is on the receiver.
    fn first_picture(&mut self) {
        let progress = Progress::new();
        let mut picture = |preview: &Arc<Preview>| {
            if self.exposure.expose(preview, self.playhead, TEXELS, &[]).is_some() {
                progress.cancel();
            }
        };
        let _ = self.engine.preview(&self.project, Quality::Draft, self.playhead, &progress, &mut picture);
    }

    fn all_frames(&mut self, quality: Quality) {
        let (playhead, progress) = (self.playhead, Progress::new());
        let _ = self.engine.preview(&self.project, quality, playhead, &progress, &mut |_| ());
    }

    fn new_gamma(&mut self) {
        let gamma = &mut self.project.flow.gamma;
        *gamma = if *gamma < 0.9 { *gamma + 0.01 } else { 0.2 };
    }

    /// In the middle of the plane, each time a little longer.
    fn new_wall(&mut self, length: f32) {
        self.project.constraints.truncate(self.drawn);
        let wall = Wall::new(vec![[0.5, 0.3], [0.5, 0.4 + length]]);
        self.project.constraints.push(Constraint::Wall(wall));
    }
}

#[divan::bench(args = PROJECTS)]
fn first_picture_after_gamma(bencher: Bencher, name: &str) {
    let mut editing = Editing::new(name);
    bencher.bench_local(|| {
        editing.new_gamma();
        editing.first_picture();
    });
}

#[divan::bench(args = PROJECTS)]
fn first_picture_after_a_wall(bencher: Bencher, name: &str) {
    let mut editing = Editing::new(name);
    let mut length = 0.0;
    bencher.bench_local(|| {
        length = (length + 0.001) % 0.2;
        editing.new_wall(length);
        editing.first_picture();
    });
}

#[divan::bench(args = PROJECTS, sample_count = 10)]
fn all_frames_after_gamma(bencher: Bencher, name: &str) {
    let mut editing = Editing::new(name);
    editing.all_frames(Quality::Preview);
    bencher.bench_local(|| {
        editing.new_gamma();
        editing.all_frames(Quality::Preview);
    });
}

#[divan::bench(args = PROJECTS, sample_count = 5)]
fn all_frames_after_a_wall(bencher: Bencher, name: &str) {
    let mut editing = Editing::new(name);
    let mut length = 0.0;
    bencher.bench_local(|| {
        length = (length + 0.001) % 0.2;
        editing.new_wall(length);
        editing.all_frames(Quality::Preview);
    });
}

#[divan::bench(args = ["dark_glass", "bottles"], sample_count = 20)]
fn a_look(bencher: Bencher, name: &str) {
    let (project, engine) = open(name);
    let camera = project.scene.as_ref().map(|scene| scene.camera.clone()).unwrap_or_default();
    bencher.bench_local(|| engine.orbit_view(&project, &camera, [480, 270], None, &Progress::new()));
}
