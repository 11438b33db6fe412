//! Carries out commands.

use eframe::egui;

use super::file_state::Leave;
use super::{App, Gpu};
use crate::editor::clipboard;
use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::selection::Selection;
use crate::editor::session::{Comparison, FieldMap, Panel, PlaneViewport, ShotViewport, ViewLayout, Wipe};
use crate::editor::store::PhotonRenderer;
use crate::editor::tools::arrange::{self, Arranged};
use crate::editor::{preferences, timeline};
use lightloom_core::flow::Movement;

/// Factor of one step of zooming.
const ZOOM: f32 = 1.25;

impl App {
    /// Carries out a command.
    pub(super) fn command(&mut self, ctx: &egui::Context, command: Command) {
        let mut actions = Vec::new();
        let drawn = !self.session.selection.is_empty();
        let mut editor = EditorContext {
            document: &self.document,
            session: &mut self.session,
            preview: &self.preview,
            actions: &mut actions,
        };
        // What is drawn and selected goes before the key frame in focus.
        let done = !(drawn && command == Command::Delete) && timeline::carry_out(command, &mut editor);
        for action in actions {
            self.apply(ctx, action);
        }
        if !done && !self.edit_command(ctx, command) && !self.view_command(command) {
            self.window_command(ctx, command);
        }
    }

    /// Commands that change the document; tells whether it was one.
    fn edit_command(&mut self, ctx: &egui::Context, command: Command) -> bool {
        let (project, selection) = (self.document.project().clone(), self.session.selection.clone());
        match command {
            Command::Undo => self.document.undo(),
            Command::Redo => self.document.redo(),
            Command::Copy => self.copy(ctx, clipboard::copy(&project, &selection)),
            Command::Cut => {
                if let Some((text, arranged)) = clipboard::cut(&project, &selection) {
                    self.copy(ctx, Some(text));
                    self.arrange(arranged);
                }
            }
            Command::Paste => ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
            Command::Duplicate => self.arrange(clipboard::duplicate(&project, &selection)),
            Command::Delete => self.arrange(arrange::delete(&project, &selection)),
            Command::Reverse => self.arrange(arrange::reverse(&project, &selection)),
            Command::Join => self.arrange(arrange::join(&project, &selection)),
            Command::Split => self.arrange(arrange::split(&project, &selection)),
            Command::SelectAll => self.session.selection = Selection::all(0..project.constraints.len()),
            Command::SelectNone => self.session.selection = Selection::default(),
            _ => return false,
        }
        true
    }

    /// Commands that change what is shown; tells whether it was one.
    fn view_command(&mut self, command: Command) -> bool {
        let session = &mut self.session;
        let show = &mut session.overlays;
        let toggle = |on: &mut bool| *on = !*on;
        let mut map = |wanted| show.map = if show.map == Some(wanted) { None } else { Some(wanted) };
        match command {
            Command::ShowDivergence => map(FieldMap::Divergence),
            Command::ShowCurl => map(FieldMap::Curl),
            Command::ShowResidual => map(FieldMap::Residual),
            Command::ShowArrows => toggle(&mut show.arrows),
            Command::ShowStreamlines => toggle(&mut show.streamlines),
            Command::ShowTrails => toggle(&mut show.trails),
            Command::ShowGrid => toggle(&mut show.grid),
            Command::ShowTarget => toggle(&mut show.target),
            Command::ShowDrawn => toggle(&mut show.drawn),
            Command::BothViews => session.layout = ViewLayout::PlaneAndShot,
            Command::PlaneView => session.layout = ViewLayout::Plane,
            Command::ShotView => session.layout = ViewLayout::Shot,
            Command::OrbitView => session.layout = ViewLayout::Orbit,
            Command::FitView => {
                (session.plane, session.shot, session.orbit) =
                    (PlaneViewport::default(), ShotViewport::default(), None);
            }
            Command::ActualSize => self.views.actual_size(session, self.document.project()),
            Command::ZoomIn => zoom(session, ZOOM),
            Command::ZoomOut => zoom(session, ZOOM.recip()),
            Command::Compare => {
                let with = Comparison::Method(Movement::Linear);
                session.compare =
                    if session.compare.is_some() { None } else { Some(Wipe { with, split: 0.5 }) };
            }
            Command::Snapping => {
                toggle(&mut session.snapping);
                self.preferences.snapping = session.snapping;
            }
            _ => return false,
        }
        true
    }

    /// Commands of the window and its files.
    fn window_command(&mut self, ctx: &egui::Context, command: Command) {
        let scale = &mut self.preferences.ui_scale;
        match command {
            Command::New => self.windows.welcome.open = true,
            Command::Open => self.ask_what_to_open(ctx),
            Command::Save => self.save(ctx),
            Command::SaveAs => self.save_as(ctx),
            Command::Quit => self.leave(ctx, Leave::Quit),
            Command::Export => self.windows.export.open = true,
            Command::Palette => self.windows.palette.open(),
            Command::Shortcuts => self.windows.shortcuts.open = !self.windows.shortcuts.open,
            Command::Preferences => self.windows.preferences = !self.windows.preferences,
            Command::Tour => self.windows.tour.begin(self.document.project()),
            Command::Larger => *scale = preferences::stepped(*scale, 1),
            Command::Smaller => *scale = preferences::stepped(*scale, -1),
            Command::NormalSize => *scale = 1.0,
            _ => {}
        }
        preferences::apply(ctx, &self.preferences);
    }

    fn copy(&mut self, ctx: &egui::Context, text: Option<String>) {
        if let Some(text) = text {
            ctx.copy_text(text);
        }
    }

    /// Puts in what the clipboard holds.
    pub(super) fn paste(&mut self, text: &str) {
        match clipboard::paste(self.document.project(), text) {
            Ok((edit, selection)) => self.arrange(Some((edit, selection))),
            Err(error) => self.status = error.to_string(),
        }
    }

    /// Changes what was drawn, and selects what came of it.
    fn arrange(&mut self, arranged: Arranged) {
        if let Some((edit, selection)) = arranged {
            self.edit(edit);
            self.document.settle();
            self.session.selection = selection;
            self.session.panel = Panel::Drawn;
        }
    }

    /// Whether the graphics card draws the photons of the plane.
    pub(super) fn draws_on_gpu(&self) -> bool {
        match (self.preferences.photon_renderer, self.gpu) {
            (PhotonRenderer::Auto, gpu) => gpu == Gpu::Hardware,
            (PhotonRenderer::Gpu, gpu) => gpu != Gpu::None,
            (PhotonRenderer::Cpu, _) => false,
        }
    }
}

fn zoom(session: &mut crate::editor::session::Session, factor: f32) {
    let old = if session.plane.zoom > 0.0 { session.plane.zoom } else { 1.0 };
    session.plane.zoom = (old * factor).clamp(0.05, 200.0);
    session.shot.zoom = (session.shot.zoom * factor).clamp(0.05, 200.0);
    session.shot.offset = session.shot.offset.map(|n| n * factor);
}
