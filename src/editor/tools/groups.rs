//! Groups of constraints, as the artist makes them: what stands together in the list, and is switched together.

use std::collections::BTreeSet;

use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;

use super::arrange::Arranged;
use crate::editor::document::Edit;
use crate::editor::selection::Selection;
use crate::editor::unique_name::unique_name;

/// Puts the selected constraints into a new group, one after the other in the list, where the first of them stands.
pub fn group(project: &Project, selection: &Selection) -> Arranged {
    let all = &project.constraints;
    let chosen: Vec<usize> = selection.constraints().filter(|index| *index < all.len()).collect();
    let first = *chosen.first()?;
    let name = unique_name("group", |name| all.iter().any(|other| other.group() == name));
    let members = chosen.iter().map(|&index| in_group(&all[index], &name));
    let rest = |from: usize, to: usize| {
        (from..to).filter(|index| !chosen.contains(index)).map(|index| all[index].clone())
    };
    let grouped = all[..first].iter().cloned().chain(members).chain(rest(first, all.len())).collect();
    Some((Edit::Constraints(grouped), Selection::all(first..first + chosen.len())))
}

/// Takes the selected constraints out of their groups.
pub fn ungroup(project: &Project, selection: &Selection) -> Arranged {
    let all = project.constraints.iter().enumerate();
    let members = all.filter(|(index, of)| selection.contains(*index) && !of.group().is_empty());
    let changes: Vec<_> = members.map(|(index, of)| (index, in_group(of, ""))).collect();
    (!changes.is_empty()).then(|| (Edit::Change(changes), selection.clone()))
}

/// The groups in the order of their first members; the last is of those without a group, where there are any. Each with its
/// name and the indices of its members.
pub fn groups(constraints: &[Constraint]) -> Vec<(&str, Vec<usize>)> {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    for (index, constraint) in constraints.iter().enumerate() {
        match groups.iter_mut().find(|(name, _)| *name == constraint.group()) {
            Some((_, members)) => members.push(index),
            None => groups.push((constraint.group(), vec![index])),
        }
    }
    groups.sort_by_key(|(name, _)| name.is_empty());
    groups
}

/// Renames the group of these members.
pub fn renamed(constraints: &[Constraint], members: &[usize], name: &str) -> Edit {
    Edit::Change(members.iter().map(|&index| (index, in_group(&constraints[index], name))).collect())
}

/// Lets these members alone act; where they do, all act again.
pub fn solo(constraints: &[Constraint], members: &[usize]) -> Edit {
    let members: BTreeSet<usize> = members.iter().copied().collect();
    let alone = is_solo(constraints, &members);
    let set = |(index, constraint): (usize, &Constraint)| {
        let on = alone || members.contains(&index);
        (constraint.is_enabled() != on).then(|| (index, constraint.with(|common| *common.enabled = on)))
    };
    Edit::Change(constraints.iter().enumerate().filter_map(set).collect())
}

/// Whether all of these members act, and nothing else.
pub fn is_solo(constraints: &[Constraint], members: &BTreeSet<usize>) -> bool {
    members.len() < constraints.len()
        && constraints.iter().enumerate().all(|(index, of)| of.is_enabled() == members.contains(&index))
}

/// A constraint in another group; an empty name takes it out of all.
fn in_group(constraint: &Constraint, name: &str) -> Constraint {
    constraint.with(|common| name.clone_into(common.group))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::path::Path;

    use lightloom_core::constraint::Wall;

    use super::*;

    fn project(count: usize) -> Project {
        let mut project =
            Project::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json")).unwrap();
        let wall = |i: usize| {
            Constraint::Wall(Wall { name: i.to_string(), ..Wall::new(vec![[0.1, 0.1], [0.2, 0.2]]) })
        };
        project.constraints = (0..count).map(wall).collect();
        project
    }

    fn after(project: &Project, edit: Edit) -> Project {
        let mut project = project.clone();
        match edit {
            Edit::Constraints(all) => project.constraints = all,
            Edit::Change(changes) => changes.into_iter().for_each(|(i, new)| project.constraints[i] = new),
            other => panic!("{other:?}"),
        }
        project
    }

    fn names(project: &Project) -> Vec<String> {
        let name = |of: &Constraint| match of {
            Constraint::Wall(wall) => format!("{}{}", wall.group, wall.name),
            Constraint::DirectedLine(_) => panic!("a line"),
        };
        project.constraints.iter().map(name).collect()
    }

    #[test]
    fn a_group_stands_together_and_can_be_taken_apart() {
        let one = project(5);
        let (edit, selection) = group(&one, &Selection::all([1, 3])).unwrap();
        let two = after(&one, edit);
        assert_eq!(names(&two), ["0", "group1", "group3", "2", "4"]);
        assert_eq!(selection, Selection::all([1, 2]));
        let (edit, _) = group(&two, &Selection::all([0, 4])).unwrap();
        let three = after(&two, edit);
        assert_eq!(names(&three), ["group 20", "group 24", "group1", "group3", "2"]);
        let listed = groups(&three.constraints);
        assert_eq!(listed, [("group 2", vec![0, 1]), ("group", vec![2, 3]), ("", vec![4])]);
        let (edit, _) = ungroup(&three, &Selection::all([0, 4])).unwrap();
        assert_eq!(names(&after(&three, edit)), ["0", "group 24", "group1", "group3", "2"]);
        assert_eq!(ungroup(&one, &Selection::all([0])), None);
        assert_eq!(group(&one, &Selection::default()), None);
    }

    #[test]
    fn solo_switches_the_others_off_and_on_again() {
        let one = project(4);
        let on =
            |project: &Project| project.constraints.iter().map(Constraint::is_enabled).collect::<Vec<_>>();
        let two = after(&one, solo(&one.constraints, &[1, 2]));
        assert_eq!(on(&two), [false, true, true, false]);
        assert_eq!(on(&after(&two, solo(&two.constraints, &[1, 2]))), [true; 4]);
        assert_eq!(on(&after(&two, solo(&two.constraints, &[0]))), [true, false, false, false]);
    }
}
