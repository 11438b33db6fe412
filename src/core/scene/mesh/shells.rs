//! The shells of a mesh: its connected surfaces, and which of their faces are wound the wrong way.
//!
//! Glass is wound outward: neighbours run their common edge in opposite directions, and a closed shell encloses a positive
//! volume, each shell by itself, as halves that were mirrored may be inside out. A shell within another is a cavity or a
//! solid as the file has it: only the outermost decides.

use glam::DVec3;
use rayon::prelude::*;

/// Closed shells of a mesh above which none is taken to stand within another: the search is quadratic.
const MANY: usize = 1024;

/// One side of an edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// Welded vertices, ascending.
    edge: [u32; 2],
    face: u32,
    /// Whether the face runs it from the lower to the higher vertex.
    is_forward: bool,
}

/// The sides of all edges, those of one edge together.
pub(super) struct Sides(Vec<Side>);

impl Sides {
    pub(super) fn new(faces: &[[u32; 3]]) -> Self {
        let of = |(face, [a, b, c]): (usize, &[u32; 3])| {
            [(*a, *b), (*b, *c), (*c, *a)].map(|(from, to)| Side {
                edge: [from.min(to), from.max(to)],
                face: face as u32,
                is_forward: from < to,
            })
        };
        let mut sides: Vec<Side> = faces.par_iter().enumerate().flat_map_iter(of).collect();
        sides.par_sort_unstable();
        Self(sides)
    }

    fn edges(&self) -> impl Iterator<Item = &[Side]> {
        self.0.chunk_by(|a, b| a.edge == b.edge)
    }

    /// Numbers of open edges, which have an odd number of faces, and of those that all faces run in the same direction.
    pub(super) fn faulty(&self) -> (usize, usize) {
        let (mut open, mut inconsistent) = (0, 0);
        for sides in self.edges() {
            let turns: i32 = sides.iter().map(|side| if side.is_forward { 1 } else { -1 }).sum();
            match (turns, sides.len() % 2) {
                (0, _) => (),
                (_, 1) => open += 1,
                _ => inconsistent += 1,
            }
        }
        (open, inconsistent)
    }

    /// For each face its shell, numbered from 0: faces that share an edge, where `crowded` also edges of more than two faces.
    pub(super) fn shells(&self, faces: usize, crowded: bool) -> Vec<u32> {
        let mut parent: Vec<u32> = (0..faces as u32).collect();
        for sides in self.edges().filter(|sides| crowded || sides.len() == 2) {
            for side in &sides[1..] {
                let (a, b) = (root(&mut parent, sides[0].face), root(&mut parent, side.face));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
        // The root is the lowest face of its shell, so that it has its number before the others ask for it.
        let mut numbers = vec![0; faces];
        let mut count = 0;
        for face in 0..faces as u32 {
            let root = root(&mut parent, face);
            numbers[face as usize] = if root == face { count } else { numbers[root as usize] };
            count += u32::from(root == face);
        }
        numbers
    }

    /// For each shell whether all its edges have an even number of its `wanted` faces.
    pub(super) fn closed(&self, shells: &[u32], wanted: impl Fn(u32) -> bool) -> Vec<bool> {
        let mut closed = vec![true; shells.iter().max().map_or(0, |last| *last as usize + 1)];
        let mut at = Vec::new();
        for sides in self.edges() {
            at.clear();
            at.extend(sides.iter().filter(|side| wanted(side.face)).map(|side| shells[side.face as usize]));
            at.sort_unstable();
            for shell in at.chunk_by(|a, b| a == b).filter(|group| group.len() % 2 == 1) {
                closed[shell[0] as usize] = false;
            }
        }
        closed
    }

    /// For each face whether it is wound against the first face of its shell.
    fn against_first(&self, faces: usize) -> Vec<bool> {
        let mut neighbours = vec![[(u32::MAX, false); 3]; faces];
        let mut put = |face: u32, other: u32, is_against: bool| {
            let free = neighbours[face as usize].iter_mut().find(|(neighbour, _)| *neighbour == u32::MAX);
            free.into_iter().for_each(|slot| *slot = (other, is_against));
        };
        for sides in self.edges() {
            if let [a, b] = sides {
                put(a.face, b.face, a.is_forward == b.is_forward);
                put(b.face, a.face, a.is_forward == b.is_forward);
            }
        }
        let mut against: Vec<Option<bool>> = vec![None; faces];
        let mut open = Vec::new();
        for first in 0..faces {
            if against[first].is_none() {
                against[first] = Some(false);
                open.push(first);
            }
            while let Some(face) = open.pop() {
                let own = against[face].unwrap_or(false);
                for (other, is_against) in neighbours[face].into_iter().filter(|n| n.0 != u32::MAX) {
                    let place = &mut against[other as usize];
                    if place.is_none() {
                        *place = Some(own != is_against);
                        open.push(other as usize);
                    }
                }
            }
        }
        against.into_iter().map(|is| is.unwrap_or(false)).collect()
    }
}

fn root(parent: &mut [u32], mut face: u32) -> u32 {
    while parent[face as usize] != face {
        parent[face as usize] = parent[parent[face as usize] as usize];
        face = parent[face as usize];
    }
    face
}

/// For each face whether it must be turned for the glass to be wound outward.
pub(super) fn inward(sides: &Sides, shells: &[u32], corners: &[[DVec3; 3]]) -> Vec<bool> {
    let mut turned = sides.against_first(shells.len());
    let closed = sides.closed(shells, |_| true);
    let mut bodies: Vec<Body> = closed.iter().map(|is_closed| Body::new(*is_closed)).collect();
    let origin = corners.first().map_or(DVec3::ZERO, |c| c[0]);
    for (face, c) in corners.iter().enumerate() {
        bodies[shells[face] as usize].add(face, c.map(|corner| corner - origin), turned[face]);
    }
    let own: Vec<bool> = bodies.iter().map(Body::is_inward).collect();
    let mut solids: Vec<usize> = (0..bodies.len()).filter(|shell| bodies[*shell].is_closed).collect();
    if solids.len() > MANY {
        solids.clear();
    }
    let inward: Vec<bool> = (0..bodies.len())
        .map(|shell| {
            let around = |solid: &&usize| {
                **solid != shell && bodies[**solid].contains(&bodies[shell], corners, origin)
            };
            // The largest of those around it is the outermost.
            let outermost = solids
                .iter()
                .filter(around)
                .max_by(|a, b| bodies[**a].volume.abs().total_cmp(&bodies[**b].volume.abs()));
            own[*outermost.unwrap_or(&shell)]
        })
        .collect();
    turned.iter_mut().zip(shells).for_each(|(turned, shell)| *turned ^= inward[*shell as usize]);
    turned
}

/// One shell, with its faces wound as its first.
struct Body {
    is_closed: bool,
    faces: Vec<usize>,
    /// Faces that were turned to be wound as the first.
    turned: usize,
    /// Six times the volume; negative if wound inward.
    volume: f64,
    lower: DVec3,
    upper: DVec3,
    /// A point of it.
    point: DVec3,
}

impl Body {
    fn new(is_closed: bool) -> Self {
        let (lower, upper) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        Self { is_closed, faces: Vec::new(), turned: 0, volume: 0.0, lower, upper, point: DVec3::ZERO }
    }

    fn add(&mut self, face: usize, [a, b, c]: [DVec3; 3], turned: bool) {
        self.faces.push(face);
        self.turned += usize::from(turned);
        let volume = a.dot(b.cross(c));
        self.volume += if turned { -volume } else { volume };
        self.lower = self.lower.min(a).min(b).min(c);
        self.upper = self.upper.max(a).max(b).max(c);
        self.point = (a + b + c) / 3.0;
    }

    /// Whether the first face is wound inward: by the volume, or where the shell has none, by most of its faces.
    fn is_inward(&self) -> bool {
        if self.is_closed { self.volume < 0.0 } else { 2 * self.turned > self.faces.len() }
    }

    /// Whether another shell stands inside it: a ray from there crosses it an odd number of times.
    fn contains(&self, other: &Self, corners: &[[DVec3; 3]], origin: DVec3) -> bool {
        let is_within = self.lower.cmplt(other.lower).all() && self.upper.cmpgt(other.upper).all();
        if !self.is_closed || !is_within {
            return false;
        }
        let direction = DVec3::new(0.371_39, 0.801_78, 0.468_12);
        let crossed = |face: &&usize| {
            let [a, b, c] = corners[**face].map(|corner| corner - origin - other.point);
            let sides = [a.cross(b), b.cross(c), c.cross(a)].map(|normal| normal.dot(direction));
            let is_through = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
            let normal = (b - a).cross(c - a);
            is_through && a.dot(normal) / direction.dot(normal) > 0.0
        };
        self.faces.iter().filter(crossed).count() % 2 == 1
    }
}
