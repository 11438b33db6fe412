//! Contact: the meaning of surfaces that lie in one another.
//!
//! Two rays' lengths to coincident surfaces differ by their rounding alone, so that a tracer would meet them in any order, or
//! lose one of them. Coincidence is found once, before the hierarchy is built: wherever triangles of several solids lie in
//! one plane, within the rounding of their coordinates ([`rounding`]), each place keeps one triangle, and that knows all the
//! solids that begin or end there ([`Contact`]). Rays meet it as any other surface. Ray origins are never moved, and a scene
//! in which nothing touches is left as it is.
//!
//! | what lies in one another | meaning |
//! |---|---|
//! | glass, glass on the other side (water and its tumbler, stacked blocks) | one boundary from the one glass to the other, without air between |
//! | glass, glass on the same side (an object twice in place) | one boundary; the glass of the higher priority, among equals the later in the list, fills the place |
//! | glass, a mirror or a matt surface | the mirror or matt surface: glass ends on it, without air between |
//! | mirrors, matt surfaces | that of the higher priority, among equals the later in the list |
//! | glass, the receiver or its floor | the receiver: light goes from the glass to it, without air between |
//! | a mirror or a matt surface, the receiver or its floor | the receiver |
//!
//! A gap above rounding, be it of 1e-6 m, is a gap of air. Every pair of objects that touch is noted, with what it means, and
//! every pair of which one is glass and that nearly touches.

mod arrangement;
mod interface;
mod merge;
mod notes;
mod on_receiver;
mod touching;

pub(super) use interface::Contact;
pub(super) use merge::{Merged, merge};
pub(super) use on_receiver::OnReceiver;
