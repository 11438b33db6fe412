//! Rendering of photons to pictures (Sec. 4).
//!
//! On a plane, progressive photon mapping is a histogram of each pass ([`splat`]) filtered with the kernel of the pass
//! ([`density`]), summed per frame in a scratch file ([`frames`]). A sparse matrix ([`gather_matrix`]) maps the texture to
//! the camera's pixels; a frame is [`mod@background`], or a [`plate`], + matrix x texture. [`view`] is the view transform for
//! screens.
//! [`still_light`] is what does not flow. [`orbit_view`] is an immediate picture of the scene from anywhere, for orientation.

pub mod background;
pub mod density;
pub mod first_hits;
mod frame_journal;
pub mod frames;
pub mod gather_matrix;
pub mod image;
pub mod orbit_view;
pub mod plane_image;
pub mod plane_view;
pub mod plate;
pub mod progressive;
pub mod settings;
pub mod sparse;
pub mod splat;
pub mod still_light;
pub mod texture;
pub mod view;

mod adaptive;
mod camera_sampler;
mod fireflies;
mod in_view;
mod sampler;
mod smooth;

pub use background::{
    Background, BackgroundSamples, KeepSamples, background, background_from, rough_background,
};
pub use fireflies::ClampedLight;
pub use first_hits::FirstHits;
pub use gather_matrix::{GatherMatrix, layout_for};
pub use image::Image;
pub use in_view::{ReceiverView, receiver_view};
pub use orbit_view::{OrbitLight, orbit_image};
pub use plane_image::{PlaneMaterial, plane_image};
pub use plane_view::PlaneView;
pub use plate::{Plate, PlateSettings};
pub use progressive::{ProgressiveRender, Workspace, first_radius};
pub use settings::RenderSettings;
pub use sparse::smooth_sparse;
pub use still_light::{StillPictures, StillTextures, still_layout, still_pictures, watts_at};
pub use texture::{ReceiverTexture, TextureLayout};
pub use view::{View, ViewSettings, ViewTransform};
