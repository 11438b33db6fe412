//! The session: unsaved state of the window, such as tool, selection, playhead and views.

use std::collections::BTreeSet;

use glam::Vec2;
use lightloom_core::flow::MotionMethod;
use lightloom_core::scene::CameraDesc;

use super::look::object::SceneObject;
use super::look::transforming::Transforming;
use super::selection::Selection;

/// Smallest and largest zoom of the plane view and the shot view.
pub const ZOOM_RANGE: std::ops::RangeInclusive<f32> = 0.05..=200.0;

/// The unsaved state of the window.
#[derive(Clone, Debug)]
pub struct Session {
    /// Index of the active tool.
    pub tool: usize,
    /// The selected constraints.
    pub selection: Selection,
    /// The current frame.
    pub playhead: i32,
    /// Whether the animation plays.
    pub playing: bool,
    /// Whether it loops.
    pub looping: bool,
    /// Playback speed over the project's frame rate.
    pub speed: f64,
    /// First and last played frame; none for the ends of the animation.
    pub marks: [Option<i32>; 2],
    /// The visible views.
    pub layout: ViewLayout,
    /// Pan and zoom of the plane view.
    pub plane: PlaneViewport,
    /// Pan and zoom of the shot view.
    pub shot: ShotViewport,
    /// Free camera of the orbit view; none until it was moved.
    pub free_camera: Option<CameraDesc>,
    /// Whether the orbit view looks through the project's camera, and flies it.
    pub through_camera: bool,
    /// The transform in progress.
    pub transforming: Option<Transforming>,
    /// The visible overlays.
    pub overlays: Overlays,
    /// Hidden caustics, by group.
    pub hidden: BTreeSet<usize>,
    /// Solo caustics, by group; empty shows all that are not hidden.
    pub solo: BTreeSet<usize>,
    /// The wipe comparison.
    pub compare: Option<Wipe>,
    /// Row of the followed photon.
    pub probe: Option<usize>,
    /// Whether drawing snaps to points, lines and the grid.
    pub snapping: bool,
    /// The open panel.
    pub panel: Panel,
    /// The elements that the panels show in detail.
    pub focus: Focus,
}

/// The visible views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewLayout {
    /// Plane and shot, side by side.
    #[default]
    PlaneAndShot,
    /// The plane view.
    Plane,
    /// The shot view, through the camera.
    Shot,
    /// The orbit view.
    Orbit,
}

/// Pan and zoom of the plane view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneViewport {
    /// The plane point at the centre; none for the centre of the plane.
    pub centre: Option<Vec2>,
    /// Zoom relative to the fitted size, 0.05 to 200; 0 counts as 1.
    pub zoom: f32,
}

/// Pan and zoom of the shot view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotViewport {
    /// Zoom relative to the fitted size, 0.05 to 200.
    pub zoom: f32,
    /// Offset of the picture's centre from the view's centre, points.
    pub offset: [f32; 2],
}

impl Default for ShotViewport {
    fn default() -> Self {
        Self { zoom: 1.0, offset: [0.0; 2] }
    }
}

/// The overlays over the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlays {
    /// Lines and walls.
    pub drawn: bool,
    /// The target picture of the next key frame.
    pub target: bool,
    /// Arrows of the field.
    pub arrows: bool,
    /// Moving streamlines of the field.
    pub streamlines: bool,
    /// Paths of some photons.
    pub trails: bool,
    /// The grid of the field.
    pub grid: bool,
    /// The light of plane and shot in false colours.
    pub false_colour: bool,
    /// A map of the field over the light.
    pub map: Option<FieldMap>,
}

impl Default for Overlays {
    fn default() -> Self {
        Self {
            drawn: true,
            target: true,
            arrows: false,
            streamlines: false,
            trails: false,
            grid: false,
            false_colour: false,
            map: None,
        }
    }
}

/// A quantity of the flow field shown as a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldMap {
    /// Sources and sinks: zero at gamma 0.
    Divergence,
    /// Swirls: zero at gamma 1.
    Curl,
    /// Residual of the fit: field minus the directions of the photons.
    Residual,
    /// Where light is torn from its neighbours, and where dark cracks open in it.
    Tears,
}

/// A wipe between this flow and a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wipe {
    /// What the right side shows.
    pub with: Comparison,
    /// Position of the handle, 0 to 1 of the width.
    pub split: f32,
}

/// What the flow is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Another method of movement.
    Method(MotionMethod),
    /// The same project without constraints.
    NothingDrawn,
}

/// A panel on the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Panel {
    /// Flow settings.
    #[default]
    Flow,
    /// Constraints.
    Drawn,
    /// Caustics.
    Caustics,
    /// Key frames.
    Keys,
    /// Meshes, lights, camera, receiver.
    Scene,
    /// Photons, passes, picture size, output files.
    Render,
    /// Energy, walls, solver, time.
    Numbers,
}

/// The elements shown in detail, by index.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Focus {
    /// A key frame.
    pub key: Option<usize>,
    /// A caustic.
    pub caustic: Option<usize>,
    /// An object of the scene: the one selection of the orbit view and the panel.
    pub object: Option<SceneObject>,
}

impl Default for Session {
    fn default() -> Self {
        Self {
            tool: 0,
            selection: Selection::default(),
            playhead: 1,
            playing: false,
            looping: true,
            speed: 1.0,
            marks: [None; 2],
            layout: ViewLayout::default(),
            plane: PlaneViewport::default(),
            shot: ShotViewport::default(),
            free_camera: None,
            through_camera: false,
            transforming: None,
            overlays: Overlays::default(),
            hidden: BTreeSet::new(),
            solo: BTreeSet::new(),
            compare: None,
            probe: None,
            snapping: true,
            panel: Panel::default(),
            focus: Focus::default(),
        }
    }
}

impl Session {
    /// Whether the light of a group is shown.
    pub fn shows_group(&self, group: usize) -> bool {
        if self.solo.is_empty() { !self.hidden.contains(&group) } else { self.solo.contains(&group) }
    }
}
