//! The status line of the active export.

use egui::{Button, ProgressBar, RichText, Ui};

use super::{ExportJob, Exports, Status};
use crate::editor::theme;

/// Shows the active export, or the last finished one, in one line of the status bar. Returns whether it was clicked
/// to open the export window.
pub fn status_line(ui: &mut Ui, exports: &Exports) -> bool {
    let jobs = exports.jobs();
    let Some(job) = jobs.iter().find(|job| job.is_open()).or(jobs.last()) else { return false };
    let waiting = jobs.iter().filter(|job| job.status() == Status::Waiting).count();
    let mut wanted = false;
    ui.horizontal(|ui| {
        if job.is_open() {
            let more = if waiting > 0 { format!(", {waiting} waiting") } else { String::new() };
            let text = RichText::new(format!("{}{more}", words(job))).small();
            let bar = ProgressBar::new(job.progress().overall as f32)
                .text(text)
                .desired_width(260.0)
                .corner_radius(4);
            let show = |ui: &mut Ui| {
                wanted |= ui.add(bar).accessible_name("Export").interact(egui::Sense::click()).clicked();
            };
            // The bar comes first for the reader, from whichever side it is laid out.
            if ui.layout().prefer_right_to_left() {
                controls(ui, job);
                show(ui);
            } else {
                show(ui);
                controls(ui, job);
            }
        } else {
            let text = RichText::new(words(job)).color(colour(&job.status(), ui));
            wanted |= ui.add(Button::new(text).frame(false)).clicked();
        }
    });
    wanted
}

/// The buttons to pause, stop with the completed passes, and cancel, in this order for the reader.
pub(super) fn controls(ui: &mut Ui, job: &ExportJob) {
    let mut buttons: [fn(&mut Ui, &ExportJob); 3] = [pause, stop, cancel];
    if ui.layout().prefer_right_to_left() {
        buttons.reverse();
    }
    for button in buttons {
        button(ui, job);
    }
}

fn pause(ui: &mut Ui, job: &ExportJob) {
    let paused = job.is_paused();
    if ui.button(if paused { "Resume" } else { "Pause" }).clicked() {
        if paused { job.resume() } else { job.pause() }
    }
}

fn stop(ui: &mut Ui, job: &ExportJob) {
    let passes = job.passes();
    let stop = ui.add_enabled(passes > 0, Button::new("Stop"));
    let stop =
        stop.on_hover_text(format!("Stops now and writes all frames with the {passes} completed passes."));
    if stop.on_disabled_hover_text("Frames can be written once the first pass is complete.").clicked() {
        job.stop();
    }
}

fn cancel(ui: &mut Ui, job: &ExportJob) {
    let cancel = ui.button("Cancel");
    if cancel.on_hover_text("Cancels the export; nothing more is written.").clicked() {
        job.cancel();
    }
}

/// The status of a job in words.
pub(super) fn words(job: &ExportJob) -> String {
    match job.status() {
        Status::Waiting => "Waiting".into(),
        Status::Running if job.is_paused() => format!("Paused{}", passes(job)),
        Status::Running => {
            let seen = job.progress();
            let written =
                if seen.stage == Some("write") { format!(", {} files", job.files()) } else { passes(job) };
            format!("{}{written}, {} left", stage(seen.stage), time(seen.remaining))
        }
        Status::Done(outcome) => {
            let bad = if outcome.bad { "; some values had to be replaced, see summary.json" } else { "" };
            let part = if outcome.passes < outcome.planned {
                format!(" with {} of {} passes", outcome.passes, outcome.planned)
            } else {
                String::new()
            };
            format!("{} frames exported{part}{bad}", outcome.frames)
        }
        Status::Cancelled => "Export cancelled".into(),
        Status::Failed(why) => format!("Export failed: {why}"),
        Status::Occupied(_) => "Frames of another project or other settings are in the folder".into(),
    }
}

pub(super) fn colour(status: &Status, ui: &Ui) -> egui::Color32 {
    let colour = match status {
        Status::Done(outcome) if outcome.bad => theme::WARN,
        Status::Occupied(_) => theme::WARN,
        Status::Done(_) => theme::GOOD,
        Status::Failed(_) => theme::BAD,
        Status::Waiting | Status::Running | Status::Cancelled => return ui.visuals().text_color(),
    };
    theme::words(ui.visuals(), colour)
}

fn passes(job: &ExportJob) -> String {
    let planned = job.cost().map_or(0, |cost| cost.passes);
    let at_passes = job.progress().stage == Some("render");
    if at_passes { format!(", pass {} of {planned}", (job.passes() + 1).min(planned)) } else { String::new() }
}

/// The name of an engine stage in words.
fn stage(name: Option<&'static str>) -> &'static str {
    match name {
        None => "Reading files",
        Some("visible") => "Finding the visible receiver",
        Some("background") => "Rendering the background",
        Some("still") => "Rendering the light that does not flow",
        Some("trace") => "Tracing photons",
        Some("match") => "Matching",
        Some("plan") => "Planning the flow",
        Some("fit") => "Fitting the flow",
        Some("watch" | "measure") => "Measuring the flow",
        Some("render") => "Rendering",
        Some("write") => "Writing frames",
        Some("film") => "Writing the film",
        Some(other) => other,
    }
}

/// A duration in words, to two digits: it is an estimate.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "a moment".into(),
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
