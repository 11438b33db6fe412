//! A preview: photons at every frame, and the fields that moved them.

use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::field::FieldAt;
use crate::engine::Quality;
use crate::engine::energy_balance::{between, total};
use crate::engine::fitted_segment::FittedSegment;
use crate::engine::flow_numbers::FlowNumbers;
use crate::engine::grouping::CausticFlux;
use crate::engine::key_photons::{KeyPhotons, all_flux, all_positions};
use crate::engine::meter::StageCost;
use crate::engine::plan::LeftOut;
use crate::flow::{SegmentFlow, flux};
use crate::project::SegmentTime;
use crate::{Note, Progress, Result};

/// Photons at the frames of a project, from the first key to the last, and the fields that moved them. It never changes: while work
/// goes on, new ones with more frames are handed out, which share what they have in common.
///
/// Rows are photons: row i is the same photon at every frame. The photons of each named caustic follow each other, and
/// the rest comes last.
#[derive(Clone)]
pub struct Preview {
    pub(super) keys: Arc<Keys>,
    /// By frame; absent until worked out.
    pub(super) frames: Vec<Option<Arc<[Vec2]>>>,
    /// By segment; absent until fitted.
    pub(super) segments: Vec<Option<Arc<FittedSegment>>>,
    /// By segment; absent until fitted.
    pub(super) ends: Vec<Option<Ends>>,
    pub(super) numbers: Option<FlowNumbers>,
    pub(super) stages: Vec<StageCost>,
    pub(super) notes: Vec<Note>,
}

/// The key frames of a preview, known before anything flows.
pub(super) struct Keys {
    pub(super) quality: Quality,
    pub(super) extent: Vec2,
    /// Number of the first frame.
    pub(super) first: i32,
    /// Numbers of the key frames.
    pub(super) frames: Vec<i32>,
    /// By frame.
    pub(super) moments: Vec<SegmentTime>,
    pub(super) lights: Vec<KeyLight>,
    pub(super) groups: Vec<(Option<String>, Range<usize>)>,
    pub(super) caustics: Vec<CausticFlux>,
    pub(super) left_out: Vec<LeftOut>,
    pub(super) mesh_files: Arc<[PathBuf]>,
    /// Area that the photons cover, plane units squared, as a mean over the keys.
    pub(super) covered: f32,
    /// Brightness requested at later keys than the first.
    pub(super) rho: f64,
}

/// The photons at both keys of a segment, by group.
pub(super) type Ends = [Arc<Vec<KeyPhotons>>; 2];

/// The light of all photons at a key frame.
pub(super) struct KeyLight {
    pub(super) positions: Arc<[Vec2]>,
    flux: Vec<Vec3>,
    /// Flux of all photons, and what they should have without rho, watts.
    watts: f64,
    requested: f64,
}

impl KeyLight {
    /// The photons `at` a key, group by group; `requested` is the flux that they should have but for rho, watts.
    pub(super) fn new(at: &[KeyPhotons], requested: f64) -> Self {
        let positions = all_positions(at).collect();
        let flux: Vec<Vec3> = all_flux(at).collect();
        let watts = total(&flux);
        Self { positions, flux, watts, requested }
    }
}

impl Preview {
    /// The quality.
    pub fn quality(&self) -> Quality {
        self.keys.quality
    }

    /// Size of the plane; its longer side is 1.
    pub fn extent(&self) -> Vec2 {
        self.keys.extent
    }

    /// The frames, from the first key to the last.
    pub fn frames(&self) -> RangeInclusive<i32> {
        let first = self.keys.first;
        first..=first + self.frames.len() as i32 - 1
    }

    /// Photons at every frame.
    pub fn photons(&self) -> usize {
        self.keys.lights.first().map_or(0, |light| light.positions.len())
    }

    /// The named caustics in their order, then the rest, without a name: their rows.
    pub fn groups(&self) -> &[(Option<String>, Range<usize>)] {
        &self.keys.groups
    }

    /// Whether the photons of a frame are known; frames outside show the nearest key frame.
    pub fn is_ready(&self, frame: i32) -> bool {
        self.frames[self.slot(frame)].is_some()
    }

    /// Positions of all photons at a frame, plane units; none before they are known. Frames outside show the nearest key frame.
    pub fn positions(&self, frame: i32) -> Option<&[Vec2]> {
        self.frames[self.slot(frame)].as_deref()
    }

    /// Whether another preview has the same light at a frame, known or not, because both are of the same work.
    pub fn has_light_of(&self, other: &Self, frame: i32) -> bool {
        let [a, b] = [self, other].map(|preview| &preview.frames[preview.slot(frame)]);
        let same_photons = match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        same_photons && Arc::ptr_eq(&self.keys, &other.keys)
    }

    /// The files that the meshes of the scene were read from, with those that these name.
    pub fn mesh_files(&self) -> &[PathBuf] {
        &self.keys.mesh_files
    }

    /// RGB flux of all photons at a frame, watts, into `out`, which grows or shrinks to fit.
    pub fn flux(&self, frame: i32, out: &mut Vec<Vec3>) {
        out.resize(self.photons(), Vec3::ZERO);
        let ([from, to], time) = self.lights(frame);
        flux::blend(&from.flux, &to.flux, time as f32, out);
    }

    /// Flux of all photons at a frame over that of the source, times rho, colour and brightness as they are requested:
    /// 1 but for rounding. None where no light is requested.
    pub fn energy(&self, frame: i32) -> Option<f64> {
        let ([from, to], time) = self.lights(frame);
        let key = self.moment(frame).segment;
        let rho = |key: usize| if key == 0 { 1.0 } else { self.keys.rho };
        let last = self.keys.lights.len() - 1;
        let requested = between([from.requested * rho(key), to.requested * rho((key + 1).min(last))], time);
        (requested > 0.0).then(|| between([from.watts, to.watts], time) / requested)
    }

    /// The fields that act at a frame: the one that caustics share, and those of caustics that flow by themselves. None
    /// before they are fitted, where the method has none, and from the end of the fade on, where photons go straight.
    pub fn fields(&self, frame: i32) -> Vec<FieldAt> {
        let moment = self.moment(frame);
        let layers = self.segments.get(moment.segment).into_iter().flatten().flat_map(|s| &s.layers);
        let field = |groups: &[usize], flow: &SegmentFlow| {
            let rows = groups.iter().map(|&group| self.keys.groups[group].1.clone()).collect();
            FieldAt::new(flow.at(moment.time), rows)
        };
        layers.filter_map(|layer| field(&layer.groups, &layer.flow)).collect()
    }

    /// The residual of the fit at a frame: for each photon, guidance minus the velocity of its field (where key frames meet half way,
    /// its own velocity minus that), plane units per segment; zero for those that no field moves there. None before the frame is known.
    ///
    /// # Errors
    /// `Cancelled`; around walls ways must be found anew.
    pub fn residuals(&self, frame: i32, progress: &Progress) -> Result<Option<Vec<Vec2>>> {
        let SegmentTime { segment, time } = self.moment(frame);
        let Some(positions) = self.positions(frame) else { return Ok(None) };
        let mut residuals = vec![Vec2::ZERO; positions.len()];
        let targets = self.targets(frame);
        for layer in self.segments.get(segment).into_iter().flatten().flat_map(|s| &s.layers) {
            let acting = layer.flow.at(time);
            for rows in layer.groups.iter().map(|&group| self.keys.groups[group].1.clone()) {
                if acting.is_empty() {
                    continue;
                }
                let at = &positions[rows.clone()];
                let guidance = match layer.flow.fields() {
                    Some(fields) => fields.guidance(time, at, &targets[rows.clone()], progress)?,
                    None => self.velocities(frame, rows.clone()),
                };
                for ((out, v), &p) in residuals[rows].iter_mut().zip(guidance).zip(at) {
                    *out = v - acting.iter().map(|field| field.velocity(p)).sum::<Vec2>();
                }
            }
        }
        Ok(Some(residuals))
    }

    /// The velocities of some photons at a frame, plane units per segment: differences between the neighbouring frames of the
    /// segment that are known.
    fn velocities(&self, frame: i32, rows: Range<usize>) -> Vec<Vec2> {
        let here = self.moment(frame);
        let beside = |other: i32| {
            let moment = self.moment(other);
            let positions = self.positions(other).filter(|_| moment.segment == here.segment);
            positions.map(|positions| (moment.time, &positions[rows.clone()]))
        };
        let [(before, from), (after, to)] = match [beside(frame - 1), beside(frame), beside(frame + 1)] {
            [Some(a), _, Some(b)] | [Some(a), Some(b), None] | [None, Some(a), Some(b)] => [a, b],
            _ => return vec![Vec2::ZERO; rows.len()],
        };
        let per_time = 1.0 / ((after - before) as f32).max(f32::MIN_POSITIVE);
        from.iter().zip(to).map(|(a, b)| (*b - *a) * per_time).collect()
    }

    /// The targets of the photons at a frame: their positions at the next key frame, row by row.
    pub fn targets(&self, frame: i32) -> &[Vec2] {
        &self.lights(frame).0[1].positions
    }

    /// The trajectory of the photon in row `row` over the known frames, with their numbers; empty beyond the last row.
    pub fn track(&self, row: usize) -> Vec<(i32, Vec2)> {
        let at =
            |(frame, positions): (i32, &Option<Arc<[Vec2]>>)| Some((frame, *positions.as_ref()?.get(row)?));
        self.frames().zip(&self.frames).filter_map(at).collect()
    }

    /// The rows of the `count` photons nearest to `point` at a frame, the nearest first.
    pub fn nearest(&self, frame: i32, point: Vec2, count: usize) -> Vec<usize> {
        let positions = self.positions(frame).unwrap_or_default();
        let mut rows: Vec<usize> = (0..positions.len()).collect();
        let by_distance = |a: &usize, b: &usize| {
            let distance = |row: usize| positions[row].distance_squared(point);
            distance(*a).total_cmp(&distance(*b)).then(a.cmp(b))
        };
        if count < rows.len() {
            rows.select_nth_unstable_by(count, by_distance);
            rows.truncate(count);
        }
        rows.sort_unstable_by(by_distance);
        rows
    }

    /// The unsteadiness of the motion at a frame: the change of the photons' step from this frame to the next, over the step
    /// itself, both root mean square. 0 for even motion, 2 where every step turns back. None at the first and the last
    /// frame, where nothing moves, and before the neighbours are known.
    pub fn unsteadiness(&self, frame: i32) -> Option<f64> {
        let frames = self.frames();
        if frame <= *frames.start() || frame >= *frames.end() {
            return None;
        }
        let [before, now, after] = [frame - 1, frame, frame + 1].map(|frame| self.positions(frame));
        let (mut change, mut step) = (0.0, 0.0);
        for ((&a, &b), &c) in before?.iter().zip(now?).zip(after?) {
            change += f64::from((c - b - (b - a)).length_squared());
            step += f64::from((c - b).length_squared() + (b - a).length_squared()) / 2.0;
        }
        (step > 0.0).then(|| (change / step).sqrt())
    }

    /// The numbers of the flow, the worst over all segments; none before all frames are known, and where nothing moves.
    pub fn numbers(&self) -> Option<&FlowNumbers> {
        self.numbers.as_ref()
    }

    /// The light of each named caustic, and of the rest; empty where none is named.
    pub fn caustics(&self) -> &[CausticFlux] {
        &self.keys.caustics
    }

    /// Parts that the project does not need.
    pub fn left_out(&self) -> &[LeftOut] {
        &self.keys.left_out
    }

    /// Notes for the artist.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// The cost of the stages that ran for it; remembered results do not appear.
    pub fn stages(&self) -> &[StageCost] {
        &self.stages
    }

    /// Flux of all photons over that of the source, times the colour and brightness requested, at the key where it is
    /// farthest from 1; between two keys it is between theirs.
    pub(super) fn flux_ratio(&self) -> f64 {
        let ratios =
            self.keys.lights.iter().filter(|s| s.requested > 0.0).map(|light| light.watts / light.requested);
        ratios.reduce(|a, b| if (b - 1.0).abs() > (a - 1.0).abs() { b } else { a }).unwrap_or(1.0)
    }

    pub(super) fn slot(&self, frame: i32) -> usize {
        let last = self.frames.len() as i64 - 1;
        (i64::from(frame) - i64::from(self.keys.first)).clamp(0, last) as usize
    }

    pub(super) fn moment(&self, frame: i32) -> SegmentTime {
        self.keys.moments[self.slot(frame)]
    }

    /// The keys around a frame, and the time between them. With one key, that one twice.
    fn lights(&self, frame: i32) -> ([&KeyLight; 2], f64) {
        let SegmentTime { segment, time } = self.moment(frame);
        let lights = &self.keys.lights;
        ([&lights[segment], &lights[(segment + 1).min(lights.len() - 1)]], time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn previews_go_from_thread_to_thread() {
        fn shared<T: Send + Sync>() {}
        shared::<Preview>();
    }
}
