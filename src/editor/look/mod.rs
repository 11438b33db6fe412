//! Building the scene by hand in the orbit view: selecting, transforming, flying. What happens here is tested without a window.

pub mod arrange;
pub mod axis;
pub mod bounds;
pub mod change;
pub mod commands;
pub mod fly;
pub mod gizmo;
pub(in crate::editor) mod lamp;
pub mod object;
pub mod overlay;
pub mod pick;
pub mod transforming;
pub mod viewpoint;
