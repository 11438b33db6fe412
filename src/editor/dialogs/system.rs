//! The file dialogs of the system: those of the desktop portal, of macOS, or of Windows.

use std::pin::Pin;

use rfd::{AsyncFileDialog, FileHandle};

use super::request::{Answer, PickRequest, PickResult};

/// Begins the dialog that a blank one becomes by a request.
pub(super) fn begin(blank: AsyncFileDialog, request: &PickRequest) -> Answer {
    // macOS wants the dialog itself made here, on the main thread.
    let dialog = dialog(blank, request);
    Box::pin(async {
        #[cfg(all(unix, not(target_os = "macos")))]
        if !super::portal::has_file_dialogs().await {
            return PickResult::Unavailable;
        }
        dialog.await.map_or(PickResult::Cancelled, |file| PickResult::Picked(file.path().to_owned()))
    })
}

fn dialog(
    blank: AsyncFileDialog,
    request: &PickRequest,
) -> Pin<Box<dyn Future<Output = Option<FileHandle>> + Send>> {
    let (kind, endings) = request.purpose.files();
    let mut dialog = blank.set_title(request.purpose.title());
    if let Some(folder) = &request.folder {
        dialog = dialog.set_directory(folder);
    }
    if endings.is_empty() {
        return Box::pin(dialog.pick_folder());
    }
    dialog = dialog.add_filter(kind, endings);
    match request.purpose.saves() {
        true => Box::pin(dialog.set_file_name(&request.name).save_file()),
        false => Box::pin(dialog.pick_file()),
    }
}
