//! From a saved description to a scene: every value checked, every mesh read, what looks odd told.

use std::path::PathBuf;

use glam::Vec3;

use super::accel::Accel;
use super::{Mesh, Scene, SceneDesc, mesh};
use crate::{Error, Result};

/// Most meshes and most lights: photons name them by 16 bits.
const MAX_OBJECTS: usize = u16::MAX as usize;

/// See [`Scene::load`].
pub(super) fn load(
    desc: &SceneDesc,
    assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
) -> Result<(Scene, Vec<String>)> {
    desc.check("scene")?;
    let mut notes = Vec::new();
    let mut meshes = Vec::new();
    let mut triangles = Vec::new();
    for (index, mesh_desc) in desc.meshes.iter().enumerate() {
        for part in mesh::load(mesh_desc, &format!("scene.meshes[{index}]"), assets, &mut notes)? {
            let corners = || part.triangles.iter().flat_map(|t| t.corners);
            let number = meshes.len() as u16;
            let lower = corners().fold(Vec3::INFINITY, Vec3::min);
            let upper = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
            let middle = (lower + upper) / 2.0;
            meshes.push(Mesh {
                name: part.name,
                material: part.material,
                lower,
                upper,
                radius: corners().map(|p| p.distance(middle)).fold(0.0, f32::max),
                priority: mesh_desc.priority,
                triangles: part.triangles.len(),
            });
            triangles.extend(part.triangles.into_iter().map(|t| mesh::Triangle { mesh: number, ..t }));
            check_count("scene.meshes", meshes.len())?;
        }
    }
    let receiver = desc.receiver.resolve("scene.receiver")?;
    notes.extend(meshes.iter().filter_map(|mesh| size_hint(mesh, receiver.metres_per_plane_unit())));
    let scene = Scene {
        accel: Accel::new(&triangles),
        meshes,
        lights: desc.lights.clone(),
        camera: desc.camera.resolve("scene.camera")?,
        receiver,
        environment: desc.environment.clone(),
    };
    Ok((scene, notes))
}

impl SceneDesc {
    /// Refuses values out of range, naming their place under `place`.
    pub fn check(&self, place: &str) -> Result<()> {
        check_count(&format!("{place}.meshes"), self.meshes.len())?;
        check_count(&format!("{place}.lights"), self.lights.len())?;
        for (index, mesh) in self.meshes.iter().enumerate() {
            mesh.check(&format!("{place}.meshes[{index}]"))?;
        }
        for (index, light) in self.lights.iter().enumerate() {
            light.check(&format!("{place}.lights[{index}]"))?;
        }
        self.camera.check(&format!("{place}.camera"))?;
        self.receiver.check(&format!("{place}.receiver"))?;
        self.environment.check(&format!("{place}.environment"))
    }
}

fn check_count(place: &str, count: usize) -> Result<()> {
    if count <= MAX_OBJECTS {
        return Ok(());
    }
    let what = format!("holds {count} objects, at most {MAX_OBJECTS} can be told apart; join some");
    Err(Error::Limit { place: place.into(), what })
}

/// A mesh far smaller or larger than the receiver is most likely in other units.
fn size_hint(mesh: &Mesh, receiver: f32) -> Option<String> {
    let size = (mesh.upper - mesh.lower).max_element();
    let factor = size / receiver;
    (!(1e-3..=1e3).contains(&factor)).then(|| {
        format!(
            "{}: is {size:.3e} m wide, {factor:.1e} times the receiver; is the file in other units? \
             Set transform.scale (0.001 for millimetres)",
            mesh.name
        )
    })
}
