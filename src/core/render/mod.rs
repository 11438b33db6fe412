//! From photons to pictures (Sec. 4).
//!
//! On a plane, progressive photon mapping is a histogram of each pass ([`splat`]) filtered with the kernel of the pass
//! ([`density`]), summed per frame in a scratch file ([`frames`]). The camera sees the texture through a sparse matrix
//! ([`visible`]); a frame is [`mod@background`] + matrix x texture. [`view`] makes it fit for a screen. [`mod@look`] shows
//! a scene at once from anywhere, to find one's way in it.

pub mod background;
pub mod density;
pub mod frames;
pub mod image;
pub mod look;
pub mod plane_picture;
pub mod plane_view;
pub mod progressive;
pub mod settings;
pub mod splat;
pub mod texture;
pub mod view;
pub mod visible;

mod sampler;

pub use background::{background, rough_background};
pub use image::Image;
pub use look::{LookLight, Mark, MarkKind, look, marks};
pub use plane_picture::{Paper, plane_picture};
pub use plane_view::PlaneView;
pub use progressive::{ProgressiveRender, Workspace, first_radius};
pub use settings::RenderSettings;
pub use texture::{ReceiverTexture, TextureLayout};
pub use view::{View, ViewSettings, ViewTransform};
pub use visible::{Visible, layout_for};
