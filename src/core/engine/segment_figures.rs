//! The figures of the light of one segment, of all that moves and of each flow.

use glam::Vec2;
use serde::Serialize;

use super::fitted_segment::FittedSegment;
use super::grouping::Grouping;
use super::key_photons::{KeyPhotons, count};
use super::segment_photons::SegmentPhotons;
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
    /// The figures of the photons that move in a segment.
    pub(super) fn of(
        fitted: &FittedSegment,
        photons: &SegmentPhotons,
        extent: Vec2,
        progress: &Progress,
    ) -> Result<Self> {
        let rows = rows_of(&photons.from, &photons.layers);
        let [from, to] = [&photons.from, &photons.to].map(|at| {
            let groups = at.iter().zip(&rows);
            groups.map(|(group, rows)| group.selected(rows)).collect::<Vec<_>>()
        });
        let frames = frames(SegmentTrajectories::new(fitted, &from, &to), progress)?;
        let of_layer = |groups: &Vec<usize>| {
            Ok((groups.clone(), measure(&columns(&frames, &from, groups), extent, progress)?))
        };
        let all = if photons.layers.is_empty() { None } else { Some(measure(&frames, extent, progress)?) };
        let several = if photons.layers.len() > 1 { &photons.layers[..] } else { &[] };
        Ok(Self { all, layers: several.iter().map(of_layer).collect::<Result<_>>()? })
    }

    /// With the numbers of the key frames and the names of the caustics; none where nothing moves.
    pub(super) fn named(&self, frames: [i32; 2], grouping: &Grouping) -> Option<SegmentContinuity> {
        let name = |group: &usize| grouping.name(*group).map(str::to_owned);
        let layer = |(groups, figures): &(Vec<usize>, Continuity)| LayerContinuity {
            caustics: groups.iter().map(name).collect(),
            figures: figures.clone(),
        };
        let all = self.all.clone()?;
        Some(SegmentContinuity { frames, all, layers: self.layers.iter().map(layer).collect() })
    }
}

/// The rows of each group that are looked at; none of those that rest.
fn rows_of(groups: &[KeyPhotons], layers: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let moves = |group: usize| layers.iter().any(|layer| layer.contains(&group));
    let counts: Vec<usize> =
        (0..groups.len()).map(|i| if moves(i) { groups[i].positions.len() } else { 0 }).collect();
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

/// The photons of some groups alone.
fn columns(frames: &[Vec<Vec2>], all: &[KeyPhotons], groups: &[usize]) -> Vec<Vec<Vec2>> {
    let rows: Vec<_> = groups
        .iter()
        .map(|&group| {
            let start = count(&all[..group]);
            start..start + all[group].positions.len()
        })
        .collect();
    let of = |frame: &Vec<Vec2>| rows.iter().flat_map(|rows| &frame[rows.clone()]).copied().collect();
    frames.iter().map(of).collect()
}
