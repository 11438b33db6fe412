//! Writes the gathered light of all frames to files.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Mutex;

use glam::{Vec2, Vec4, vec2};
use rayon::prelude::*;

use super::camera::CameraPictures;
use super::film_writer::FilmWriter;
use super::frame_times::FrameTimes;
use super::kept_picture::kept_picture;
use super::output_folder::CONTACT_SHEET;
use super::run_files::RunFiles;
use super::summary::BadValues;
use crate::export::{
    Frame, FrameFormat, FrameLayer, FramePattern, Metadata, Overlay, OverlayLine, RepairedSamples, sheet,
    write_frame, write_plane,
};
use crate::project::{Project, SegmentTime};
use crate::render::{Image, PlaneMaterial, PlaneView, ProgressiveRender, ReceiverTexture, View, plane_image};
use crate::scene::Receiver;
use crate::scene::camera::Camera;
use crate::{Error, Progress, Result};

/// Pictures on the contact sheet.
pub(super) const SHEET_PICTURES: usize = 12;
/// Its columns.
pub(super) const SHEET_COLUMNS: usize = 4;
/// Width of one of its pictures in pixels.
const SHEET_WIDTH: usize = 480;

/// Small pictures in screen values with the numbers of their frames.
pub(super) type Thumbnails = Vec<(i32, Image)>;

/// A picture as small as on the sheet.
pub(super) fn small(image: &Image) -> Image {
    image.resized(SHEET_WIDTH, (SHEET_WIDTH * image.height).div_ceil(image.width))
}

/// What a contact sheet tells of itself. It is as finished as it can be: any run of the same makes it anew.
pub(super) fn sheet_texts(fingerprint: &str) -> [(&'static str, String); 3] {
    [("passes", "0"), ("passes_planned", "0"), ("fingerprint", fingerprint)]
        .map(|(name, text)| (name, text.to_owned()))
}

/// The light of a frame as the camera sees it.
struct FrameLight {
    /// Of all caustics.
    all: Image,
    /// Of each by itself with the name of its layer, where they are apart.
    caustics: Vec<(String, Image)>,
    /// The irradiance on the plane, where it is wanted.
    plane: Option<Image>,
    /// The passes in it.
    passes: usize,
}

/// Everything that the frames of a run are made from.
pub(super) struct FrameWriter<'a> {
    pub(super) project: &'a Project,
    pub(super) render: &'a ProgressiveRender,
    /// What the camera sees apart from the light that flows.
    pub(super) pictures: &'a CameraPictures,
    /// Names of the layers of single caustics, whose light is in textures of their own; none where it is in one.
    pub(super) caustic_names: &'a [String],
    pub(super) camera: Option<Camera>,
    /// None without a scene.
    pub(super) receiver: Option<&'a Receiver>,
    /// Size of the plane, plane units.
    pub(super) extent: Vec2,
    /// The output folder.
    pub(super) folder: &'a Path,
    /// The drawn constraints, for the contact sheet.
    pub(super) drawn: &'a [OverlayLine],
    pub(super) plane: PlaneView,
    /// What is there already.
    pub(super) files: &'a RunFiles,
    /// Passes of a finished frame.
    pub(super) planned: usize,
    /// Called with each finished file.
    pub(super) saved: &'a (dyn Fn(&Path) + Sync),
}

impl FrameWriter<'_> {
    /// Writes the `requested` frames that are not there, and the contact sheet of all; keeps the pictures of a film. Returns
    /// the replaced values, and the pictures on the sheet with their numbers.
    pub(super) fn run(
        &self,
        times: &FrameTimes,
        requested: &[i32],
        film: Option<&FilmWriter>,
        progress: &Progress,
    ) -> Result<(BadValues, Thumbnails)> {
        progress.begin("write", requested.len() as u64);
        let on_sheet =
            if self.files.sheet { sheet::evenly_chosen(requested, SHEET_PICTURES) } else { Vec::new() };
        let view = self.project.render.view.view();
        let thumbnails = Mutex::new(Vec::new());
        let rendered: HashMap<i32, usize> = times.frames.iter().copied().collect();
        let repairs: Vec<(i32, RepairedSamples)> = requested
            .par_iter()
            .enumerate()
            .map(|(index, &frame)| {
                if progress.is_abandoned() {
                    return Err(Error::Cancelled);
                }
                let shown = on_sheet.contains(&frame);
                let mut repairs = RepairedSamples::default();
                let mut small_picture = None;
                if let Some(&slot) = rendered.get(&frame) {
                    let (repaired, beauty) = self.frame(frame, (slot, times.moments[slot]), &view)?;
                    repairs = repaired;
                    film.map_or(Ok(()), |film| film.keep(index, &view.apply(&beauty)))?;
                    small_picture = shown.then(|| view.apply(&small(&beauty)));
                } else if (film.is_some() || shown)
                    && let Some(picture) = kept_picture(&self.project.output, self.folder, frame, &view)?
                {
                    film.map_or(Ok(()), |film| film.keep(index, &picture))?;
                    small_picture = shown.then(|| small(&picture));
                }
                if let Some(small) = small_picture {
                    thumbnails.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((frame, small));
                }
                progress.advance(1);
                Ok((frame, repairs))
            })
            .collect::<Result<_>>()?;
        let mut thumbnails = thumbnails.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        thumbnails.sort_by_key(|(frame, _)| requested.iter().position(|n| n == frame));
        let path = self.folder.join(CONTACT_SHEET);
        if self.files.sheet && !self.files.found.kept.contains(&path) {
            let size = thumbnails.first().map_or([1, 1], |(_, p)| [p.width, p.height]);
            let pixel_from_plane = |point| self.plane.pixel_from_plane(point, size);
            let overlay = Overlay { lines: self.drawn, pixel_from_plane: &pixel_from_plane };
            let texts = sheet_texts(&self.files.fingerprint);
            sheet::write_contact_sheet(&path, &thumbnails, SHEET_COLUMNS, overlay, &texts)?;
            (self.saved)(&path);
        }
        Ok((BadValues::sum(&repairs), thumbnails))
    }

    /// The current picture of a frame in screen values; none for a frame that is not rendered.
    pub(super) fn picture(&self, times: &FrameTimes, frame: i32) -> Result<Option<Image>> {
        let Some(&(_, slot)) = times.frames.iter().find(|(number, _)| *number == frame) else {
            return Ok(None);
        };
        let light = self.light(slot, times.moments[slot])?;
        let beauty = self.pictures.background.image.plus(&light.all);
        Ok(Some(self.project.render.view.view().apply(&beauty)))
    }

    /// The light of a slot and moment.
    fn light(&self, slot: usize, moment: SegmentTime) -> Result<FrameLight> {
        if self.caustic_names.is_empty() {
            let (texture, passes) = self.render.mean(slot)?;
            let all = self.pictures.caustic(&texture, None, moment);
            let plane = self.on_plane(&texture, moment);
            return Ok(FrameLight { all, caustics: Vec::new(), plane, passes });
        }
        let mut together =
            self.project.output.shows_plane().then(|| ReceiverTexture::new(*self.render.layout()));
        let image = &self.pictures.background.image;
        let (mut all, mut passes) = (Image::new(image.width, image.height), 0);
        let mut caustics = Vec::new();
        for (group, name) in self.caustic_names.iter().enumerate() {
            let (texture, of_group) = self.render.mean(slot * self.caustic_names.len() + group)?;
            let caustic = self.pictures.caustic(&texture, Some(group), moment);
            all = all.plus(&caustic);
            if let Some(together) = &mut together {
                let texels = together.texels_mut().iter_mut().zip(texture.texels());
                texels.for_each(|(sum, one): (&mut Vec4, _)| *sum += *one);
            }
            caustics.push((name.clone(), caustic));
            passes = of_group;
        }
        let plane = together.and_then(|together| self.on_plane(&together, moment));
        Ok(FrameLight { all, caustics, plane, passes })
    }

    /// The irradiance on the plane (W/m²), where it is wanted: the light that flows, and what stays in its place.
    fn on_plane(&self, texture: &ReceiverTexture, moment: SegmentTime) -> Option<Image> {
        if !self.project.output.shows_plane() {
            return None;
        }
        let metres = self.receiver.map_or(1.0, Receiver::metres_per_plane_unit);
        let mut plane = plane_image(texture, self.extent, PlaneMaterial::irradiance(metres));
        if let Some(still) = &self.pictures.still {
            still.add_to_plane(&mut plane, (self.extent, metres), moment);
        }
        Some(plane)
    }

    /// Writes one frame in all formats; returns its beauty picture.
    fn frame(
        &self,
        frame: i32,
        (slot, moment): (usize, SegmentTime),
        view: &View,
    ) -> Result<(RepairedSamples, Image)> {
        let FrameLight { all: caustic, caustics, plane, passes } = self.light(slot, moment)?;
        let background = &self.pictures.background.image;
        let output = &self.project.output;
        let metadata = self.metadata(frame, passes);
        let picture = Frame {
            layers: &output.layers,
            background,
            caustic: &caustic,
            caustics: &caustics,
            first_hits: self.pictures.first_hits.as_deref(),
            metadata: &metadata,
        };
        let pattern = FramePattern::parse(&output.name, "output.name")?;
        let mut all = RepairedSamples::default();
        for &format in &output.formats {
            if format == FrameFormat::Exr && !output.shows_frames() {
                continue;
            }
            let path = pattern.path(self.folder, frame, format);
            if self.files.found.kept.contains(&path) {
                continue;
            }
            all += write_frame(&path, format, &picture, view, output.png_depth())?;
            (self.saved)(&path);
        }
        if let Some(plane) = plane {
            let path = pattern.beside(FrameLayer::Plane.name()).path(self.folder, frame, FrameFormat::Exr);
            if !self.files.found.kept.contains(&path) {
                all += write_plane(&path, &plane, &self.plane_metadata(metadata))?;
                (self.saved)(&path);
            }
        }
        Ok((all, background.plus(&caustic)))
    }

    /// The metadata of the light on the plane: its unit and its place in the world.
    fn plane_metadata(&self, mut of_frame: Metadata) -> Metadata {
        of_frame.camera = None;
        let mut tell = |name: &str, value: String| of_frame.settings.push((name.into(), value));
        tell("unit", "W/m^2, irradiance; times albedo / pi it is the radiance of a matt plane".into());
        if let Some(receiver) = self.receiver {
            let corners = [Vec2::ZERO, vec2(self.extent.x, 0.0), vec2(0.0, self.extent.y)];
            let corners = corners.map(|corner| receiver.world_from_plane(corner).to_array());
            tell("corners", format!("{corners:?}: lower left, lower right, upper left; metres, y is up"));
        }
        of_frame
    }

    fn metadata(&self, frame: i32, passes: usize) -> Metadata {
        let Project { name, seed, method, flow, render, output, .. } = self.project;
        // Plain numbers and strings: writing them as JSON has nothing to fail on.
        let json = |value: serde_json::Result<String>| value.unwrap_or_default();
        let mut settings = vec![
            ("project".into(), name.clone()),
            ("flow".into(), json(serde_json::to_string(flow))),
            ("render".into(), json(serde_json::to_string(render))),
        ];
        settings.push(("passes_planned".into(), self.planned.to_string()));
        settings.push(("fingerprint".into(), self.files.fingerprint.clone()));
        if !method.fits() {
            settings.push(("method".into(), method.name().into()));
        }
        Metadata {
            frame,
            frames_per_second: (output.fps[0] as i32, output.fps[1]),
            seed: *seed,
            passes: passes as u32,
            is_finished: passes >= self.planned,
            camera: self.camera,
            settings,
        }
    }
}
