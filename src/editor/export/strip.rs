//! The export that is at work, in one line.

use egui::{Button, ProgressBar, Response, RichText, Ui};

use super::{Exports, Job, Stage};
use crate::editor::theme;

/// Shows the export at work, or the last one that is over, in one line of the status bar. Returns whether it was clicked:
/// then the window of exports is wanted.
pub fn strip(ui: &mut Ui, exports: &Exports) -> bool {
    let jobs = exports.jobs();
    let Some(job) = jobs.iter().find(|job| job.is_open()).or(jobs.last()) else { return false };
    let waiting = jobs.iter().filter(|job| job.stage() == Stage::Waiting).count();
    let mut wanted = false;
    ui.horizontal(|ui| {
        if job.is_open() {
            let more = if waiting > 0 { format!(", {waiting} waiting") } else { String::new() };
            let text = RichText::new(format!("{}{more}", words(job))).small();
            let bar = ProgressBar::new(job.progress().overall as f32)
                .text(text)
                .desired_width(260.0)
                .corner_radius(4);
            wanted |= ui.add(bar).accessible_name("Export").interact(egui::Sense::click()).clicked();
            controls(ui, job);
        } else {
            let text = RichText::new(words(job)).color(colour(&job.stage(), ui));
            wanted |= ui.add(Button::new(text).frame(false)).clicked();
        }
    });
    wanted
}

/// Pause and cancel; stopping with what is complete, once something is.
pub(super) fn controls(ui: &mut Ui, job: &Job) {
    let paused = job.is_paused();
    if ui.button(if paused { "Go on" } else { "Pause" }).clicked() {
        if paused { job.resume() } else { job.pause() }
    }
    let passes = job.passes();
    let stop = ui.add_enabled(passes > 0, Button::new("Stop"));
    let stop = stop.on_hover_text(format!(
        "Ends it now: all frames are written with the {passes} passes that are complete."
    ));
    if stop.on_disabled_hover_text("Once the first pass is complete, all frames can be written.").clicked() {
        job.stop();
    }
    let cancel: Response = ui.button("Cancel");
    if cancel.on_hover_text("Breaks it off: nothing more is written.").clicked() {
        job.cancel();
    }
}

/// How a job stands, in words.
pub(super) fn words(job: &Job) -> String {
    match job.stage() {
        Stage::Waiting => "Waiting".into(),
        Stage::Running if job.is_paused() => format!("Paused{}", passes(job)),
        Stage::Running => {
            let seen = job.progress();
            let written =
                if seen.stage == Some("write") { format!(", {} files", job.files()) } else { passes(job) };
            format!("{}{written}, {} left", stage(seen.stage), time(seen.remaining))
        }
        Stage::Done(outcome) => {
            let bad = if outcome.bad { "; some values had to be replaced, see summary.json" } else { "" };
            let part = if outcome.passes < outcome.planned {
                format!(" with {} of {} passes", outcome.passes, outcome.planned)
            } else {
                String::new()
            };
            format!("{} frames exported{part}{bad}", outcome.frames)
        }
        Stage::Cancelled => "Export cancelled".into(),
        Stage::Failed(why) => format!("Export failed: {why}"),
    }
}

pub(super) fn colour(stage: &Stage, ui: &Ui) -> egui::Color32 {
    match stage {
        Stage::Done(outcome) if outcome.bad => theme::WARN,
        Stage::Done(_) => theme::GOOD,
        Stage::Failed(_) => theme::BAD,
        Stage::Waiting | Stage::Running | Stage::Cancelled => ui.visuals().text_color(),
    }
}

fn passes(job: &Job) -> String {
    let planned = job.cost().map_or(0, |cost| cost.passes);
    let at_passes = job.progress().stage == Some("render");
    if at_passes { format!(", pass {} of {planned}", (job.passes() + 1).min(planned)) } else { String::new() }
}

/// The stages of the pipeline in words.
fn stage(name: Option<&'static str>) -> &'static str {
    match name {
        None => "Reading files",
        Some("visible") => "Looking at the receiver",
        Some("background") => "Lighting the background",
        Some("trace") => "Tracing photons",
        Some("match") => "Matching",
        Some("fit") => "Fitting the flow",
        Some("render") => "Rendering",
        Some("write") => "Writing frames",
        Some(other) => other,
    }
}

/// Seconds in words, to two figures: an estimate knows no more.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "a moment".into(),
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
