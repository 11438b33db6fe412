//! The resolution of a saved description to a scene: values checked, meshes read, notes on what looks wrong.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;

use super::accel::Accel;
use super::{Geometry, Mesh, MeshDesc, Scene, SceneDesc, mesh};
use crate::{Error, Progress, Result};

/// Most meshes, and most lights: photons index them by 16 bits.
const MAX_OBJECTS: usize = u16::MAX as usize;

/// See [`Geometry::load`].
pub(super) fn geometry(
    descs: &[MeshDesc],
    assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
    progress: &Progress,
) -> Result<(Geometry, Vec<String>)> {
    let mut notes = Vec::new();
    let mut meshes = Vec::new();
    let mut triangles = Vec::new();
    for (index, mesh_desc) in descs.iter().enumerate() {
        let place = format!("scene.meshes[{index}]");
        for part in mesh::load(mesh_desc, &place, assets, &mut notes, progress)? {
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
    Ok((Geometry { accel: Accel::new(&triangles, progress)?, meshes }, notes))
}

/// See [`Scene::with_geometry`].
pub(super) fn scene(desc: &SceneDesc, geometry: Arc<Geometry>) -> Result<(Scene, Vec<String>)> {
    desc.check("scene")?;
    let receiver = desc.receiver.resolve("scene.receiver")?;
    let size = receiver.metres_per_plane_unit();
    let notes = geometry.meshes.iter().filter_map(|mesh| size_hint(mesh, size)).collect();
    let scene = Scene {
        geometry,
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

/// The note on a mesh far smaller or larger than the receiver: most likely in other units.
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
