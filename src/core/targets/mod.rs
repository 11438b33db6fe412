//! Target points of the photons: samples of a picture's brightness, or points from a file.

mod brightness;
mod decode;
mod picture;
mod points;
mod settings;

pub use brightness::Brightness;
pub use picture::PictureSampler;
pub use points::{Points, load_points};
pub use settings::{Channel, ImageTarget, Placement, PointsTarget};
