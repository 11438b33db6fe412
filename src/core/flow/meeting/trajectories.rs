//! Photons that move from both key frames to the meeting, paired.

use std::borrow::Cow;

use glam::Vec2;
use rayon::prelude::*;

use super::detours::Detours;
use super::diffusion::Diffusion;
use super::fields::MeetingFields;
use super::half_step::HalfStep;
use super::made_up::MadeUp;
use super::tracks::HalfTracks;
use crate::flow::observer::{Kinematics, Observer};
use crate::flow::report::FlowReport;
use crate::flow::segment::guide_rows;
use crate::flow::step::CHUNK;
use crate::flow::trajectories::Trajectories;
use crate::flow::walls::WallViolations;
use crate::{Progress, Result};

/// The photons of one pass on their way through a segment that meets half way: 8 bytes for each photon and step.
///
/// In the first half a photon is where the light of the earlier key frame is that moves forward, in the second half where
/// that of the later one is that moves backward. What is between its two ends at the meeting is made up for by half in
/// either half (`made_up`), so that position and velocity have no jump.
pub struct MeetingTrajectories<'a> {
    fields: &'a MeetingFields,
    source: &'a [Vec2],
    targets: &'a [Vec2],
    halves: Option<[Cow<'a, HalfTracks>; 2]>,
    /// Known with the tracks; none where no wall stands.
    detours: Option<Option<Detours>>,
    /// Made when it is first asked for.
    diffusion: Option<Diffusion>,
}

impl<'a> MeetingTrajectories<'a> {
    /// Photons at `source`, each bound for the target in the same row; their tracks are made when they are asked for.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn new(fields: &'a MeetingFields, source: &'a [Vec2], targets: &'a [Vec2]) -> Self {
        assert_eq!(source.len(), targets.len(), "each photon has one target");
        Self { fields, source, targets, halves: None, detours: None, diffusion: None }
    }

    /// As [`Self::new`], with known tracks from both key frames, row by row.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn with_tracks(
        fields: &'a MeetingFields,
        (source, targets): (&'a [Vec2], &'a [Vec2]),
        halves: [&'a HalfTracks; 2],
    ) -> Self {
        assert!(halves.iter().all(|tracks| tracks.end().len() == source.len()), "a track for each photon");
        Self { halves: Some(halves.map(Cow::Borrowed)), ..Self::new(fields, source, targets) }
    }

    /// Makes the tracks unless they are known.
    fn prepare(&mut self, progress: &Progress) -> Result<()> {
        if self.halves.is_none() {
            let tracks = |half, photons| HalfTracks::new(self.fields, half, photons, progress);
            let tracks = [tracks(0, self.source)?, tracks(1, self.targets)?];
            self.halves = Some(tracks.map(Cow::Owned));
        }
        if let (None, Some([forward, backward])) = (&self.detours, &self.halves) {
            self.detours = Some(Detours::new(self.fields, [forward, backward], progress)?);
        }
        Ok(())
    }

    /// Moves of photons through walls, each photon with a path looked at in every substep.
    fn crossings(&self, progress: &Progress) -> Result<usize> {
        let Some(obstacles) = self.fields.obstacles() else { return Ok(0) };
        let substeps = obstacles.steps();
        let mut at = self.source.to_vec();
        let mut next = at.clone();
        let mut count = 0;
        let mut reachable = vec![true; at.len()];
        let detours = self.detours.iter().flatten();
        detours.flat_map(Detours::unreachable).for_each(|row| reachable[row] = false);
        for n in 1..=substeps {
            progress.check()?;
            match n == substeps {
                true => next.copy_from_slice(self.targets),
                false => self.positions(n as f64 / substeps as f64, &mut next),
            }
            if let Some(graph) = obstacles.graph(n - 1) {
                let barriers = graph.barriers();
                let moves = at.par_iter().zip(&next).zip(&reachable).with_min_len(4096);
                count += moves.filter(|((a, b), reachable)| **reachable && barriers.blocks(**a, **b)).count();
            }
            at.copy_from_slice(&next);
        }
        Ok(count)
    }

    /// Share of the photons that leave the flow for a path around walls; 0 before the tracks are known.
    fn detours(&self) -> f64 {
        let count: usize = self.detours.iter().flatten().map(Detours::count).sum();
        count as f64 / self.source.len().max(1) as f64
    }

    /// Root mean square gap at the meeting, plane units; 0 before the tracks are known.
    pub fn gap(&self) -> f64 {
        let Some([forward, backward]) = &self.halves else { return 0.0 };
        let squares =
            forward.end().iter().zip(backward.end()).map(|(a, b)| f64::from(a.distance_squared(*b)));
        (squares.sum::<f64>() / self.source.len().max(1) as f64).sqrt()
    }

    /// The half at time `t`, and its step there with the fraction of it that is done; none before the tracks are known.
    fn place(&self, t: f64) -> Option<(Half, HalfStep<'_>, f32)> {
        let second = usize::from(t > 0.5);
        let tracks = &self.halves.as_ref()?[second];
        let since = (if second == 0 { t } else { 1.0 - t }).clamp(0.0, 0.5);
        let place = since * self.fields.steps() as f64;
        let done = (place as usize).min(tracks.count() - 1);
        let half = Half { second, since, sign: if second == 0 { 1.0 } else { -1.0 } };
        Some((half, HalfStep::new(self.fields, second, done, tracks), (place - done as f64) as f32))
    }

    /// Writes `value` of the row and its gap for each photon.
    fn each(&self, out: &mut [Vec2], value: impl Fn(usize, Vec2) -> Vec2 + Sync) {
        let Some([forward, backward]) = &self.halves else { return };
        let (first, last) = (forward.end(), backward.end());
        out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, out)| {
            for (i, out) in out.iter_mut().enumerate().map(|(i, out)| (chunk * CHUNK + i, out)) {
                *out = value(i, last[i] - first[i]);
            }
        });
    }
}

/// A time as one of a half.
struct Half {
    /// 0 or 1.
    second: usize,
    /// Time since its key frame.
    since: f64,
    /// 1 in the first half, -1 in the second.
    sign: f32,
}

impl Trajectories for MeetingTrajectories<'_> {
    fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        assert_eq!(out.len(), self.targets.len(), "one position for each photon");
        progress.check()?;
        match t {
            t if t <= 0.0 => out.copy_from_slice(self.source),
            t if t >= 1.0 => out.copy_from_slice(self.targets),
            t => {
                self.prepare(progress)?;
                self.positions(t, out);
            }
        }
        Ok(())
    }

    fn light_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<f32> {
        self.positions_at(t, out, progress)?;
        let Self { fields, source, targets, .. } = *self;
        let Some([forward, backward]) = &self.halves else { return Ok(0.0) };
        let new = || Diffusion::new(fields.hold(), [source, targets], [forward.end(), backward.end()]);
        let diffusion = self.diffusion.get_or_insert_with(new);
        diffusion.displace(fields, t, out);
        Ok(diffusion.deviation(t))
    }

    fn wall_violations(&self) -> WallViolations {
        self.detours.iter().flatten().map(Detours::violations).next().unwrap_or_default()
    }
}

impl Kinematics for MeetingTrajectories<'_> {
    fn positions(&self, t: f64, out: &mut [Vec2]) {
        let Some((half, step, x)) = self.place(t) else { return };
        // Also in steps without walls: they may have stood before, or come.
        let detours = self.detours.as_ref().and_then(Option::as_ref);
        let made_up = MadeUp::at(half.since as f32, self.fields.hold());
        self.each(out, |row, gap| {
            let early = made_up.share(gap);
            let share =
                detours.map_or(early, |detours| detours.share(half.second, row, 2.0 * half.since, early));
            step.position(row, x) + half.sign * share * gap
        });
        if let Some(detours) = detours {
            detours.place(t, out);
        }
    }

    fn velocities(&self, t: f64, out: &mut [Vec2]) {
        let Some((half, step, x)) = self.place(t) else { return };
        let per_time = half.sign * self.fields.steps() as f32;
        let made_up = MadeUp::at(half.since as f32, self.fields.hold());
        // The slope in forward time is the same from either side.
        self.each(out, |row, gap| per_time * step.curve(row).slope(x) + made_up.slope(gap) * gap);
    }
}

/// Photons that a report looks at, at most.
const WATCHED: usize = 20_000;

/// The report on a flow that meets half way, from at most `guides` of its photons, evenly spaced rows. `fits` has the figures
/// of its fits.
///
/// # Errors
/// As [`HalfTracks::new`].
pub fn meeting_report(
    fields: &MeetingFields,
    (source, targets): (&[Vec2], &[Vec2]),
    (extent, guides): (Vec2, usize),
    fits: &FlowReport,
    progress: &Progress,
) -> Result<FlowReport> {
    let rows = guide_rows(source.len(), guides.min(WATCHED));
    let [source, targets] = [source, targets].map(|all| rows.iter().map(|&row| all[row]).collect::<Vec<_>>());
    let mut photons = MeetingTrajectories::new(fields, &source, &targets);
    photons.prepare(progress)?;
    let mut observer = Observer::new(&source, &targets, extent);
    let steps = fields.steps();
    for n in 0..steps {
        progress.check()?;
        observer.stepped(&photons, n as f64 / steps as f64, 1.0 / steps as f64);
    }
    let crossings = photons.crossings(progress)?;
    let violations = WallViolations { crossings, ..photons.wall_violations() };
    let report = observer.finish(&targets, fields.turbulence(), violations, fits.clone());
    Ok(FlowReport { gap: photons.gap(), detours: photons.detours(), field_share: 1.0, ..report })
}
