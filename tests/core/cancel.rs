//! Cancelling what takes long before the first photon: reading meshes and pictures, building hierarchies. With
//! `LIGHTLOOM_CANCEL=1000000` meshes of so many triangles are read, and the longest delay of many is told.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glam::Vec3;
use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Progress};
use serde_json::{Value, json};

use crate::scenes::{icosphere, obj};

/// Times at which each work is cancelled.
const TIMES: u32 = 12;

/// Triangles of a mesh, and pixels of a picture.
fn size() -> usize {
    std::env::var("LIGHTLOOM_CANCEL").ok().and_then(|size| size.parse().ok()).unwrap_or(5000)
}

fn work(path: &Path, progress: &Progress) -> lightloom_core::Result<()> {
    let project = Project::load(path)?;
    Engine::new(AssetFolder::new(path, false)?).fitted(&project, progress).map(|_| ())
}

/// Runs a project once, then cancels it again and again; it must end by being cancelled, or before.
fn cancel_at_many_times(name: &str, path: &Path) {
    let start = Instant::now();
    work(path, &Progress::new()).unwrap();
    let whole = start.elapsed();
    let mut worst = (Duration::ZERO, Duration::ZERO, "");
    for i in 0..TIMES {
        let progress = Progress::new();
        let at = whole * (2 * i + 1) / (2 * TIMES);
        let (done, asked, stage) = std::thread::scope(|scope| {
            let done = scope.spawn(|| {
                let done = work(path, &progress);
                (done, Instant::now())
            });
            std::thread::sleep(at);
            let stage = progress.snapshot().stage.unwrap_or("before the first stage");
            let asked = Instant::now();
            progress.abandon();
            (done.join().unwrap(), asked, stage)
        });
        let (done, ended) = done;
        assert!(matches!(done, Ok(()) | Err(Error::Cancelled)), "{name}: {done:?}");
        worst = worst.max((ended.saturating_duration_since(asked), at, stage));
    }
    println!(
        "{name}: {whole:.2?} in all; cancelled {TIMES} times, at most {:.0?} later (at {:.2?}, {})",
        worst.0, worst.1, worst.2
    );
}

fn written(folder: &Path, project: &Value) -> PathBuf {
    let path = folder.join("test.json");
    std::fs::write(&path, project.to_string()).unwrap();
    path
}

#[test]
fn a_scene_of_many_triangles() {
    let levels = (0..12).find(|level| 20 * 4_usize.pow(*level) >= size()).unwrap();
    let (unit, faces) = icosphere(levels as usize);
    let vertices: Vec<Vec3> = unit.iter().map(|v| *v * 0.1 + Vec3::new(0.0, 0.2, 0.0)).collect();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.obj"), obj(&vertices, None, &faces)).unwrap();
    let light =
        json!({ "type": "spot", "name": "key", "watts": 5, "position": [0, 1.5, 0], "target": [0, 0, 0] });
    let scene = json!({
        "meshes": [{ "name": "ball", "file": "ball.obj", "material": { "type": "glass" } }],
        "lights": [light]
    });
    let project = json!({
        "lightloom": 1, "scene": scene,
        "keys": [{ "frame": 1, "shows": "physical_caustic" }],
        "render": { "width": 32, "height": 24, "photons": 1000, "passes": 1 }
    });
    cancel_at_many_times(&format!("scene of {} triangles", faces.len()), &written(folder.path(), &project));
}

#[test]
fn a_huge_picture() {
    let side = ((size() as f64 * 60.0).sqrt() as u32).min(9000);
    let picture = image::RgbImage::from_fn(side, side, |x, y| {
        let noise = x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(0x9e37_79b9).rotate_left(7);
        image::Rgb([(noise >> 8) as u8, (noise >> 16) as u8, (noise >> 24) as u8])
    });
    let folder = tempfile::tempdir().unwrap();
    picture.save(folder.path().join("a.png")).unwrap();
    let key = |frame| json!({ "frame": frame, "shows": { "image": { "file": "a.png" } } });
    let project = json!({
        "lightloom": 1,
        "keys": [key(1), key(11)],
        "flow": { "grid": 16, "steps": 8 },
        "render": { "width": 32, "height": 24, "photons": 1000, "passes": 1 }
    });
    cancel_at_many_times(&format!("picture of {side} x {side}"), &written(folder.path(), &project));
}
