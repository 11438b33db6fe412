//! Whether a desktop portal is there for file dialogs.

use ashpd::desktop::file_chooser::FileChooserProxy;

/// Whether the portal answers, by D-Bus, that it has file dialogs: without them a dialog of the system cannot be told from one
/// that the user cancelled at once.
pub(super) async fn has_file_dialogs() -> bool {
    FileChooserProxy::new().await.is_ok_and(|portal| portal.version() > 0)
}
