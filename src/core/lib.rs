//! Lightloom's core: from a glass and a picture to a rendered caustic animation.
//!
//! # Layout
//!
//! ```text
//! Project ──check──► plan ──► Scene ──► Photons ──► Matching ──► fit_segment ──► Fields ──► passes ──► frames
//! project            pipeline scene     photon      targets      flow            flow       render     export
//!                                                   matching
//! ```
//!
//! | of the paper (Baeza et al. 2020) | stands in |
//! |---|---|
//! | Sec. 2, photon tracing | [`scene`], [`photon`] |
//! | Sec. 3, target points and matching | [`targets`], [`matching`] |
//! | Directed lines and wall lines | [`constraint`]; `flow/lines.rs`, `flow/walker.rs` |
//! | Eq. (1), the field | `flow/field.rs` |
//! | Eq. (2), guidance | `flow/guidance.rs` |
//! | Eqs. (3) to (7), the fit | `flow/fit.rs`, `flow/bending.rs`, `flow/local.rs` |
//! | advection, fade, flux blending | `flow/advect.rs`, `flow/fade.rs`, `flow/flux.rs` |
//! | synthetic turbulence | `flow/turbulence` |
//! | Sec. 4, progressive rendering | [`render`], [`engine`] |
//! | Fig. 1, the method before (Günther et al. 2016) | `matching/stylized`, `flow/path.rs`, `pipeline/compare.rs` |
//!
//! # What is absent
//!
//! [`flow`] has never heard of a scene; [`scene`] has never heard of a flow; nothing here has heard of a window or of
//! command-line arguments. No stage but [`project`] looks at JSON. Modules use only those above them in the list below
//! (`tests/tidy` watches it).

pub mod error;
pub mod progress;

pub mod files;

pub mod math;

pub mod scene;

pub mod photon;

pub mod targets;

pub mod constraint;

pub mod matching;

pub mod flow;

pub mod render;

pub mod export;

pub mod project;

pub mod engine;

pub use error::{Error, Result};
pub use progress::Progress;
