//! The solids that begin or end at one place.

/// A place where surfaces of several glass solids lie in one another.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(in crate::scene) struct Contact {
    /// The mesh whose triangle stands for all: by priority, then the later in the list. Light that passes counts as its.
    pub owner: u16,
    /// Every shell that begins or ends there: its mesh, and whether its outside is that of the owner's triangle.
    pub sides: Vec<(u16, bool)>,
}
