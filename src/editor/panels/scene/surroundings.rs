//! Camera, receiver, sky; and the plane of a project without scene.

use egui::Ui;
use lightloom_core::project::PlaneSettings;
use lightloom_core::scene::{CameraDesc, EnvironmentDesc, ReceiverDesc};

use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::look::fly;
use crate::editor::panels::control::Control;
use crate::editor::panels::widgets::XYZ;
use crate::editor::session::ViewLayout;

const POSITION: Control = Control::new("Position", CameraDesc::POSITION);
const LOOK_AT: Control = Control::new("Looks at", CameraDesc::LOOK_AT);
const UP: Control = Control::new("Up", CameraDesc::UP);
const FOV: Control = Control::new("Field of view", CameraDesc::FOV).slider(5.0, 120.0);
const SHIFT: Control = Control::new("Lens shift", CameraDesc::SHIFT);
const CENTRE: Control = Control::new("Centre", ReceiverDesc::CENTRE);
const SIZE: Control = Control::new("Size", ReceiverDesc::SIZE);
const TURN: Control = Control::new("Turn", ReceiverDesc::ROTATE);
const ALBEDO: Control = Control::new("Albedo", ReceiverDesc::ALBEDO);
const SURROUND: Control = Control::new("Surround", ReceiverDesc::SURROUND).log_slider(0.0, 100.0);
const BORDER: Control = Control::new("Soft border", ReceiverDesc::BORDER).slider(0.0, 0.5).without_suffix();
const ZENITH: Control = Control::new("Zenith", EnvironmentDesc::ZENITH);
const HORIZON: Control = Control::new("Horizon", EnvironmentDesc::HORIZON);
const GROUND: Control = Control::new("Ground", EnvironmentDesc::GROUND);
const ASPECT: Control = Control::new("Aspect", PlaneSettings::ASPECT).log_slider(0.25, 4.0);
const WATTS: Control = Control::new("Power", PlaneSettings::WATTS).log_slider(0.01, 100.0);

/// The settings of this part.
#[rustfmt::skip]
pub(super) const CONTROLS: &[Control] = &[
    POSITION, LOOK_AT, UP, FOV, SHIFT, CENTRE, SIZE, TURN, ALBEDO, SURROUND, BORDER, ZENITH, HORIZON, GROUND, ASPECT, WATTS,
];

/// The camera.
pub(super) fn camera(ui: &mut Ui, editor: &mut EditorContext, camera: &mut CameraDesc) {
    POSITION.numbers(ui, &mut camera.position, XYZ);
    LOOK_AT.numbers(ui, &mut camera.look_at, XYZ);
    UP.numbers(ui, &mut camera.up, XYZ);
    FOV.number(ui, &mut camera.fov_deg);
    SHIFT.numbers(ui, &mut camera.shift, ["right", "up"]);
    let through = editor.session.layout == ViewLayout::Orbit && editor.session.through_camera;
    let look = ui.add(egui::Button::selectable(through, "Look through and fly").frame(true));
    if look
        .on_hover_text("The orbit view through this camera: a drag orbits it, Shift pans, the wheel dollies")
        .clicked()
    {
        editor.ask(Command::LookThroughCamera);
    }
    ui.add_enabled_ui(editor.session.free_camera.is_some() && !through, |ui| {
        let take = ui.button("Align camera to view").on_hover_text("Moves the camera to the orbit view");
        if take.on_disabled_hover_text("Open the orbit view first").clicked()
            && let Some(free) = &editor.session.free_camera
        {
            *camera = fly::aligned(camera, free);
        }
    });
}

/// The receiver.
pub(super) fn receiver(ui: &mut Ui, receiver: &mut ReceiverDesc) {
    SIZE.numbers(ui, &mut receiver.size, ["width", "height"]);
    CENTRE.numbers(ui, &mut receiver.centre, XYZ);
    TURN.numbers(ui, &mut receiver.rotate, XYZ);
    ALBEDO.colour(ui, &mut receiver.albedo);
    SURROUND.number(ui, &mut receiver.surround);
    BORDER.number(ui, &mut receiver.border);
}

/// The sky.
pub(super) fn sky(ui: &mut Ui, sky: &mut EnvironmentDesc) {
    ZENITH.colour(ui, &mut sky.zenith);
    HORIZON.colour(ui, &mut sky.horizon);
    GROUND.colour(ui, &mut sky.ground);
}

/// The plane of a project without scene.
pub(super) fn plane(ui: &mut Ui, plane: &mut PlaneSettings) {
    ASPECT.number(ui, &mut plane.aspect);
    WATTS.number(ui, &mut plane.watts);
}
