//! The commands of the menu Scene: transforms of the selected object, and actions of one step.

use lightloom_core::scene::SceneDesc;

use super::arrange::{self, Aim, Arranged};
use super::bounds::{Loaded, pivot, sphere};
use super::fly;
use super::object::SceneObject;
use super::transforming::{TransformKind, Transforming};
use crate::editor::action::Action;
use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::document::{Document, Edit};
use crate::editor::session::{Session, ViewLayout};

/// Carries out a command of the scene; returns whether it was one.
pub fn carry_out(command: Command, editor: &mut EditorContext) -> bool {
    if is_enabled(command, editor.document, editor.session).is_none() {
        return false;
    }
    let Some(scene) = editor.document.project().scene.clone() else { return true };
    match command {
        Command::LookThroughCamera => look_through(editor, &scene),
        Command::AlignCamera => align_camera(editor, scene),
        _ => match editor.session.focus.object.filter(|object| object.is_in(&scene)) {
            Some(object) => of_object(command, editor, &scene, object),
            None => say(editor, "Select a mesh, a light, the camera or the receiver first"),
        },
    }
    true
}

/// Whether a command of the scene has an effect now; none for other commands.
pub fn is_enabled(command: Command, document: &Document, session: &Session) -> Option<bool> {
    let scene = document.project().scene.as_ref();
    let object = session.focus.object.filter(|object| scene.is_some_and(|scene| object.is_in(scene)));
    let is_listed = object.is_some_and(|object| object.mesh().or(object.light()).is_some());
    Some(match command {
        // Where one of these cannot be done with the object, it says why.
        Command::MoveObject
        | Command::TurnObject
        | Command::ScaleObject
        | Command::FrameSelected
        | Command::SnapToTable
        | Command::AimAtGlass
        | Command::AimAtReceiver => object.is_some(),
        Command::DuplicateObject | Command::DeleteObject | Command::SwitchObject | Command::SoloObject => {
            is_listed
        }
        Command::LookThroughCamera => scene.is_some(),
        Command::AlignCamera => scene.is_some() && session.free_camera.is_some() && !session.through_camera,
        _ => return None,
    })
}

fn of_object(command: Command, editor: &mut EditorContext, scene: &SceneDesc, object: SceneObject) {
    let seen = editor.preview.look();
    let loaded = seen.loaded();
    let arranged = match command {
        Command::MoveObject => return transform(editor, TransformKind::Move, scene, object, loaded),
        Command::TurnObject => return transform(editor, TransformKind::Turn, scene, object, loaded),
        Command::ScaleObject => return transform(editor, TransformKind::Scale, scene, object, loaded),
        Command::FrameSelected => return frame(editor, scene, object, loaded),
        Command::DuplicateObject => return duplicate(editor, scene, object, loaded),
        Command::DeleteObject => {
            let deleted = arrange::deleted(scene, object);
            if deleted.is_ok() {
                editor.session.focus.object = None;
            }
            deleted
        }
        Command::SnapToTable => arrange::on_table(scene, object, loaded),
        Command::AimAtGlass => arrange::aimed(scene, object, Aim::Glass, loaded),
        Command::AimAtReceiver => arrange::aimed(scene, object, Aim::Receiver, loaded),
        Command::SwitchObject => arrange::switched(scene, object),
        Command::SoloObject => arrange::alone(scene, object),
        _ => return,
    };
    step(editor, arranged);
}

/// Asks for a scene as one undo step, or says why not.
fn step(editor: &mut EditorContext, arranged: Arranged) {
    match arranged {
        Ok(scene) => {
            editor.ask(Action::Settle);
            editor.ask(Edit::Scene(Some(Box::new(scene))));
            editor.ask(Action::Settle);
        }
        Err(reason) => say(editor, reason),
    }
}

fn say(editor: &mut EditorContext, words: &str) {
    editor.ask(Action::Say(words.to_owned()));
}

/// Begins a transform, in the orbit view.
fn transform(
    editor: &mut EditorContext,
    kind: TransformKind,
    scene: &SceneDesc,
    object: SceneObject,
    loaded: Option<Loaded>,
) {
    let Some(pivot) = pivot(scene, object, loaded) else { return };
    editor.ask(Action::Settle);
    editor.session.playing = false;
    editor.session.layout = ViewLayout::Orbit;
    editor.session.transforming = Some(Transforming::new(object, kind, scene, pivot));
}

/// Moves the free camera so that it shows the object.
fn frame(editor: &mut EditorContext, scene: &SceneDesc, object: SceneObject, loaded: Option<Loaded>) {
    let Some((centre, radius)) = sphere(scene, object, loaded) else { return };
    let session = &mut *editor.session;
    let from = session.free_camera.take().unwrap_or_else(|| fly::free(&scene.camera));
    session.layout = ViewLayout::Orbit;
    session.through_camera = false;
    session.free_camera = Some(fly::framed(&from, centre, radius));
}

fn duplicate(editor: &mut EditorContext, scene: &SceneDesc, object: SceneObject, loaded: Option<Loaded>) {
    match arrange::duplicated(scene, object, loaded) {
        Ok((scene, copy)) => {
            step(editor, Ok(scene));
            // Not before it is there.
            editor.ask(Action::SelectObject(copy));
        }
        Err(reason) => say(editor, reason),
    }
}

/// Looks through the project's camera, which then flies; or freely, from the same place.
fn look_through(editor: &mut EditorContext, scene: &SceneDesc) {
    let session = &mut *editor.session;
    let shown = session.layout == ViewLayout::Orbit;
    session.through_camera = !(shown && session.through_camera);
    if !session.through_camera {
        session.free_camera = Some(fly::free(&scene.camera));
    }
    session.layout = ViewLayout::Orbit;
}

/// Moves the project's camera to the free one.
fn align_camera(editor: &mut EditorContext, scene: SceneDesc) {
    let Some(free) = &editor.session.free_camera else { return };
    let camera = fly::aligned(&scene.camera, free);
    step(editor, Ok(SceneDesc { camera, ..scene }));
}
