//! The photons of one pass from key frame to key frame.
//!
//! The only loop over the key frames of a project: fits, passes, previews and tracks all step through a [`Walk`].

use std::sync::Arc;

use glam::Vec2;

use super::job::Job;
use super::key_photons::{KeyPhotons, PassLight};
use super::memo::Same;
use super::numeric_place::in_segment;
use super::pairing::{Pairing, PairingMethod, TransportCost};
use super::segment_photons::{
    FirstKey, GroupTracks, Maps, MatchInput, Matched, MeetingFlow, Origin, SegmentPhotons,
};
use crate::flow::meeting::{HalfTracks, MeetingFields};
use crate::flow::spatial_order;
use crate::matching::{ContinuousMap, MatchingMethod, mean_square_distance, transport_map};
use crate::{Progress, Result};

/// The photons of one pass at a key frame, on their way to the next.
pub(super) struct Walk<'a> {
    job: &'a Job<'a>,
    pass: u64,
    light: PassLight,
    key: usize,
    at: Arc<Vec<KeyPhotons>>,
    origin: Origin,
}

/// Where the maps of a segment come from.
pub(super) enum MapsFrom<'a> {
    /// The photons of the walk itself. `bounded` asks for a lower bound of the transport cost, which takes as long as a map.
    Own { bounded: bool },
    /// Other photons of the same key frames, matched before.
    Others(&'a Arc<Maps>),
}

impl<'a> Walk<'a> {
    /// The photons of `pass` at the first key frame.
    pub(super) fn start(job: &'a Job, pass: u64) -> Result<Self> {
        Ok(Self::with_light(job, pass, job.light(pass)?))
    }

    /// As [`Walk::start`], with the light of photons that are traced.
    pub(super) fn with_light(job: &'a Job, pass: u64, light: PassLight) -> Self {
        let sources = job.sources;
        let first = |group| {
            let at = sources.key(0, group, &light, pass);
            match job.project.matching {
                // Neighbours on the plane become neighbours in memory: a step reads each coefficient of the field once.
                MatchingMethod::Transport => at.permuted(&spatial_order(&at.positions)),
                MatchingMethod::Given => at,
            }
        };
        let at = Arc::new((0..light.groups.len()).map(first).collect());
        let origin = Origin::First(Box::new(FirstKey {
            guide: job.guide.as_ref().map(Same::of),
            photons: job.photons,
            seed: sources.seed(),
            extent: job.extent,
            caustics: job.project.caustics.clone(),
            matching: job.project.matching,
            sources: sources.at_key(0),
        }));
        Self { job, pass, light, key: 0, at, origin }
    }

    /// The light that the groups share.
    pub(super) fn light(&self) -> &PassLight {
        &self.light
    }

    /// The photons of each group at the key frame where they are.
    pub(super) fn at(&self) -> &Arc<Vec<KeyPhotons>> {
        &self.at
    }

    /// The flux that all photons should have there, watts; rho does not count.
    pub(super) fn requested(&self) -> f64 {
        self.job.sources.requested(self.key, &self.light)
    }

    /// Moves on to the next key frame; none after the last. The matching of pass 0 is remembered if the job remembers.
    ///
    /// # Errors
    /// Points that cannot be matched; cancelled.
    pub(super) fn next(&mut self, maps: MapsFrom) -> Result<Option<SegmentPhotons>> {
        let (job, number) = (self.job, self.key);
        if number + 1 >= job.project.keys.len() {
            return Ok(None);
        }
        let layers = self.layers();
        let paired = match self.is_remembered(&maps) {
            true => self.remembered(&maps),
            false => self.pair(&maps, job.progress),
        };
        let (matched, mut to, tracks) = in_segment(paired, job.project, number)?;
        for (group, (before, to)) in self.at.iter().zip(&mut to).enumerate() {
            job.sources.keep_colours((number + 1, group), before, to);
        }
        let to = Arc::new(to);
        let before = self.requested();
        let from = std::mem::replace(&mut self.at, to.clone());
        self.key += 1;
        self.origin = Origin::Matched(Same::of(&matched));
        let requested = [before, self.requested()];
        Ok(Some(SegmentPhotons { number, from, to, requested, layers, matched, tracks }))
    }

    /// The groups that have photons to move until the next key frame; those together that share a field.
    fn layers(&self) -> Vec<Vec<usize>> {
        let groups = self.job.sources.grouping();
        let moves = |group: &usize| !self.rests(*group) && !self.at[*group].positions.is_empty();
        let (own, shared): (Vec<_>, Vec<_>) =
            (0..groups.count()).filter(moves).partition(|&group| groups.own_flow(group));
        let shared = Some(shared).filter(|groups| !groups.is_empty());
        shared.into_iter().chain(own.into_iter().map(|group| vec![group])).collect()
    }

    /// Whether a matching of this pass by these maps is remembered. One by the maps of a bake is not: it would take the place
    /// of that which made the maps.
    fn is_remembered(&self, maps: &MapsFrom) -> bool {
        let by_bake = self.job.baked && matches!(maps, MapsFrom::Others(_));
        self.job.remembers && self.pass == 0 && !by_bake
    }

    /// Whether the photons of a group stay in place until the next key frame.
    fn rests(&self, group: usize) -> bool {
        self.job.sources.rests(self.key, group)
    }

    fn method(&self) -> PairingMethod {
        PairingMethod::of(self.job.project, self.key, self.job.extent)
    }

    /// The points of a group at the next key frame, not yet paired.
    fn next_points(&self, group: usize) -> KeyPhotons {
        self.job.sources.key(self.key + 1, group, &self.light, self.pass)
    }

    fn remembered(&self, maps: &MapsFrom) -> Result<Paired> {
        let Job { stages, progress, anchors, .. } = *self.job;
        let input = MatchInput {
            from: self.origin.clone(),
            sources: self.job.sources.at_key(self.key + 1),
            method: self.method(),
            anchors,
            bounded: matches!(maps, MapsFrom::Own { bounded: true }),
            maps: match maps {
                MapsFrom::Own { .. } => None,
                MapsFrom::Others(maps) => Some(Same::of(maps)),
            },
        };
        let mut fresh = None;
        let matched = stages.matchings.get(self.job.slot(self.key), input, progress, |_| {
            let (matched, to, tracks) = self.pair(maps, progress)?;
            fresh = Some((to, tracks));
            Ok(matched)
        })?;
        let arrange = |(group, pairing): (usize, &Pairing)| pairing.arrange(self.next_points(group));
        let (to, tracks) =
            fresh.unwrap_or_else(|| (matched.pairings.iter().enumerate().map(arrange).collect(), Vec::new()));
        Ok((matched, to, tracks))
    }

    /// Pairs the photons of all groups with their points of the next key frame: row k of the points is the target of
    /// photon k.
    fn pair(&self, maps: &MapsFrom, progress: &Progress) -> Result<Paired> {
        let points: Vec<KeyPhotons> = (0..self.at.len()).map(|group| self.next_points(group)).collect();
        let meeting = match (self.method(), maps) {
            (_, MapsFrom::Others(maps)) => maps.meeting.clone(),
            (PairingMethod::Meeting(input), MapsFrom::Own { .. }) => {
                let groups: Vec<[&[Vec2]; 2]> =
                    self.at.iter().zip(&points).map(|(a, b)| [&*a.positions, &*b.positions]).collect();
                let meeting = super::meeting::fit(self.job, (self.key, &input), (&self.layers(), &groups))?;
                Some(Arc::new(meeting))
            }
            _ => None,
        };
        let pair = || {
            progress.begin("match", 1);
            self.pair_groups((maps, meeting), points, progress)
        };
        // What is done again for every pass is a part of the render.
        if self.is_remembered(maps) { self.job.meter.measure("match", pair) } else { pair() }
    }

    /// Pairs group by group, where they meet if there is a meeting.
    fn pair_groups(
        &self,
        (maps, meeting): (&MapsFrom, Option<Arc<MeetingFlow>>),
        all_points: Vec<KeyPhotons>,
        progress: &Progress,
    ) -> Result<Paired> {
        let (mut own, mut pairings, mut arranged, mut all_tracks) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut cost = TransportCost::default();
        for (group, (at, points)) in self.at.iter().zip(all_points).enumerate() {
            let fields = meeting.as_ref().and_then(|meeting| meeting.fields_of(group));
            let tracks = match fields {
                Some(fields) if !self.rests(group) && !at.positions.is_empty() => Some([
                    HalfTracks::new(fields, 0, &at.positions, &progress.inner())?,
                    HalfTracks::new(fields, 1, &points.positions, &progress.inner())?,
                ]),
                _ => None,
            };
            // Photons are paired where they meet, or at their key frames.
            let ends = match &tracks {
                Some([earlier, later]) => [earlier.end(), later.end()],
                None => [&*at.positions, &*points.positions],
            };
            let made = match maps {
                MapsFrom::Own { .. } => self.map((group, fields), ends, &progress.inner())?,
                MapsFrom::Others(_) => None,
            };
            let map = match maps {
                MapsFrom::Own { .. } => made.as_ref(),
                MapsFrom::Others(maps) => maps.by_group[group].as_ref(),
            };
            let bound = match (map, maps, &tracks) {
                (Some(map), MapsFrom::Own { bounded: true }, None) => {
                    map.lower_bound(ends[0], ends[1], progress)?
                }
                _ => None,
            };
            let pairing = self.pairing((group, fields), ends, map, &progress.inner())?;
            let tracks = tracks.map(|[earlier, later]| match &pairing.order {
                Some(order) => [earlier, later.permuted(order)],
                None => [earlier, later],
            });
            let points = pairing.arrange(points);
            if matches!(maps, MapsFrom::Own { .. }) && !self.rests(group) && !at.positions.is_empty() {
                let mean = match map.filter(|_| tracks.is_none()) {
                    Some(map) => map.cost(&at.positions, &points.positions),
                    None => mean_square_distance(&at.positions, points.positions.iter().copied()),
                };
                cost.add(at.positions.len(), mean, bound);
            }
            own.push(made);
            pairings.push(pairing);
            arranged.push(points);
            all_tracks.push(tracks);
        }
        let maps = match maps {
            MapsFrom::Own { .. } => Arc::new(Maps { by_group: own, meeting }),
            MapsFrom::Others(maps) => (*maps).clone(),
        };
        Ok((Arc::new(Matched { pairings, maps, cost }), arranged, all_tracks))
    }

    /// The map of a group between its photons and points; none where rows are paired as given, where the group rests, and
    /// where it has no photon.
    fn map(
        &self,
        (group, meeting): (usize, Option<&MeetingFields>),
        ends: [&[Vec2]; 2],
        progress: &Progress,
    ) -> Result<Option<ContinuousMap>> {
        if self.rests(group) || ends[0].is_empty() {
            return Ok(None);
        }
        let walls = meeting.and_then(MeetingFields::walls_at_meeting);
        if let Some(graph) = walls {
            let map = transport_map(ends[0], ends[1], self.job.extent, progress)?;
            return Ok(Some(ContinuousMap::Beside(map, graph)));
        }
        let plane = (self.job.extent, self.job.anchors);
        self.method().map((ends[0], ends[1]), plane, progress)
    }

    /// The pairing of a group between its photons and points along `map`, or along a map of its own where the photons that
    /// were matched before had none.
    fn pairing(
        &self,
        (group, meeting): (usize, Option<&MeetingFields>),
        ends: [&[Vec2]; 2],
        map: Option<&ContinuousMap>,
        progress: &Progress,
    ) -> Result<Pairing> {
        if self.rests(group) {
            return Ok(Pairing { order: Some(self.at[group].origin.clone()), midpoint_offsets: Vec::new() });
        }
        if ends[0].is_empty() {
            return Ok(Pairing::default());
        }
        let own = match map {
            Some(_) => None,
            None => self.map((group, meeting), ends, progress)?,
        };
        let Some(map) = map.or(own.as_ref()) else { return Ok(Pairing::default()) };
        let seed = self.job.sources.seed();
        let paired = map.pair(ends[0], ends[1], seed, self.pass, progress)?;
        Ok(Pairing { order: Some(paired.matching.target_of), midpoint_offsets: paired.midpoint_offsets })
    }
}

/// A matching, the points in the rows of their photons, and the tracks to the meeting by group; no tracks where the matching
/// was remembered.
type Paired = (Arc<Matched>, Vec<KeyPhotons>, Vec<Option<GroupTracks>>);
