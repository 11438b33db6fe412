//! The list of exports with their status, and the preview picture of the active one.

use egui::{Color32, ColorImage, RichText, ScrollArea, TextureHandle, TextureOptions, Ui, vec2};
use lightloom_core::engine::Existing;
use lightloom_core::export::FrameFormat;
use lightloom_core::render::Image;

use super::convergence;
use super::job::{ExportJob, ExportSettings, Growing, Status};
use super::queue::Exports;
use super::status_line::{colour, controls, words};
use crate::editor::action::Action;

/// The list of exports.
#[derive(Default)]
pub(super) struct JobList {
    /// The preview texture, with its job and passes, and its frame.
    picture: Option<([usize; 2], i32, TextureHandle)>,
}

impl JobList {
    /// Shows the list; the active export previews the frame at `playhead`.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        playhead: i32,
        exports: &mut Exports,
        actions: &mut Vec<Action>,
    ) {
        let jobs = exports.jobs().to_vec();
        if jobs.is_empty() {
            ui.weak("Exports run in the background, from the project as it is when they start. Each pass refines all frames, so that you can stop at any time.");
            return;
        }
        ui.horizontal(|ui| {
            ui.strong("Exports");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if jobs.iter().any(|job| !job.is_open()) && ui.small_button("Clear finished").clicked() {
                    exports.clear();
                    self.picture = None;
                }
            });
        });
        let active = jobs.iter().position(|job| job.is_open()).unwrap_or(jobs.len() - 1);
        jobs[active].show(playhead);
        ScrollArea::vertical().max_height(480.0).auto_shrink([false, true]).show(ui, |ui| {
            // The one at work first, then the newest.
            let others = (0..jobs.len()).rev().filter(|index| *index != active);
            for index in std::iter::once(active).chain(others) {
                let job = &jobs[index];
                ui.push_id(index, |ui| {
                    if index == active {
                        self.picture(ui, index, job);
                    }
                    if let Some(again) = card(ui, job, actions) {
                        exports.add(again);
                    }
                });
                ui.add_space(6.0);
            }
        });
    }

    /// The preview picture of a running job.
    fn picture(&mut self, ui: &mut Ui, index: usize, job: &ExportJob) {
        let Some(Growing { frame, passes, image }) = job.picture() else { return };
        let now = [index, passes];
        if !matches!(&self.picture, Some((of, shown, _)) if *of == now && *shown == frame) {
            let texture = ui.ctx().load_texture("export", on_screen(&image), TextureOptions::LINEAR);
            self.picture = Some((now, frame, texture));
        }
        if let Some((.., texture)) = &self.picture {
            let passes = convergence::counted(passes);
            let label = format!("Frame {frame} after {passes}");
            let shown =
                egui::Image::new(texture).max_size(vec2(ui.available_width(), 230.0)).corner_radius(3.0);
            let tip = format!("{label}. The frame under the playhead is shown after the next pass.");
            ui.add(shown.alt_text(&label)).on_hover_text(tip);
            ui.label(RichText::new(label).small().weak());
            convergence::show(ui, &job.noise());
        }
    }
}

/// One export; returns what the user decided to export after all.
fn card(ui: &mut Ui, job: &ExportJob, actions: &mut Vec<Action>) -> Option<ExportSettings> {
    let fill = ui.visuals().faint_bg_color;
    let mut decided = None;
    egui::Frame::new().fill(fill).corner_radius(4.0).inner_margin(8.0).show(ui, |ui| {
        ui.set_width(ui.available_width());
        let status = job.status();
        ui.label(RichText::new(job.settings().folder.to_string_lossy()).small().weak());
        ui.colored_label(colour(&status, ui), words(job));
        if !job.is_open() {
            let settings = job.settings();
            let shown = settings.project.output.formats.contains(&FrameFormat::Png);
            if matches!(status, Status::Occupied(_)) {
                decided = decide(ui, settings);
            }
            if matches!(status, Status::Done(_)) && shown && ui.button("Play frames").clicked() {
                actions.push(Action::PlayFrames(settings.folder.clone()));
            }
            return;
        }
        let bar = egui::ProgressBar::new(job.progress().overall as f32).show_percentage().corner_radius(4);
        ui.add(bar).accessible_name("Progress");
        if let Some(cost) = job.cost() {
            let (memory, scratch) = (size(cost.memory_mib), size(cost.scratch_mib));
            let text = format!(
                "Up to {memory} of memory for any number of frames; {scratch} of scratch space in the folder."
            );
            ui.label(RichText::new(text).small().weak());
        }
        ui.horizontal(|ui| controls(ui, job));
    });
    decided
}

/// Asks what becomes of the frames of another render.
fn decide(ui: &mut Ui, settings: &ExportSettings) -> Option<ExportSettings> {
    let answers = [
        ("Replace them", Existing::Overwrite, "The frames there are lost."),
        ("Keep them", Existing::Skip, "Only frames that are missing are exported."),
    ];
    let ask = |ui: &mut Ui| {
        let clicked =
            answers.into_iter().filter(|(text, _, tip)| ui.button(*text).on_hover_text(*tip).clicked());
        clicked.last().map(|(_, existing, _)| ExportSettings { existing, ..settings.clone() })
    };
    ui.horizontal(ask).inner
}

fn size(mib: f64) -> String {
    if mib < 1000.0 { format!("{mib:.0} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
}

/// Screen values in 0..=1 as bytes.
fn on_screen(image: &Image) -> ColorImage {
    let byte = |value: f32| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let pixels = image.pixels.iter().map(|c| Color32::from_rgb(byte(c.x), byte(c.y), byte(c.z))).collect();
    ColorImage::new([image.width, image.height], pixels)
}
