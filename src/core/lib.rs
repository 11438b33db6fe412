//! Lightloom's core: from a glass and a picture to a rendered caustic animation.
//!
//! # Layout
//!
//! ```text
//! Project ──► Scene ──► Photons ──► plan ────► fit ──► meeting ──► Trajectories ──► textures ──► frames
//! project     scene     photon      targets    flow    matching    flow             render       export
//!                                   bridge
//! ```
//!
//! [`import`] makes a project of a scene of another program.
//!
//! [`engine`] runs these stages and remembers their results; the command line, the editor and the report (the package
//! `lightloom_report`) ask it.
//!
//! By default the light of both key frames is planned as one body ([`bridge`]), fields are fitted to the plan, and photons are
//! paired where both meet half way ([`flow::meeting`]). The method of the paper pairs first (`"method": "guided"`).
//!
//! | of the paper (Baeza et al. 2020) | module |
//! |---|---|
//! | Sec. 2, photon tracing | [`scene`], [`photon`] |
//! | Sec. 3, target points and matching | [`targets`], [`matching`] |
//! | Directed lines and wall lines | [`constraint`], [`flow::fit`]; `flow::walls` |
//! | Eq. (1), the field | [`flow::field`] |
//! | Eq. (2), guidance | [`flow::guidance`] |
//! | Eqs. (3) to (7), the fit | [`flow::fit`], written out there |
//! | Advection (RK4), fade, flux blending | `flow::step`, [`flow::fade`], [`flow::flux`] |
//! | Synthetic turbulence | [`flow::turbulence`] |
//! | Sec. 4, progressive rendering | [`render`], [`engine`] |
//! | How well light holds together on the way (not in the paper) | [`continuity`] |
//! | Fig. 1, the previous method (Günther et al. 2016) | `matching::stylized`, `flow::path_trajectories`, `engine::compare` |
//!
//! [`setting`] describes every value of a project once: range, default, unit, help. Modules use only those above them in
//! the list below (`tests/tidy` checks it): [`scene`] is independent of the flow, [`flow`] of the scene. Only [`project`]
//! reads JSON. The core is independent of windows and command-line arguments.
//!
//! # Glossary
//!
//! | term | meaning |
//! |---|---|
//! | flux | Power of light, RGB in watts; every photon carries a share ([`photon::Photons::flux`]). |
//! | irradiance | Flux per area, W/m²; the brightness of a caustic. |
//! | caustic | Light focused on the receiver by glass or mirrors; named ones move separately ([`project::CausticDesc`]). |
//! | photon | A point of flux on the plane, traced from a light or sampled from a picture ([`photon::Photons`]). |
//! | pass | One batch of photons with the whole flux; a frame is the mean of its passes ([`render::ProgressiveRender`]). |
//! | receiver | The rectangle on which caustics fall and are animated ([`scene::Receiver`]). |
//! | plane units | Coordinates on the receiver: its longer side is 1, the origin a corner. |
//! | extent | Width and height of the plane in plane units ([`project::Project::extent`]). |
//! | key frame | A frame at which the project says what the light shows ([`project::KeyFrame`]). |
//! | segment | The time between two key frames, from 0 to 1 ([`flow::Segment`], [`project::SegmentTime`]). |
//! | stage | A named step of the engine's work: trace, match, fit, render and so on ([`Progress`]). |
//! | emission guide | The learned importance sampling of emission towards the receiver ([`photon::EmissionGuide`]). |
//! | target points | The positions of the photons at a key frame, sampled from a picture or read from a file ([`targets`]). |
//! | pairing | The choice of a target point for each photon of a segment, by any method ([`project::Project::matching`]). |
//! | map | A continuous map from the source to the target density, made once per segment ([`matching::ContinuousMap`]). |
//! | matching | The bijection between source and target points of one pass, near the map ([`matching::Matching`]). |
//! | guidance | The velocity straight to the target in the time left, Eq. (2) ([`flow::guidance`]); of the method of the paper. |
//! | stream function | psi; its co-gradient is the divergence-free part of the field ([`flow::field`]). |
//! | scalar potential | phi; its gradient is the irrotational part of the field ([`flow::field`]). |
//! | gamma | Blend of the parts: 0 divergence-free, 1 irrotational ([`flow::FlowSettings::gamma`]). |
//! | alpha | Smoothness of the field ([`flow::FlowSettings::alpha`]). |
//! | beta | Strength of directed lines in the fit ([`flow::FlowSettings::beta`]). |
//! | plan | The motion of the whole body of light between two key frames: a Schroedinger bridge ([`bridge`]). |
//! | meeting | The time t = 1/2, at which the light of both key frames is paired ([`flow::meeting`]). |
//! | gap | The distance between the two ends of a photon at the meeting ([`flow::FlowReport::gap`]). |
//! | guides | The photons to which the field is fitted ([`flow::FlowSettings::guides`]). |
//! | fade | The transition of the photons from the field to their targets ([`flow::Fade`]). |
//! | trajectory | The path of one photon through a segment ([`flow::Trajectories`]). |
//! | crack | A dark seam that opens between parts of a body of light on its way ([`continuity`]). |
//! | torn | Of a photon: away from the neighbours that it has in a key ([`continuity::Neighbourhoods`]). |
//! | bunch | Light piled up in one place on its way ([`continuity::Continuity::bunch`]). |
//! | turbulence | Divergence-free noise added to the field ([`flow::Turbulence`]). |
//! | directed line | A drawn line along which the field flows ([`constraint::DirectedLine`]). |
//! | wall | A drawn line that no photon crosses ([`constraint::Wall`]). |
//! | visibility graph | The graph of wall corners in sight of each other, for shortest paths ([`constraint::VisibilityGraph`]). |
//! | kernel radius | Reach of the smoothing kernel, plane units; shrinks from pass to pass ([`render::density`]). |
//! | texture | Flux per texel of the receiver ([`render::ReceiverTexture`]). |
//! | gather matrix | The sparse matrix from texels to pixels of the camera ([`render::GatherMatrix`]). |
//! | background | The picture without caustics, path traced once ([`mod@render::background`]). |
//! | preview | The frames of a project at reduced quality, growing while computed ([`engine::Preview`]). |
//! | quality | The limits on photons, cells and steps, from draft to final ([`engine::Quality`]). |
//! | fingerprint | The hash of all that the pixels of a render depend on; frames carry it (`engine::fingerprint`). |
//! | bake | The results of the stages before the first pass, in files ([`engine::Engine::bake`]). |
//! | checkpoint | The folder that keeps the unfinished light of a render (`engine::checkpoint`). |
//! | shot | Background and gather matrix of a preview, for pictures of any texture ([`engine::Shot`]). |
//! | memo | The remembered results of a stage, found by their input (`engine::memo`). |
//! | slot | The place that keeps one result of a memo, by client, quality and segment (`engine::memo`). |
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

pub mod note;

pub mod error;
pub mod progress;
pub mod setting;

pub mod files;

pub mod math;

pub mod continuity;

pub mod scene;

pub mod photon;

pub mod targets;

pub mod constraint;

pub mod matching;

pub mod bridge;

pub mod flow;

pub mod render;

pub mod export;

pub mod project;

pub mod import;

pub mod engine;

pub use error::{Error, Result};
/// The vectors of this crate's interface.
pub use glam;
pub use note::Note;
pub use progress::Progress;
