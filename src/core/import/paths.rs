//! Paths of a file and its neighbours.

use std::path::{Path, PathBuf};

use crate::project::AssetFolder;
use crate::{Error, Result};

/// The resolver of the files of a scene that stands in the folder of `path`.
pub(super) fn assets_of(path: &Path) -> Result<impl Fn(&str, &str) -> Result<PathBuf> + use<>> {
    let folder = AssetFolder::new(path, false)?;
    Ok(move |written: &str, place: &str| folder.resolve(written, place))
}

/// The name of a file without its folder.
pub(super) fn file_name(path: &Path) -> Result<String> {
    let name = path.file_name().and_then(|name| name.to_str());
    name.map(str::to_owned)
        .ok_or_else(|| Error::format(path, "", "has a name that is no UTF-8 text; rename the file"))
}
