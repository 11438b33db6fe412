//! Where a new picture lies: found out on a thread of its own from the light that becomes it.

use std::path::Path;

use eframe::egui;
use lightloom_core::Error;
use lightloom_core::project::{Shows, relative};
use lightloom_core::targets::{ImageTarget, Placement};

use super::App;
use super::file_state::Placing;
use super::task::Task;
use crate::editor::asset::{AssetUse, TargetSlot, show};
use crate::editor::templates;

impl App {
    /// Puts a picked picture into the project: a new one where the light is that becomes it, at its size.
    pub(super) fn put_picture(&mut self, at: &TargetSlot, file: &Path) {
        let project = self.editor.document.project();
        let written = relative(file, &templates::file_of(&self.editor.document));
        match at.shows(&project.keys) {
            Some(Shows::Image(_)) | None => self.put(&AssetUse::Picture(at.clone()), written),
            Some(_) => self.find_place(at.clone(), file, ImageTarget::new(written)),
        }
    }

    /// Lays the picture that a target shows anew.
    pub(super) fn place_picture(&mut self, at: TargetSlot) {
        let project = self.editor.document.project();
        let Some(Shows::Image(image)) = at.shows(&project.keys) else { return };
        let target = ImageTarget { placement: Placement::default(), ..image.clone() };
        let found = self
            .files
            .access()
            .assets(&templates::file_of(&self.editor.document))
            .and_then(|assets| assets.resolve(&target.file, "image.file"));
        match found {
            Ok(file) => self.find_place(at, &file, target),
            Err(error) => self.editor.status = error.to_string(),
        }
    }

    fn find_place(&mut self, at: TargetSlot, file: &Path, target: ImageTarget) {
        let project = self.editor.document.project().clone();
        let base = templates::file_of(&self.editor.document);
        let (access, engine) = (self.files.access(), self.engine.clone());
        let (slot, picture, wanted) = (at.clone(), file.to_owned(), target.clone());
        let find = move |progress: &_| {
            let engine = engine.of(&base, &access)?;
            engine.placement(&project, (slot.key, slot.caustic.as_deref()), (&picture, &wanted), progress)
        };
        match Task::start("Placing", file, find) {
            Ok(task) => self.placing = Some(Placing { at, target, task }),
            Err(_) => self.lay(&at, target),
        }
    }

    /// Takes over the place of a picture that was found.
    pub(super) fn placed(&mut self, ctx: &egui::Context) {
        let Some(placing) = &self.placing else { return };
        let Some(result) = placing.task.result(ctx) else { return };
        let Some(Placing { at, mut target, .. }) = self.placing.take() else { return };
        match result {
            Ok(placement) => target.placement = placement,
            Err(Error::Cancelled) => return,
            // In the middle, as large as fits; the preview tells what is wrong with the scene or the picture.
            Err(error) => tracing::info!("no place for a picture: {error}"),
        }
        self.lay(&at, target);
    }

    fn lay(&mut self, at: &TargetSlot, target: ImageTarget) {
        let project = self.editor.document.project();
        if at.shows(&project.keys).is_some() {
            self.editor.edit(show(project, at, Shows::Image(target)));
            self.editor.document.settle();
        }
    }
}
