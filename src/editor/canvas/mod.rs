//! The receiver seen flat: live light, what was drawn, the flow.

pub mod space;
