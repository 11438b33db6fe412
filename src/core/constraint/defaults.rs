//! Serde defaults shared by the constraints.

/// The default of `enabled`.
pub(super) fn enabled() -> bool {
    true
}

/// Whether a flag has its default and is left out of the file.
pub(super) fn is_false(value: &bool) -> bool {
    !value
}
