//! Relative paths as projects store them: from the project file, with forward slashes.

use std::path::{Component, Path, PathBuf};

use lightloom_core::project::Project;

/// Path of `file` relative to the project file `project`; both absolute. On another drive the path stays absolute.
pub(super) fn relative(file: &Path, project: &Path) -> String {
    let folder = plain(project.parent().unwrap_or(Path::new("")));
    let file = plain(file);
    let common = folder.iter().zip(&file).take_while(|(a, b)| a == b).count();
    if common == 0 && !folder.is_empty() {
        return written(&file);
    }
    let up = std::iter::repeat_n(Component::ParentDir, folder.len() - common);
    written(&up.chain(file[common..].iter().copied()).collect::<Vec<_>>())
}

/// The project with its file paths rewritten for another location of the project file.
pub(super) fn relocated(project: &Project, from: &Path, to: &Path) -> Project {
    let mut project = project.clone();
    let folder = from.parent().unwrap_or(Path::new(""));
    project.rename_files(|file| {
        if Path::new(file).is_absolute() { file.to_owned() } else { relative(&folder.join(file), to) }
    });
    project
}

/// The components without `.`, and with `..` resolved where possible.
fn plain(path: &Path) -> Vec<Component<'_>> {
    let mut plain: Vec<Component> = Vec::new();
    for part in path.components() {
        match (part, plain.last()) {
            (Component::CurDir, _) => {}
            (Component::ParentDir, Some(Component::Normal(_))) => {
                plain.pop();
            }
            _ => plain.push(part),
        }
    }
    plain
}

fn written(parts: &[Component]) -> String {
    let path: PathBuf = parts.iter().collect();
    path.to_string_lossy().replace('\\', "/")
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
    }
}
