//! The file dialogs of the desktop portal, by D-Bus. Whether there is one is what the portal answers: only "cancelled by the
//! user" counts as cancelled, any other failure as no dialog.

use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt as _;
use std::path::{Path, PathBuf};

use ashpd::desktop::ResponseError;
use ashpd::desktop::file_chooser::{FileFilter, SelectedFiles};
use ashpd::{Error, Uri};

use super::request::{Answer, PickRequest, PickResult};

/// Begins a dialog.
pub(super) fn begin(request: &PickRequest) -> Answer {
    let request = request.clone();
    Box::pin(async move {
        match ask(&request).await {
            Ok(files) => {
                files.uris().first().and_then(file_of).map_or(PickResult::Unavailable, PickResult::Picked)
            }
            Err(Error::Response(ResponseError::Cancelled)) => PickResult::Cancelled,
            Err(_) => PickResult::Unavailable,
        }
    })
}

async fn ask(request: &PickRequest) -> ashpd::Result<SelectedFiles> {
    let (kind, endings) = request.purpose.files();
    let title = request.purpose.title();
    let any_case = |filter: FileFilter, ending: &&str| {
        filter.glob(&format!("*.{ending}")).glob(&format!("*.{}", ending.to_uppercase()))
    };
    let filter = (!endings.is_empty()).then(|| endings.iter().fold(FileFilter::new(kind), any_case));
    if request.purpose.saves() {
        let dialog = SelectedFiles::save_file().title(title).modal(true).current_name(request.name.as_str());
        let dialog = dialog.filters(filter).current_folder::<&Path>(request.folder.as_deref())?;
        return dialog.send().await?.response();
    }
    let dialog = SelectedFiles::open_file().title(title).modal(true).directory(endings.is_empty());
    dialog.filters(filter).current_folder::<&Path>(request.folder.as_deref())?.send().await?.response()
}

/// The file of a URI such as `file:///home/me/a%20shot.json`.
fn file_of(uri: &Uri) -> Option<PathBuf> {
    let path = uri.as_str().strip_prefix("file://")?;
    let path = &path[path.find('/')?..];
    let bytes: Vec<u8> = percent_encoding::percent_decode_str(path).collect();
    Some(OsString::from_vec(bytes).into())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_uri_names_a_file_with_any_characters() {
        let file = |uri| file_of(&Uri::parse(uri).unwrap());
        assert_eq!(file("file:///home/me/a%20sh%C3%B6t.json"), Some("/home/me/a shöt.json".into()));
        assert_eq!(file("file://localhost/tmp/a"), Some("/tmp/a".into()));
        assert_eq!(file("https://example.org/a"), None);
    }
}
