//! Where photons should go: pictures, drawn from by brightness, and files of points.

mod brightness;
mod decode;
mod picture;
mod points;
mod settings;

pub use brightness::Brightness;
pub use picture::PictureSampler;
pub use points::{Points, load_points};
pub use settings::{Channel, ImageTarget, Placement, PointsTarget};
