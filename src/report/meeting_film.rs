//! Light that meets half way, planned, fitted, paired, and followed from key to key.

use glam::Vec2;

use lightloom_core::bridge::BridgeSettings;
use lightloom_core::continuity::chosen_rows;
use lightloom_core::flow::meeting::{
    BridgeReport, HalfTracks, MeetingFields, MeetingFit, MeetingSegment, MeetingTrajectories,
    fit_meeting_with, meeting_report,
};
use lightloom_core::flow::{FlowReport, Trajectories as _};
use lightloom_core::matching::{ContinuousMap, transport_map};
use lightloom_core::{Error, Progress, Result};

/// The photons of one segment on their way.
pub(crate) struct MeetingFilm {
    pub(crate) plan: BridgeReport,
    fields: MeetingFields,
    fits: FlowReport,
    extent: Vec2,
    source: Vec<Vec2>,
    /// In the rows of the source.
    targets: Vec<Vec2>,
    tracks: [HalfTracks; 2],
}

impl MeetingFilm {
    /// The light of the first group of a segment, as much of it as figures of continuity look at. `refine` sets cells and
    /// sweeps of the plan.
    ///
    /// # Errors
    /// A fit that fails; photons that cannot be paired; cancelled.
    pub(crate) fn new(
        segment: &MeetingSegment,
        refine: impl FnOnce(BridgeSettings) -> BridgeSettings + Send,
        progress: &Progress,
    ) -> Result<Self> {
        let MeetingFit { fields, fits, plan } = fit_meeting_with(segment, refine, progress)?;
        let [source, targets] = segment.groups.first().ok_or(Error::value("flow", "there are no photons"))?;
        let rows = chosen_rows(source.len().min(targets.len()));
        let [source, targets] = [source, targets].map(|all| rows.iter().map(|&row| all[row]).collect());
        let tracks = |half, at: &Vec<Vec2>| HalfTracks::new(&fields, half, at, progress);
        let [forward, backward] = [tracks(0, &source)?, tracks(1, &targets)?];
        let map = transport_map(forward.end(), backward.end(), segment.extent, progress)?;
        let map = match fields.walls_at_meeting() {
            Some(graph) => ContinuousMap::Beside(map, graph),
            None => ContinuousMap::Transport(map),
        };
        let order = map.pair(forward.end(), backward.end(), 1, 0, progress)?.matching.target_of;
        let targets = order.iter().map(|&row| targets[row as usize]).collect();
        let tracks = [forward, backward.permuted(&order)];
        Ok(Self { plan, fields, fits, extent: segment.extent, source, targets, tracks })
    }

    /// Places at the begin of each move and at the end: no move is longer than that which walls are asked about.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(crate) fn frames(&self, progress: &Progress) -> Result<Vec<Vec<Vec2>>> {
        let Self { fields, source, targets, tracks: [forward, backward], .. } = self;
        let mut photons = MeetingTrajectories::with_tracks(fields, (source, targets), [forward, backward]);
        let moves = fields.moves();
        let frame = |n: usize| {
            let mut out = vec![Vec2::ZERO; source.len()];
            photons.positions_at(n as f64 / moves as f64, &mut out, progress)?;
            Ok(out)
        };
        (0..=moves).map(frame).collect()
    }

    /// The figures of the motion.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn report(&self, progress: &Progress) -> Result<FlowReport> {
        let Self { fields, fits, extent, source, targets, .. } = self;
        meeting_report(fields, (source, targets), (*extent, source.len()), fits, progress)
    }

    /// Where the photons must be at the end.
    pub(crate) fn targets(&self) -> &[Vec2] {
        &self.targets
    }
}
