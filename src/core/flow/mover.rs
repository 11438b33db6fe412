//! What moves the photons of a segment, whatever the method: one interface for passes and tracks.

use glam::Vec2;

use super::path::Paths;
use super::trajectory::{Astray, Carrier, Fields};
use crate::{Progress, Result};

/// What moves the photons from one key to the next.
pub enum Mover {
    /// Fitted fields.
    Fields(Fields),
    /// Ways that are known from their ends and bows.
    Paths,
}

impl Mover {
    /// Photons at `source`, each bound for the target in the same row. `bows` are those of their pairing; fields have no
    /// use for them.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn carry<'a>(&'a self, source: &'a [Vec2], targets: &'a [Vec2], bows: &'a [Vec2]) -> Carriage<'a> {
        match self {
            Self::Fields(fields) => Carriage::Fields(Box::new(Carrier::new(fields, source, targets))),
            Self::Paths => Carriage::Paths(Paths::new(source, targets, bows)),
        }
    }

    /// The fields, where there are any.
    pub fn fields(&self) -> Option<&Fields> {
        match self {
            Self::Fields(fields) => Some(fields),
            Self::Paths => None,
        }
    }
}

/// Photons of one pass on their way.
pub enum Carriage<'a> {
    /// Carried along the fields.
    Fields(Box<Carrier<'a>>),
    /// Asked of their ways.
    Paths(Paths<'a>),
}

impl Carriage<'_> {
    /// Positions at time `t`, clipped to 0..=1. Ascending times cost least; at t = 1 each photon is at its target.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        match self {
            Self::Fields(carrier) => carrier.positions_at(t, out, progress),
            Self::Paths(paths) => {
                paths.positions(t, out);
                progress.check()
            }
        }
    }

    /// Photons that walls did not keep, so far.
    pub fn astray(&self) -> Astray {
        match self {
            Self::Fields(carrier) => carrier.astray(),
            Self::Paths(_) => Astray::default(),
        }
    }
}
