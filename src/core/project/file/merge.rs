//! Three-way merge of JSON: `file` is the text of the file, `was` the project that was read from it, `now` the project to be
//! written. `was` has all members that this program knows; `file` lacks some (defaults) and has others (unknown members).

use super::align;
use super::tree::{Kind, Node};

/// Name of the member that tags an enum's variant.
const TAG: &str = "type";

/// JSON to be formatted.
#[derive(Clone, Debug)]
pub(super) enum Piece<'a> {
    /// Text that is written as it stands: a leaf, or an unchanged value of the file.
    Text(&'a str),
    List {
        items: Vec<Piece<'a>>,
        /// Whether it spans several lines in the file.
        broken: bool,
    },
    Object {
        members: Vec<(String, Piece<'a>)>,
        /// Whether it spans several lines in the file.
        broken: bool,
    },
}

/// The file's value with the changes from `was` to `now` applied.
pub(super) fn merge<'a>(file: &Node<'a>, was: &Node, now: &Node<'a>) -> Piece<'a> {
    if was.text == now.text {
        return Piece::Text(file.text);
    }
    let broken = file.text.contains('\n');
    match (&file.kind, &was.kind, &now.kind) {
        (Kind::Object(_), Kind::Object(_), Kind::Object(_)) => {
            Piece::Object { members: members(file, was, now), broken }
        }
        (Kind::List(in_file), Kind::List(before), Kind::List(after)) if in_file.len() == before.len() => {
            // Lists of points are formatted anew as a whole.
            let numbers = !now.text.contains(['{', '"']);
            let item = |(now, origin): (&Node<'a>, Option<usize>)| match origin {
                Some(i) if numbers && before[i].text == now.text => fresh(&in_file[i]),
                Some(i) => merge(&in_file[i], &before[i], now),
                None => fresh(now),
            };
            let items = after.iter().zip(align::origins(before, after)).map(item).collect();
            Piece::List { items, broken: broken && !numbers }
        }
        _ => fresh(now),
    }
}

/// A value to be formatted anew, with its numbers and strings as they stand.
pub(super) fn fresh<'a>(now: &Node<'a>) -> Piece<'a> {
    match &now.kind {
        Kind::Leaf => Piece::Text(now.text),
        Kind::List(items) => Piece::List { items: items.iter().map(fresh).collect(), broken: false },
        Kind::Object(members) => {
            let members = members.iter().map(|(name, value)| (name.clone(), fresh(value)));
            Piece::Object { members: members.collect(), broken: false }
        }
    }
}

fn members<'a>(file: &Node<'a>, was: &Node, now: &Node<'a>) -> Vec<(String, Piece<'a>)> {
    let mut members = Vec::new();
    for (name, value) in file.members() {
        let piece = match (was.get(name), now.get(name)) {
            (Some(was), Some(now)) => merge(value, was, now),
            // New to the project: the file's text was a default, or of no effect.
            (None, Some(now)) => fresh(now),
            (Some(gone), None) => match renamed(gone, was, now) {
                Some(name) if members.iter().all(|(own, _)| own != name) => {
                    members.push((name.to_owned(), Piece::Text(value.text)));
                    continue;
                }
                _ => continue,
            },
            (None, None) => Piece::Text(value.text),
        };
        members.push((name.clone(), piece));
    }
    let same_kind = kind(was) == kind(now);
    let mut at = 0;
    for (name, value) in now.members() {
        if let Some(found) = members.iter().position(|(own, _)| own == name) {
            at = found + 1;
            continue;
        }
        // Another variant may have other defaults, so that equal values are written too.
        let added = match was.get(name).filter(|_| same_kind) {
            Some(was) => changed(was, value),
            None => Some(fresh(value)),
        };
        if let Some(added) = added {
            members.insert(at, (name.clone(), added));
            at += 1;
        }
    }
    members
}

/// The new name of an object that was renamed, such as a caustic.
fn renamed<'n>(gone: &Node, was: &Node, now: &'n Node) -> Option<&'n str> {
    let same = |(name, value): &&(String, Node)| was.get(name).is_none() && value.text == gone.text;
    let found = now.members().iter().find(same).filter(|(_, value)| matches!(value.kind, Kind::Object(_)));
    found.map(|(name, _)| name.as_str())
}

/// What of a value that the file leaves to the defaults is no longer the default; none where all still is.
fn changed<'a>(was: &Node, now: &Node<'a>) -> Option<Piece<'a>> {
    if was.text == now.text {
        return None;
    }
    if was.members().is_empty() || now.members().is_empty() || kind(was) != kind(now) {
        return Some(fresh(now));
    }
    let members = now.members().iter().filter_map(|(name, value)| {
        let piece = match was.get(name) {
            Some(was) if name != TAG => changed(was, value)?,
            _ => fresh(value),
        };
        Some((name.clone(), piece))
    });
    Some(Piece::Object { members: members.collect(), broken: false })
}

/// The tag of an object that has one.
fn kind<'a>(node: &Node<'a>) -> Option<&'a str> {
    node.get(TAG).map(|tag| tag.text)
}
