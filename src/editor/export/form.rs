//! The settings of a new export.

use egui::{Button, DragValue, Grid, TextEdit, Ui};
use lightloom_core::export::{FilmFormat, FrameFormat};

use super::options::{self, ExportOptions};
use super::path_field::path_field;
use crate::editor::context::EditorContext;
use crate::editor::dialogs::{PickRequest, Picker, Purpose};
use crate::editor::panels::layer_boxes;
use crate::editor::playback;
use crate::editor::reset_label::reset_label;

/// Width of the boxes of layers, points.
const LAYERS_WIDTH: f32 = 250.0;

/// Width of the field of the folder, points: with its button as wide as the rest.
const FOLDER: f32 = 202.0;

/// Shows the options, which reset to the project's `own`, and the time limit in minutes with its switch.
pub(super) fn show(
    ui: &mut Ui,
    editor: &EditorContext,
    (options, own): (&mut ExportOptions, &ExportOptions),
    (minutes, limited): &mut (f64, bool),
    picker: &mut Picker,
) {
    Grid::new("export settings").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
        let tip = "Which frames are rendered, such as 1-100, 1-100x5 or 1,5-10.";
        row(ui, "Frames", tip, &mut options.frames, &own.frames, |ui, frames| range(ui, editor, frames));
        purposes(ui, options, own);
        let tip = "Width and height of the pictures in pixels, 16 to 16384.";
        row(ui, "Size", tip, &mut options.size, &own.size, |ui, size| {
            for (side, label) in size.iter_mut().zip(["Width in pixels", "Height in pixels"]) {
                ui.add(DragValue::new(side).range(16..=16_384).suffix(" px")).accessible_name(label);
            }
        });
        let tip = "Each pass has its own photons: more passes, less noise, sharper edges.";
        row(ui, "Passes", tip, &mut options.passes, &own.passes, |ui, passes| {
            ui.add(DragValue::new(passes).range(1..=100_000).speed(0.2)).accessible_name("Passes");
        });
        let tip = "Photons of one pass. More photons make a finer picture and need more memory.";
        row(ui, "Photons", tip, &mut options.photons, &own.photons, |ui, photons| {
            let field = DragValue::new(photons).range(1..=100_000_000).speed(2_000.0);
            ui.add(field.custom_formatter(|n, _| grouped(n))).accessible_name("Photons per pass");
        });
        let tip = "EXR: linear half floats in layers, for compositing. PNG: display values.";
        row(ui, "Formats", tip, &mut options.formats, &own.formats, formats);
        let tip = "All frames in one file, film.gif and so on, that plays at the frame rate of the project. MP4 films are written by ffmpeg, where it is installed.";
        row(ui, "Film", tip, &mut options.film, &own.film, |ui, film| {
            ui.selectable_value(film, None, "None");
            for format in FilmFormat::ALL {
                ui.selectable_value(film, Some(format), format.extension().to_uppercase());
            }
        });
        let tip = "What EXR files hold. Without beauty and background none is traced: PNG files show the caustics on black.";
        reset_label(ui, "Layers", tip, &mut options.layers, &own.layers);
        // Two lines: in a row of one the next would lie over them.
        ui.vertical(|ui| {
            ui.set_max_width(LAYERS_WIDTH);
            let named = !editor.document.project().caustics.is_empty();
            ui.horizontal_wrapped(|ui| layer_boxes(ui, &mut options.layers, named));
        });
        ui.end_row();
        let tip = "Without a limit all passes are rendered. The first pass is always completed.";
        ui.label("Time").on_hover_text(tip);
        ui.horizontal(|ui| {
            ui.checkbox(limited, "Stop after");
            let field = DragValue::new(minutes).range(0.1..=10_000.0).speed(0.1).suffix(" min");
            ui.add_enabled(*limited, field).accessible_name("Minutes");
        });
        ui.end_row();
        let tip = "The output folder; created if it does not exist.";
        row(ui, "Folder", tip, &mut options.folder, &own.folder, |ui, folder| {
            path_field(ui, folder, FOLDER, "Folder");
            if ui.button("Browse…").clicked() {
                let start = folder.parent().map(ToOwned::to_owned);
                picker.ask(PickRequest::new(Purpose::ExportFolder).in_folder(start), ui.ctx());
            }
        });
    });
}

/// The choice of size, passes and photons by what the film is for.
fn purposes(ui: &mut Ui, options: &mut ExportOptions, own: &ExportOptions) {
    ui.label("For").on_hover_text("Sets size, passes and photons by what the film is for.");
    ui.horizontal(|ui| {
        for (purpose, name, tip) in options::Purpose::ALL {
            let wanted = purpose.apply(options, own);
            let button = ui.selectable_label(*options == wanted, name).on_hover_text(tip);
            if button.clicked() {
                *options = wanted;
            }
        }
    });
    ui.end_row();
}

/// One row: a label that resets the value, and its field.
fn row<T: Clone + PartialEq>(
    ui: &mut Ui,
    label: &str,
    tip: &str,
    value: &mut T,
    own: &T,
    field: impl FnOnce(&mut Ui, &mut T),
) {
    reset_label(ui, label, tip, value, own);
    ui.horizontal(|ui| field(ui, value));
    ui.end_row();
}

/// The field of the frames, and the button that takes them from the timeline.
fn range(ui: &mut Ui, editor: &EditorContext, frames: &mut String) {
    ui.add(TextEdit::singleline(frames).desired_width(120.0)).accessible_name("Frames");
    let played = playback::played(editor.document.project(), editor.session);
    let button = ui.add_enabled(editor.session.marks != [None; 2], Button::new("Marked range"));
    if button.on_hover_text("From the in point to the out point of the timeline.").clicked() {
        *frames = format!("{}-{}", played.start(), played.end());
    }
}

/// A count in groups of three digits.
fn grouped(count: f64) -> String {
    let digits = format!("{count:.0}");
    let group = |(i, digit): (usize, char)| {
        let parted = i > 0 && (digits.len() - i) % 3 == 0;
        [parted.then_some('\u{2009}'), Some(digit)].into_iter().flatten().collect::<Vec<_>>()
    };
    digits.chars().enumerate().flat_map(group).collect()
}

fn formats(ui: &mut Ui, chosen: &mut Vec<FrameFormat>) {
    for format in FrameFormat::ALL {
        let mut on = chosen.contains(&format);
        if ui.checkbox(&mut on, format.extension().to_uppercase()).changed() {
            // In the order of the list, whatever was clicked first.
            *chosen = FrameFormat::ALL
                .into_iter()
                .filter(|f| if *f == format { on } else { chosen.contains(f) })
                .collect();
        }
    }
}
