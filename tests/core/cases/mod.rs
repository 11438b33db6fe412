//! Scenes and files as people have them, in tables: what goes in, what must come out.

use std::path::Path;

use glam::Vec3;
use lightloom_core::engine::{CheckReport, Engine};
use lightloom_core::photon::Tracer;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::scene::light::SpotLight;
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{LightDesc, Scene};
use lightloom_core::{Progress, Result};
use serde_json::json;

use crate::scenes::{Stage, sphere_obj};

mod exr_files;
mod fuzz;
mod meshes;
mod mtl;
mod obj;
mod picture_colours;
mod pictures;
mod points;
mod reasons;
mod touching;

pub(crate) use fuzz::Random;

/// Photons of a measured flux: its noise is below a root of their number, .8 %.
const PHOTONS: usize = 16_384;

/// A lamp of 5 W above the middle, or aslant.
fn lamp(position: [f32; 3], angle_deg: f32) -> LightDesc {
    let name = "lamp".into();
    LightDesc::Spot(SpotLight {
        name,
        watts: 5.0,
        position,
        target: [0.0, 0.05, 0.0],
        angle_deg,
        ..Default::default()
    })
}

/// The caustics' flux on the receiver (W).
fn watts(stage: &Stage) -> f64 {
    let scene = stage.load();
    let tracer = Tracer::new(&scene, 7, &Progress::new()).unwrap();
    tracer.trace(0, PHOTONS, &Progress::new()).unwrap().0.total_flux().x
}

/// The scene's notes.
fn notes(stage: &Stage) -> Vec<String> {
    stage.try_load().unwrap().1
}

fn check(stage: &Stage) -> Result<CheckReport> {
    let project = json!({
        "lightloom": 1,
        "scene": stage.desc,
        "keys": [ { "frame": 1, "shows": "physical_caustic" } ],
        "render": { "width": 64, "height": 48, "photons": 1000, "passes": 1 }
    });
    let project = Project::parse(project.to_string().as_bytes(), Path::new("project.json"))?;
    Engine::new(AssetFolder::new(&stage.folder.path().join("project.json"), false)?).check(&project)
}

/// Glass by its material file.
const GLASS: &str = "newmtl Glass\nNi 1.5\nd 0.1\nillum 7\nKd 0.8 0.8 0.8\n";

/// A ball of glass over the origin, without a material.
fn ball() -> String {
    sphere_obj(2, BALL, RADIUS)
}

const BALL: Vec3 = Vec3::new(0.0, 0.2, 0.0);
const RADIUS: f32 = 0.12;
/// Triangles of the ball.
const FACES: usize = 320;

/// The scene of one mesh file beside other files, with the notes on it; or the error.
fn load(
    mesh: impl AsRef<[u8]>,
    others: &[(&str, &str)],
    place: Transform,
) -> Result<(Scene, String), String> {
    let mut stage = Stage::new();
    for (name, content) in others {
        let path = stage.folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }
    stage.mesh("mesh", mesh, None).transform = place;
    let (scene, notes) = stage.try_load().map_err(|error| error.to_string())?;
    Ok((scene, notes.join("\n")))
}
