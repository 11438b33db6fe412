//! Operations on a selection: reverse, join, split, delete, move. Locked constraints are unchanged.

use glam::Vec2;
use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;

use crate::editor::document::Edit;
use crate::editor::selection::Selection;

/// An edit and the selection after it; none where there is nothing to do.
pub type Arranged = Option<(Edit, Selection)>;

/// Maximum coordinate of a point, plane units.
const FARTHEST: f32 = 10.0;
/// Ends closer than this coincide, plane units: less than any picture shows.
const SAME: f32 = 1e-5;

/// The points of a constraint, plane units.
pub(super) fn points(constraint: &Constraint) -> Vec<Vec2> {
    constraint.points().iter().map(|&p| p.into()).collect()
}

/// The constraint with other points.
pub(super) fn through(constraint: &Constraint, points: &[Vec2]) -> Constraint {
    let mut constraint = constraint.clone();
    let own = match &mut constraint {
        Constraint::DirectedLine(line) => &mut line.points,
        Constraint::Wall(wall) => &mut wall.points,
    };
    *own = points.iter().map(|&p| p.into()).collect();
    constraint
}

/// Whether a polyline is closed.
pub(super) fn is_loop(points: &[Vec2]) -> bool {
    matches!(points, [first, _, _, .., last] if first.distance(*last) < SAME)
}

/// The selected constraints that are not locked.
pub(super) fn chosen<'a>(
    project: &'a Project,
    selection: &'a Selection,
) -> impl Iterator<Item = (usize, &'a Constraint)> {
    let all = project.constraints.iter().enumerate();
    all.filter(|(i, constraint)| selection.contains(*i) && !constraint.is_locked())
}

/// Reverses the direction of the selected lines.
pub fn reverse(project: &Project, selection: &Selection) -> Arranged {
    let (mut changes, mut after) = (Vec::new(), selection.clone());
    for (i, constraint) in chosen(project, selection) {
        let mut points = points(constraint);
        points.reverse();
        let turned: Vec<usize> = selection.points(i).map(|k| points.len().saturating_sub(k + 1)).collect();
        after.subtract(&Selection::one(i), |_| 0);
        after.extend(&if turned.is_empty() { Selection::one(i) } else { Selection::some(i, turned) });
        changes.push((i, through(constraint, &points)));
    }
    if changes.is_empty() { None } else { Some((Edit::Change(changes), after)) }
}

/// Joins the selected constraints of the kind of the first, nearest ends first; a single wall closes to a loop.
pub fn join(project: &Project, selection: &Selection) -> Arranged {
    let (first, constraint) = chosen(project, selection).next()?;
    let alike = |c: &Constraint| std::mem::discriminant(c) == std::mem::discriminant(constraint);
    let mut rest: Vec<(usize, Vec<Vec2>)> =
        chosen(project, selection).skip(1).filter(|(_, c)| alike(c)).map(|(i, c)| (i, points(c))).collect();
    let gone: Vec<usize> = rest.iter().map(|(i, _)| *i).collect();
    let mut chain = points(constraint);
    if rest.is_empty() {
        let open = matches!(constraint, Constraint::Wall(_)) && chain.len() > 2 && !is_loop(&chain);
        let begin = *chain.first().filter(|_| open)?;
        chain.push(begin);
    }
    while let Some((at, link)) = nearest_link(&chain, &rest) {
        let (_, mut other) = rest.swap_remove(at);
        if link.turned {
            other.reverse();
        }
        let (head, tail) = if link.before { (other, chain) } else { (chain, other) };
        chain = head;
        let met = chain.last().zip(tail.first()).is_some_and(|(a, b)| a.distance(*b) < SAME);
        chain.extend(tail.into_iter().skip(usize::from(met)));
    }
    let mut constraints = project.constraints.clone();
    constraints[first] = through(constraint, &chain);
    let mut index = 0..;
    constraints.retain(|_| index.next().is_none_or(|i| !gone.contains(&i)));
    Some((Edit::Constraints(constraints), Selection::one(first)))
}

/// How a line is joined to a chain.
struct Link {
    /// Before its start rather than after its end.
    before: bool,
    /// Reversed.
    turned: bool,
}

fn nearest_link(chain: &[Vec2], rest: &[(usize, Vec<Vec2>)]) -> Option<(usize, Link)> {
    let (begin, end) = (*chain.first()?, *chain.last()?);
    let links = rest.iter().enumerate().flat_map(|(at, (_, other))| {
        let ends = other.first().copied().zip(other.last().copied());
        ends.into_iter().flat_map(move |(first, last)| {
            // Those without reversal first: they win ties.
            [
                (end.distance(first), at, Link { before: false, turned: false }),
                (begin.distance(last), at, Link { before: true, turned: false }),
                (end.distance(last), at, Link { before: false, turned: true }),
                (begin.distance(first), at, Link { before: true, turned: true }),
            ]
        })
    });
    links.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at, link)| (at, link))
}

/// Splits the selected constraints at their selected points; a loop opens at the first of them.
pub fn split(project: &Project, selection: &Selection) -> Arranged {
    let (mut constraints, mut pieces, mut any) = (Vec::new(), Vec::new(), false);
    for (i, constraint) in project.constraints.iter().enumerate() {
        let cuts: Vec<usize> = selection.points(i).filter(|_| !constraint.is_locked()).collect();
        let parts = cut_at(&points(constraint), &cuts);
        if parts.is_empty() {
            constraints.push(constraint.clone());
            continue;
        }
        any = true;
        pieces.extend(constraints.len()..constraints.len() + parts.len());
        constraints.extend(parts.iter().map(|part| through(constraint, part)));
    }
    any.then(|| (Edit::Constraints(constraints), Selection::all(pieces)))
}

/// The parts between the points `cuts` (ascending); none where nothing is cut.
fn cut_at(points: &[Vec2], cuts: &[usize]) -> Vec<Vec<Vec2>> {
    let last = points.len().saturating_sub(1);
    if is_loop(points) {
        // Its ends are one point.
        let mut cuts: Vec<usize> = cuts.iter().map(|k| k % last).collect();
        cuts.dedup();
        let Some(&begin) = cuts.first() else { return Vec::new() };
        let mut open = points[begin..last].to_vec();
        open.extend(&points[..=begin]);
        let shifted: Vec<usize> = cuts[1..].iter().map(|k| k - begin).filter(|k| *k > 0).collect();
        return between(&open, &shifted);
    }
    let inner: Vec<usize> = cuts.iter().copied().filter(|k| *k > 0 && *k < last).collect();
    if inner.is_empty() { Vec::new() } else { between(points, &inner) }
}

fn between(points: &[Vec2], cuts: &[usize]) -> Vec<Vec<Vec2>> {
    let ends: Vec<usize> =
        std::iter::once(0).chain(cuts.iter().copied()).chain([points.len().saturating_sub(1)]).collect();
    ends.windows(2).map(|pair| points[pair[0]..=pair[1]].to_vec()).collect()
}

/// Deletes the selected points, and constraints with fewer than two points left.
pub fn delete(project: &Project, selection: &Selection) -> Arranged {
    let mut constraints = Vec::new();
    for (i, constraint) in project.constraints.iter().enumerate() {
        if constraint.is_locked() || !selection.contains(i) {
            constraints.push(constraint.clone());
            continue;
        }
        let mut point = 0..;
        let mut left = points(constraint);
        left.retain(|_| point.next().is_none_or(|k| !selection.moves(i, k)));
        if left.len() > 1 {
            constraints.push(through(constraint, &left));
        }
    }
    let gone = chosen(project, selection).map(|(i, _)| i);
    let edit = if chosen(project, selection).all(|(i, _)| selection.is_whole(i)) {
        Edit::Remove(gone.collect())
    } else {
        Edit::Constraints(constraints)
    };
    chosen(project, selection).next()?;
    Some((edit, Selection::default()))
}

/// Moves the selection by a vector, plane units.
pub fn nudge(project: &Project, selection: &Selection, by: Vec2) -> Arranged {
    let base: Vec<(usize, Constraint)> = chosen(project, selection).map(|(i, c)| (i, c.clone())).collect();
    (!base.is_empty()).then(|| (moved(&base, selection, by), selection.clone()))
}

/// The edit that moves the selected points of `base` by a vector, limited to the drawing range.
pub(super) fn moved(base: &[(usize, Constraint)], selection: &Selection, by: Vec2) -> Edit {
    let by = reach(
        by,
        base.iter().flat_map(|(i, c)| {
            let points = c.points().iter().enumerate();
            points.filter(|(k, _)| selection.moves(*i, *k)).map(|(_, p)| Vec2::from(*p))
        }),
    );
    let change = |(i, constraint): &(usize, Constraint)| {
        let mut points = points(constraint);
        for (_, point) in points.iter_mut().enumerate().filter(|(k, _)| selection.moves(*i, *k)) {
            *point += by;
        }
        (*i, through(constraint, &points))
    };
    Edit::Change(base.iter().map(change).collect())
}

/// Whole constraints moved by a vector, limited to the drawing range.
pub(in crate::editor) fn shifted(constraints: &[Constraint], by: Vec2) -> Vec<Constraint> {
    let by = reach(by, constraints.iter().flat_map(points));
    let moved = |constraint: &Constraint| points(constraint).into_iter().map(|p| p + by).collect::<Vec<_>>();
    constraints.iter().map(|constraint| through(constraint, &moved(constraint))).collect()
}

/// A move limited so that all points stay within the drawing range.
fn reach(by: Vec2, points: impl Iterator<Item = Vec2>) -> Vec2 {
    let far = Vec2::splat(FARTHEST);
    points.fold(by, |by, p| (p + by).clamp(-far, far) - p)
}
