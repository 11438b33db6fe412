//! Samples of the field at one frame.

use glam::{Vec2, vec2};
use lightloom_core::Progress;
use lightloom_core::engine::FieldAt;

use super::picture::{FlowPicture, HeatMap, Request};
use crate::editor::session::FieldMap;

/// Arrows along the longer side where the plane fits the view, and at most.
const ARROWS: [usize; 2] = [26, 104];
/// Streamlines, and steps along each.
const STREAMS: (usize, usize) = (420, 28);
/// Length of a fast streamline, plane units.
const LONG: f32 = 0.16;
/// Photons whose trails are shown.
const TRAILS: usize = 200;
/// Cells of a map along the longer side.
const CELLS: f32 = 72.0;
/// Cells of a map of photons: wide enough that most hold some.
const PHOTON_CELLS: f32 = 40.0;
/// The share of values that lie below the full colour.
const SHARE: f32 = 0.99;
/// The share of speeds that lie below the full colour: a few hurry at drawn lines and at corners of walls.
const FAST: f32 = 0.95;

/// Arrows along the longer side at a zoom: twice as many wherever they have room.
pub(super) fn lattice(zoom: f32) -> usize {
    let doublings = if zoom > 1.0 { zoom.log2().floor() } else { 0.0 };
    (ARROWS[0] << doublings.min(8.0) as usize).min(ARROWS[1])
}

/// Everything that takes but a few milliseconds.
pub(super) fn quickly(request: &Request) -> FlowPicture {
    let Request { preview, frame, show, .. } = request;
    let field = field(request);
    let mut picture = FlowPicture::default();
    if let Some(field) = field.as_ref().filter(|_| show.arrows || show.streamlines) {
        let arrows = arrows(field, preview.extent(), request.arrows);
        picture.fast = most(arrows.iter().map(|(_, u)| u.length()), FAST);
        if show.streamlines && picture.fast > 0.0 {
            picture.streamlines = streamlines(field, preview.extent(), picture.fast);
        }
        if show.arrows {
            picture.arrows = arrows;
        }
    }
    picture.map = match (field, show.map) {
        (Some(field), Some(FieldMap::Divergence)) => {
            Some(map(FieldMap::Divergence, preview.extent(), |p| field.divergence(p)))
        }
        (Some(field), Some(FieldMap::Curl)) => Some(map(FieldMap::Curl, preview.extent(), |p| field.curl(p))),
        _ => None,
    };
    if show.trails && preview.is_ready(*frame) {
        let count = preview.photons();
        let rows = (0..TRAILS.min(count)).map(|i| i * count / TRAILS.min(count));
        picture.trails = rows.map(|row| trajectory(request, row)).collect();
    }
    picture
}

/// The trajectory of a photon over the known frames.
pub(super) fn trajectory(request: &Request, row: usize) -> Vec<Vec2> {
    request.preview.track(row).into_iter().map(|(_, p)| p).collect()
}

/// The field of the caustic in focus, or the one that most share.
fn field(request: &Request) -> Option<FieldAt> {
    let mut fields = request.preview.fields(request.frame);
    let rows = request.caustic.and_then(|i| request.preview.groups().get(i)).map(|(_, rows)| rows);
    let own = rows.and_then(|rows| fields.iter().position(|field| field.rows().contains(rows)));
    let at = own.unwrap_or(0);
    if at < fields.len() { Some(fields.swap_remove(at)) } else { None }
}

fn arrows(field: &FieldAt, extent: Vec2, count: usize) -> Vec<(Vec2, Vec2)> {
    let step = extent.max_element() / count as f32;
    let along = |length: f32| (length / step).round().max(1.0) as usize;
    let (columns, rows) = (along(extent.x), along(extent.y));
    let places =
        (0..rows).flat_map(|y| (0..columns).map(move |x| vec2(x as f32 + 0.5, y as f32 + 0.5) * step));
    places.map(|p| (p, field.velocity(p))).filter(|(_, u)| u.is_finite()).collect()
}

/// Ways from evenly spread places (Roberts 2018, the R2 sequence), by the midpoint rule.
fn streamlines(field: &FieldAt, extent: Vec2, fast: f32) -> Vec<Vec<Vec2>> {
    let dt = LONG / fast / STREAMS.1 as f32;
    let inside = |p: Vec2| p.cmpge(Vec2::ZERO).all() && p.cmple(extent).all();
    let stream = |i: usize| {
        let mut p = vec2(0.754_877_7, 0.569_840_3) * (i as f32 + 0.5);
        p = p.fract() * extent;
        let mut line = vec![p];
        for _ in 0..STREAMS.1 {
            let middle = p + field.velocity(p) * (0.5 * dt);
            p += field.velocity(middle) * dt;
            if !p.is_finite() || !inside(p) {
                break;
            }
            line.push(p);
        }
        line
    };
    (0..STREAMS.0).map(stream).filter(|line| line.len() > 2).collect()
}

fn map(of: FieldMap, extent: Vec2, value: impl Fn(Vec2) -> f32) -> HeatMap {
    let cells = cells(extent, CELLS);
    let step = extent / vec2(cells[0] as f32, cells[1] as f32);
    let nodes = (0..=cells[1]).flat_map(|y| (0..=cells[0]).map(move |x| vec2(x as f32, y as f32) * step));
    let values: Vec<f32> = nodes.map(value).map(|v| if v.is_finite() { v } else { 0.0 }).collect();
    HeatMap { of, cells, most: most(values.iter().copied(), SHARE), values }
}

pub(super) fn cells(extent: Vec2, longer: f32) -> [usize; 2] {
    [extent.x, extent.y].map(|side| (side / extent.max_element() * longer).round().max(1.0) as usize)
}

/// The size below which this share of the values lies that are not 0.
fn most(values: impl Iterator<Item = f32>, share: f32) -> f32 {
    let mut sizes: Vec<f32> = values.map(f32::abs).filter(|size| *size > 0.0).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let at = ((sizes.len() - 1) as f32 * share) as usize;
    *sizes.select_nth_unstable_by(at, f32::total_cmp).1
}

/// The mean size of what the fit leaves undone, over the photons near each node.
pub(super) fn residual(request: &Request, progress: &Progress) -> Option<HeatMap> {
    let residuals = request.preview.residuals(request.frame, progress).ok()??;
    let positions = request.preview.positions(request.frame)?;
    let extent = request.preview.extent();
    let cells = cells(extent, PHOTON_CELLS);
    let last = vec2(cells[0] as f32, cells[1] as f32);
    let (mut sums, mut counts) = (vec![0.0f32; (cells[0] + 1) * (cells[1] + 1)], Vec::new());
    counts.resize(sums.len(), 0u32);
    for (p, r) in positions.iter().zip(&residuals).filter(|(p, r)| p.is_finite() && r.is_finite()) {
        let node = (*p / extent * last).round().clamp(Vec2::ZERO, last);
        let at = node.y as usize * (cells[0] + 1) + node.x as usize;
        sums[at] += r.length();
        counts[at] += 1;
    }
    let values: Vec<f32> = sums.iter().zip(&counts).map(|(sum, &n)| sum / n.max(1) as f32).collect();
    Some(HeatMap { of: FieldMap::Residual, cells, most: most(values.iter().copied(), SHARE), values })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_full_colour_is_not_that_of_an_outlier() {
        let mut values: Vec<f32> = (0..1000).map(|i| (i as f32 - 500.0) / 500.0).collect();
        values.push(1e6);
        let most_of = most(values.into_iter(), SHARE);
        assert!((0.9..=1.0).contains(&most_of), "{most_of}");
        assert_eq!(most([0.0, 0.0].into_iter(), SHARE), 0.0);
    }

    #[test]
    fn arrows_grow_more_as_the_view_comes_nearer() {
        assert_eq!([0.0, 0.5, 1.0, 2.0, 5.0, 200.0].map(lattice), [26, 26, 26, 52, 104, 104]);
    }
}
