//! The summary of a run: `summary.json` and the lines at the end of a command.

use std::fmt::Write as _;

use serde::Serialize;

use super::energy_balance::EnergyBalance;
use super::fitted_segment::FittedFlow;
use super::flow_numbers::{FlowNumbers, note_on_solver, note_on_walls};
use super::grouping::{CausticFlux, notes_on_dark};
use super::meter::{Meter, StageCost};
use super::plan::LeftOut;
use super::prepare::Prepared;
use super::segment_figures::SegmentContinuity;
use crate::Note;
use crate::constraint::Constraint;
use crate::continuity::FIGURES;
use crate::export::RepairedSamples;
use crate::note::About;
use crate::render::ClampedLight;

/// The conservation of flux.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Energy {
    /// Flux in the receiver texture over flux of the photons on it, the frame farthest from 1.
    pub texture_ratio: Option<f64>,
    /// Photons beyond the texture in the frame with most of them.
    pub photons_outside: usize,
}

/// Values that were replaced so that files hold only finite numbers.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BadValues {
    /// Values that were not finite, replaced by 0.
    pub nonfinite_replaced: u64,
    /// Values too large for half floats, clamped.
    pub half_clamped: u64,
    /// The frames that hold them.
    pub frames: Vec<i32>,
}

/// The summary of one run.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// "render" or "fit".
    pub command: &'static str,
    /// The project's name.
    pub project: String,
    /// This program and its version.
    pub software: String,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Photons of one pass.
    pub photons: usize,
    /// Passes that were finished.
    pub passes: usize,
    /// Passes that were planned; more than were finished in a run that was stopped.
    pub passes_planned: usize,
    /// Frames that were written.
    pub frames: usize,
    /// Frames that a run that was told to end had no time to write; their light is kept.
    #[serde(skip_serializing_if = "is_zero")]
    pub frames_left: usize,
    /// Files of frames that were there already, and kept.
    pub kept: usize,
    /// The hash of all that the frames are made from; empty where they do not tell it.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub fingerprint: String,
    /// Whether it is about a part of the frames, or about none, so that it must not replace the summary of all.
    #[serde(skip)]
    pub(super) partial: bool,
    /// Frames per second of the project, as a fraction.
    pub frames_per_second: [u32; 2],
    /// The flow; absent where nothing moves.
    #[serde(flatten)]
    pub flow: Option<FlowNumbers>,
    /// How well the light holds together in each segment in which it moves; empty in a run that was stopped.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub continuity: Vec<SegmentContinuity>,
    /// The light of each named caustic, and of the rest: their photons follow each other in the tracks. Absent where none
    /// is named.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub caustics: Vec<CausticFlux>,
    /// Whether walls were drawn.
    #[serde(skip)]
    pub walled: bool,
    /// Where the light went.
    pub energy: Energy,
    /// Highlights of the background that were clamped; absent where none was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clamped: Option<ClampedLight>,
    /// Replaced values.
    pub bad_values: BadValues,
    /// Seconds and peak memory of each stage.
    pub stages: Vec<StageCost>,
    /// Seconds of all stages.
    pub seconds: f64,
    /// Parts that the project did not need.
    pub left_out: Vec<LeftOut>,
    /// Notes for the artist.
    pub notes: Vec<Note>,
}

impl BadValues {
    /// Over all frames.
    pub(super) fn sum(repairs: &[(i32, RepairedSamples)]) -> Self {
        let bad = |r: &RepairedSamples| r.nonfinite_replaced > 0 || r.half_clamped > 0;
        Self {
            nonfinite_replaced: repairs.iter().map(|(_, r)| r.nonfinite_replaced).sum(),
            half_clamped: repairs.iter().map(|(_, r)| r.half_clamped).sum(),
            frames: repairs.iter().filter(|(_, r)| bad(r)).map(|(frame, _)| *frame).collect(),
        }
    }
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// The results of a run.
pub(super) struct Done<'a> {
    pub(super) command: &'static str,
    pub(super) passes: usize,
    pub(super) flow: &'a FittedFlow,
    pub(super) continuity: Vec<SegmentContinuity>,
    pub(super) balance: EnergyBalance,
    pub(super) bad_values: BadValues,
    pub(super) clamped: ClampedLight,
}

impl Summary {
    pub(super) fn new(prepared: &Prepared, done: Done, meter: &Meter) -> Self {
        let (project, balance) = (&prepared.project, done.balance);
        let flow = done.flow.numbers.clone();
        let flow = flow.map(|mut numbers| {
            numbers.flux_ratio = balance.flux_ratio.unwrap_or(1.0);
            numbers.flow.wall_crossings += balance.crossings;
            numbers.flow.unreachable = numbers.flow.unreachable.max(balance.unreachable);
            numbers
        });
        let stages = meter.costs();
        let mut notes = prepared.notes.clone();
        notes.extend(notes_on_dark(&done.flow.caustics));
        let idle = done.flow.idle_lights.iter();
        notes.extend(idle.map(|(light, text)| About::Light(*light).note(text)));
        notes.extend(flow.iter().filter_map(|numbers| note_on_walls(&numbers.flow)));
        let tolerance = project.flow.tolerance.into();
        notes.extend(flow.iter().filter_map(|numbers| note_on_solver(&numbers.flow, tolerance)));
        Self {
            command: done.command,
            project: project.name.clone(),
            software: concat!("lightloom ", env!("CARGO_PKG_VERSION")).into(),
            seed: project.seed,
            photons: prepared.plan.photons,
            passes: done.passes,
            passes_planned: if done.command == "render" { prepared.plan.passes } else { 0 },
            frames: if done.command == "render" { prepared.plan.frames } else { 0 },
            frames_left: 0,
            kept: 0,
            fingerprint: String::new(),
            partial: false,
            frames_per_second: project.output.fps,
            flow,
            continuity: done.continuity,
            caustics: done.flow.caustics.clone(),
            walled: project.constraints.iter().any(|c| matches!(c, Constraint::Wall(_))),
            energy: Energy { texture_ratio: balance.texture_ratio, photons_outside: balance.outside },
            clamped: Some(done.clamped).filter(|clamped| clamped.pixels > 0),
            bad_values: done.bad_values,
            seconds: stages.iter().map(|cost| cost.seconds).sum(),
            stages,
            left_out: prepared.plan.left_out.clone(),
            notes,
        }
    }

    /// Whether it is about all frames of the run.
    pub fn is_of_all(&self) -> bool {
        !self.partial
    }

    /// Whether it was stopped before all frames had all their passes.
    pub fn is_stopped(&self) -> bool {
        self.passes < self.passes_planned || self.frames_left > 0
    }

    /// Whether a frame holds values that were not finite and had to be replaced.
    pub fn has_bad_frames(&self) -> bool {
        self.bad_values.nonfinite_replaced > 0
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers, strings and lists: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// As a few lines for people.
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "{}: {} frames, {} passes of {} photons, {:.1} s\n",
            self.project, self.frames, self.passes, self.photons, self.seconds
        );
        if self.kept > 0 {
            let _ = writeln!(text, "  kept: {} files that were there", self.kept);
        }
        for cost in &self.stages {
            let memory = cost.peak_memory_mib.map_or(String::new(), |mib| format!("  {mib:7.0} MiB"));
            let _ = writeln!(text, "  {:<12}{:8.2} s{memory}", cost.stage, cost.seconds);
        }
        if let Some(FlowNumbers { flow, .. }) = &self.flow {
            let _ = writeln!(
                text,
                "  endpoint error {:.1e}, peak speed {:.2} (straight lines {:.2}), dispersion {:.4}{}",
                flow.endpoint_error,
                flow.peak_speed_ratio,
                flow.straight_peak_ratio,
                flow.dispersion,
                if flow.fits > 0 {
                    format!(", {:.1} solver iterations", flow.solver_iterations_mean)
                } else {
                    String::new()
                }
            );
        }
        if let Some(FlowNumbers { flow, .. }) = self.flow.as_ref().filter(|_| self.walled) {
            let _ = writeln!(
                text,
                "  walls: {} crossings, {} photons shut off, {:.2} % on detours",
                flow.wall_crossings,
                flow.unreachable,
                100.0 * flow.detours
            );
        }
        if let Some(ClampedLight { pixels, share }) = &self.clamped {
            let _ = writeln!(
                text,
                "  highlights clamped in {pixels} pixels of the background: {:.2} % of its light",
                100.0 * share
            );
        }
        for (name, figures) in self.continuity.iter().flat_map(SegmentContinuity::named_figures) {
            let named = FIGURES.iter().filter_map(|f| Some(format!("{} {}", f.name, f.text(figures)?)));
            let _ = writeln!(text, "  {name}: {}", named.collect::<Vec<_>>().join(", "));
        }
        let BadValues { nonfinite_replaced, half_clamped, frames } = &self.bad_values;
        if !frames.is_empty() {
            let _ = writeln!(
                text,
                "  replaced: {nonfinite_replaced} values that were not finite, {half_clamped} too large for half floats, in frames {frames:?}"
            );
        }
        for left in &self.left_out {
            let _ = writeln!(text, "  left out: {} ({})", left.what, left.why);
        }
        for note in &self.notes {
            let _ = writeln!(text, "  note: {note}");
        }
        text
    }
}
