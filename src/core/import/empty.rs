//! The empty project: a table, a lamp over it and a camera, for the glass that comes.

use std::collections::BTreeMap;

use glam::vec3;

use super::draft::Bounds;
use super::flat::Rectangle;
use super::{camera, lamp, receiver};
use crate::flow::{FlowSettings, MotionMethod};
use crate::matching::MatchingMethod;
use crate::project::{Ease, KeyFrame, OutputSettings, PlaneSettings, Project, Shows, VERSION};
use crate::render::RenderSettings;
use crate::scene::{EnvironmentDesc, SceneDesc};

/// Radiance of a faint sky (W/(sr m²)).
const ZENITH: [f32; 3] = [0.02, 0.023, 0.03];
const HORIZON: [f32; 3] = [0.04, 0.04, 0.045];
/// First and last frame.
const FRAMES: [i32; 2] = [1, 100];

/// A project without glass: its table, lamp and camera suit a thing of 20 cm in the middle.
pub fn empty_project() -> Project {
    let glass = Bounds { lower: vec3(-0.1, 0.0, -0.1), upper: vec3(0.1, 0.2, 0.1) };
    let lights = vec![lamp::aimed_at(&glass, None)];
    let receiver = receiver::made(&receiver::needed(
        &Rectangle::horizontal(glass.centre().with_y(0.0)),
        &glass,
        &lights,
    ));
    let scene = SceneDesc {
        meshes: Vec::new(),
        camera: camera::framing(&glass, &receiver),
        lights,
        receiver,
        environment: sky(),
    };
    let key = |frame| KeyFrame {
        frame,
        shows: Shows::PhysicalCaustic,
        caustics: BTreeMap::new(),
        ease: Ease::default(),
    };
    Project {
        schema: None,
        lightloom: VERSION,
        minimum_reader: None,
        name: String::new(),
        seed: Project::SEED.value(),
        scene: Some(scene),
        plane: PlaneSettings::default(),
        caustics: Vec::new(),
        keys: FRAMES.map(key).into(),
        matching: MatchingMethod::default(),
        method: MotionMethod::default(),
        constraints: Vec::new(),
        flow: FlowSettings::default(),
        render: RenderSettings::default(),
        output: OutputSettings::default(),
    }
}

/// Whether a project has no glass yet for the caustic that it shall show: there is nothing to compute until one comes.
pub fn awaits_glass(project: &Project) -> bool {
    let shows_it = || project.keys.iter().any(|key| key.shows == Shows::PhysicalCaustic);
    project.scene.as_ref().is_some_and(|scene| scene.meshes.is_empty()) && shows_it()
}

/// A faint sky, so that glass is seen.
pub(super) fn sky() -> EnvironmentDesc {
    EnvironmentDesc { zenith: ZENITH, horizon: HORIZON, ..EnvironmentDesc::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_caustic_without_glass_awaits_one() {
        let empty = empty_project();
        assert!(awaits_glass(&empty));
        assert!(!awaits_glass(&Project { scene: None, ..empty.clone() }));
        assert!(!awaits_glass(&Project { keys: Vec::new(), ..empty }));
    }
}
