//! A scene the size of a grain, and one of ten kilometres.

use super::super::Size;
use super::super::case::{Bound, Case};
use super::super::light::{Room, limits};
use super::Group;

pub(super) const GROUP: Group = Group { name: "receiver", cases };

fn cases(size: Size) -> Vec<Case> {
    let count = size.pick(20_000, 400_000);
    let with = |scale: f32| {
        let mut limits = limits(
            "all lengths times one factor: as much light lands, within five deviations of two independent runs",
        );
        limits.energy = Some(5.0 * (2.0 / count as f64).sqrt());
        let room = Room { scale, ..Room::new(size) };
        Case::new(format!("{scale:e} m"), Bound::Holds(limits), move |progress| {
            room.run_scaled(count, progress)
        })
    };
    let refused = |scale: f32| {
        let room = Room { scale, ..Room::new(size) };
        let bound = Bound::Refused { words: "receiver.size", why: "beyond the range of the format" };
        Case::new(format!("{scale:e} m"), bound, move |progress| room.run(progress))
    };
    vec![with(1e-4), with(1e-2), with(1e4), refused(1e-5), refused(2e5)]
}
