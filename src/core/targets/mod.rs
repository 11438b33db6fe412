//! Target points of the photons: samples of a picture's brightness, or points from a file.

mod brightness;
mod decode;
mod light;
mod picture;
mod points;
mod settings;

pub use brightness::Brightness;
pub use light::PictureLight;
pub use picture::PictureSampler;
pub use points::{Points, load_points};
pub use settings::{Channel, ImageTarget, Placement, PointsTarget};
