//! How much work a sketch is worth.

use crate::constraint::Constraint;
use crate::matching::Method;
use crate::project::Project;

/// Most positions that a sketch keeps, photons times frames: 160 MB.
const MOST_POSITIONS: usize = 20_000_000;

/// Most photons that go around walls.
const MOST_WALLED: usize = 60_000;
/// Relative residual of the solver: what is left shows on no screen.
const TOLERANCE: f32 = 1e-3;

fn is_wall(constraint: &Constraint) -> bool {
    constraint.is_enabled() && matches!(constraint, Constraint::Wall(_))
}

/// How much work a sketch is worth, from an answer at once to one that looks like the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// An answer while the hand still moves: 4000 photons, 32 cells, 12 steps.
    Draft,
    /// What is worked with: 20 000 photons, 64 cells, 30 steps.
    Preview,
    /// The fields of the preview carry 150 000 photons of their own; 60 000 where walls stand, around which each finds its
    /// way.
    Fine,
}

impl Detail {
    /// All, the cheapest first.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Preview, Self::Fine];

    /// Photons at most.
    pub fn photons(self) -> usize {
        match self {
            Self::Draft => 4_000,
            Self::Preview => 20_000,
            Self::Fine => 150_000,
        }
    }

    /// Most anchors of a map around walls.
    pub(super) fn anchors(self) -> usize {
        match self {
            Self::Draft => 128,
            Self::Preview | Self::Fine => 512,
        }
    }

    /// Cells along each side of the field, and its steps, at most.
    fn cells_and_steps(self) -> (u32, u32) {
        match self {
            Self::Draft => (32, 12),
            Self::Preview | Self::Fine => (64, 30),
        }
    }

    /// Photons for a project of this many frames, and a note where they are fewer than they would be.
    pub(super) fn photons_for(self, project: &Project, frames: usize) -> (usize, Option<String>) {
        // Where rows are paired as given, their number is that of the files.
        let most = match project.matching {
            Method::Given => usize::MAX,
            Method::Transport => usize::try_from(project.render.photons).unwrap_or(usize::MAX),
        };
        let walled = project.fits() && project.constraints.iter().any(is_wall);
        let wanted = self.photons().min(most).min(if walled { MOST_WALLED } else { usize::MAX });
        let kept = (MOST_POSITIONS / frames.max(1)).clamp(1, wanted);
        let note = (kept < wanted).then(|| {
            format!(
                "preview: {kept} photons in place of {wanted}, so that {frames} frames fit into memory; what is rendered keeps its photons"
            )
        });
        (kept, note)
    }

    /// The project whose flow is no more work than this is worth. Fields are fitted to all `photons`, whose ways then
    /// need no second look.
    pub(super) fn apply(self, project: &Project, photons: usize) -> Project {
        let mut project = project.clone();
        let (cells, steps) = self.cells_and_steps();
        let flow = &mut project.flow;
        flow.grid = flow.grid.at_most(cells);
        flow.steps = flow.steps.min(steps);
        flow.tolerance = flow.tolerance.max(TOLERANCE);
        flow.guides = u32::try_from(photons).unwrap_or(u32::MAX);
        project
    }
}
