//! An import, and how it becomes part of a project.

use std::path::PathBuf;

use super::draft::give_new_names;
use super::empty::empty_project;
use super::summary::Summary;
use crate::project::Project;
use crate::render::RenderSettings;
use crate::scene::SceneDesc;

/// A scene read from a file of another program, complete: it casts a caustic.
#[derive(Clone, Debug)]
pub struct Import {
    /// Meshes (by the name of the file alone), lamps, camera and receiver.
    pub scene: SceneDesc,
    /// Width over height of the picture, where the file's camera says it.
    pub aspect: Option<f32>,
    /// What was taken, and the notes on it.
    pub summary: Summary,
    /// The file, then those that belong to it.
    pub files: Vec<PathBuf>,
}

impl Import {
    /// The scene with its meshes in another file: a path relative to the project.
    pub fn scene_in(&self, file: &str) -> SceneDesc {
        let mut scene = self.scene.clone();
        scene.meshes.iter_mut().for_each(|mesh| file.clone_into(&mut mesh.file));
        scene
    }

    /// A project of the scene alone: its light stays as it is until a key frame shows something else.
    pub fn project(&self, name: &str, file: &str) -> Project {
        let mut project = Project { name: name.into(), ..empty_project() };
        let plain: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        project.output.name = format!("{plain}.####");
        self.add_to(&mut project, file);
        project
    }

    /// Puts the scene into a project: in place of a scene without meshes, or else its meshes and lamps beside those there.
    pub fn add_to(&self, project: &mut Project, file: &str) {
        let mut new = self.scene_in(file);
        match &mut project.scene {
            Some(scene) if !scene.meshes.is_empty() => {
                give_new_names(scene, &mut new);
                scene.meshes.append(&mut new.meshes);
                scene.lights.extend(new.lights.into_iter().filter(|_| self.summary.has_lamps));
            }
            _ => {
                project.scene = Some(new);
                if let Some(aspect) = self.aspect {
                    let height = (project.render.width as f32 / aspect / 2.0).round() * 2.0;
                    project.render.height = RenderSettings::HEIGHT.clamped(height) as u32;
                }
            }
        }
    }
}
