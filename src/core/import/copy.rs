//! The files of an import, and a project of it, in a folder.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::imported::Import;
use super::paths::file_name;
use super::reading::read;
use crate::files::{read_regular_file, write_atomic};
use crate::project::ProjectFile;
use crate::{Error, Progress, Result};

/// Imports a file into a folder: its project, and copies of it and of what belongs to it. Returns the import and the path of
/// the project.
///
/// # Errors
/// As [`read`]; `Value` where the project, or another file of a name, is there already: nothing is written then.
pub fn into_folder(path: &Path, folder: &Path, progress: &Progress) -> Result<(Import, PathBuf)> {
    let import = read(path, progress)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let project_path = folder.join(format!("{stem}.json"));
    if project_path.exists() {
        let what =
            format!("'{}' is there already; name another folder, or move it away", project_path.display());
        return Err(Error::value("--into", what));
    }
    let project = import.project(&stem, &file_name(path)?);
    std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
    let origin = path.parent().unwrap_or(Path::new(""));
    let copies =
        import.files.iter().map(|file| copied(file, &folder.join(file.strip_prefix(origin).unwrap_or(file))));
    for (bytes, to) in copies.collect::<Result<Vec<_>>>()?.into_iter().flatten() {
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        }
        write_atomic(&to, |out| out.write_all(&bytes))?;
    }
    ProjectFile::new(project.clone())?.save(&project_path, &project)?;
    Ok((import, project_path))
}

/// What to write to get a copy of a file; none where it is there already.
///
/// # Errors
/// `Value` where another file has its name.
fn copied(from: &Path, to: &Path) -> Result<Option<(Vec<u8>, PathBuf)>> {
    let bytes = read_regular_file(from, u64::MAX)?;
    if !to.exists() {
        return Ok(Some((bytes, to.to_owned())));
    }
    if read_regular_file(to, u64::MAX)? == bytes {
        return Ok(None);
    }
    let what =
        format!("'{}' is there already and differs; name another folder, or move it away", to.display());
    Err(Error::value("--into", what))
}
