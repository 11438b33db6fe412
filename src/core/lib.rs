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
//! | Directed lines and wall lines | [`constraint`]; `flow/fit/lines.rs`, `flow/walls` |
//! | Eq. (1), the field | `flow/field.rs` |
//! | Eq. (2), guidance | `flow/guidance.rs` |
//! | Eqs. (3) to (7), the fit | [`flow::fit`], written out there |
//! | advection (RK4), fade, flux blending | `flow/step.rs`, `flow/fade.rs`, `flow/flux.rs` |
//! | synthetic turbulence | `flow/turbulence` |
//! | Sec. 4, progressive rendering | [`render`], [`engine`] |
//! | Fig. 1, the method before (Günther et al. 2016) | `matching/stylized`, `flow/path_trajectories.rs`, `engine/compare.rs` |
//!
//! # What is absent
//!
//! [`flow`] has never heard of a scene; [`scene`] has never heard of a flow; nothing here has heard of a window or of
//! command-line arguments. No stage but [`project`] looks at JSON. Modules use only those above them in the list below
//! (`tests/tidy` watches it).
//!
//! # Examples
//!
//! Two point sets are matched: each source point gets a target of its own, at little total squared distance.
//!
//! ```
//! use lightloom_core::Progress;
//! use lightloom_core::glam::{Vec2, vec2};
//! use lightloom_core::matching::{Matching, transport_map};
//!
//! let progress = Progress::new();
//! let source: Vec<Vec2> = (0..1000).map(|i| vec2(0.2 + 0.1 * (i % 10) as f32, 0.001 * i as f32)).collect();
//! let target: Vec<Vec2> = source.iter().rev().map(|p| vec2(p.x.powi(2), p.y)).collect();
//!
//! let map = transport_map(&source, &target, vec2(1.2, 1.0), &progress)?;
//! let matching = Matching::new(&source, &target, &map, 1, 0, &progress)?;
//! let matched: Vec<Vec2> = matching.apply(&target);
//! assert!(matching.is_bijection());
//! assert!(matching.cost(&source, &target) < 0.2 * Matching::given(1000, 1000)?.cost(&source, &target));
//! # assert!(source.iter().zip(&matched).all(|(a, b)| a.distance(*b) < 0.5));
//! # Ok::<(), lightloom_core::Error>(())
//! ```
//!
//! A flow is fitted between two point sets that are paired row by row, and carries photons. At the end each photon is at
//! its target.
//!
//! ```
//! use lightloom_core::Progress;
//! use lightloom_core::flow::{FieldTrajectories, FlowSettings, GridSize, Segment, Trajectories as _, fit_segment};
//! use lightloom_core::glam::{Vec2, vec2};
//!
//! let progress = Progress::new();
//! let circle = |i: u32| Vec2::from_angle(i as f32 * 0.01) * (0.1 + 0.0001 * i as f32);
//! let source: Vec<Vec2> = (0..1000).map(|i| vec2(0.3, 0.3) + circle(i)).collect();
//! let target: Vec<Vec2> = (0..1000).map(|i| vec2(0.6, 0.7) + 0.5 * circle(i)).collect();
//!
//! let settings = FlowSettings { grid: GridSize::Longer(16), steps: 10, ..FlowSettings::default() };
//! let (fields, report) = fit_segment(&Segment::new(&source, &target, Vec2::ONE, &settings), &progress)?;
//! let mut trajectories = FieldTrajectories::new(&fields, &source, &target);
//! let mut positions = vec![Vec2::ZERO; 1000];
//! trajectories.positions_at(0.5, &mut positions, &progress)?;
//! assert!(positions.iter().all(|p| p.distance(vec2(0.45, 0.5)) < 0.3));
//! trajectories.positions_at(1.0, &mut positions, &progress)?;
//! assert_eq!(positions, target);
//! # assert_eq!(report.endpoint_error, 0.0);
//! # Ok::<(), lightloom_core::Error>(())
//! ```
//!
//! A project is rendered: light through a goblet, one frame.
//!
//! ```
//! use std::path::Path;
//!
//! use lightloom_core::Progress;
//! use lightloom_core::engine::Engine;
//! use lightloom_core::project::{AssetFolder, Project};
//!
//! let text = r#"{
//!   "lightloom": 1,
//!   "scene": {
//!     "meshes": [{ "name": "goblet", "file": "../assets/meshes/goblet.obj" }],
//!     "lights": [{ "type": "spot", "name": "key", "position": [-0.8, 0.6, -0.7], "target": [0, 0.1, 0], "angle_deg": 8 }]
//!   },
//!   "keys": [{ "frame": 1, "shows": "physical_caustic" }],
//!   "render": { "width": 64, "height": 36, "photons": 2000, "passes": 1 },
//!   "output": { "name": "goblet.####", "formats": ["png"] }
//! }"#;
//! // Files are found from the project's place, which need not be written there.
//! let place = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../projects/goblet.json"));
//! let project = Project::parse(text.as_bytes(), place)?;
//! let out = tempfile::tempdir().unwrap();
//! let engine = Engine::new(AssetFolder::new(place, false)?);
//! let summary = engine.render(&project, out.path(), &Progress::new(), &|file| println!("{}", file.display()))?;
//! assert!(out.path().join("goblet.0001.png").exists());
//! # assert_eq!(summary.photons, 2000);
//! # Ok::<(), lightloom_core::Error>(())
//! ```

pub mod error;
pub mod progress;
pub mod setting;

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
/// The vectors of this crate's interface.
pub use glam;
pub use progress::Progress;
