//! The engine: Project -> scene -> photons -> matching -> flow -> passes -> frames.
//!
//! ```text
//! meshes ─► geometry ─► scene ─► emission guide ─► photons (pass, n) ─┐
//! pictures, points ─► key sources ────────────────────────────────────┴► matching (segment) ─► fit (segment) ─┐
//! visible, background ◄─ scene, camera                                                                        │
//!         └──────────► frame ◄─ exposure (pass) ◄─ positions (segment, n, times) ◄────────────────────────────┘
//! ```
//!
//! Each stage remembers its results with the input they were made from (`memo`): a new gamma fits anew but neither traces
//! nor matches; a key frame that is moved in time leaves the fields as they are; a light that is moved leaves the meshes
//! as they are. Exposures alone are not remembered. Commands, exports, the live preview, comparisons and reports ask the
//! same stages; an [`Engine`] that is shared by several users shares its results among them.

mod active_constraints;
mod bake;
mod camera;
mod check;
mod checkpoint;
mod compare;
mod contact_sheet;
mod continuity;
mod disk_queue;
mod energy_balance;
mod existing;
mod film_writer;
mod fingerprint;
mod fitted_project;
mod fitted_segment;
mod flow;
mod flow_bake;
mod flow_numbers;
mod frame_light;
mod frame_sequence;
mod frame_times;
mod frame_writer;
mod grouping;
mod job;
mod kept_picture;
mod key_photons;
mod key_sources;
mod layer;
mod meeting;
mod memo;
mod memo_keys;
mod meter;
mod moving_segment;
mod numeric_place;
mod observer;
mod output;
mod output_folder;
mod pairing;
mod passes;
mod photon_files;
mod placing;
mod plan;
mod prepare;
mod preview;
mod quality;
mod ray_benchmark;
mod render;
mod run_files;
mod scene_notes;
mod segment_figures;
mod segment_photons;
mod stages;
mod still_light;
mod summary;
mod track_files;
mod trajectories;
mod verify;
mod walk;

use std::sync::Arc;

pub use check::{CastCaustic, CheckReport};
pub use compare::{Compared, Comparison};
pub use existing::Existing;
pub use fitted_project::{FittedProject, PlaneLight, PlanePasses};
pub use flow_numbers::FlowNumbers;
pub use frame_sequence::write_sheet;
pub use grouping::CausticFlux;
pub use memo::Client;
pub use meter::StageCost;
pub use moving_segment::{Halfway, MovingSegment};
pub use observer::RenderObserver;
pub use output::Output;
pub use output_folder::{prepare_film, prepare_folder, write_report};
pub use plan::{LeftOut, Plan};
pub use preview::{FieldAt, OrbitView, Preview, PreviewExposure, Shot, covered_area};
pub use quality::Quality;
pub use ray_benchmark::Traced;
pub use segment_figures::{LayerContinuity, SegmentContinuity};
pub use summary::{BadValues, Energy, Summary};
pub use verify::{Verification, verify};

use crate::project::{AssetFolder, Project};
use crate::{Progress, Result};
use job::Job;
use meter::Meter;
use prepare::Prepared;
use stages::Stages;

/// Bytes that the positions of a preview may take unless another number is set: 150 000 photons in 133 frames.
const PREVIEW_BYTES: usize = 160_000_000;

/// The stages of projects in one folder, with what they remember. Clones share it.
#[derive(Clone)]
pub struct Engine {
    stages: Arc<Stages>,
    client: Client,
    /// Bytes that the positions of a preview may take.
    preview_bytes: usize,
}

impl Engine {
    /// An engine that remembers nothing and finds files through `assets`.
    pub fn new(assets: AssetFolder) -> Self {
        Self { stages: Arc::new(Stages::new(assets)), client: Client::Main, preview_bytes: PREVIEW_BYTES }
    }

    /// An engine that finds the same files and remembers nothing.
    pub fn afresh(&self) -> Self {
        Self::new(self.stages.assets.clone())
    }

    /// The same engine on behalf of another user: results are shared, and each user keeps those it needs.
    pub fn on_behalf_of(&self, client: Client) -> Self {
        Self { client, ..self.clone() }
    }

    /// The same engine whose previews take at most so many bytes for the positions of their photons, by fewer photons.
    pub fn with_preview_memory(self, bytes: usize) -> Self {
        Self { preview_bytes: bytes, ..self }
    }

    fn prepare(&self, project: &Project, meter: &Meter, progress: &Progress) -> Result<Prepared> {
        meter.measure("load", || self.stages.prepare(self.client, project, progress))
    }

    fn job<'a>(
        &'a self,
        prepared: &'a Prepared,
        meter: &'a Meter,
        progress: &'a Progress,
    ) -> Result<Job<'a>> {
        let job = Job::new(&self.stages, self.client, prepared, meter, progress);
        // Notes are often the reason: a material that was taken for another, a size in other units.
        job.map_err(|error| error.with_notes(&prepared.notes))
    }
}

#[cfg(test)]
mod tests;
