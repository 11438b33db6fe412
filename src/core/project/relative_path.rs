//! Relative paths as projects store them: from the project file, with forward slashes.

use std::path::{Component, Path, PathBuf};

use super::Project;

/// Path of `file` relative to the project file `project`; both absolute. On another drive the path stays absolute.
pub fn relative(file: &Path, project: &Path) -> String {
    let folder = normalise(project.parent().unwrap_or(Path::new("")));
    let file = normalise(file);
    let (folder, file): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = folder.iter().zip(&file).take_while(|(a, b)| a == b).count();
    if common == 0 && !folder.is_empty() {
        return written(file.into_iter());
    }
    let up = std::iter::repeat_n(Component::ParentDir, folder.len() - common);
    written(up.chain(file[common..].iter().copied()))
}

/// The path `written` in the project file `from`, as the project file `to` names the same file.
pub fn moved(written: &str, from: &Path, to: &Path) -> String {
    if is_absolute(written) || from.parent() == to.parent() {
        return written.to_owned();
    }
    relative(&from.parent().unwrap_or(Path::new("")).join(written), to)
}

impl Project {
    /// The project with its file paths rewritten for another place of the project file; no file is touched.
    pub fn relocated(&self, from: &Path, to: &Path) -> Self {
        let mut project = self.clone();
        project.rename_files(|file| moved(file, from, to));
        project
    }
}

/// Whether a path as written names a place of one machine, on any system.
pub(super) fn is_absolute(written: &str) -> bool {
    Path::new(written).is_absolute() || written.as_bytes().get(1) == Some(&b':')
}

/// The path without `.`, and with `..` resolved where possible; the file system is not asked.
pub(super) fn normalise(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match (part, plain.components().next_back()) {
            (Component::CurDir, _) => {}
            (Component::ParentDir, Some(Component::Normal(_))) => {
                plain.pop();
            }
            (Component::ParentDir, Some(Component::RootDir)) => {}
            _ => plain.push(part),
        }
    }
    plain
}

/// Parts of a path with forward slashes.
pub(super) fn written<'a>(parts: impl Iterator<Item = Component<'a>>) -> String {
    parts.collect::<PathBuf>().to_string_lossy().replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_from_the_project_s_folder() {
        let from = |file, project| relative(Path::new(file), Path::new(project));
        assert_eq!(from("/a/b/mesh.obj", "/a/b/p.json"), "mesh.obj");
        assert_eq!(from("/a/assets/mesh.obj", "/a/projects/p.json"), "../assets/mesh.obj");
        assert_eq!(from("/x/mesh.obj", "/a/b/p.json"), "../../x/mesh.obj");
        assert_eq!(from("/a/b/../c/./mesh.obj", "/a/b/p.json"), "../c/mesh.obj");
        assert_eq!(from("/../../a/mesh.obj", "/a/p.json"), "mesh.obj");
    }
}
