//! The transport cost of a matching over a lower bound of it, over the seconds it takes.

mod points;
mod text;
mod variants;

use super::section_def::{SectionDef, nothing_moves};
use crate::content::Section;
use crate::context::Context;
use lightloom_core::{Progress, Result};
use points::Points;
use text::Measured;
use variants::{Variant, Variants};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "matching", skip: nothing_moves, measure, seconds: [4.0, 20.0] };

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let photons = context.moving_segment(progress)?;
    let (seed, most, finest) =
        (context.project.seed, context.effort.pick(10_000, 200_000), context.effort.pick(256, 512));
    let points = Points::new(&photons, most, seed);
    let walls = !photons.matched_walls().is_empty();
    let list = Variant::list(Variant::of(&context.project, walls), walls, finest);
    progress.begin("matching", list.len() as u64 + 2);
    let variants = Variants::new(&points, &photons, seed, progress)?;
    progress.advance(1);
    let mut rows = Vec::new();
    for variant in list {
        rows.push(variants.measure(variant)?);
        progress.advance(1);
    }
    let bound = points.bound(finest, &progress.inner())?;
    progress.advance(1);
    let (project, count) = (context.project.name.clone(), points.source.len());
    Ok(Measured { project, count, rows, bound, walls: variants.walls() }.section())
}
