//! Camera, receiver, sky; and the plane of a project without scene.

use egui::Ui;
use lightloom_core::project::PlaneSettings;
use lightloom_core::scene::{CameraDesc, EnvironmentDesc, ReceiverDesc};

use super::list::XYZ;
use crate::editor::context::EditorContext;
use crate::editor::panels::setting::Setting;

const POSITION: Setting = Setting::vector("Position", "scene.camera.position", [-1e6, 1e6], &[0.0, 1.2, 1.6])
    .help("Where the camera stands, x y z in metres; y is up.");
const LOOK_AT: Setting = Setting::vector("Looks at", "scene.camera.look_at", [-1e6, 1e6], &[0.0; 3])
    .help("The point in the middle of the picture, in metres.");
const UP: Setting = Setting::vector("Up", "scene.camera.up", [-1e6, 1e6], &[0.0, 1.0, 0.0])
    .help("What is up in the picture. Touch it only to look straight down, or to tilt.");
const FOV: Setting = Setting::real("Field of view", "scene.camera.fov_deg", [1.0, 170.0], &[40.0])
    .unit("°")
    .slider(5.0, 120.0)
    .help("Vertical angle of the picture. Narrow flattens, wide exaggerates.");
const CENTRE: Setting = Setting::vector("Middle", "scene.receiver.centre", [-1e6, 1e6], &[0.0; 3])
    .help("The middle of the rectangle on which the caustics fall, in metres.");
const SIZE: Setting = Setting::vector("Size", "scene.receiver.size", [1e-4, 1e5], &[1.0, 1.0])
    .help("Width and height in metres. What was drawn keeps its place in shares of the longer side.");
const TURN: Setting = Setting::vector("Turn", "scene.receiver.rotate", [-36_000.0, 36_000.0], &[0.0; 3])
    .help("Turn about the x, then y, then z axis in degrees; none lies flat and faces up.");
const ALBEDO: Setting = Setting::colour("Albedo", "scene.receiver.albedo", [0.0, 1.0], &[0.8, 0.8, 0.8])
    .help("Share of light it gives back, linear Rec.709. Darker tables let caustics stand out.");
const SURROUND: Setting = Setting::real("Surround", "scene.receiver.surround", [0.0, 1e5], &[0.0])
    .unit("m")
    .slider(0.0, 100.0)
    .logarithmic()
    .help("How much further the floor reaches around the rectangle in the picture.");
const ZENITH: Setting = Setting::colour("Zenith", "scene.environment.zenith", [0.0, 1e6], &[0.0, 0.0, 0.0])
    .help("Light from straight up, linear Rec.709 radiance. It casts no caustics.");
const HORIZON: Setting =
    Setting::colour("Horizon", "scene.environment.horizon", [0.0, 1e6], &[0.0, 0.0, 0.0])
        .help("Light from the horizon, linear Rec.709 radiance.");
const GROUND: Setting = Setting::colour("Ground", "scene.environment.ground", [0.0, 1e6], &[0.0, 0.0, 0.0])
    .help("Light from below the horizon where no floor hides it.");
const ASPECT: Setting = Setting::real("Aspect", "plane.aspect", [0.01, 100.0], &[1.0])
    .slider(0.25, 4.0)
    .logarithmic()
    .help("Width of the plane over its height.");
const WATTS: Setting = Setting::real("Power", "plane.watts", [1e-9, 1e9], &[1.0])
    .unit("W")
    .slider(0.01, 100.0)
    .logarithmic()
    .help("Power of all the light on the plane.");

/// The settings of this part.
#[rustfmt::skip]
pub(super) const SETTINGS: &[Setting] = &[
    POSITION, LOOK_AT, UP, FOV, CENTRE, SIZE, TURN, ALBEDO, SURROUND, ZENITH, HORIZON, GROUND, ASPECT, WATTS,
];

/// From where the picture is taken.
pub(super) fn camera(ui: &mut Ui, editor: &EditorContext, camera: &mut CameraDesc) {
    POSITION.numbers(ui, &mut camera.position, XYZ);
    LOOK_AT.numbers(ui, &mut camera.look_at, XYZ);
    UP.numbers(ui, &mut camera.up, XYZ);
    FOV.number(ui, &mut camera.fov_deg);
    ui.add_enabled_ui(editor.session.orbit.is_some(), |ui| {
        let take = ui.button("Align camera to view").on_hover_text("Moves the camera to the orbit view");
        if take.on_disabled_hover_text("Open the orbit view first").clicked()
            && let Some(orbit) = editor.session.orbit
        {
            *camera = orbit.camera(camera);
        }
    });
}

/// The rectangle of the caustics.
pub(super) fn receiver(ui: &mut Ui, receiver: &mut ReceiverDesc) {
    SIZE.numbers(ui, &mut receiver.size, ["width", "height"]);
    CENTRE.numbers(ui, &mut receiver.centre, XYZ);
    TURN.numbers(ui, &mut receiver.rotate, XYZ);
    ALBEDO.tint(ui, &mut receiver.albedo);
    SURROUND.number(ui, &mut receiver.surround);
}

/// The light of the sky.
pub(super) fn sky(ui: &mut Ui, sky: &mut EnvironmentDesc) {
    ZENITH.tint(ui, &mut sky.zenith);
    HORIZON.tint(ui, &mut sky.horizon);
    GROUND.tint(ui, &mut sky.ground);
}

/// The plane of a project without scene.
pub(super) fn plane(ui: &mut Ui, plane: &mut PlaneSettings) {
    ASPECT.number(ui, &mut plane.aspect);
    WATTS.number(ui, &mut plane.watts);
}
