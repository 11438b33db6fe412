//! The file dialogs of macOS and Windows: they are always there.

use rfd::AsyncFileDialog;

use super::request::{Answer, PickRequest, PickResult};

/// Begins a dialog.
pub(super) fn begin(request: &PickRequest) -> Answer {
    let (kind, endings) = request.purpose.files();
    let mut dialog = AsyncFileDialog::new().set_title(request.purpose.title());
    if let Some(folder) = &request.folder {
        dialog = dialog.set_directory(folder);
    }
    let folder = endings.is_empty();
    if !folder {
        dialog = dialog.add_filter(kind, endings);
    }
    if request.purpose.saves() {
        dialog = dialog.set_file_name(&request.name);
    }
    // The dialog itself must be made here, on the main thread.
    let picked: std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>> =
        match (folder, request.purpose.saves()) {
            (true, _) => Box::pin(dialog.pick_folder()),
            (false, true) => Box::pin(dialog.save_file()),
            (false, false) => Box::pin(dialog.pick_file()),
        };
    Box::pin(async {
        picked.await.map_or(PickResult::Cancelled, |file| PickResult::Picked(file.path().to_owned()))
    })
}
