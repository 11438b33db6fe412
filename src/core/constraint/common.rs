//! The settings that all constraints share, and their serde defaults.

use crate::setting::{Choice, Setting, settings};

/// The settings that all constraints share.
pub struct Common;

settings! { Common {
    /// The artist's name for it.
    NAME = Setting::text("constraints[].name");
    /// The frames during which it acts. Light that a wall holds back meanwhile goes on afterwards.
    SPAN = Setting::choice("constraints[].span", &[
        Choice { value: "", help: "in all frames" },
        Choice { value: "", help: "from one frame to another" },
    ]);
    /// Whether it acts at all: the eye in the editor's list.
    ENABLED = Setting::switch("constraints[].enabled", true);
    /// Whether the editor keeps it from being changed: the padlock in its list.
    LOCKED = Setting::switch("constraints[].locked", false);
    /// The group to which the artist puts it: those of one name stand together in the editor's list, with an eye and a padlock for
    /// all of them.
    GROUP = Setting::text("constraints[].group");
} }

/// The default of `enabled`.
pub(super) fn enabled() -> bool {
    Common::ENABLED.is_on()
}

/// Whether a flag has its default and is left out of the file.
pub(super) fn is_false(value: &bool) -> bool {
    !value
}
