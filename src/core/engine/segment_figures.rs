//! The figures of the light of one segment, of all that moves and of each flow.

use glam::Vec2;
use serde::Serialize;

use super::fitted_segment::FittedSegment;
use super::key_photons::{KeyPhotons, count};
use super::trajectories::SegmentTrajectories;
use crate::continuity::{Continuity, chosen_rows, measure};
use crate::{Progress, Result};

/// Evenly spaced steps by which photons are followed through a segment: around walls they turn within a hundredth of it.
const STEPS: usize = 160;

/// The figures of the light between two key frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SegmentContinuity {
    /// Numbers of the key frames.
    pub frames: [i32; 2],
    /// All light that moves.
    #[serde(flatten)]
    pub all: Continuity,
    /// The caustics that flow by themselves, and the others together; empty where all light shares one flow.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerContinuity>,
}

/// The figures of the light that shares one flow.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerContinuity {
    /// Names of its caustics; `None` for light without a name.
    pub caustics: Vec<Option<String>>,
    /// Its figures.
    #[serde(flatten)]
    pub figures: Continuity,
}

impl SegmentContinuity {
    /// The figures of all light and of each layer, with names for people.
    pub fn named_figures(&self) -> impl Iterator<Item = (String, &Continuity)> {
        let [from, to] = self.frames;
        let layer = move |layer: &'_ LayerContinuity| {
            let names = layer.caustics.iter().map(|name| name.as_deref().unwrap_or("the rest"));
            format!("frames {from}-{to}, {}", names.collect::<Vec<_>>().join(" and "))
        };
        let layers = self.layers.iter().map(move |of| (layer(of), &of.figures));
        [(format!("frames {from}-{to}"), &self.all)].into_iter().chain(layers)
    }

    /// The worst of all segments in each figure; none where nothing moves.
    pub fn worst(segments: &[Self]) -> Option<Continuity> {
        segments.iter().map(|segment| segment.all.clone()).reduce(|a, b| a.worst(&b))
    }
}

/// The figures of one segment, whatever the numbers of its key frames.
pub(super) struct Figures {
    /// Of all light that moves; none where it rests.
    all: Option<Continuity>,
    /// By the groups of each layer, where there are several.
    layers: Vec<(Vec<usize>, Continuity)>,
}

impl Figures {
    /// The figures of the photons that move in a segment, at its ends group by group and row by row.
    pub(super) fn of(
        fitted: &FittedSegment,
        ends: [&[KeyPhotons]; 2],
        extent: Vec2,
        progress: &Progress,
    ) -> Result<Self> {
        let layers: Vec<&Vec<usize>> = fitted.layers.iter().map(|layer| &layer.groups).collect();
        if layers.is_empty() {
            return Ok(Self { all: None, layers: Vec::new() });
        }
        let rows = rows_of(ends[0], &layers);
        let [from, to] = ends.map(|at| {
            let groups = at.iter().zip(&rows);
            groups.map(|(group, rows)| group.selected(rows)).collect::<Vec<_>>()
        });
        let frames = frames(SegmentTrajectories::new(fitted, &from, &to), progress)?;
        // Only where key frames meet half way do they miss each other.
        let gaps = fitted.reports.iter().map(|report| Some(report.gap).filter(|gap| *gap > 0.0));
        let all = Continuity {
            gap: gaps.clone().flatten().reduce(f64::max),
            ..measure(&frames, extent, progress)?
        };
        let of_layer = |(groups, gap): (&Vec<usize>, Option<f64>)| {
            let figures = measure(&columns(&frames, &from, groups), extent, progress)?;
            Ok((groups.clone(), Continuity { gap, ..figures }))
        };
        let several = if layers.len() > 1 { layers } else { Vec::new() };
        let layers = several.into_iter().zip(gaps).map(of_layer).collect::<Result<_>>()?;
        Ok(Self { all: Some(all), layers })
    }

    /// With the numbers of the key frames and the names of the caustics by group; none where nothing moves.
    pub(super) fn named(
        &self,
        frames: [i32; 2],
        name: impl Fn(usize) -> Option<String>,
    ) -> Option<SegmentContinuity> {
        let layer = |(groups, figures): &(Vec<usize>, Continuity)| LayerContinuity {
            caustics: groups.iter().map(|&group| name(group)).collect(),
            figures: figures.clone(),
        };
        let all = self.all.clone()?;
        Some(SegmentContinuity { frames, all, layers: self.layers.iter().map(layer).collect() })
    }
}

/// The rows of each group that are looked at; none of those that rest.
fn rows_of(groups: &[KeyPhotons], layers: &[&Vec<usize>]) -> Vec<Vec<usize>> {
    let moves = |group| layers.iter().any(|layer| layer.contains(&group));
    let count = |(i, group): (usize, &KeyPhotons)| if moves(i) { group.positions.len() } else { 0 };
    let counts: Vec<usize> = groups.iter().enumerate().map(count).collect();
    let mut chosen = chosen_rows(counts.iter().sum()).into_iter().peekable();
    let mut start = 0;
    let of_group = |count: usize| {
        let end = start + count;
        let rows = std::iter::from_fn(|| chosen.next_if(|&row| row < end)).map(|row| row - start).collect();
        start = end;
        rows
    };
    counts.into_iter().map(of_group).collect()
}

/// Positions of all photons at evenly spaced times from key to key.
fn frames(mut trajectories: SegmentTrajectories, progress: &Progress) -> Result<Vec<Vec<Vec2>>> {
    let mut frames = Vec::with_capacity(STEPS + 1);
    for step in 0..=STEPS {
        let mut positions = vec![Vec2::ZERO; trajectories.len()];
        trajectories.positions_at(step as f64 / STEPS as f64, &mut positions, progress)?;
        frames.push(positions);
    }
    Ok(frames)
}

/// The photons of some of all groups alone.
fn columns(frames: &[Vec<Vec2>], all: &[KeyPhotons], groups: &[usize]) -> Vec<Vec<Vec2>> {
    let rows = |&group: &usize| {
        let start = count(&all[..group]);
        start..start + all[group].positions.len()
    };
    let rows: Vec<_> = groups.iter().map(rows).collect();
    let of = |frame: &Vec<Vec2>| rows.iter().flat_map(|rows| &frame[rows.clone()]).copied().collect();
    frames.iter().map(of).collect()
}
