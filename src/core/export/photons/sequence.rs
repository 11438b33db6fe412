//! The photons of a sequence, frame by frame, and the lines drawn among them.

use glam::Vec3;

/// What is the same in all frames.
#[derive(Clone, Debug)]
pub struct PhotonSequence {
    /// The project's name.
    pub name: String,
    /// First and last frame.
    pub range: [i32; 2],
    /// Frames per second as a fraction.
    pub frames_per_second: [u32; 2],
    /// Number of photons in every frame.
    pub photons: usize,
    /// Diameter at which photons are drawn: the mean distance of evenly spread ones (m).
    pub width: f32,
    /// Drawn lines and walls.
    pub lines: Vec<DrawnLine>,
}

/// A drawn line or wall.
#[derive(Clone, Debug)]
pub struct DrawnLine {
    /// Its name in the file: letters, digits and underscores; each name once.
    pub name: String,
    /// World (m), at least two.
    pub points: Vec<Vec3>,
    /// Full width (m).
    pub width: f32,
    /// Linear colour.
    pub colour: Vec3,
    /// First and last frame in which it acts; none for all.
    pub span: Option<[i32; 2]>,
}

/// The photons of one frame: columns of equal length, row k being photon k in every frame.
#[derive(Clone, Copy, Debug)]
pub struct PhotonFrame<'a> {
    /// Its number.
    pub frame: i32,
    /// World (m).
    pub positions: &'a [Vec3],
    /// Metres per second.
    pub velocities: &'a [Vec3],
    /// RGB flux, watts.
    pub flux: &'a [Vec3],
}
