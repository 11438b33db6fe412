//! Damaged files of every kind that is read: each is read or refused with an error that names it, and none makes a panic.
//! `LIGHTLOOM_FUZZ=100000` sets how many are tried, and then every beginning of each file, too; the slowest is told.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use exr::prelude::Encoding;
use glam::Vec2;
use image::ImageFormat;
use image::codecs::hdr::HdrEncoder;
use lightloom_core::project::{Project, ProjectFile};
use lightloom_core::targets::{ImageTarget, PictureSampler, load_points};
use lightloom_core::{Progress, import};

use super::seeds::{BALL_MATERIAL, ball, crc_corrected, encoded, exr_packed, npy, picture, png};
use crate::cases::Random;
use crate::scenes::Stage;

/// Rounds of a usual run.
const FEW: usize = 200;
/// Beginnings of each file that a usual run tries.
const FEW_CUTS: usize = 60;

/// A file format under test.
struct Target {
    name: &'static str,
    /// The file's name.
    file: &'static str,
    seeds: Vec<Vec<u8>>,
    /// Makes a damaged file of a good one.
    damage: fn(&mut Random, &[u8]) -> Vec<u8>,
    /// Reads the file of that name in a folder; an error is the message.
    read: fn(&Path) -> Result<(), String>,
}

/// What came of all damaged files of a format.
#[derive(Default)]
struct Tally {
    inputs: usize,
    read: usize,
    slowest: Duration,
    failures: Vec<String>,
}

impl Target {
    fn run(&self) {
        let rounds =
            std::env::var("LIGHTLOOM_FUZZ").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(FEW);
        let stage = Stage::new();
        stage.file("a.mtl", BALL_MATERIAL);
        stage.file("mesh.obj", format!("mtllib a.mtl\nusemtl Glass\n{}", ball()));
        let path = stage.folder.path().join(self.file);
        let mut tally = Tally::default();
        for seed in &self.seeds {
            let step = if rounds > FEW { 1 } else { seed.len().div_ceil(FEW_CUTS) };
            for end in (0..seed.len()).step_by(step.max(1)) {
                self.one(&path, &seed[..end], &mut tally, &format!("cut at {end}"));
            }
        }
        let mut random = Random::new(0x9e37_79b9_7f4a_7c15);
        for round in 0..rounds {
            let seed = random.below(self.seeds.len());
            let bytes = (self.damage)(&mut random, &self.seeds[seed]);
            self.one(&path, &bytes, &mut tally, &format!("round {round}"));
        }
        tally.report(self.name, rounds);
    }

    fn one(&self, path: &Path, bytes: &[u8], tally: &mut Tally, which: &str) {
        std::fs::write(path, bytes).unwrap();
        let start = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| (self.read)(path)));
        tally.slowest = tally.slowest.max(start.elapsed());
        tally.inputs += 1;
        match outcome {
            Ok(Ok(())) => tally.read += 1,
            Ok(Err(error)) if error.contains(self.file) => (),
            Ok(Err(error)) => tally.failures.push(format!("{which}: does not name the file: {error}")),
            Err(_) => tally.failures.push(format!("{which}: panic")),
        }
    }
}

impl Tally {
    fn report(&self, name: &str, rounds: usize) {
        let row = format!(
            "| {name} | {} | {} | {} | {} | {:.1} |",
            self.inputs,
            self.read,
            self.inputs - self.read - self.failures.len(),
            self.failures.len(),
            self.slowest.as_secs_f64() * 1000.0
        );
        println!("{row}");
        assert!(self.failures.is_empty(), "{name}: {:#?}", &self.failures[..self.failures.len().min(5)]);
        // Not all damage is fatal.
        assert!(self.read > 0, "{name}: none of {}", self.inputs);
        if super::updates_pages() && rounds > FEW {
            write_row(name, &row);
        }
    }
}

/// The row of a format in the page, written anew.
fn write_row(name: &str, row: &str) {
    const HEAD: &str = "# Damaged files\n\nWritten by the tests (`LIGHTLOOM_FUZZ=100000 UPDATE_PAGES=1`, `tests/core/hostile/fuzz.rs`): every beginning of\n\
        good files, and files that were damaged at random (fixed seed). A failure is a panic, or an error that does not name the\n\
        file. The slowest is of this machine, with two formats tried at once.\n\n\
        | format | inputs | read | refused | failures | slowest, ms |\n|---|---|---|---|---|---|\n";
    static PAGE: Mutex<()> = Mutex::new(());
    let _turn = PAGE.lock();
    let path = super::page("fuzzing.md");
    let old = std::fs::read_to_string(&path).unwrap_or_default();
    let start = format!("| {name} |");
    let is_other =
        |line: &&str| line.starts_with("| ") && !line.starts_with("| format") && !line.starts_with(&start);
    let mut rows: Vec<&str> = old.lines().filter(is_other).chain([row]).collect();
    rows.sort_unstable();
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, format!("{HEAD}{}\n", rows.join("\n"))).unwrap();
}

/// Words and numbers of the text formats are exchanged, too.
fn damaged_text(random: &mut Random, seed: &[u8]) -> Vec<u8> {
    random.damage(seed)
}

/// Bytes are changed, one to four next to each other, also to the ends of their range.
fn damaged_binary(random: &mut Random, seed: &[u8]) -> Vec<u8> {
    let mut file = seed.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(file.len());
        let end = (at + [1, 2, 4][random.below(3)]).min(file.len());
        match random.below(4) {
            0 => file[at..end].fill(0),
            1 => file[at..end].fill(0xff),
            2 => file[at] ^= 1 << random.below(8),
            _ => file[at] = random.below(256) as u8,
        }
    }
    if random.below(12) == 0 {
        file.truncate(random.below(file.len()));
    }
    file
}

/// Half of the files have sums that fit, so that not all end there.
fn damaged_png(random: &mut Random, seed: &[u8]) -> Vec<u8> {
    let file = damaged_binary(random, seed);
    if random.below(2) == 0 { crc_corrected(file) } else { file }
}

fn read_project(path: &Path) -> Result<(), String> {
    let bytes = std::fs::read(path).unwrap();
    let tolerant = ProjectFile::parse(&bytes, path);
    let project = Project::load(path).map_err(|error| error.to_string())?;
    // What is read is in range: it can be saved, and comes back.
    let text = project.to_json().unwrap();
    assert_eq!(Project::parse(text.as_bytes(), path).unwrap(), project);
    assert_eq!(*tolerant.unwrap().0.project(), project);
    Ok(())
}

fn read_scene(path: &Path) -> Result<(), String> {
    let mut stage = lightloom_core::scene::SceneDesc::default();
    stage.meshes.push(lightloom_core::scene::MeshDesc::new("mesh", "mesh.obj"));
    let folder = path.parent().unwrap().to_owned();
    let loaded =
        lightloom_core::scene::Scene::load(&stage, &move |file: &str, _: &str| Ok(folder.join(file)));
    loaded.map(|_| ()).map_err(|error| error.to_string())
}

fn read_glb(path: &Path) -> Result<(), String> {
    import::read(path, &Progress::new()).map(|_| ()).map_err(|error| error.to_string())
}

fn read_picture(path: &Path) -> Result<(), String> {
    let target = ImageTarget::new("picture");
    let sampler = PictureSampler::load(path, &target, Vec2::ONE, path.file_name().unwrap().to_str().unwrap())
        .map_err(|error| error.to_string())?;
    assert!(sampler.sample(1, 0, 16).positions.iter().all(|point| point.is_finite()));
    Ok(())
}

fn read_points(path: &Path) -> Result<(), String> {
    let points = load_points(path).map_err(|error| error.to_string())?;
    assert!(points.positions.iter().all(|point| point.is_finite()));
    Ok(())
}

#[test]
fn project() {
    let small = super::projects::good();
    let letters = std::fs::read(crate::root().join("projects/letters.json")).unwrap();
    let seeds = vec![small.to_string().into(), serde_json::to_vec_pretty(&small).unwrap(), letters];
    Target { name: "project (JSON)", file: "shot.json", seeds, damage: damaged_text, read: read_project }
        .run();
}

#[test]
fn obj() {
    let seeds = vec![
        format!("mtllib a.mtl\nusemtl Glass\n{}", ball()).into(),
        b"mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv .2 0 .8\nv 0 0 1\nvn 0 1 0\nvt 0 0\nusemtl Glass\nf 1//1 2//1 3//1 4 \\\n5//1\nusemtl M #2\nf -1/1 -2/1 -3/1/1\nf 1 2 3 4\n".to_vec(),
    ];
    Target { name: "mesh (OBJ)", file: "mesh.obj", seeds, damage: damaged_text, read: read_scene }.run();
}

#[test]
fn mtl() {
    let seeds = vec![BALL_MATERIAL.as_bytes().to_vec()];
    Target { name: "materials (MTL)", file: "a.mtl", seeds, damage: damaged_text, read: read_scene }.run();
}

#[test]
fn glb() {
    let seeds = vec![crate::gltf::rich(), crate::gltf::smallest()];
    Target {
        name: "scene (GLB)",
        file: "scene.glb",
        seeds,
        damage: |random, _| crate::gltf::fuzz::damaged(random),
        read: read_glb,
    }
    .run();
}

#[test]
fn png_pictures() {
    let mut seeds = vec![png()];
    seeds.push(encoded(&picture().to_rgb16().into(), ImageFormat::Png));
    seeds.push(encoded(&picture().to_luma8().into(), ImageFormat::Png));
    Target { name: "picture (PNG)", file: "a.png", seeds, damage: damaged_png, read: read_picture }.run();
}

#[test]
fn other_pictures() {
    let rgb = picture().to_rgb8().into();
    let seeds = [ImageFormat::Jpeg, ImageFormat::Tiff, ImageFormat::WebP].map(|format| encoded(&rgb, format));
    let (seeds, file) = (seeds.to_vec(), "a.jpg");
    Target { name: "picture (JPEG, TIFF, WebP)", file, seeds, damage: damaged_binary, read: read_picture }
        .run();
}

#[test]
fn exr() {
    let values: Vec<f32> = (0..64).map(|i| i as f32 / 8.0).collect();
    let encodings = [Encoding::UNCOMPRESSED, Encoding::SMALL_LOSSLESS, Encoding::FAST_LOSSLESS];
    let seeds = encodings.map(|encoding| exr_packed(&values, encoding)).to_vec();
    Target { name: "picture (EXR)", file: "a.exr", seeds, damage: damaged_binary, read: read_picture }.run();
}

#[test]
fn hdr() {
    let pixels: Vec<_> = (0..96).map(|i| image::Rgb([i as f32 / 9.0, 0.5, 2.0])).collect();
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes).encode(&pixels, 12, 8).unwrap();
    let seeds = vec![bytes];
    Target { name: "picture (HDR)", file: "a.hdr", seeds, damage: damaged_binary, read: read_picture }.run();
}

#[test]
fn npy_points() {
    let values: Vec<f32> = (0..50).map(|i| i as f32 / 50.0).collect();
    let seeds = vec![npy(&[25, 2], &values), npy(&[10, 5], &values)];
    Target { name: "points (NPY)", file: "points", seeds, damage: damaged_binary, read: read_points }.run();
}

#[test]
fn csv() {
    let rows: String = (0..20).map(|i| format!("0.{i},0.5,1,{i},0\n")).collect();
    let seeds = vec![format!("x,y,r,g,b\n{rows}").into(), b"0,5;0,25\n1;0,75\n# end\n".to_vec()];
    Target { name: "points (CSV)", file: "points", seeds, damage: damaged_text, read: read_points }.run();
}
