//! One frame of the active tool over a view of the plane.

use egui::{Response, Ui};
use glam::Vec2;

use super::input;
use crate::editor::context::EditorContext;
use crate::editor::preview::FlowPicture;
use crate::editor::tools::{Gesture, Ghost, ToolContext, Toolbox};

/// What a view of the plane tells the active tool.
pub(super) struct Surface<'a> {
    /// Plane units per screen point.
    pub(super) per_point: f32,
    /// Size in pixels of the target picture at the playhead.
    pub(super) picture: Option<Vec2>,
    /// Photon positions at the playhead, by row; empty while unknown.
    pub(super) photons: &'a [Vec2],
}

/// Passes gestures to the active tool; `draw` then paints the flow and the tool's shapes. Shapes at the pointer are only
/// shown while it is over the view.
pub(super) fn run_tool<R>(
    (ui, response): (&Ui, &Response),
    editor: &mut EditorContext,
    toolbox: &mut Toolbox,
    gestures: Vec<Gesture>,
    surface: &Surface,
    draw: impl FnOnce(&ToolContext, &FlowPicture, &[Ghost]) -> R,
) -> R {
    let project = editor.document.project().clone();
    let context = ToolContext {
        project: &project,
        session: editor.session,
        extent: project.extent(),
        per_point: surface.per_point,
        held: input::held(ui),
        picture: surface.picture,
        photons: surface.photons,
    };
    for gesture in gestures {
        editor.actions.extend(toolbox.gesture(gesture, &context));
    }
    let here = response.contains_pointer() || toolbox.tool().is_busy();
    let mut ghosts = toolbox.ghosts(&context);
    ghosts.retain(|ghost| here || matches!(ghost, Ghost::Frame(..)));
    draw(&context, &editor.preview.flow(), &ghosts)
}
