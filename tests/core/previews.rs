//! Projects to preview, and what the tests ask of a preview.
#![allow(dead_code, unreachable_pub, missing_docs)] // Each test uses its part.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use lightloom_core::Progress;
use lightloom_core::engine::{Engine, Preview, Quality};
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::PointLight;
use serde_json::{Value, json};

use crate::scenes::{Stage, glass, sphere_obj};

pub fn example_path(name: &str) -> PathBuf {
    crate::root().join("projects").join(format!("{name}.json"))
}

pub fn example(name: &str) -> (Project, Engine) {
    let path = example_path(name);
    (Project::load(&path).unwrap(), Engine::new(AssetFolder::new(&path, false).unwrap()))
}

pub fn draft(engine: &Engine, project: &Project) -> Arc<Preview> {
    engine.preview(project, Quality::Draft, 1, &Progress::new(), &mut |_| ()).unwrap()
}

pub fn stages(preview: &Preview) -> Vec<&str> {
    preview.stages().iter().map(|cost| cost.stage).collect()
}

/// Positions at all frames, bit by bit.
pub fn bits(preview: &Preview) -> Vec<Vec<[u32; 2]>> {
    let frame = |frame| preview.positions(frame).unwrap().iter().map(|p| p.to_array().map(f32::to_bits));
    preview.frames().map(|number| frame(number).collect()).collect()
}

pub fn flux(preview: &Preview, frame: i32) -> Vec<Vec3> {
    let mut flux = Vec::new();
    preview.flux(frame, &mut flux);
    flux
}

/// Two balls of glass side by side, a lamp over each; the left caustic goes to one corner, the right to another.
pub fn two_balls() -> (Stage, Project, Engine) {
    let mut stage = Stage::new();
    for (name, x) in [("left", -0.25), ("right", 0.25)] {
        stage.mesh(&format!("{name} ball"), sphere_obj(3, Vec3::new(x, 0.12, 0.0), 0.08), glass(1.5));
        let lamp = PointLight { name: format!("{name} lamp"), position: [x, 1.0, 0.0], ..Default::default() };
        stage.desc.lights.push(LightDesc::Point(lamp));
    }
    let white = image::GrayImage::from_pixel(8, 8, image::Luma([255]));
    white.save(stage.folder.path().join("square.png")).unwrap();
    let square = |centre: [f32; 2]| -> Value {
        json!({ "shows": { "image": { "file": "square.png", "placement": { "centre": centre, "width": 0.2 } } } })
    };
    let project = json!({
        "lightloom": 1,
        "scene": stage.desc,
        "caustics": [
            { "name": "left", "mesh": "left ball", "own_flow": true },
            { "name": "right", "mesh": "right ball", "own_flow": false }
        ],
        "keys": [
            { "frame": 1, "shows": "physical_caustic" },
            { "frame": 9, "shows": "physical_caustic",
              "caustics": { "left": square([0.2, 0.8]), "right": square([0.8, 0.2]) } },
            { "frame": 21, "shows": "physical_caustic" }
        ],
        "flow": { "grid": 16, "steps": 6 },
        "render": { "width": 32, "height": 32, "photons": 3000, "background_samples": 1 }
    });
    let path = stage.folder.path().join("project.json");
    let project = Project::parse(project.to_string().as_bytes(), &path).unwrap();
    let engine = Engine::new(AssetFolder::new(&path, false).unwrap());
    (stage, project, engine)
}
