//! The document an artist saves.
