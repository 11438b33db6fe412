//! Files as people have them: each row of a table is an input with the result that is right.

mod fuzz;
mod mtl;
mod obj;
mod pictures;
mod points;

use glam::Vec3;
use lightloom_core::scene::Scene;
use lightloom_core::scene::mesh::Transform;

use crate::scenes::{Stage, sphere_obj};

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
fn load(mesh: impl AsRef<[u8]>, others: &[(&str, &str)], place: Transform) -> Result<(Scene, String), String> {
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
