//! What the light shows at a key frame: the physical caustic, a picture, or points.

use egui::Ui;
use lightloom_core::project::Shows;
use lightloom_core::targets::{Channel, ImageTarget};

use super::setting::{Choice, Setting};
use crate::editor::action::Action;
use crate::editor::asset::{AssetUse, TargetSlot};
use crate::editor::context::EditorContext;

const SHOWS: Setting = Setting::choice(
    "Shows",
    "keys[].shows",
    &[
        Choice::new("physical_caustic", "Physical caustic", "what the scene's glass and mirrors really cast"),
        Choice::new("", "Picture", "the bright parts of a picture attract the light"),
        Choice::new("", "Points", "a file of points, one for each photon or fewer"),
        Choice::new("", "As all", "what the key frame shows by all light"),
    ],
)
.help("What the light shows at this key frame.");
const FILE: Setting = Setting::part("File", "keys[].shows.image.file")
    .help("PNG, JPEG, OpenEXR or Radiance HDR, relative to the project.");
const POINTS: Setting = Setting::part("File", "keys[].shows.points.file").help(
    "CSV with columns x, y and perhaps r, g, b, or NPY; in plane coordinates, relative to the project.",
);
const CHANNEL: Setting = Setting::choice(
    "Channel",
    "keys[].shows.image.channel",
    &[
        Choice::new("brightness", "Brightness", "luminance times opacity"),
        Choice::new("alpha", "Opacity", "opacity alone"),
    ],
)
.help("What of the picture attracts the light.");
const COLOUR: Setting = Setting::switch("Take colours", "keys[].shows.image.colour", false)
    .help("The light takes the picture's colours on; else it keeps its own.");
const INVERT: Setting = Setting::switch("Invert", "keys[].shows.image.invert", false)
    .help("The dark parts attract instead of the bright ones. Transparent parts never do.");
const THRESHOLD: Setting = Setting::real("Threshold", "keys[].shows.image.threshold", [0.0, 1.0], &[0.0])
    .help("Brightness below which a pixel counts as black. Raise it where a grey ground takes light.");
const CENTRE: Setting = Setting::vector("Centre", "keys[].shows.image.placement.centre", [-10.0, 10.0], &[])
    .help("Middle of the picture in plane coordinates: x to the right, y upwards, the longer side is 1. Default: the middle of the plane.");
const WIDTH: Setting = Setting::real("Width", "keys[].shows.image.placement.width", [0.0, 10.0], &[])
    .above()
    .slider(0.01, 2.0)
    .help("Width of the picture in plane units. Default: nine tenths of what fits.");
const TURN: Setting = Setting::real("Turn", "keys[].shows.image.placement.rotate", [-360.0, 360.0], &[0.0])
    .unit("°")
    .slider(-180.0, 180.0)
    .help("Turn of the picture about its middle, counter-clockwise.");

/// The settings of what is shown.
pub(super) const SETTINGS: &[Setting] =
    &[SHOWS, FILE, POINTS, CHANNEL, COLOUR, INVERT, THRESHOLD, CENTRE, WIDTH, TURN];

/// What is chosen where a caustic has nothing of its own.
const AS_ALL: usize = 3;

/// What is shown `at` a key; none of its own only where `may_be_none`. Gives what it is now where that changed.
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
    let mut setting = SHOWS;
    if at.caustic.is_none() {
        setting.options = &SHOWS.options[..AS_ALL];
    }
    let mut new = match setting.pick_another(ui, kind) {
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

/// A target without a file is none: what it shows changes when one is picked.
fn pick(editor: &mut EditorContext, pick: AssetUse) -> Option<Option<Shows>> {
    editor.ask(Action::PickFile(pick));
    None
}

/// The file's name, and a button that picks another; whether it was pressed.
pub(super) fn file(ui: &mut Ui, setting: &Setting, file: &str) -> bool {
    setting.line(ui, true, |ui| {
        let name = file.rsplit('/').next().unwrap_or(file);
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        let button = egui::Button::new(name).truncate();
        let response = ui.add_sized(size, button).accessible_name(format!("{}: {name}", setting.spoken()));
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
    WIDTH.optional(ui, &mut placement.width, "fit", 0.5);
    TURN.number(ui, &mut placement.rotate);
}
