//! The rows of meshes and lights: eye, solo, name and kind; a click selects, here and in the orbit view.

use egui::{Button, RichText, Ui, vec2};
use lightloom_core::scene::SceneDesc;

use crate::editor::context::EditorContext;
use crate::editor::look::arrange;
use crate::editor::look::object::SceneObject;
use crate::editor::panels::icons::{self, Icon, SIDE};

/// The rows of all objects of a `kind`, by name and what they are; `object` makes one of its index.
pub(super) fn list(
    ui: &mut Ui,
    editor: &mut EditorContext,
    scene: &mut SceneDesc,
    kind: &str,
    names: &[(String, &'static str)],
    object: impl Fn(usize) -> SceneObject,
) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        for (index, (name, what)) in names.iter().enumerate() {
            row(ui, editor, scene, kind, (name, what), object(index));
        }
    });
}

fn row(
    ui: &mut Ui,
    editor: &mut EditorContext,
    scene: &mut SceneDesc,
    kind: &str,
    (name, what): (&str, &str),
    object: SceneObject,
) {
    let on = match object {
        SceneObject::Mesh(index) => scene.meshes.get(index).is_some_and(|mesh| mesh.enabled),
        _ => object.light().and_then(|index| scene.lights.get(index)).is_some_and(|light| light.is_enabled()),
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.spacing_mut().button_padding.x = 4.0;
        let (icon, verb) = if on { (Icon::Eye, "Switch off") } else { (Icon::EyeShut, "Switch on") };
        if icons::button(ui, icon, &format!("{verb}: {kind} {name}"), on).clicked() {
            take(scene, arrange::switched(scene, object));
        }
        let alone = arrange::is_alone(scene, object);
        let solo = ui.add(Button::selectable(alone, "S").frame(true).min_size(vec2(SIDE, SIDE)));
        let solo = solo.accessible_name(format!("Solo: {kind} {name}"));
        if solo.on_hover_text("Only this on, the others of the list off; again: all on").clicked() {
            take(scene, arrange::alone(scene, object));
        }
        let selected = editor.session.focus.object;
        let chosen = selected == Some(object)
            || object.light().is_some_and(|own| selected.and_then(SceneObject::light) == Some(own));
        let text = if on { RichText::new(name) } else { RichText::new(name).weak() };
        // Weak words are lost on the colour of the selection.
        let what = if chosen { RichText::new(what) } else { RichText::new(what).weak() };
        let button = Button::selectable(chosen, text).right_text(what).truncate();
        let size = vec2(ui.available_width(), SIDE);
        let button = ui.add_sized(size, button).accessible_name(format!("{kind} {name}"));
        if button.clicked() {
            editor.session.focus.object = (!chosen).then_some(object);
        }
        let was = ui.scope_id().with(("was chosen", kind, object));
        let was = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or_default::<bool>(was), chosen));
        if chosen && !was {
            button.scroll_to_me(None);
        }
    });
}

fn take(scene: &mut SceneDesc, arranged: arrange::Arranged) {
    if let Ok(arranged) = arranged {
        *scene = arranged;
    }
}
