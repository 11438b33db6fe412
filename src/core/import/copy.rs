//! The files of an import, and a project of it, in a folder.

use std::path::{Path, PathBuf};

use glam::Vec2;

use super::imported::Import;
use super::paths::file_name;
use super::reading::read;
use crate::files::{copy_new, is_same_content};
use crate::project::{ProjectFile, Shows};
use crate::targets::{ImageTarget, PictureSampler};
use crate::{Error, Progress, Result};

/// Imports a file into a folder: its project, and copies of it and of what belongs to it. A `picture` is what the light of the
/// last key frame shows. Returns the import and the path of the project.
///
/// # Errors
/// As [`read`]; a picture that cannot be used; `Value` where the project, or another file of a name, is there already: nothing is
/// written then.
pub fn into_folder(
    path: &Path,
    picture: Option<&Path>,
    folder: &Path,
    progress: &Progress,
) -> Result<(Import, PathBuf)> {
    let import = read(path, progress)?;
    let shown = picture.map(|picture| used(picture, progress)).transpose()?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let project_path = folder.join(format!("{stem}.json"));
    if project_path.exists() {
        let what =
            format!("'{}' is there already; name another folder, or move it away", project_path.display());
        return Err(Error::value("--into", what));
    }
    let mut project = import.project(&stem, &file_name(path)?);
    if let (Some(target), Some(last)) = (shown, project.keys.last_mut()) {
        last.shows = Shows::Image(target);
    }
    std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
    let origin = path.parent().unwrap_or(Path::new(""));
    let scene = import
        .files
        .iter()
        .map(|file| (file.as_path(), folder.join(file.strip_prefix(origin).unwrap_or(file))));
    let beside = picture.map(|picture| (picture, folder.join(picture.file_name().unwrap_or_default())));
    let places = scene.chain(beside);
    let mut copies = Vec::new();
    for (file, to) in places {
        if copies.iter().any(|(_, taken)| *taken == to) {
            let what = format!("two of the files would be called '{}'; rename one", to.display());
            return Err(Error::value("--into", what));
        } else if !to.exists() {
            copies.push((file, to));
        } else if !is_same_content(file, &to)? {
            let what = format!(
                "'{}' is there already and differs; name another folder, or move it away",
                to.display()
            );
            return Err(Error::value("--into", what));
        }
    }
    for (file, to) in copies {
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        }
        copy_new(file, &to, &progress.inner())?;
    }
    ProjectFile::new(project.clone())?.save(&project_path, &project)?;
    Ok((import, project_path))
}

/// A target of a picture that can be used.
fn used(picture: &Path, progress: &Progress) -> Result<ImageTarget> {
    let target = ImageTarget::new(file_name(picture)?);
    PictureSampler::load_cancellable(picture, &target, (Vec2::ONE, "--picture"), progress)?;
    Ok(target)
}
