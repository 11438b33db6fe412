//! Copy and paste of lines and walls as text: the JSON list under `constraints` of a project, so that they move
//! between projects.

use glam::Vec2;
use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;
use lightloom_core::{Error, Result};

use super::document::Edit;
use super::selection::Selection;
use super::tools::arrange::{self, Arranged};

/// Longest text that is read, bytes: more than the constraints of any project.
const LONGEST: usize = 64 << 20;
/// Offset of a copy from a constraint it would hide, plane units.
const OFFSET: Vec2 = Vec2::new(0.02, -0.02);

/// The selected constraints as text; none where nothing is selected.
pub fn copy(project: &Project, selection: &Selection) -> Option<String> {
    let selected: Vec<&Constraint> =
        selection.constraints().filter_map(|index| project.constraints.get(index)).collect();
    if selected.is_empty() { None } else { serde_json::to_string_pretty(&selected).ok() }
}

/// The selected constraints as text, and the change that removes them. Locked ones are copied but stay.
pub fn cut(project: &Project, selection: &Selection) -> Option<(String, Arranged)> {
    let wholes = Selection::all(selection.constraints());
    Some((copy(project, selection)?, arrange::delete(project, &wholes)))
}

/// The edit that adds the constraints of a text, and the new selection. If one would cover an equal one, all are
/// offset.
///
/// # Errors
/// The text is no list of constraints, or holds a value out of range.
pub fn paste(project: &Project, text: &str) -> Result<(Edit, Selection)> {
    let pasted = read(text)?;
    let hides =
        pasted.iter().any(|constraint| project.constraints.iter().any(|c| c.points() == constraint.points()));
    Ok(added(project, pasted, if hides { OFFSET } else { Vec2::ZERO }))
}

/// Duplicates the selection with an offset.
pub fn duplicate(project: &Project, selection: &Selection) -> Arranged {
    let copies: Vec<Constraint> =
        selection.constraints().filter_map(|index| project.constraints.get(index)).cloned().collect();
    (!copies.is_empty()).then(|| added(project, copies, OFFSET))
}

fn added(project: &Project, mut constraints: Vec<Constraint>, by: Vec2) -> (Edit, Selection) {
    for constraint in &mut constraints {
        // A copy is meant to be edited.
        match constraint {
            Constraint::DirectedLine(line) => line.locked = false,
            Constraint::Wall(wall) => wall.locked = false,
        }
    }
    let first = project.constraints.len();
    let selection = Selection::all(first..first + constraints.len());
    (Edit::Add(arrange::shifted(&constraints, by)), selection)
}

fn read(text: &str) -> Result<Vec<Constraint>> {
    let refused = |what: String| {
        let help = "copy lines or walls here, or the list under \"constraints\" of a project";
        Error::value("clipboard", format!("{what}; {help}"))
    };
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.len() > LONGEST {
        return Err(refused(format!("holds {} bytes, the limit is {LONGEST}", text.len())));
    }
    let constraints: Vec<Constraint> =
        serde_json::from_str(text).map_err(|e| refused(format!("holds no lines or walls ({e})")))?;
    if constraints.is_empty() {
        return Err(refused("holds an empty list".into()));
    }
    for (i, constraint) in constraints.iter().enumerate() {
        constraint.check(&format!("clipboard[{i}]"))?;
    }
    Ok(constraints)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use lightloom_core::constraint::{DirectedLine, Wall};

    use super::*;
    use crate::editor::document::Document;

    fn project(constraints: Vec<Constraint>) -> Project {
        let text =
            r#"{ "lightloom": 1, "keys": [ { "frame": 1, "shows": { "image": { "file": "a.png" } } } ] }"#;
        Project { constraints, ..serde_json::from_str(text).unwrap() }
    }

    fn drawn() -> Vec<Constraint> {
        let line = DirectedLine { weight: 3.5, ..DirectedLine::new(vec![[0.1, 0.1], [0.2, 0.7]]) };
        let wall = Wall { locked: true, name: "left".into(), ..Wall::new(vec![[0.3, 0.1], [0.3, 0.9]]) };
        vec![Constraint::DirectedLine(line), Constraint::Wall(wall)]
    }

    fn after(project: Project, edit: Edit) -> Project {
        let mut document = Document::new(project, None);
        document.edit(edit).unwrap();
        Project::clone(document.project())
    }

    #[test]
    fn lines_go_from_one_project_to_another_as_they_are_and_unlocked() {
        let text = copy(&project(drawn()), &Selection::all([0, 1])).unwrap();
        let (edit, selection) = paste(&project(Vec::new()), &text).unwrap();
        let other = after(project(Vec::new()), edit);
        assert_eq!(other.constraints[0], drawn()[0]);
        assert_eq!(other.constraints[1].points(), drawn()[1].points());
        assert!(!other.constraints[1].is_locked());
        assert_eq!(selection, Selection::all([0, 1]));
    }

    #[test]
    fn a_copy_that_would_hide_its_like_stands_off() {
        let here = project(drawn());
        let (edit, _) = paste(&here, &copy(&here, &Selection::one(0)).unwrap()).unwrap();
        let pasted = after(here.clone(), edit);
        let (edit, selection) = duplicate(&here, &Selection::one(0)).unwrap();
        assert_eq!(pasted, after(here, edit));
        assert_ne!(pasted.constraints[2].points(), pasted.constraints[0].points());
        assert_eq!(selection, Selection::one(2));
    }

    #[test]
    fn cutting_removes_what_is_not_locked() {
        let here = project(drawn());
        let (text, arranged) = cut(&here, &Selection::all([0, 1])).unwrap();
        let left = after(here, arranged.unwrap().0);
        assert_eq!(left.constraints, drawn()[1..]);
        assert_eq!(read(&text).unwrap(), drawn());
        assert!(cut(&left, &Selection::default()).is_none());
    }

    #[test]
    fn what_is_no_list_of_constraints_is_refused_with_a_reason() {
        let here = project(Vec::new());
        for text in [
            "",
            "hello",
            "[]",
            "{}",
            "[1, 2]",
            r#"[{"type":"wall"}]"#,
            r#"[{"type":"wall","points":[[99, 0]]}]"#,
        ] {
            let error = paste(&here, text).unwrap_err().to_string();
            assert!(error.contains("clipboard"), "{text}: {error}");
        }
    }
}
