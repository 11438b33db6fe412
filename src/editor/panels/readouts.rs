//! Readouts: the numbers of the frame that is shown.

use egui::{Color32, RichText, Ui};
use lightloom_core::Note;
use lightloom_core::continuity::{Continuity, FIGURES, Figure};
use lightloom_core::engine::{Preview, Quality, SegmentContinuity};
use lightloom_core::flow::FlowReport;
use lightloom_core::note::About;
use lightloom_core::setting::format::number;

use super::control;
use super::control::row::LABELS;
use super::widgets::{fold, section};
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::theme;

/// Deviation of the energy above which it is marked.
const ENERGY: f64 = 0.01;

/// Most notes in a tooltip, and its width, points.
const TOLD: usize = 4;
const TOOLTIP: f32 = 420.0;

/// A number with name and help.
#[derive(Clone, Debug, PartialEq)]
struct Readout {
    /// Its label.
    pub name: &'static str,
    /// The number with its unit.
    pub value: String,
    /// Its meaning, and what to do where it is bad.
    pub help: &'static str,
    /// Whether it is marked as bad.
    pub is_bad: bool,
}

/// The readouts of a preview at a frame; `tolerance` is that of the solver.
fn of(preview: &Preview, frame: i32, tolerance: f32) -> Vec<Readout> {
    let detail = match preview.quality() {
        Quality::Draft => "draft",
        Quality::Preview => "preview",
        Quality::Fine | Quality::Final => "fine",
    };
    let mut all = vec![Readout {
        name: "Photons",
        value: format!("{} ({detail})", number(preview.photons() as f64, true)),
        help: "Photons of the preview; it gets finer while nothing is changed.",
        is_bad: false,
    }];
    if let Some(energy) = preview.energy(frame) {
        all.push(of_energy(energy));
    }
    if let Some(change) = preview.unsteadiness(frame) {
        all.push(Readout {
            name: "Step change",
            value: percent(change),
            help: "How much the photons' step changes from this frame to the next, over the step itself. High values flicker: raise alpha, lower the rate of turbulence, or use more frames.",
            is_bad: false,
        });
    }
    if let Some(numbers) = preview.numbers() {
        all.extend(of_flow(&numbers.flow, tolerance));
    }
    all
}

fn of_energy(energy: f64) -> Readout {
    Readout {
        name: "Energy",
        value: format!("{:.2} %", 100.0 * energy),
        help: "Light at this frame over that of the source, times rho, colour and brightness. It should be 100 %.",
        is_bad: (energy - 1.0).abs() > ENERGY,
    }
}

fn of_flow(flow: &FlowReport, tolerance: f32) -> Vec<Readout> {
    let [early, middle, late] = flow.crossing_index.map(percent);
    let plain = |name, value, help| Readout { name, value, help, is_bad: false };
    let count = |name, count: usize, help| Readout {
        name,
        value: number(count as f64, true),
        help,
        is_bad: count > 0,
    };
    vec![
        count(
            "Wall crossings",
            flow.wall_crossings,
            "Photons that crossed a wall though a path leads around it. It should be 0.",
        ),
        count(
            "Unreachable",
            flow.unreachable,
            "Photons whose target lies behind walls without a path around them: they go straight through. Open the walls, or move the target.",
        ),
        plain(
            "Crossing index",
            format!("{early}, {middle}, {late}"),
            "Share of the motion that neighbours do not have in common, at a quarter, half and three quarters of the time. High values look like noise.",
        ),
        plain(
            "Dispersion",
            number(digits(flow.dispersion), false),
            "How much neighbours differ in velocity, over the run. Low values look like one fluid.",
        ),
        plain(
            "Peak speed",
            format!("{} x", number(digits(flow.peak_speed_ratio), false)),
            "Fastest photons over the mean straight speed. Lower the speed limit of the fade where light darts.",
        ),
        plain(
            "Fit residual",
            percent(flow.fit_residual),
            "Share of the motion to the targets that the field does not represent; the fade corrects it.",
        ),
        plain(
            "Solver",
            format!("{} iterations", flow.solver_iterations),
            "Most iterations of the solver in a fit.",
        ),
        Readout {
            name: "Solver error",
            value: number(digits(flow.solver_error), false),
            help: "Largest error of the velocities that the solver leaves, relative. Above the tolerance the fit did not converge.",
            is_bad: flow.solver_error > f64::from(tolerance),
        },
    ]
}

/// Rounded to three significant digits.
fn digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

fn percent(share: f64) -> String {
    format!("{} %", number(digits(100.0 * share), false))
}

/// The panel of readouts.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    if let Some(problem) = editor.preview.problem() {
        ui.colored_label(theme::words(ui.visuals(), theme::BAD), problem);
        ui.add_space(4.0);
    }
    let Some(preview) = editor.preview.preview() else {
        ui.weak("Nothing is computed yet.");
        return;
    };
    // Above what comes later: a link stays where it is.
    let notes = editor.preview.notes();
    if !notes.is_empty() {
        section(ui, "Notes");
        for note in notes {
            if show_note(ui, note) {
                editor.actions.push(Action::Show(note.about.clone()));
            }
        }
    }
    let frame = editor.session.playhead;
    section(ui, &format!("Frame {frame}"));
    if !editor.preview.is_current() {
        ui.weak("From before the last change.");
    }
    for readout in of(preview, frame, editor.document.project().flow.tolerance) {
        let colour = if readout.is_bad { bad(ui) } else { ui.visuals().text_color() };
        line(ui, readout.name, &readout.value, colour, readout.help);
    }
    if let Some(segments) = editor.preview.continuity() {
        show_continuity(ui, &segments, frame);
    }
    section(ui, "Seconds of each stage");
    for stage in preview.stages() {
        let seconds = number(digits(stage.seconds), false);
        let help = "Wall-clock time; cached results do not run again.";
        line(ui, stage.stage, &format!("{seconds} s"), ui.visuals().text_color(), help);
    }
    fold(ui, "Left out", |ui| {
        if preview.left_out().is_empty() {
            ui.weak("Nothing: this project needs every stage.");
        }
        for left_out in preview.left_out() {
            ui.label(RichText::new(left_out.what).strong());
            ui.weak(left_out.why);
        }
    });
}

/// A note, as a link to what it is about; returns whether that is asked for.
fn show_note(ui: &mut Ui, note: &Note) -> bool {
    if note.about == About::Project {
        ui.label(&note.text);
        return false;
    }
    let clicked = ui.link(&note.text).on_hover_text(format!("Show {}", note.about.place())).clicked();
    if let (true, About::Setting(place)) = (clicked, &note.about) {
        control::row::seek(ui, place);
    }
    clicked
}

/// How well the light of the segment of a frame holds together.
fn show_continuity(ui: &mut Ui, segments: &[SegmentContinuity], frame: i32) {
    let holds = |segment: &&SegmentContinuity| (segment.frames[0]..=segment.frames[1]).contains(&frame);
    let Some(segment) = segments.iter().find(holds) else { return };
    for (name, figures) in segment.named_figures() {
        section(ui, &format!("Holding together, {name}"));
        for readout in of_continuity(figures) {
            let colour = if readout.is_bad { bad(ui) } else { ui.visuals().text_color() };
            line(ui, &capitalised(readout.name), &readout.value, colour, readout.help);
        }
    }
}

/// The colour of a figure that is not as it should be.
fn bad(ui: &Ui) -> Color32 {
    theme::words(ui.visuals(), theme::WARN)
}

/// With a capital first letter, as labels have it.
fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn of_continuity(figures: &Continuity) -> Vec<Readout> {
    let readout = |figure: &Figure| {
        let is_bad = figure.is_seen(figures);
        Some(Readout { name: figure.name, value: figure.text(figures)?, help: figure.help, is_bad })
    };
    FIGURES.iter().filter_map(readout).collect()
}

fn line(ui: &mut Ui, name: &str, value: &str, colour: Color32, help: &str) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let size = egui::vec2(LABELS, ui.text_style_height(&egui::TextStyle::Body));
        ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_min_width(LABELS);
            ui.add(egui::Label::new(RichText::new(name).weak()).truncate()).on_hover_text(help);
        });
        ui.add(egui::Label::new(RichText::new(value).color(colour)).truncate()).on_hover_text(help);
    });
}

/// The most important of it for the status bar, from right to left; nothing of a project that cannot be computed.
pub(in crate::editor) fn status_line(ui: &mut Ui, editor: &EditorContext) {
    if editor.preview.problem().is_some() {
        return;
    }
    let Some(preview) = editor.preview.preview() else { return };
    for readout in in_short(preview, editor.session.playhead).into_iter().rev() {
        let text = RichText::new(readout.value);
        let text = if readout.is_bad { text.color(bad(ui)) } else { text.weak() };
        ui.label(text).on_hover_text(readout.help);
    }
}

/// How many notes there are, for the status bar; whether they are asked for.
pub(in crate::editor) fn note_count(ui: &mut Ui, notes: &[Note]) -> bool {
    let words = match notes.len() {
        0 => return false,
        1 => "1 note".to_owned(),
        count => format!("{count} notes"),
    };
    let button = egui::Button::new(RichText::new(words).color(bad(ui))).small();
    let response = ui.add(button).on_hover_ui(|ui| {
        ui.set_max_width(TOOLTIP);
        notes.iter().take(TOLD).for_each(|note| {
            ui.label(&note.text);
        });
        if notes.len() > TOLD {
            ui.weak(format!("and {} more", notes.len() - TOLD));
        }
    });
    response.clicked()
}

/// The linear light of a pixel, as rendered and as exposed.
pub(in crate::editor) fn pixel(ui: &mut Ui, light: glam::Vec3, exposure: f32) {
    ui.label(RichText::new(pixel_in_words(light, exposure)).weak()).on_hover_text(
        "Linear light under the pointer: red, green, blue as in the EXR files, whatever the exposure; in brackets as exposed, \
         1 is the white of a screen without view transform.",
    );
}

fn pixel_in_words(light: glam::Vec3, exposure: f32) -> String {
    let words =
        |light: glam::Vec3| light.to_array().map(|value| number(digits(f64::from(value)), false)).join("  ");
    let exposed =
        if exposure == 0.0 { String::new() } else { format!("  ({})", words(light * exposure.exp2())) };
    format!("RGB {}{exposed}", words(light))
}

fn in_short(preview: &Preview, frame: i32) -> Vec<Readout> {
    let mut all = vec![Readout {
        name: "Photons",
        value: format!("{} photons", number(preview.photons() as f64, true)),
        help: "Photons of the preview.",
        is_bad: false,
    }];
    if let Some(energy) = preview.energy(frame) {
        let readout = of_energy(energy);
        all.push(Readout { value: format!("energy {}", readout.value), ..readout });
    }
    let crossed = preview.numbers().map_or(0, |numbers| numbers.flow.wall_crossings);
    let unreachable = preview.numbers().map_or(0, |numbers| numbers.flow.unreachable);
    for (count, words, help) in [
        (crossed, "through walls", "Photons that crossed a wall though a path leads around it."),
        (unreachable, "unreachable", "Photons whose target no path around the walls reaches."),
    ] {
        if count > 0 {
            let value = format!("{} {words}", number(count as f64, true));
            all.push(Readout { name: "Walls", value, help, is_bad: true });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_marked_beyond_one_per_cent() {
        for (energy, bad) in [(1.0, false), (1.0099, false), (0.985, true), (1.02, true)] {
            assert_eq!(of_energy(energy).is_bad, bad, "{energy}");
        }
    }

    #[test]
    fn a_pixel_is_told_as_rendered_and_as_exposed() {
        let light = glam::Vec3::new(0.125, 0.25, 1.0);
        assert_eq!(pixel_in_words(light, 0.0), "RGB 0.125  0.25  1");
        assert_eq!(pixel_in_words(light, 1.0), "RGB 0.125  0.25  1  (0.25  0.5  2)");
    }

    #[test]
    fn walls_and_a_solver_that_did_not_end_are_marked() {
        let good = FlowReport::default();
        assert!(of_flow(&good, 1e-4).iter().all(|readout| !readout.is_bad));
        let bad = FlowReport { wall_crossings: 1, unreachable: 2, solver_error: 1e-3, ..good };
        let marked: Vec<_> =
            of_flow(&bad, 1e-4).into_iter().filter(|readout| readout.is_bad).map(|r| r.name).collect();
        assert_eq!(marked, ["Wall crossings", "Unreachable", "Solver error"]);
    }
}
