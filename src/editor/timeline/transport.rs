//! The transport: playback buttons, frame number, frame rate.

use egui::{Align, ComboBox, DragValue, Layout, Rect, RichText, Ui};
use lightloom_core::project::OutputSettings;

use super::Timeline;
use super::commands::{carry_out, go, step};
use super::icons::{self, Icon};
use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::{playback, shortcuts};

/// Common frame rates, as fractions.
const RATES: [[u32; 2]; 10] = [
    [12, 1],
    [24_000, 1001],
    [24, 1],
    [25, 1],
    [30_000, 1001],
    [30, 1],
    [48, 1],
    [50, 1],
    [60_000, 1001],
    [60, 1],
];

impl Timeline {
    /// Shows the transport; returns the rectangle of the play button.
    pub(super) fn transport(&mut self, ui: &mut Ui, editor: &mut EditorContext) -> Rect {
        let mut play = Rect::NOTHING;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            command(ui, editor, Icon::First, Command::FirstFrame, false);
            command(ui, editor, Icon::PreviousKey, Command::PreviousKey, false);
            command(ui, editor, Icon::Back, Command::PreviousFrame, false);
            let icon = if editor.session.playing { Icon::Pause } else { Icon::Play };
            let playing = editor.session.playing;
            play = command(ui, editor, icon, Command::PlayPause, playing);
            command(ui, editor, Icon::Forward, Command::NextFrame, false);
            command(ui, editor, Icon::NextKey, Command::NextKey, false);
            command(ui, editor, Icon::Last, Command::LastFrame, false);
            let looping = editor.session.looping;
            command(ui, editor, Icon::Loop, Command::ToggleLoop, looping);
            ui.add_space(10.0);
            number(ui, editor);
            ui.add_space(10.0);
            command(ui, editor, Icon::AddKey, Command::AddKey, false);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let fit = icons::button(ui, Icon::Fit, "Show all frames", false);
                if fit.on_hover_text("Show all frames. The wheel zooms, the middle button pans.").clicked() {
                    self.seen = None;
                }
                ui.add_space(8.0);
                rate(ui, editor);
                ui.add_space(4.0);
                speed(ui, editor);
            });
        });
        play
    }
}

fn command(ui: &mut Ui, editor: &mut EditorContext, icon: Icon, command: Command, on: bool) -> Rect {
    let Some(entry) = command.info() else { return Rect::NOTHING };
    let response = icons::button(ui, icon, entry.name, on).on_hover_text(shortcuts::with_key(entry));
    if response.clicked() {
        carry_out(command, editor);
    }
    response.rect
}

fn number(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project().clone();
    let (whole, fps) = (playback::whole(&project), playback::fps(&project));
    let mut frame = editor.session.playhead;
    let field =
        DragValue::new(&mut frame).speed(0.1).range(-1_000_000..=1_000_000).update_while_editing(false);
    let shown = ui.add_sized([58.0, 22.0], field).accessible_name("Current frame");
    if shown.on_hover_text("The current frame. Drag, or click and type.").changed() {
        go(editor, frame);
    }
    let seconds = f64::from(editor.session.playhead - whole.start()) / fps;
    ui.add_space(4.0);
    ui.label(RichText::new(format!("of {}", whole.end())).weak());
    ui.add_space(6.0);
    ui.label(RichText::new(format!("{seconds:.2} s")).weak());
}

/// Playback speeds over the project's frame rate.
const SPEEDS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

fn speed(ui: &mut Ui, editor: &mut EditorContext) {
    let name = |speed: f64| format!("{speed} x");
    let speed = &mut editor.session.speed;
    let combo = ComboBox::from_id_salt("speed").width(66.0).selected_text(name(*speed));
    let shown = combo.show_ui(ui, |ui| {
        for choice in SPEEDS {
            ui.selectable_value(speed, choice, name(choice));
        }
    });
    let response = shown.response.accessible_name("Playback speed");
    response.on_hover_text("How fast it plays here. The project and its frames stay as they are.");
}

fn rate(ui: &mut Ui, editor: &mut EditorContext) {
    let output = editor.document.project().output.clone();
    let name = |[count, seconds]: [u32; 2]| {
        let text = format!("{:.3}", f64::from(count) / f64::from(seconds));
        format!("{} fps", text.trim_end_matches('0').trim_end_matches('.'))
    };
    let combo = ComboBox::from_id_salt("frame rate").width(86.0).selected_text(name(output.fps));
    let shown = combo.show_ui(ui, |ui| {
        for fps in RATES {
            if ui.selectable_label(fps == output.fps, name(fps)).clicked() && fps != output.fps {
                step(editor, Edit::Output(OutputSettings { fps, ..output.clone() }));
            }
        }
    });
    let response = shown.response.accessible_name("Frame rate");
    response.on_hover_text("Frames per second. It changes how fast the animation plays, not its frames.");
}
