//! Axes: their names, colours, and the locks of a transform to them.

use egui::Color32;
use glam::Vec3;

/// Names of the axes.
pub const NAMES: [&str; 3] = ["X", "Y", "Z"];

/// Colours of the axes, as in most programs.
pub const COLOURS: [Color32; 3] =
    [Color32::from_rgb(238, 84, 84), Color32::from_rgb(120, 200, 70), Color32::from_rgb(84, 146, 250)];

/// The unit vector of an axis of the world.
pub fn unit(axis: usize) -> Vec3 {
    Vec3::AXES[axis.min(2)]
}

/// Where a transform may go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisLock {
    /// Anywhere in the plane of the view.
    #[default]
    Free,
    /// Along one axis of the world, or about it.
    Axis(usize),
    /// Across one axis of the world.
    Plane(usize),
}

impl AxisLock {
    /// The lock after the key of an axis was pressed: a second press lifts it.
    pub fn pressed(self, axis: usize, shift: bool) -> Self {
        let wanted = if shift { Self::Plane(axis) } else { Self::Axis(axis) };
        if self == wanted { Self::Free } else { wanted }
    }

    /// Its words in the status line, such as " along X".
    pub fn words(self, turns: bool) -> String {
        match self {
            Self::Free => String::new(),
            Self::Axis(axis) if turns => format!(" about {}", NAMES[axis]),
            Self::Plane(axis) if turns => format!(" about {}", NAMES[axis]),
            Self::Axis(axis) => format!(" along {}", NAMES[axis]),
            Self::Plane(axis) => format!(" across {}", NAMES[axis]),
        }
    }
}
