//! Writes the gathered light of all frames to files.

use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use glam::{Vec2, vec2};
use rayon::prelude::*;

use super::contact_sheet::{PICTURES, Thumbnails, thumbnails};
use super::disk_queue::{DiskQueue, with_disk};
use super::film_writer::FilmWriter;
use super::frame_light::{FrameLight, FrameLights};
use super::frame_times::FrameTimes;
use super::kept_picture::{kept_picture, small};
use super::run_files::RunFiles;
use super::summary::BadValues;
use crate::export::{
    Backdrop, Frame, FrameFormat, FrameLayer, FramePattern, Metadata, OverlayLine, RepairedSamples,
    encode_frame, encode_plane, evenly_chosen,
};
use crate::project::Project;
use crate::render::{Image, PlaneView, View};
use crate::scene::camera::Camera;
use crate::{Error, Progress, Result};

/// What was written.
#[derive(Default)]
pub(super) struct Written {
    /// The replaced values.
    pub(super) bad_values: BadValues,
    /// The pictures on the contact sheet.
    pub(super) thumbnails: Thumbnails,
    /// Frames for which there was no time.
    pub(super) left: usize,
}

/// Everything that the frames of a run are made from.
pub(super) struct FrameWriter<'a> {
    pub(super) lights: FrameLights<'a>,
    pub(super) camera: Option<Camera>,
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
    /// Writes the `requested` frames that are not there, and the contact sheet of all; keeps the pictures of a film. Where the
    /// time is short, frames all over the sequence come first.
    pub(super) fn run(
        &self,
        times: &FrameTimes,
        requested: &[i32],
        film: Option<&FilmWriter>,
        progress: &Progress,
    ) -> Result<Written> {
        progress.begin("write", requested.len() as u64);
        let rendered: HashMap<i32, usize> = times.frames.iter().copied().collect();
        let done = AtomicUsize::new(0);
        let view = self.lights.project.render.view.view();
        let pictures = self.lights.pictures;
        let hits = pictures.first_hits.as_deref();
        let backdrop = Backdrop::new(&self.lights.project.output.layers, &pictures.background.image, hits);
        let repairs = with_disk(self.saved, |disk| {
            let write = |&(index, frame): &(usize, i32), light: Option<FrameLight>| {
                if progress.is_abandoned() {
                    return Err(Error::Cancelled);
                }
                if progress.is_late() {
                    return Ok((frame, RepairedSamples::default()));
                }
                let (look, light) = ((&backdrop, &view), light.as_ref());
                let written = light.map(|light| self.frame(frame, light, look, disk)).transpose()?;
                film.map_or(Ok(()), |film| self.keep((index, frame), light, look, film))?;
                done.fetch_add(usize::from(light.is_some()), Relaxed);
                progress.advance(1);
                Ok((frame, written.unwrap_or_default()))
            };
            let mut frames: Vec<(usize, i32)> = requested.iter().copied().enumerate().collect();
            if progress.ends_soon() {
                frames.sort_by_key(|(index, _)| index.reverse_bits());
            }
            // What is too late is not even gathered.
            let slot = |frame| rendered.get(&frame).copied().filter(|_| !progress.is_late());
            self.in_batches(times, slot, &frames, write)
        })?;
        let thumbnails = if progress.is_late() { Vec::new() } else { self.write_sheet(times, requested)? };
        let wanted = requested.iter().filter(|frame| rendered.contains_key(frame)).count();
        let left = wanted - done.into_inner();
        Ok(Written { bad_values: BadValues::sum(&repairs), thumbnails, left })
    }

    /// Calls `write` with each frame and its place among those requested, and its light where it has a slot: those of one batch in
    /// parallel, while the light of the next is gathered.
    fn in_batches(
        &self,
        times: &FrameTimes,
        slot: impl Fn(i32) -> Option<usize> + Sync,
        frames: &[(usize, i32)],
        write: impl Fn(&(usize, i32), Option<FrameLight>) -> Result<(i32, RepairedSamples)> + Sync,
    ) -> Result<Vec<(i32, RepairedSamples)>> {
        let light = |frames: &[(usize, i32)]| {
            let slots: Vec<_> = frames.iter().map(|(_, frame)| slot(*frame)).collect();
            let moments: Vec<_> = slots.iter().flatten().map(|&slot| (slot, times.moments[slot])).collect();
            let mut lights = self.lights.of(&moments)?.into_iter();
            Ok::<_, Error>(slots.into_iter().map(|slot| slot.and_then(|_| lights.next())).collect::<Vec<_>>())
        };
        let mut batches = frames.chunks(self.batch());
        let mut next = || batches.next().map(|batch| Ok::<_, Error>((batch, light(batch)?))).transpose();
        let mut done = Vec::with_capacity(frames.len());
        let mut current = next()?;
        while let Some((batch, lights)) = current {
            let write = || batch.par_iter().zip(lights).map(|(frame, light)| write(frame, light));
            let (written, following) = rayon::join(|| write().collect::<Result<Vec<_>>>(), &mut next);
            done.extend(written?);
            current = following?;
        }
        Ok(done)
    }

    /// Keeps a frame, by its place and number, for the film.
    fn keep(
        &self,
        (index, frame): (usize, i32),
        light: Option<&FrameLight>,
        (backdrop, view): (&Backdrop, &View),
        film: &FilmWriter,
    ) -> Result<()> {
        if let Some(light) = light {
            return film.keep(index, &view.apply(&backdrop.background.plus(&light.all)));
        }
        let kept = kept_picture(&self.lights.project.output, self.folder, frame, view)?;
        kept.iter().try_for_each(|picture| film.keep(index, picture))
    }

    /// Writes the contact sheet, where one is wanted; returns the pictures on it.
    fn write_sheet(&self, times: &FrameTimes, requested: &[i32]) -> Result<Thumbnails> {
        if !self.files.sheet {
            return Ok(Vec::new());
        }
        let mut thumbnails = thumbnails(self.lights.project, self.folder, requested)?;
        if thumbnails.is_empty() {
            // No file has a picture, such as where the light on the plane alone is written.
            for frame in evenly_chosen(requested, PICTURES) {
                thumbnails.extend(self.picture(times, frame)?.map(|picture| (frame, small(&picture))));
            }
        }
        self.files.write_sheet(&thumbnails, (self.drawn, &self.plane), (self.folder, self.saved))?;
        Ok(thumbnails)
    }

    /// Frames whose light is in memory at once: as many as there are threads, and at least as many as are gathered together.
    fn batch(&self) -> usize {
        rayon::current_num_threads().max(4).div_ceil(self.lights.textures())
    }

    /// The current picture of a frame in screen values; none for a frame that is not rendered.
    pub(super) fn picture(&self, times: &FrameTimes, frame: i32) -> Result<Option<Image>> {
        let Some(&(_, slot)) = times.frames.iter().find(|(number, _)| *number == frame) else {
            return Ok(None);
        };
        let lights = self.lights.of(&[(slot, times.moments[slot])])?;
        let beauty = |light: &FrameLight| self.lights.pictures.background.image.plus(&light.all);
        let view = self.lights.project.render.view.view();
        Ok(lights.first().map(|light| view.apply(&beauty(light))))
    }

    /// Writes one frame in all formats.
    fn frame(
        &self,
        frame: i32,
        light: &FrameLight,
        (backdrop, view): (&Backdrop, &View),
        disk: &DiskQueue,
    ) -> Result<RepairedSamples> {
        let output = &self.lights.project.output;
        let metadata = self.metadata(frame, light.passes);
        // An unfinished frame is replaced soon, and may be wanted within seconds.
        let compressed = light.passes >= self.planned;
        let (caustic, caustics) = (&light.all, &light.caustics[..]);
        let picture = Frame { backdrop, caustic, caustics, metadata: &metadata, compressed };
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
            let (bytes, repairs) = encode_frame(&path, format, &picture, view, output.png_depth())?;
            all += repairs;
            disk.put(path, bytes)?;
        }
        if let Some(plane) = &light.plane {
            let path = pattern.beside(FrameLayer::Plane.name()).path(self.folder, frame, FrameFormat::Exr);
            if !self.files.found.kept.contains(&path) {
                let (bytes, repairs) = encode_plane(&path, plane, &self.plane_metadata(metadata))?;
                all += repairs;
                disk.put(path, bytes)?;
            }
        }
        Ok(all)
    }

    /// The metadata of the light on the plane: its unit and its place in the world.
    fn plane_metadata(&self, mut of_frame: Metadata) -> Metadata {
        of_frame.camera = None;
        let mut tell = |name: &str, value: String| of_frame.settings.push((name.into(), value));
        tell("unit", "W/m^2, irradiance; times albedo / pi it is the radiance of a matt plane".into());
        if let Some(receiver) = self.lights.receiver {
            let extent = self.lights.extent;
            let corners = [Vec2::ZERO, vec2(extent.x, 0.0), vec2(0.0, extent.y)];
            let corners = corners.map(|corner| receiver.world_from_plane(corner).to_array());
            tell("corners", format!("{corners:?}: lower left, lower right, upper left; metres, y is up"));
        }
        of_frame
    }

    fn metadata(&self, frame: i32, passes: usize) -> Metadata {
        let Project { name, seed, method, flow, render, output, .. } = self.lights.project;
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
            camera: self.camera,
            settings,
        }
    }
}
