//! The editor without its window: the open document, the session and the preview, and what actions do to them.

use lightloom_core::flow::MotionMethod;

use super::action::Action;
use super::clipboard;
use super::command::Command;
use super::context::EditorContext;
use super::document::{Document, Edit};
use super::engine::SharedEngine;
use super::jump;
use super::look;
use super::preview::LivePreview;
use super::selection::Selection;
use super::session::{
    Comparison, FieldMap, Panel, PlaneViewport, Session, ShotViewport, ViewLayout, Wipe, ZOOM_RANGE,
};
use super::timeline;
use super::tools::arrange::{self, Arranged};
use super::tools::groups;

/// Factor of one zoom step.
const ZOOM_STEP: f32 = 1.25;

/// Document, session and preview of the editor.
pub struct EditorState {
    /// The open project with its history.
    pub document: Document,
    /// The unsaved state of the window.
    pub session: Session,
    /// The results of the preview's workers.
    pub preview: LivePreview,
    /// The message in the status bar.
    pub status: String,
    /// Makes a preview of nothing yet.
    new_preview: Box<dyn Fn() -> LivePreview>,
}

impl EditorState {
    /// The editor at the first key frame of a document. `wake` is called from other threads when the preview has news.
    pub fn new(document: Document, engine: SharedEngine, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let session = start_of(&document);
        let new_preview = Box::new(move || LivePreview::new(engine.clone(), wake.clone()));
        Self { document, session, preview: new_preview(), status: String::new(), new_preview }
    }

    /// What a part of the window reads; the actions it asks for are appended to `actions`.
    pub fn context<'a>(&'a mut self, actions: &'a mut Vec<Action>) -> EditorContext<'a> {
        EditorContext {
            document: &self.document,
            session: &mut self.session,
            preview: &self.preview,
            status: &self.status,
            actions,
        }
    }

    /// Replaces the document. View layout, overlays, tool and panel stay as they are. The preview starts anew, with workers of
    /// its own: no late answer shows the light of another project.
    pub fn open(&mut self, document: Document) {
        let Session { layout, overlays, snapping, looping, speed, panel, tool, .. } = self.session.clone();
        self.session =
            Session { layout, overlays, snapping, looping, speed, panel, tool, ..start_of(&document) };
        self.document = document;
        self.status.clear();
        self.begin_preview();
    }

    /// Makes the preview anew.
    pub fn begin_preview(&mut self) {
        let old = std::mem::replace(&mut self.preview, (self.new_preview)());
        // Its workers stop soon; the window does not wait for them.
        let _ = std::thread::Builder::new().name("old preview".into()).spawn(move || drop(old));
    }

    /// Carries out an action. Returns it where it needs the window: files, dialogs, clipboard, preferences. A refused
    /// edit leaves the document as it is and its reason in the status bar.
    pub fn apply(&mut self, action: Action) -> Option<Action> {
        match action {
            Action::Edit(edit) => self.edit(edit),
            Action::Settle => self.document.settle(),
            Action::Abort => self.document.abort(),
            Action::Tool(tool) => self.session.tool = tool,
            Action::Select(selection) => self.session.selection = selection,
            Action::Playhead(frame) => self.session.playhead = frame,
            Action::Solo(groups) => self.session.solo = groups,
            Action::Probe(row) => self.session.probe = row,
            Action::SelectObject(object) => self.session.focus.object = Some(object),
            Action::Panel(panel) => self.session.panel = panel,
            Action::Show(about) => jump::jump(self.document.project(), &mut self.session, &about),
            Action::Say(message) => self.status = message,
            Action::Paste(text) => match clipboard::paste(self.document.project(), &text) {
                Ok(pasted) => self.arrange(Some(pasted)),
                Err(error) => self.status = error.to_string(),
            },
            Action::Command(command) if !self.command(command) => return Some(action),
            Action::Command(_) => (),
            Action::Open(_)
            | Action::OpenBackup(_)
            | Action::PlayFrames(_)
            | Action::New(_)
            | Action::PickFile(_)
            | Action::PlacePicture(_) => {
                return Some(action);
            }
        }
        self.keep_selection();
        None
    }

    /// Edits the document; the reason of a refusal goes to the status bar.
    pub fn edit(&mut self, edit: Edit) {
        let removes = matches!(edit, Edit::Remove(_));
        match self.document.edit(edit) {
            Ok(()) if removes => self.session.selection = Selection::default(),
            Ok(()) => self.status.clear(),
            Err(error) => self.status = error.to_string(),
        }
    }

    /// Changes what was drawn in one undo step, and selects the result.
    pub fn arrange(&mut self, arranged: Arranged) {
        if let Some((edit, selection)) = arranged {
            self.edit(edit);
            self.document.settle();
            self.session.selection = selection;
            self.session.panel = Panel::Drawn;
            self.keep_selection();
        }
    }

    /// Drops what no longer exists from the selections: constraints, points, objects of the scene.
    fn keep_selection(&mut self) {
        let points = self.document.project().constraints.iter().map(|c| c.points().len());
        self.session.selection.keep_within(&points.collect::<Vec<_>>());
        let scene = self.document.project().scene.as_ref();
        let focus = &mut self.session.focus;
        focus.object = focus.object.filter(|object| scene.is_some_and(|scene| object.is_in(scene)));
    }

    /// Carries out a command that needs no window; returns whether it was one.
    fn command(&mut self, command: Command) -> bool {
        let mut actions = Vec::new();
        // Delete removes selected constraints before the key frame in focus.
        let selected = command == Command::Delete && !self.session.selection.is_empty();
        let done = !selected && timeline::carry_out(command, &mut self.context(&mut actions));
        let done = done || look::commands::carry_out(command, &mut self.context(&mut actions));
        for action in actions {
            self.apply(action);
        }
        done || self.edit_command(command) || self.view_command(command)
    }

    fn edit_command(&mut self, command: Command) -> bool {
        let (project, selection) = (self.document.project().clone(), self.session.selection.clone());
        match command {
            Command::Undo => self.document.undo(),
            Command::Redo => self.document.redo(),
            Command::Duplicate => self.arrange(clipboard::duplicate(&project, &selection)),
            Command::Delete => self.arrange(arrange::delete(&project, &selection)),
            Command::Reverse => self.arrange(arrange::reverse(&project, &selection)),
            Command::Join => self.arrange(arrange::join(&project, &selection)),
            Command::Split => self.arrange(arrange::split(&project, &selection)),
            Command::Group => self.arrange(groups::group(&project, &selection)),
            Command::Ungroup => self.arrange(groups::ungroup(&project, &selection)),
            Command::SelectAll => self.session.selection = Selection::all(0..project.constraints.len()),
            Command::SelectNone => self.session.selection = Selection::default(),
            _ => return false,
        }
        true
    }

    fn view_command(&mut self, command: Command) -> bool {
        let session = &mut self.session;
        let overlays = &mut session.overlays;
        let toggle = |on: &mut bool| *on = !*on;
        let mut map = |wanted| overlays.map = Some(wanted).filter(|_| overlays.map != Some(wanted));
        match command {
            Command::ShowDivergence => map(FieldMap::Divergence),
            Command::ShowCurl => map(FieldMap::Curl),
            Command::ShowResidual => map(FieldMap::Residual),
            Command::ShowTears => map(FieldMap::Tears),
            Command::FalseColour => toggle(&mut overlays.false_colour),
            Command::ShowArrows => toggle(&mut overlays.arrows),
            Command::ShowStreamlines => toggle(&mut overlays.streamlines),
            Command::ShowTrails => toggle(&mut overlays.trails),
            Command::ShowGrid => toggle(&mut overlays.grid),
            Command::ShowTarget => toggle(&mut overlays.target),
            Command::ShowDrawn => toggle(&mut overlays.drawn),
            Command::BothViews => session.layout = ViewLayout::PlaneAndShot,
            Command::PlaneView => session.layout = ViewLayout::Plane,
            Command::ShotView => session.layout = ViewLayout::Shot,
            Command::OrbitView => session.layout = ViewLayout::Orbit,
            Command::FitView => {
                (session.plane, session.shot, session.free_camera) =
                    (PlaneViewport::default(), ShotViewport::default(), None);
            }
            Command::ZoomIn => zoom(session, ZOOM_STEP),
            Command::ZoomOut => zoom(session, ZOOM_STEP.recip()),
            Command::Compare => {
                let with = Comparison::Method(MotionMethod::Linear);
                session.compare =
                    if session.compare.is_some() { None } else { Some(Wipe { with, split: 0.5 }) };
            }
            _ => return false,
        }
        true
    }
}

/// The session of a document that was just opened.
fn start_of(document: &Document) -> Session {
    let first = document.project().keys.first().map_or(1, |key| key.frame);
    Session { playhead: first, ..Session::default() }
}

fn zoom(session: &mut Session, factor: f32) {
    let zoomed = |zoom: f32| (zoom * factor).clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
    session.plane.zoom = zoomed(if session.plane.zoom > 0.0 { session.plane.zoom } else { 1.0 });
    session.shot.zoom = zoomed(session.shot.zoom);
    session.shot.offset = session.shot.offset.map(|n| n * factor);
}
