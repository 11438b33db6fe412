//! The resolution of a saved description to a scene: values checked, meshes read, notes on what looks wrong.

use std::path::PathBuf;
use std::sync::Arc;

use super::check;
use super::contact::OnReceiver;
use super::geometry::Geometry;
use super::object::Mesh;
use super::sunk::sunk_notes;
use super::{Scene, SceneDesc};
use crate::note::About;
use crate::{Note, Progress, Result};

impl Scene {
    /// Loads, checks and indexes a scene; with notes for the artist on what was cleaned up, guessed or looks wrong.
    /// `assets` resolves a path as written to a readable file, or refuses; its second argument is the place to name in the
    /// error.
    ///
    /// # Errors
    /// The place of the first value or file that cannot be used.
    pub fn load(
        desc: &SceneDesc,
        assets: &dyn Fn(&str, &str) -> Result<PathBuf>,
    ) -> Result<(Self, Vec<Note>)> {
        desc.check("scene")?;
        let (geometry, mut notes) = Geometry::load(&desc.meshes, assets, &Progress::new())?;
        let (scene, more) = Self::with_geometry(desc, Arc::new(geometry))?;
        notes.extend(more);
        Ok((scene, notes))
    }

    /// The scene of a description whose meshes are `geometry`, with notes for the artist.
    ///
    /// # Errors
    /// `Value` names the first value that cannot be used.
    pub fn with_geometry(desc: &SceneDesc, geometry: Arc<Geometry>) -> Result<(Self, Vec<Note>)> {
        desc.check("scene")?;
        let receiver = desc.receiver.resolve("scene.receiver")?;
        let size = receiver.metres_per_plane_unit();
        let mut notes: Vec<Note> =
            geometry.meshes().iter().filter_map(|mesh| size_hint(mesh, size)).collect();
        let (on_receiver, of_contact) = OnReceiver::new(&geometry, &receiver);
        notes.extend(of_contact);
        notes.extend(sunk_notes(&geometry, &receiver));
        let scene = Self {
            has_contacts: on_receiver.is_some() || geometry.has_contacts(),
            on_receiver,
            geometry,
            lights: desc.lights.clone(),
            camera: desc.camera.resolve("scene.camera")?,
            receiver,
            environment: desc.environment.clone(),
        };
        Ok((scene, notes))
    }
}

impl SceneDesc {
    /// Refuses values out of range, naming their place under `place`.
    pub fn check(&self, place: &str) -> Result<()> {
        check::count(&format!("{place}.meshes"), self.meshes.len())?;
        check::count(&format!("{place}.lights"), self.lights.len())?;
        for (index, mesh) in self.meshes.iter().enumerate() {
            let checked = mesh.check(&format!("{place}.meshes[{index}]"));
            checked.map_err(|error| error.of(&format!("mesh \"{}\"", mesh.name)))?;
        }
        for (index, light) in self.lights.iter().enumerate() {
            let checked = light.check(&format!("{place}.lights[{index}]"));
            checked.map_err(|error| error.of(&format!("light \"{}\"", light.name())))?;
        }
        self.camera.check(&format!("{place}.camera"))?;
        self.receiver.check(&format!("{place}.receiver"))?;
        self.environment.check(&format!("{place}.environment"))
    }
}

/// Sizes, in those of the receiver, beyond which glass and mirrors are most likely in other units; matt things, such as a
/// room or a pebble, may be larger and smaller.
const USUAL: std::ops::Range<f32> = 5e-3..20.0;
const USUAL_MATT: std::ops::Range<f32> = 1e-3..1e3;

/// The note on a mesh far smaller or larger than the receiver: most likely in other units.
fn size_hint(mesh: &Mesh, receiver: f32) -> Option<Note> {
    let size = (mesh.upper - mesh.lower).max_element();
    let factor = size / receiver;
    let usual = if mesh.material.is_specular() { USUAL } else { USUAL_MATT };
    (!usual.contains(&factor)).then(|| {
        About::Mesh(mesh.desc).note(format!(
            "{}: is {size:.3e} m wide, {factor:.1e} times the receiver; is the file in other units? \
             Set transform.scale (0.001 for millimetres, 0.01 for centimetres, 0.0254 for inches)",
            mesh.name
        ))
    })
}
