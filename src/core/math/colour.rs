//! Linear Rec.709 colours.

use glam::Vec3;

/// Luminance of a linear Rec.709 colour (ITU-R BT.709-6, Sec. 3.2).
pub fn luminance(colour: Vec3) -> f32 {
    colour.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}
