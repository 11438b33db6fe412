//! The light of frames as the camera sees it, from the sums of their passes.

use glam::{Vec2, Vec4};
use rayon::prelude::*;

use super::camera::CameraPictures;
use crate::Result;
use crate::project::{Project, SegmentTime};
use crate::render::density::radius_of_pass;
use crate::render::{Image, PlaneMaterial, ProgressiveRender, ReceiverTexture, plane_image, smooth_sparse};
use crate::scene::Receiver;

/// The light of a frame as the camera sees it.
pub(super) struct FrameLight {
    /// Of all caustics.
    pub(super) all: Image,
    /// Of each by itself with the name of its layer, where they are apart.
    pub(super) caustics: Vec<(String, Image)>,
    /// The irradiance on the plane, where it is wanted.
    pub(super) plane: Option<Image>,
    /// The passes in it.
    pub(super) passes: usize,
}

/// What the light of frames is made from.
pub(super) struct FrameLights<'a> {
    pub(super) project: &'a Project,
    pub(super) render: &'a ProgressiveRender,
    /// What the camera sees apart from the light that flows.
    pub(super) pictures: &'a CameraPictures,
    /// Names of the layers of single caustics, whose light is in textures of their own; none where it is in one.
    pub(super) caustic_names: &'a [String],
    /// None without a scene.
    pub(super) receiver: Option<&'a Receiver>,
    /// Size of the plane, plane units.
    pub(super) extent: Vec2,
}

impl FrameLights<'_> {
    /// Textures of a frame.
    pub(super) fn textures(&self) -> usize {
        self.caustic_names.len().max(1)
    }

    /// The light of some slots with their moments; several together take less time than one by one.
    ///
    /// # Errors
    /// The scratch file cannot be read.
    pub(super) fn of(&self, moments: &[(usize, SegmentTime)]) -> Result<Vec<FrameLight>> {
        let count = self.textures();
        let read = |i: usize| self.render.mean(moments[i / count].0 * count + i % count);
        let mut means = (0..moments.len() * count).into_par_iter().map(read).collect::<Result<Vec<_>>>()?;
        means.par_chunks_mut(count).for_each(|means| self.smooth(means));
        let textures: Vec<&ReceiverTexture> = means.iter().map(|(texture, _)| texture).collect();
        let mut seen = self.pictures.visible.gather_all(&textures).into_iter();
        let seen: Vec<Vec<Image>> = moments.iter().map(|_| seen.by_ref().take(count).collect()).collect();
        let frames = moments.par_iter().zip(means.par_chunks(count)).zip(seen);
        Ok(frames.map(|((&(_, moment), means), seen)| self.frame(moment, means, seen)).collect())
    }

    /// Smooths what few photons carry in the textures of a frame.
    fn smooth(&self, means: &mut [(ReceiverTexture, usize)]) {
        let Some(passes) = means.last().map(|(_, passes)| *passes).filter(|passes| *passes > 0) else {
            return;
        };
        let photons = passes as f32 * self.project.render.photons as f32;
        let radius = radius_of_pass(self.render.first_radius(), passes - 1);
        smooth_sparse(means.iter_mut().map(|(texture, _)| texture), photons, radius);
    }

    /// The light of a frame from the means of its textures and what the camera sees of them.
    fn frame(
        &self,
        moment: SegmentTime,
        means: &[(ReceiverTexture, usize)],
        mut seen: Vec<Image>,
    ) -> FrameLight {
        let apart = !self.caustic_names.is_empty();
        for (group, caustic) in seen.iter_mut().enumerate() {
            self.pictures.add_still(caustic, apart.then_some(group), moment);
        }
        let passes = means.last().map_or(0, |(_, passes)| *passes);
        let plane = self.on_plane(means, moment);
        if !apart {
            let all = seen.pop().unwrap_or_else(|| Image::new(0, 0));
            return FrameLight { all, caustics: Vec::new(), plane, passes };
        }
        let image = &self.pictures.background.image;
        let all = seen.iter().fold(Image::new(image.width, image.height), |all, one| all.plus(one));
        let caustics = self.caustic_names.iter().cloned().zip(seen).collect();
        FrameLight { all, caustics, plane, passes }
    }

    /// The irradiance on the plane (W/m²), where it is wanted: the light that flows, and what stays in its place.
    fn on_plane(&self, means: &[(ReceiverTexture, usize)], moment: SegmentTime) -> Option<Image> {
        if !self.project.output.shows_plane() {
            return None;
        }
        let mut together = ReceiverTexture::new(*self.render.layout());
        for (texture, _) in means {
            let texels = together.texels_mut().iter_mut().zip(texture.texels());
            texels.for_each(|(sum, one): (&mut Vec4, _)| *sum += *one);
        }
        let metres = self.receiver.map_or(1.0, Receiver::metres_per_plane_unit);
        let mut plane = plane_image(&together, self.extent, PlaneMaterial::irradiance(metres));
        if let Some(still) = &self.pictures.still {
            still.add_to_plane(&mut plane, (self.extent, metres), moment);
        }
        Some(plane)
    }
}
