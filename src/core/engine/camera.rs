//! What the camera sees of the receiver, and of all else: remembered, since photons change neither.

use std::sync::Arc;

use glam::Vec2;

use super::meter::Meter;
use super::stage::{Same, Stage};
use crate::project::Project;
use crate::render::{Image, RenderSettings, TextureLayout, Visible};
use crate::scene::Scene;
use crate::{Progress, Result};

/// The stages of the camera.
#[derive(Default)]
pub(super) struct Seen {
    visible: Stage<ViewInput, Arc<Visible>>,
    background: Stage<ViewInput, Arc<Image>>,
}

/// What the camera's stages are made from.
#[derive(Clone, PartialEq)]
struct ViewInput {
    scene: Option<Same<Scene>>,
    render: RenderSettings,
    extent: Vec2,
    seed: u64,
    layout: Option<TextureLayout>,
}

/// How the picture without caustics is drawn.
type Draw = fn(&Scene, &RenderSettings, u64, &Progress) -> Result<Image>;

impl Seen {
    /// The texels of a layout through every pixel, and the picture without caustics. The plane has this extent.
    pub(super) fn look(
        &mut self,
        project: &Project,
        scene: Option<&Arc<Scene>>,
        (extent, layout): (Vec2, TextureLayout),
        draw: Draw,
        meter: &mut Meter,
        progress: &Progress,
    ) -> Result<(Arc<Visible>, Arc<Image>)> {
        let (render, seed) = (&project.render, project.seed);
        // The photons change nothing here but the layout, and how a picture is shown changes nothing at all.
        let seen = RenderSettings { passes: 1, photons: 1, view: Default::default(), ..render.clone() };
        let input = ViewInput { scene: scene.map(Same::of), render: seen, extent, seed, layout: None };
        let visible = ViewInput { layout: Some(layout), ..input.clone() };
        let visible = meter.measure("visible", || {
            self.visible.get(visible, |_| match scene {
                Some(scene) => Visible::through_camera(scene, &layout, render, seed, progress).map(Arc::new),
                None => Visible::flat(extent, &layout, render, progress).map(Arc::new),
            })
        })?;
        let background = match scene {
            None => Arc::new(Image::new(render.width as usize, render.height as usize)),
            Some(scene) => meter.measure("background", || {
                let make = |_: &_| draw(scene, render, seed, progress).map(Arc::new);
                self.background.get(input, make)
            })?,
        };
        Ok((visible, background))
    }
}
