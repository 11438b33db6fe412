//! What the light shows at a key frame: the physical caustic, a picture, or points.

use egui::Ui;
use lightloom_core::project::{KeyFrame, Shows};
use lightloom_core::targets::{Channel, ImageTarget, Placement, PointsTarget};

use super::control::Control;
use crate::editor::action::Action;
use crate::editor::asset::{AssetUse, TargetSlot};
use crate::editor::context::EditorContext;

const SHOWS: Control =
    Control::new("Shows", KeyFrame::SHOWS).labels(&["Physical caustic", "Picture", "Points", "As all"]);
const FILE: Control = Control::new("File", ImageTarget::FILE);
const POINTS: Control = Control::new("File", PointsTarget::FILE);
const CHANNEL: Control = Control::new("Channel", ImageTarget::CHANNEL).labels(&["Brightness", "Opacity"]);
const COLOUR: Control = Control::new("Take colours", ImageTarget::COLOUR);
const INVERT: Control = Control::new("Invert", ImageTarget::INVERT);
const THRESHOLD: Control = Control::new("Threshold", ImageTarget::THRESHOLD);
const CENTRE: Control = Control::new("Centre", Placement::CENTRE);
const WIDTH: Control = Control::new("Width", Placement::WIDTH).slider(0.01, 2.0).without_suffix();
const TURN: Control = Control::new("Turn", Placement::ROTATE).slider(-180.0, 180.0);

/// The settings of what is shown.
pub(super) const CONTROLS: &[Control] =
    &[SHOWS, FILE, POINTS, CHANNEL, COLOUR, INVERT, THRESHOLD, CENTRE, WIDTH, TURN];

/// The choice where a caustic shows what all light shows.
const AS_ALL: usize = 3;

/// What is shown `at` a key; none where a caustic has nothing of its own. The new value, where it changed.
pub(super) fn show(
    ui: &mut Ui,
    editor: &mut EditorContext,
    at: &TargetSlot,
    shows: Option<&Shows>,
) -> Option<Option<Shows>> {
    let kind = match shows {
        Some(Shows::PhysicalCaustic) => 0,
        Some(Shows::Image(_)) => 1,
        Some(Shows::Points(_)) => 2,
        None => AS_ALL,
    };
    let mut control = SHOWS;
    if at.caustic.is_none() {
        control.labels = &SHOWS.labels[..AS_ALL];
    }
    let mut new = match control.pick_another(ui, kind) {
        Some(0) => Some(Some(Shows::PhysicalCaustic)),
        Some(1) => pick(editor, AssetUse::Picture(at.clone())),
        Some(2) => pick(editor, AssetUse::Points(at.clone())),
        Some(_) => Some(None),
        None => None,
    };
    match shows {
        Some(Shows::Image(image)) => {
            let mut changed = image.clone();
            if file(ui, &FILE, &image.file) {
                editor.ask(Action::PickFile(AssetUse::Picture(at.clone())));
            }
            picture(ui, editor, &mut changed);
            if editor.document.project().scene.is_some() {
                let what = "Lays the picture where the caustic falls that becomes it, as large, upright for the camera and in its view.";
                if ui.button("Fit to the light").on_hover_text(what).clicked() {
                    editor.ask(Action::PlacePicture(at.clone()));
                }
            }
            if changed != *image {
                new = Some(Some(Shows::Image(changed)));
            }
        }
        Some(Shows::Points(points)) if file(ui, &POINTS, &points.file) => {
            editor.ask(Action::PickFile(AssetUse::Points(at.clone())));
        }
        _ => {}
    }
    new
}

/// Asks for a file; the target changes once one is picked.
fn pick(editor: &mut EditorContext, pick: AssetUse) -> Option<Option<Shows>> {
    editor.ask(Action::PickFile(pick));
    None
}

/// A button with the file's name that picks another file. Whether it was clicked.
pub(super) fn file(ui: &mut Ui, control: &Control, file: &str) -> bool {
    control.line(ui, true, |ui| {
        let name = file.rsplit('/').next().unwrap_or(file);
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        let button = egui::Button::new(name).truncate();
        let response =
            ui.add_sized(size, button).accessible_name(format!("{}: {name}", control.accessible_name()));
        response.on_hover_text(format!("{file}. Click for another.")).clicked()
    })
}

fn picture(ui: &mut Ui, editor: &EditorContext, image: &mut ImageTarget) {
    CHANNEL.choose(ui, &mut image.channel, &[Channel::Brightness, Channel::Alpha]);
    COLOUR.toggle(ui, &mut image.colour);
    INVERT.toggle(ui, &mut image.invert);
    THRESHOLD.number(ui, &mut image.threshold);
    let placement = &mut image.placement;
    let middle = editor.document.project().extent() / 2.0;
    let mut centre = placement.centre.unwrap_or(middle.into());
    let row = CENTRE.row(ui, placement.centre.is_some(), |ui| {
        let width = (ui.available_width() - 4.0) / 2.0;
        for (component, name) in centre.iter_mut().zip(["Centre x", "Centre y"]) {
            CENTRE.field(ui, component, width, name);
        }
    });
    if row.reset {
        placement.centre = None;
    } else if centre != placement.centre.unwrap_or(middle.into()) {
        placement.centre = Some(centre);
    }
    WIDTH.optional(ui, &mut placement.width, "fill", 0.5);
    TURN.number(ui, &mut placement.rotate);
}
