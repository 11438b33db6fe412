//! Writes the gathered light of all frames to files.

use std::path::Path;
use std::sync::Mutex;

use rayon::prelude::*;

use super::film_writer::FilmWriter;
use super::frame_times::FrameTimes;
use super::summary::BadValues;
use crate::export::{
    Frame, FramePattern, Metadata, Overlay, OverlayLine, RepairedSamples, sheet, write_frame,
};
use crate::project::Project;
use crate::render::{FirstHits, GatherMatrix, Image, PlaneView, ProgressiveRender, View};
use crate::scene::camera::Camera;
use crate::{Error, Progress, Result};

/// Pictures on the contact sheet.
const SHEET_PICTURES: usize = 12;
/// Its columns.
const SHEET_COLUMNS: usize = 4;
/// Width of one of its pictures in pixels.
const SHEET_WIDTH: usize = 480;

/// Small pictures in screen values with the numbers of their frames.
pub(super) type Thumbnails = Vec<(i32, Image)>;

/// Everything that the frames of a run are made from.
pub(super) struct FrameWriter<'a> {
    pub(super) project: &'a Project,
    pub(super) render: &'a ProgressiveRender,
    pub(super) visible: &'a GatherMatrix,
    pub(super) background: &'a Image,
    pub(super) first_hits: Option<&'a FirstHits>,
    /// Names of the layers of single caustics, whose light is in textures of their own; none where it is in one.
    pub(super) caustic_names: &'a [String],
    pub(super) camera: Option<Camera>,
    /// The output folder.
    pub(super) folder: &'a Path,
    /// The drawn constraints, for the contact sheet.
    pub(super) drawn: &'a [OverlayLine],
    pub(super) plane: PlaneView,
    /// Called with each finished file.
    pub(super) saved: &'a (dyn Fn(&Path) + Sync),
}

/// The light of a frame as the camera sees it.
struct SeenLight {
    /// All caustics together.
    all: Image,
    /// Each by itself with the name of its layer, where they are apart.
    caustics: Vec<(String, Image)>,
    /// Its passes.
    passes: usize,
}

impl FrameWriter<'_> {
    /// Writes all frames and the contact sheet, and keeps those of a film; returns the replaced values, and the pictures on the sheet with their
    /// numbers.
    pub(super) fn run(
        &self,
        times: &FrameTimes,
        film: Option<&FilmWriter>,
        progress: &Progress,
    ) -> Result<(BadValues, Thumbnails)> {
        progress.begin("write", times.frames.len() as u64);
        let numbers: Vec<i32> = times.frames.iter().map(|(frame, _)| *frame).collect();
        let on_sheet = sheet::evenly_chosen(&numbers, SHEET_PICTURES);
        let view = self.project.render.view.view();
        let thumbnails = Mutex::new(Vec::new());
        let repairs: Vec<(i32, RepairedSamples)> = times
            .frames
            .par_iter()
            .enumerate()
            .map(|(index, &(frame, slot))| {
                if progress.is_abandoned() {
                    return Err(Error::Cancelled);
                }
                let (repairs, beauty) = self.frame(frame, slot, &view)?;
                if let Some(film) = film {
                    film.keep(index, &view.apply(&beauty))?;
                }
                if on_sheet.contains(&frame) {
                    let height = (SHEET_WIDTH * beauty.height).div_ceil(beauty.width);
                    let small = view.apply(&beauty.resized(SHEET_WIDTH, height));
                    thumbnails.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((frame, small));
                }
                progress.advance(1);
                Ok((frame, repairs))
            })
            .collect::<Result<_>>()?;
        let mut thumbnails = thumbnails.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        thumbnails.sort_by_key(|(frame, _)| numbers.iter().position(|n| n == frame));
        let path = self.folder.join("contact_sheet.png");
        let size = thumbnails.first().map_or([1, 1], |(_, p)| [p.width, p.height]);
        let pixel_from_plane = |point| self.plane.pixel_from_plane(point, size);
        let overlay = Overlay { lines: self.drawn, pixel_from_plane: &pixel_from_plane };
        sheet::write_contact_sheet(&path, &thumbnails, SHEET_COLUMNS, overlay)?;
        (self.saved)(&path);
        Ok((BadValues::sum(&repairs), thumbnails))
    }

    /// The current picture of a frame in screen values; none for a frame that is not rendered.
    pub(super) fn picture(&self, times: &FrameTimes, frame: i32) -> Result<Option<Image>> {
        let Some(&(_, slot)) = times.frames.iter().find(|(number, _)| *number == frame) else {
            return Ok(None);
        };
        let beauty = self.background.plus(&self.light(slot)?.all);
        Ok(Some(self.project.render.view.view().apply(&beauty)))
    }

    /// The light at a moment as the camera sees it.
    fn light(&self, moment: usize) -> Result<SeenLight> {
        let textures = self.caustic_names.len().max(1);
        let gathered = (0..textures).map(|i| {
            let (texture, passes) = self.render.mean(moment * textures + i)?;
            Ok((self.visible.gather(&texture), passes))
        });
        let mut gathered = gathered.collect::<Result<Vec<_>>>()?;
        let passes = gathered.first().map_or(0, |(_, passes)| *passes);
        if textures == 1 {
            let all = gathered.swap_remove(0).0;
            return Ok(SeenLight { all, caustics: Vec::new(), passes });
        }
        let mut all = Image::new(self.background.width, self.background.height);
        gathered.iter().for_each(|(image, _)| all = all.plus(image));
        let caustics = self.caustic_names.iter().cloned().zip(gathered.into_iter().map(|(image, _)| image));
        Ok(SeenLight { all, caustics: caustics.collect(), passes })
    }

    /// Writes one frame in all formats; returns its beauty picture.
    fn frame(&self, frame: i32, slot: usize, view: &View) -> Result<(RepairedSamples, Image)> {
        let SeenLight { all: caustic, caustics, passes } = self.light(slot)?;
        let output = &self.project.output;
        let metadata = self.metadata(frame, passes);
        let picture = Frame {
            layers: &output.layers,
            background: self.background,
            caustic: &caustic,
            caustics: &caustics,
            first_hits: self.first_hits,
            metadata: &metadata,
        };
        let pattern = FramePattern::parse(&output.name, "output.name")?;
        let mut all = RepairedSamples::default();
        for &format in &output.formats {
            let path = pattern.path(self.folder, frame, format);
            all += write_frame(&path, format, &picture, view, output.png_depth())?;
            (self.saved)(&path);
        }
        Ok((all, self.background.plus(&caustic)))
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
        if !method.fits() {
            settings.push(("method".into(), method.name().into()));
        }
        Metadata {
            frame,
            frames_per_second: (output.fps[0] as i32, output.fps[1]),
            seed: *seed,
            passes: passes as u32,
            camera: self.camera,
            settings,
        }
    }
}
