//! Scenes of other programs as projects: glTF with its lamps, cameras and materials, OBJ with its glass.
//!
//! What a file does not say is made so that a caustic is seen at once: glass, a lamp that shines on it, the table beneath, a
//! camera that looks at both. Whatever was guessed or left out is a note.

mod camera;
mod copy;
mod draft;
mod empty;
mod flat;
mod gltf;
mod imported;
mod lamp;
mod obj;
mod paths;
mod reading;
mod receiver;
mod setting;
mod summary;

pub use copy::into_folder;
pub use empty::{awaits_glass, empty_project};
pub use imported::Import;
pub use reading::read;
pub use summary::Summary;
