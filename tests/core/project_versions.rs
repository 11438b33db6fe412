//! Project files of other versions of the format.

use std::path::Path;

use lightloom_core::project::{Project, ProjectFile};

use crate::project_store::{STRANGE, after, read, strangers_of};

#[test]
fn a_file_of_version_1_and_one_of_a_later_program_that_says_so_are_read() {
    let (first, notes) = read(include_str!("cases/version_1.json"));
    assert!(notes.is_empty() && first.project().newer().is_none());

    // What a later program wrote for readers of version 1 is read by both ways, and all of it is written again.
    let later = STRANGE.replacen("\"lightloom\": 1,", "\"lightloom\": 3, \"minimum_reader\": 1,", 1);
    let project = Project::parse(later.as_bytes(), Path::new("shot.json")).unwrap();
    assert_eq!(project.newer(), Some(3));
    let (file, notes) = read(&later);
    assert_eq!((file.project(), notes.len()), (&project, strangers_of(STRANGE).len()));
    let written = after(&later, |project| project.flow.gamma = 0.75);
    assert_eq!(strangers_of(&written), strangers_of(STRANGE));
    assert!(written.contains("\"lightloom\": 3") && written.contains("\"minimum_reader\": 1"), "{written}");

    let path = Path::new("shot.json");
    let refused = |message: String| {
        assert!(message.contains("version 3") && message.contains("newer"), "{message}");
    };
    let beyond = later.replace("\"minimum_reader\": 1", "\"minimum_reader\": 2");
    refused(Project::parse(beyond.as_bytes(), path).unwrap_err().to_string());
    refused(ProjectFile::parse(beyond.as_bytes(), path).unwrap_err().to_string());
}

/// It is not rendered, as nobody says that the picture would be right; but it is looked at, and keeps all of its members.
#[test]
fn a_later_file_that_names_no_reader_is_opened_with_all_that_is_unknown() {
    let path = Path::new("shot.json");
    let later = STRANGE.replacen("\"lightloom\": 1,", "\"lightloom\": 3,", 1);
    let told = Project::parse(later.as_bytes(), path).unwrap_err().to_string();
    assert!(told.contains("version 3") && told.contains("newer") && told.contains("read-only"), "{told}");
    let (file, notes) = read(&later);
    assert_eq!((file.project().newer(), notes.len()), (Some(3), strangers_of(STRANGE).len()));
    let written = after(&later, |project| project.flow.gamma = 0.75);
    assert_eq!(strangers_of(&written), strangers_of(STRANGE));
    assert!(written.contains("\"lightloom\": 3") && !written.contains("minimum_reader"), "{written}");

    // A known member with a new meaning is refused, and the reason is the version.
    let changed = later.replacen("\"flow\": {", "\"flow\": 7, \"glow\": {", 1);
    assert_ne!(changed, later);
    let told = ProjectFile::parse(changed.as_bytes(), path).unwrap_err().to_string();
    assert!(told.contains("flow") && told.contains("version 3"), "{told}");
}
