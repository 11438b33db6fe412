//! What is not saved: the tool in hand, what is selected, the moment, what is shown.

use std::collections::BTreeSet;

use glam::Vec2;
use lightloom_core::flow::Movement;

use super::selection::Selection;

/// The state of the window beside the document.
#[derive(Clone, Debug)]
pub struct Session {
    /// The tool in hand, by its place in the list of tools.
    pub tool: usize,
    /// What is selected of what was drawn.
    pub selection: Selection,
    /// The frame that is shown.
    pub playhead: i32,
    /// Whether the animation runs.
    pub playing: bool,
    /// Whether it begins anew at its end.
    pub looping: bool,
    /// Frames from and to which it runs; none runs all.
    pub marks: [Option<i32>; 2],
    /// Which views stand in the window.
    pub layout: ViewLayout,
    /// Where the plane view looks.
    pub plane: PlaneViewport,
    /// Where the shot view looks.
    pub shot: ShotViewport,
    /// From where the free look sees the scene; none until it was turned.
    pub orbit: Option<Orbit>,
    /// What is drawn over the light.
    pub overlays: Overlays,
    /// Caustics that are hidden, by group.
    pub hidden: BTreeSet<usize>,
    /// Caustics that alone are shown, by group; empty shows all that are not hidden.
    pub solo: BTreeSet<usize>,
    /// What the wipe compares with.
    pub compare: Option<Wipe>,
    /// The photon that is followed, by row.
    pub probe: Option<usize>,
    /// Whether drawing snaps to points, lines and the grid.
    pub snapping: bool,
    /// Where dialogs open, and drawn-on panels stand.
    pub panel: Panel,
    /// Caustic, mesh, light or key that the panels show.
    pub focus: Focus,
}

/// Which views stand in the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewLayout {
    /// Plane and shot, side by side.
    #[default]
    PlaneAndShot,
    /// The receiver seen flat.
    Plane,
    /// Through the camera.
    Shot,
    /// From anywhere.
    Orbit,
}

/// Where the plane view looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneViewport {
    /// The plane point in the middle; none for the middle of the plane.
    pub centre: Option<Vec2>,
    /// Times the size at which the plane fits the view, 0.05 to 200; 0 counts as 1.
    pub zoom: f32,
}

/// Where the shot view looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotViewport {
    /// Times the size at which the picture fits the view, 0.05 to 200.
    pub zoom: f32,
    /// How far the middle of the picture lies from the middle of the view, points.
    pub offset: [f32; 2],
}

impl Default for ShotViewport {
    fn default() -> Self {
        Self { zoom: 1.0, offset: [0.0; 2] }
    }
}

/// A camera that looks at a point from a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// The point in the middle, world [m].
    pub target: glam::Vec3,
    /// Turn about the upright axis, radians.
    pub azimuth: f32,
    /// Height above the horizon, radians.
    pub elevation: f32,
    /// Distance from the target [m].
    pub distance: f32,
}

/// What is drawn over the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlays {
    /// Lines and walls.
    pub drawn: bool,
    /// The picture of the next key frame.
    pub target: bool,
    /// Arrows of the field.
    pub arrows: bool,
    /// Moving streamlines of the field.
    pub streamlines: bool,
    /// Ways of some photons.
    pub trails: bool,
    /// The grid of the field.
    pub grid: bool,
    /// A map over the light.
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
            map: None,
        }
    }
}

/// A quantity of the field, shown in false colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldMap {
    /// Sources and sinks: zero at gamma 0.
    Divergence,
    /// Swirls: zero at gamma 1.
    Curl,
    /// How far the field leaves the directions in which the photons should go.
    Residual,
}

/// The wipe between this flow and another way to move the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wipe {
    /// What stands on the right.
    pub with: Comparison,
    /// Where the handle stands, 0 to 1 of the width.
    pub split: f32,
}

/// What this flow is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Another method.
    Method(Movement),
    /// The same without anything drawn.
    NothingDrawn,
}

/// The panel on the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Panel {
    /// gamma, alpha, beta and the rest.
    #[default]
    Flow,
    /// What was drawn.
    Drawn,
    /// The caustics.
    Caustics,
    /// The key frames.
    Keys,
    /// Meshes, lights, camera, receiver.
    Scene,
    /// Photons, passes, picture, files.
    Render,
    /// Energy, walls, solver, time.
    Numbers,
}

/// What the panels show in detail, by index.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Focus {
    /// A key frame.
    pub key: Option<usize>,
    /// A caustic.
    pub caustic: Option<usize>,
    /// A mesh.
    pub mesh: Option<usize>,
    /// A light.
    pub light: Option<usize>,
}

impl Default for Session {
    fn default() -> Self {
        Self {
            tool: 0,
            selection: Selection::default(),
            playhead: 1,
            playing: false,
            looping: true,
            marks: [None; 2],
            layout: ViewLayout::default(),
            plane: PlaneViewport::default(),
            shot: ShotViewport::default(),
            orbit: None,
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
